"""A frame with devices as kernels see it, and the arrays that a history works in.

Nodes are the ground, 0, and the floors, 1 to N.  Springs and dashpots stand between any two nodes, links
between any two as well.  A link is a brace, a spring and perhaps a dashpot that stands on its lower node,
and a slider that joins its top to the upper node.  Its unknown is the slip offset o, the part of its
deformation g = u_upper - u_lower that is not the brace's: the brace's stretch is g - o.

Across the slider act friction and, in parallel, what depends on the offset alone: a re-centring spring,
its preload, and the bearing of a bolt that has reached the end of its slot (`law`).  A column that yields
is a link too: its brace is the part (1 - alpha) k of its stiffness that yields, friction its yield force,
the slip offset its plastic deformation.  All forces are made of straight lines, so that between two events
the frame is linear.
"""

from __future__ import annotations

from typing import Any, NamedTuple

UPPER = 0
LOWER = 1
KIND = 2
KINKED = 3
PLACE_ROWS = 4
"""Rows of ``places`` (4, L): the nodes a link joins, its kind, whether its law has a corner at offset 0."""

WITH_MASS = 0
"""A plate with mass on the brace: the offset obeys an equation of motion."""
WITHOUT_MASS = 1
"""The brace ends in the slider: its force is the slider's at all times.  Columns are of this kind."""
WITH_DASHPOT = 2
"""The same with a dashpot beside the brace's spring: the offset lags behind."""
ONE_SIDED = 3
"""A brace that works in one direction only, beyond its slack, which is its offset; yielding adds to it."""

MASS = 0
STIFFNESS = 1
DAMPING = 2
STATIC = 3
KINETIC = 4
SLOT_LENGTH = 5
SLOT_STIFFNESS = 6
RECENTRING = 7
PRELOAD = 8
FRICTION_GROWTH = 9
DIRECTION = 10
BESIDE = 11
LINK_ROWS = 12
"""Rows of ``links`` (12, L), SI units.  The mass of the plate; the brace; friction at rest and in motion, a
member's yield force; free slip to either side (inf: no end) and stiffness beyond; re-centring stiffness, its
preload, and growth of friction with the offset; the direction, +1 or -1, of a one-sided brace; stiffness that
stands beside the link and counts in its peak force, the elastic part of columns that yield."""

SPRING_STIFFNESS = 0
SPRING_DAMPING = 1
GRAVITY = 2
SPRING_ROWS = 3
"""Rows of ``springs`` (3, E): stiffness and damping between two nodes; P/h that gravity takes off, N/m."""

PHASE = 0
"""0 stuck, or the sign of the sliding velocity.  One-sided: -1 slack, 0 taut, 1 yielding."""
REGION = 1
"""Where the offset stands on the slider's law: see `law`."""
VANISHING = 2
"""How many leading coefficients of the guard vanish because of the event that has just happened."""
TOUCHING = 3
"""Direction in which a link that has just stuck stands at its limit, else 0."""
MODE_ROWS = 4
"""Rows of ``mode`` (4, L)."""

U = 0
V = 1
"""Rows of ``floors`` (2, N + 1): displacement and velocity relative to the ground, m, m/s."""
O = 0
Z = 1
"""Rows of ``sliders`` (2, L): slip offset and sliding velocity, m, m/s."""

A = 2
"""Third row of the floors' series: absolute acceleration, m/s2."""
BRACE = 2
REACTION = 3
"""Third and fourth row of the sliders' series: force in the brace; friction that would keep the sliding
velocity as it is, N."""

ANCHOR = 0
TRAVEL = 1
WORK = 2
EVENTS = 3
CONTACTS = 4
PEAK_SLIP = 5
PEAK_DEFORMATION = 6
PEAK_FORCE = 7
ORIGIN = 8
PEAK_TOP = 9
TALLY_ROWS = 10
"""Rows of ``tally`` (10, L): offset where the present slip began; distance slipped and energy dissipated
before it; changes of phase; contacts of the slot and releases; peaks of the slip from where the link was
fastened, of |g| and of the link's force; offset where it was fastened; peak of the displacement
of the brace's top."""


class Frame(NamedTuple):
    """What the building is; every field is an array."""

    mass: Any
    """(N + 1,) kg, the ground's is infinite."""
    ends: Any
    """(2, E) nodes of the springs: upper, lower."""
    springs: Any
    """(SPRING_ROWS, E)."""
    dense_stiffness: Any
    dense_damping: Any
    """(N, N), or (0, 0): what does not fit into springs between nodes."""
    places: Any
    """(PLACE_ROWS, L)."""
    links: Any
    """(LINK_ROWS, L)."""
    drift_limit: Any
    """(N,) m: drift between a floor and the one below at which the frame has collapsed; inf: never."""
    below: Any
    """(N,) node that each storey stands on."""
    carried: Any
    """(S, N + 1) which nodes each storey carries; one more row where the ground carries several frames."""


class Law(NamedTuple):
    """What the present modes make of the frame; every field is an array."""

    compliance: Any
    """(N + 1,) 1 / mass that moves with a node, 1/kg."""
    across: Any
    """(L,) stiffness across a slider in its present region and direction, N/m."""
    constant: Any
    """(L,) force across the slider at offset 0 on the present straight line, friction included while it
    slips, N."""


class State(NamedTuple):
    """Where the frame is."""

    floors: Any
    sliders: Any
    mode: Any
    tally: Any


class Series(NamedTuple):
    """Taylor series of a step: coefficients of powers of the fraction of the step."""

    floors: Any
    """(3, N + 1, TERMS): displacement, velocity, absolute acceleration."""
    sliders: Any
    """(4, L, TERMS): offset, sliding velocity, force of the brace, reaction."""
    momentum: Any
    """(TERMS,): sum m u', kg m/s."""
    c: Any
    """(TERMS,): room for one polynomial."""
