"""Frames beside each other, made one building, so that dampers may join them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from fdspec.errors import InvalidInput
from fdspec.model.building import Building
from fdspec.model.damping import DampingMatrix
from fdspec.model.device_check import NONE
from fdspec.model.link import Link, TensionBrace


def side_by_side(*buildings: Building, links: Sequence[Link | TensionBrace] = ()) -> Building:
    """Make one building of frames that stand beside each other on the same ground.

    Parameters
    ----------
    *buildings : Building
        Two or more. Their floors are counted on: those of the first are 1 to N, of the second N + 1 and so
        on.
    links : sequence of Link or TensionBrace
        What joins them, by these numbers; the buildings' own links are kept.

    Returns
    -------
    Building
        With `stands_on`. Its damping is that of each frame by itself.

    Raises
    ------
    InvalidInput
        For fewer than two buildings, or a link that does not fit.

    Examples
    --------
    >>> low = Building(30e3, [40e6, 30e6], 50.0, 80e6, 60e3)
    >>> high = Building(20e3, [30e6] * 3, 50.0, 60e6, 40e3)
    >>> side_by_side(low, high, links=[Link(2, 4, 50e6, 30e3)]).stands_on
    array([0, 1, 0, 3, 4])
    """
    if len(buildings) < 2 or not all(isinstance(building, Building) for building in buildings):
        raise InvalidInput(f"side_by_side takes two buildings or more, not {buildings!r}")
    first = np.cumsum([0, *(building.n_storeys for building in buildings[:-1])]).tolist()
    names = ("floor_mass", "brace_mass", "brace_stiffness", "slip_force", "kinetic_slip_force")
    each = {
        name: np.concatenate([getattr(building, name) for building in buildings])
        for name in (*names, "brace_damping", *NONE)
    }
    if all(building.storey_stiffness.ndim == 1 for building in buildings):
        stiffness = np.concatenate([building.storey_stiffness for building in buildings])
    else:
        stiffness = block_diag(*(building.stiffness_matrix for building in buildings))
    own = [
        _moved(link, before)
        for before, building in zip(first, buildings, strict=True)
        for link in building.links
    ]
    return Building(
        storey_stiffness=stiffness,
        damping=DampingMatrix(block_diag(*(building.damping_matrix for building in buildings))),
        stands_on=np.concatenate(
            [_on(building.stands_on, before) for before, building in zip(first, buildings, strict=True)]
        ),
        links=[*own, *links],
        **each,
    )


def _on(floors: NDArray[np.int64], before: int) -> NDArray[np.int64]:
    """Count floors on; the ground stays the ground."""
    return np.where(floors > 0, floors + before, 0)


def _moved(link: Link | TensionBrace, before: int) -> Link | TensionBrace:
    lower = link.lower + before if link.lower > 0 else 0
    return replace(link, upper=link.upper + before, lower=lower)
