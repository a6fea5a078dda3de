"""The study's first validation problem: a single-storey frame with K bracing and a friction joint.

Printed: frame 20 000 kg and 0.4 s, additional frame 27 kg and 0.0684 s, friction coefficient 0.15,
damping 2 %, the NS component of Kalamata, 13 September 1986 (0.240 g); what is plotted is the displacement
of the additional frame.
Assumed: the normal force, which is not printed; both periods are those of each frame standing by itself, so
that each stiffness is its mass times (2 pi / period)^2; the 2 % are the main frame's, the additional one is
undamped; static and kinetic friction are equal.
"""

from __future__ import annotations

import math
from typing import Final

from fdspec.model.building import Building, ModalDamping
from fdspec.model.motion import GroundMotion
from fdspec.validation.kalamata import stand_in
from fdspec.validation.pair import Pair, both

FRAME_MASS: Final = 20e3
"""kg"""
FRAME_PERIOD: Final = 0.4
"""s"""
ADDITIONAL_MASS: Final = 27.0
"""kg"""
ADDITIONAL_PERIOD: Final = 0.0684
"""s"""
FRICTION_COEFFICIENT: Final = 0.15
DAMPING_RATIO: Final = 0.02
NORMAL_FORCE: Final = 10e3
"""N, assumed: slip at 1.5 kN, about a third of the most that the brace would carry if it never slipped."""


def building(normal_force: float = NORMAL_FORCE) -> Building:
    """Make the frame with its additional frame; the joint slips at 0.15 times the normal force (N)."""
    return Building(
        floor_mass=FRAME_MASS,
        storey_stiffness=FRAME_MASS * (2.0 * math.pi / FRAME_PERIOD) ** 2,
        brace_mass=ADDITIONAL_MASS,
        brace_stiffness=ADDITIONAL_MASS * (2.0 * math.pi / ADDITIONAL_PERIOD) ** 2,
        slip_force=FRICTION_COEFFICIENT * normal_force,
        damping=ModalDamping(DAMPING_RATIO),
    )


def solve(motion: GroundMotion | None = None, normal_force: float = NORMAL_FORCE) -> Pair:
    """Solve the problem: bare frame and damped frame.

    Parameters
    ----------
    motion : GroundMotion, optional
        The excitation, by default a stand-in for Kalamata; `kalamata.read_kalamata` reads a file.
    normal_force : float, N
        Force that presses the joint's plates together.

    Returns
    -------
    Pair
        Two Datasets of one storey; the displacement of the additional frame is `brace_displacement`.

    Raises
    ------
    InvalidInput
        When the normal force is negative.
    """
    return both(building(normal_force), stand_in() if motion is None else motion)
