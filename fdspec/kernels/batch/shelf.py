"""Plans put away as rows of numbers, so that many histories can be taken up in turn."""

from __future__ import annotations

from fdspec.compiler.options import inlined, inner
from fdspec.kernels.mathematics.oscillator import StepMap
from fdspec.kernels.storey.constants import Branch, Plan
from fdspec.kernels.types import Storey

_STOREY, STICK_BRANCH, FLOOR_BRANCH, BRACE_BRANCH, SCALARS = 0, 8, 13, 18, 23
STICK_MAP, FLOOR_MAP, BRACE_MAP = 34, 46, 58
"""Places of a plan's parts in its row."""

N_SHELF = 70
"""Numbers of a plan."""

N_STRIDE = 24
"""Numbers of two step maps, of floor and brace apart over a whole step."""


@inner
def put_numbers(shelf, i, at, numbers):
    """Store a tuple of floats in row i from place ``at`` on."""
    for k in range(len(numbers)):
        shelf[i, at + k] = numbers[k]


@inlined
def branch_at(shelf, i, at):
    """Take a Branch from row i."""
    return Branch(shelf[i, at], shelf[i, at + 1], shelf[i, at + 2], shelf[i, at + 3], shelf[i, at + 4])


@inlined
def map_at(shelf, i, at):
    """Take a StepMap from row i."""
    return StepMap(
        shelf[i, at],
        shelf[i, at + 1],
        shelf[i, at + 2],
        shelf[i, at + 3],
        shelf[i, at + 4],
        shelf[i, at + 5],
        shelf[i, at + 6],
        shelf[i, at + 7],
        shelf[i, at + 8],
        shelf[i, at + 9],
        shelf[i, at + 10],
        shelf[i, at + 11],
    )


@inner
def put_plan(shelf, i, plan):
    """Put a plan away."""
    put_numbers(shelf, i, _STOREY, plan.storey)
    put_numbers(shelf, i, STICK_BRANCH, plan.stick)
    put_numbers(shelf, i, FLOOR_BRANCH, plan.floor)
    put_numbers(shelf, i, BRACE_BRANCH, plan.brace)
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
    put_numbers(shelf, i, SCALARS, scalars)
    put_numbers(shelf, i, STICK_MAP, plan.stick_map)
    put_numbers(shelf, i, FLOOR_MAP, plan.floor_map)
    put_numbers(shelf, i, BRACE_MAP, plan.brace_map)


@inlined
def take_plan(shelf, i):
    """Take a plan up again."""
    at = SCALARS
    return Plan(
        Storey(
            shelf[i, 0],
            shelf[i, 1],
            shelf[i, 2],
            shelf[i, 3],
            shelf[i, 4],
            shelf[i, 5],
            shelf[i, 6],
            shelf[i, 7],
        ),
        branch_at(shelf, i, STICK_BRANCH),
        branch_at(shelf, i, FLOOR_BRANCH),
        branch_at(shelf, i, BRACE_BRANCH),
        shelf[i, at],
        shelf[i, at + 1],
        shelf[i, at + 2],
        shelf[i, at + 3],
        shelf[i, at + 4],
        shelf[i, at + 5],
        shelf[i, at + 6],
        shelf[i, at + 7],
        shelf[i, at + 8],
        shelf[i, at + 9],
        shelf[i, at + 10],
        map_at(shelf, i, STICK_MAP),
        map_at(shelf, i, FLOOR_MAP),
        map_at(shelf, i, BRACE_MAP),
    )
