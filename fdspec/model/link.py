"""Links: dampers, joints and braces between any two floors of a building, or a floor and the ground."""

from __future__ import annotations

import math
import operator
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from fdspec.errors import InvalidInput
from fdspec.model.number_check import finite_number, not_negative_number, positive_number


@dataclass(frozen=True, init=False)
class Link:
    """Hold a friction damper on a brace between two floors, or a floor and the ground.

    The brace, a spring, stands on `lower`; its top slides against `upper` under friction. Beside friction a
    re-centring spring may act across the slider, with preload a flag-shaped joint, and bolts that come to
    bear at the ends of their slot.

    Parameters
    ----------
    upper, lower : int
        The floors it joins, counted from 1; 0 is the ground. Slip is positive where `upper` moves ahead.
    stiffness : float, N/m
        Stiffness of the brace, positive.
    slip_force : float, N
        Static friction. 0 slides freely, ``math.inf`` never slips.
    mass : float, kg
        Mass that moves with the sliding plate. 0: the damper slips quasi-statically.
    kinetic_slip_force : float, N, optional
        Friction while sliding, at most `slip_force` and by default the same.
    slot_length : float, m, optional
        Free slip to either side before the bolts bear; by default there is no end.
    slot_stiffness : float, N/m, optional
        Stiffness of the bolts in bearing; needed with a slot's length.
    recentring_stiffness : float, N/m, optional
        Spring across the slider: W/R of a friction pendulum.
    recentring_preload : float, N, optional
        Force of that spring at no slip, which makes the joint flag-shaped: it returns to its middle where the
        preload exceeds friction. For links without mass.
    friction_stiffness : float, N/m, optional
        Growth of friction with slip, as of wedges that clamp harder, at most `recentring_stiffness`. For
        links without mass.
    name : str, optional
        What the ``link`` coordinate says; "link 1" and so on unless given.

    Raises
    ------
    InvalidInput
        When an argument cannot be used; the text says which, its value and what would be right.

    Examples
    --------
    >>> Link(2, 0, 40e6, 80e3, slot_length=0.03, slot_stiffness=200e6).lower
    0
    """

    upper: int
    lower: int
    stiffness: float
    slip_force: float
    mass: float
    kinetic_slip_force: float
    slot_length: float
    slot_stiffness: float
    recentring_stiffness: float
    recentring_preload: float
    friction_stiffness: float
    name: str | None

    def __init__(
        self,
        upper: int,
        lower: int,
        stiffness: float,
        slip_force: float,
        *,
        mass: float = 0.0,
        kinetic_slip_force: float | None = None,
        slot_length: float | None = None,
        slot_stiffness: float | None = None,
        recentring_stiffness: float | None = None,
        recentring_preload: float | None = None,
        friction_stiffness: float | None = None,
        name: str | None = None,
    ) -> None:
        ends = _ends(upper, lower)
        static = _force("slip_force", slip_force)
        kinetic = static if kinetic_slip_force is None else _force("kinetic_slip_force", kinetic_slip_force)
        if kinetic > static:
            raise InvalidInput(
                f"kinetic_slip_force must be at most slip_force, but is {kinetic:g} over {static:g} N"
            )
        length = math.inf if slot_length is None else _length(slot_length)
        bearing = 0.0 if slot_stiffness is None else not_negative_number("slot_stiffness", slot_stiffness)
        if length < math.inf and bearing == 0.0:
            raise InvalidInput(
                f"slot_stiffness must be positive, in N/m, where slot_length is given ({length:g} m)"
            )
        across = {
            name: 0.0 if value is None else not_negative_number(name, value)
            for name, value in (
                ("recentring_stiffness", recentring_stiffness),
                ("recentring_preload", recentring_preload),
                ("friction_stiffness", friction_stiffness),
            )
        }
        plate = not_negative_number("mass", mass)
        for argument in ("recentring_preload", "friction_stiffness"):
            if plate > 0.0 and across[argument] > 0.0:
                raise InvalidInput(f"{argument} is for links without mass, and this one has {plate:g} kg")
        if across["friction_stiffness"] > across["recentring_stiffness"]:
            raise InvalidInput(
                f"friction_stiffness must be at most recentring_stiffness, but is "
                f"{across['friction_stiffness']:g} over {across['recentring_stiffness']:g} N/m"
            )
        fields = {
            "upper": ends[0],
            "lower": ends[1],
            "stiffness": positive_number("stiffness", stiffness, "N/m"),
            "slip_force": static,
            "mass": plate,
            "kinetic_slip_force": kinetic,
            "slot_length": length,
            "slot_stiffness": bearing,
            **across,
            "name": _name(name),
        }
        for key, value in fields.items():
            object.__setattr__(self, key, value)


