"""What kernels are handed and hand back: NamedTuples of floats, phase and status codes."""

from __future__ import annotations

from typing import Final, NamedTuple

from fdspec.compiler.positions import positions

STICK: Final = 0
"""Phase: floor and brace move as one.  The slip phases are +1 and -1, the sign of the sliding velocity."""

OK: Final = 0
"""Status: the history is complete."""
TRANSITION_CAP_REACHED: Final = 1
"""Status: more changes of phase than the cap allows; results cover the motion up to there."""
NON_FINITE_STATE: Final = 2
"""Status: displacement or velocity is no longer a number."""

ITERATION_NOT_CONVERGED: Final = 3
"""Status of a method that iterates: a step's accelerations or forces did not settle."""
ENERGY_NOT_CLOSED: Final = 4
"""Status: the balance of all energies is off by more than ENERGY_TOLERANCE; the results cannot be trusted."""
COLLAPSED: Final = 5
"""Status: a drift has reached the limit at which the frame counts as collapsed; results end there."""

STATUS_MEANINGS: Final = (
    "ok",
    "transition_cap_reached",
    "non_finite_state",
    "iteration_not_converged",
    "energy_not_closed",
    "collapsed",
)
"""Name of each status, in the order of the codes."""

ENERGY_TOLERANCE: Final = 1e-6
"""Error of the energy balance, relative to the energy in play, above which a history is not ok.

Rounding leaves 1e-15 to 1e-11 and grows with the number of changes of phase, to 1e-9 at the worst; a rule
that went wrong, a missed change of phase say, leaves 1e-4 and more.  This stands between.
"""

TRANSITION_CAP: Final = 50_000_000
"""Changes of phase after which a history is given up: a guard against a loop, beyond any real one."""


class Storey(NamedTuple):
    """One storey with its brace and damper, SI units."""

    floor_mass: float
    floor_damping: float
    floor_stiffness: float
    brace_mass: float
    brace_damping: float
    brace_stiffness: float
    slip_force: float
    kinetic_slip_force: float


class Motion(NamedTuple):
    """Floor and brace at one instant, relative to the ground: m, m/s."""

    u: float
    v: float
    d: float
    e: float


class Peaks(NamedTuple):
    """Largest magnitudes so far: absolute floor acceleration, displacement, velocity, base shear."""

    acceleration: float
    displacement: float
    velocity: float
    shear: float


class Force(NamedTuple):
    """Force over mass at a segment's start and its rate: floor (or floor and brace as one), and brace."""

    p0: float
    p1: float
    b0: float
    b1: float


class Energy(NamedTuple):
    """Work so far, J: of the ground, of the viscous dampers, of a massless brace's sudden release."""

    input: float
    viscous: float
    release: float


STATE = positions(
    "u v d e offset phase onset touching peak_acceleration peak_displacement peak_velocity peak_shear "
    "input viscous release anchor travel transitions events status stored peak_slip peak_brace".split()
)
"""Places in the state of a history: floor and brace; slip offset of the stick phase; phase; how the next
segment begins (sliding acceleration of a new slip, side at which the reaction stands at the slip force);
peaks; work of the ground, of the dampers, of releases; u - d where the slip began, slip travel before it;
counts; status; energy at the start; largest slip offset where slip began or stopped; largest brace force."""

N_STATE: Final = len(STATE)

NO_ONSET: Final = -1.0
"""Onset in the state where no slip begins with the next segment."""
