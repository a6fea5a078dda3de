"""Plans put away as rows of numbers, so that many histories can be taken up in turn."""

from __future__ import annotations

from fdspec.jit import inlined, inner
from fdspec.kernels.oscillator import StepMap
from fdspec.kernels.plan import Branch, Plan
from fdspec.kernels.types import Storey

_STOREY, _STICK, _FLOOR, _BRACE, _SCALARS, _STICK_MAP, _FLOOR_MAP, _BRACE_MAP = 0, 8, 13, 18, 23, 34, 46, 58
N_SHELF = 70
"""Numbers of a plan."""


@inner
def put_numbers(row, at, numbers):
    """Store a tuple of floats from place ``at`` on."""
    for k in range(len(numbers)):
        row[at + k] = numbers[k]


@inlined
def branch_at(row, at):
    """Take a Branch from the row."""
    return Branch(row[at], row[at + 1], row[at + 2], row[at + 3], row[at + 4])


@inlined
def map_at(row, at):
    """Take a StepMap from the row."""
    return StepMap(
        row[at],
        row[at + 1],
        row[at + 2],
        row[at + 3],
        row[at + 4],
        row[at + 5],
        row[at + 6],
        row[at + 7],
        row[at + 8],
        row[at + 9],
        row[at + 10],
        row[at + 11],
    )


@inner
def put_plan(row, plan):
    """Put a plan away."""
    put_numbers(row, _STOREY, plan.storey)
    put_numbers(row, _STICK, plan.stick)
    put_numbers(row, _FLOOR, plan.floor)
    put_numbers(row, _BRACE, plan.brace)
    scalars = (
        plan.mass,
        plan.hold_u,
        plan.hold_v,
        plan.hold_offset,
        plan.lift,
        plan.step,
        plan.slip_steps,
        plan.slip_step,
        plan.stick_order,
        plan.slip_order,
        plan.floor_order,
    )
    put_numbers(row, _SCALARS, scalars)
    put_numbers(row, _STICK_MAP, plan.stick_map)
    put_numbers(row, _FLOOR_MAP, plan.floor_map)
    put_numbers(row, _BRACE_MAP, plan.brace_map)


@inlined
def take_plan(row):
    """Take a plan up again."""
    at = _SCALARS
    return Plan(
        Storey(row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7]),
        branch_at(row, _STICK),
        branch_at(row, _FLOOR),
        branch_at(row, _BRACE),
        row[at],
        row[at + 1],
        row[at + 2],
        row[at + 3],
        row[at + 4],
        row[at + 5],
        row[at + 6],
        row[at + 7],
        row[at + 8],
        row[at + 9],
        row[at + 10],
        map_at(row, _STICK_MAP),
        map_at(row, _FLOOR_MAP),
        map_at(row, _BRACE_MAP),
    )
