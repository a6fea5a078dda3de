"""The study's second validation problem: a four-storey steel frame with friction dampers.

Printed: floors 41 610, 41 610, 41 610 and 40 820 kg, bracing 23 kg in each storey, first period 1.006 s of
the bare frame and 0.612 s of the braced one, friction coefficient 0.15, damping 2 %, the NS component of
Kalamata, 13 September 1986 (0.240 g).
Assumed: the normal forces, which are not printed; all storeys have one stiffness and all braces another,
which the two periods then fix; the braced period is that of floors and braces moving as one; the 2 % hold in
every mode of the bare frame, the braces are undamped; static and kinetic friction are equal.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from fdspec.model.building import Building, ModalDamping
from fdspec.model.motion import GroundMotion
from fdspec.validation.kalamata import stand_in
from fdspec.validation.pair import Pair, both

FLOOR_MASSES: Final = (41610.0, 41610.0, 41610.0, 40820.0)
"""kg"""
BRACE_MASS: Final = 23.0
"""kg"""
BARE_PERIOD: Final = 1.006
"""s"""
BRACED_PERIOD: Final = 0.612
"""s"""
FRICTION_COEFFICIENT: Final = 0.15
DAMPING_RATIO: Final = 0.02
NORMAL_FORCE: Final = 500e3
"""N in each storey, assumed: slip at 75 kN."""


def building(normal_force: ArrayLike = NORMAL_FORCE) -> Building:
    """Make the frame; each damper slips at 0.15 times its normal force (N), one for all or one a storey."""
    return Building.from_periods(
        FLOOR_MASSES,
        BARE_PERIOD,
        BRACED_PERIOD,
        slip_force=FRICTION_COEFFICIENT * np.asarray(normal_force, dtype=np.float64),
        brace_mass=BRACE_MASS,
        damping=ModalDamping(DAMPING_RATIO),
    )


def solve(motion: GroundMotion | None = None, normal_force: ArrayLike = NORMAL_FORCE) -> Pair:
    """Solve the problem: bare frame and damped frame.

    Parameters
    ----------
    motion : GroundMotion, optional
        The excitation, by default a stand-in for Kalamata; `kalamata.read_kalamata` reads a file.
    normal_force : float or array_like of shape (4,), N
        Force that presses the sliding plates together, in all storeys or in each.

    Returns
    -------
    Pair
        Two Datasets of four storeys.

    Raises
    ------
    InvalidInput
        When a normal force is negative.
    """
    return both(building(normal_force), stand_in() if motion is None else motion)