@dataclass(frozen=True, init=False)
class TensionBrace:
    """Hold a brace that works in one direction only, beyond its slack, and yields.

    A pair of them with directions 1 and -1 is a cross of tension-only braces. Yielding lengthens the brace
    and so adds to its slack.

    Parameters
    ----------
    upper, lower : int
        The floors it joins, counted from 1; 0 is the ground.
    stiffness : float, N/m
        Stiffness while it is taut, along the drift; positive.
    yield_force : float, N, optional
        Force at which it yields; by default it does not.
    slack : float, m
        Drift before it becomes taut, 0 or more.
    direction : int
        1 where a forward drift stretches it, -1 where a backward one does.
    name : str, optional
        What the ``link`` coordinate says; "link 1" and so on unless given.

    Raises
    ------
    InvalidInput
        When an argument cannot be used; the text says which, its value and what would be right.
    """

    upper: int
    lower: int
    stiffness: float
    yield_force: float
    slack: float
    direction: int
    name: str | None

    def __init__(
        self,
        upper: int,
        lower: int,
        stiffness: float,
        yield_force: float | None = None,
        *,
        slack: float = 0.0,
        direction: int = 1,
        name: str | None = None,
    ) -> None:
        ends = _ends(upper, lower)
        force = math.inf if yield_force is None else _force("yield_force", yield_force)
        if force == 0.0:
            raise InvalidInput("yield_force must be positive, in N (inf never yields), not 0")
        if direction not in (1, -1):
            raise InvalidInput(f"direction must be 1 or -1, not {direction!r}")
        fields = {
            "upper": ends[0],
            "lower": ends[1],
            "stiffness": positive_number("stiffness", stiffness, "N/m"),
            "yield_force": force,
            "slack": not_negative_number("slack", slack),
            "direction": int(direction),
            "name": _name(name),
        }
        for key, value in fields.items():
            object.__setattr__(self, key, value)


def link_of(parameters: Mapping[str, Any]) -> Link | TensionBrace:
    """Return the link of these parameters, by name: a `TensionBrace` where its direction is among them."""
    return TensionBrace(**parameters) if "direction" in parameters else Link(**parameters)


def _ends(upper: object, lower: object) -> tuple[int, int]:
    ends = []
    for argument, floor in (("upper", upper), ("lower", lower)):
        try:
            number = operator.index(floor)  # type: ignore[arg-type]
        except TypeError:
            number = -1
        if number < 0 or isinstance(floor, bool):
            raise InvalidInput(
                f"{argument} must be a floor counted from 1, or 0 for the ground, not {floor!r}"
            )
        ends.append(number)
    if ends[0] == ends[1]:
        raise InvalidInput(f"upper and lower must be two floors, not both {ends[0]}")
    if ends[0] == 0:
        raise InvalidInput("upper must be a floor, counted from 1; the ground, 0, is always the lower one")
    return ends[0], ends[1]


def _force(argument: str, value: float) -> float:
    if value == math.inf:
        return math.inf
    return not_negative_number(argument, value)


def _length(value: float) -> float:
    if value == math.inf:
        return math.inf
    return positive_number("slot_length", finite_number("slot_length", value), "m")


def _name(name: object) -> str | None:
    if name is not None and (not isinstance(name, str) or not name):
        raise InvalidInput(f"name must be a text of one character or more, not {name!r}")
    return name
