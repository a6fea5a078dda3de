"""What the study concludes from its figures, put to a cube.

Each claim falls into parts, sentences about cells of the cube (`fdspec.measures.claim_parts`). The number
that decides a part is the share of its cells which do what it says.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from fdspec.errors import InvalidInput
from fdspec.measures.cells import ended_well, require
from fdspec.measures.claim_parts import PARTS, Cells, TooFewPoints

if TYPE_CHECKING:
    import xarray as xr

HOLDS: Final = 0.9
"""Share of cells from which on a part holds."""

IN_PART: Final = 0.5
"""Share of cells from which on a part holds in part."""

YES, PARTLY, NO, UNTESTED = "holds", "holds in part", "does not hold", "not tested"

CLAIMS: Final = {
    "a": "the peak response over the grid grows with stiffness ratio",
    "b": "at stiffness ratios 0.5 and 1 pretension cannot control the response: no change beyond 300 kN",
    "c": "beyond stiffness ratio 4 the response is least for a pretension of 100 to 250 kN, for every record",
    "d": "the response rises past the optimum, with period up to 0.4 s, and falls with period beyond",
    "e": "at stiffness ratios 8 and 10 the response is low for periods to 0.6 s and 100 to 300 kN",
    "f": "beyond a stiffness ratio, in a range of pretension, the reduction is independent of period",
    "g": "the response of the free frame and that of the braced frame fall with period",
    "h": "what it says of single figures: 11, 12, 13 to 15, 16 and 18",
}
"""The study's conclusions, in the words of this package."""


def study_claims(cube: xr.Dataset, *, normal_force_factor: float = 1.0) -> xr.Dataset:
    """Check the study's conclusions against a cube, record by record.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep` returns, with peak_acceleration, elastic_acceleration and braced_acceleration.
    normal_force_factor : float
        The cube's pretension over the force that the study calls so: 1 when both are the total normal force,
        2 n_b when the cube's is that and the study's the force of one of n_b bolts with two faces. The bounds
        in kN are on the study's force.

    Returns
    -------
    xarray.Dataset
        Over (part, record): `share` (1) of the cells that agree, NaN where the cube has none of them;
        `cells`, their number; `verdict`: "holds" from 0.9 on, "holds in part" from 0.5 on, else
        "does not hold", or "not tested". Over (part,): `claim`, `sentence` and `verdict_of_part`, the verdict
        over all records.

    Raises
    ------
    InvalidInput
        When the cube lacks a variable or a dimension, or the factor is not positive and finite.

    Notes
    -----
    Claims (a) to (h) are from the study's section on acceleration response spectra and its conclusions.
    Histories that did not end well count nowhere.

    Examples
    --------
    >>> import fdspec
    >>> cube = fdspec.sweep(
    ...     [fdspec.load_record("FSR1")], stiffness_ratio=[0.5, 4], pretension=[1e4, 1e5], period=[0.2, 0.4]
    ... )
    >>> claims = study_claims(cube)
    >>> str(claims.verdict.sel(part="a", record="FSR1").item())
    'holds'
    """
    given: object = normal_force_factor
    if not (isinstance(given, int | float) and 0.0 < given < math.inf):
        raise InvalidInput(f"normal_force_factor must be a positive number, got {given!r}")
    require(cube, ("peak_acceleration", "elastic_acceleration", "braced_acceleration"))
    import xarray as xr

    pretension = cube["pretension"].values / normal_force_factor
    cells = Cells(
        ended_well(cube, "peak_acceleration").assign_coords(pretension=pretension).sortby("stiffness_ratio"),
        cube["elastic_acceleration"],
        cube["braced_acceleration"].sortby("stiffness_ratio"),
    )
    names = [str(name) for name in cube["record"].values]
    shares, counts = (
        np.full((len(PARTS), len(names)), np.nan),
        np.zeros((len(PARTS), len(names)), dtype=np.int64),
    )
    for k, part in enumerate(PARTS):
        try:
            found = part.found(cells).transpose("record", ...)
        except TooFewPoints:
            continue
        flat = found.values.reshape(len(names), -1)
        known = np.isfinite(flat)
        if part.records:
            known &= np.isin(names, part.records)[:, np.newaxis]
        counts[k] = known.sum(axis=1)
        agreeing = np.where(known, flat, 0.0).sum(axis=1)
        shares[k] = np.divide(agreeing, counts[k], out=np.full(len(names), np.nan), where=counts[k] > 0)
    verdicts = [[verdict(share) for share in row] for row in shares]
    return xr.Dataset(
        {
            "share": (("part", "record"), shares, {"long_name": "share of cells that agree", "units": "1"}),
            "cells": (("part", "record"), counts, {"long_name": "number of cells", "units": "1"}),
            "verdict": (("part", "record"), np.array(verdicts)),
            "verdict_of_part": ("part", np.array([together(row) for row in verdicts])),
        },
        coords={
            "part": [part.name for part in PARTS],
            "record": names,
            "claim": ("part", [part.claim for part in PARTS]),
            "sentence": ("part", [part.sentence for part in PARTS]),
        },
    )


def verdict(share: float) -> str:
    """Return what a share of agreeing cells says; NaN is not tested."""
    if math.isnan(share):
        return UNTESTED
    if share >= HOLDS:
        return YES
    return PARTLY if share >= IN_PART else NO


def together(verdicts: Sequence[str]) -> str:
    """Return one verdict for several: all alike, or in part; what was not tested does not count."""
    told = {one for one in verdicts if one != UNTESTED}
    if not told:
        return UNTESTED
    return told.pop() if len(told) == 1 else PARTLY


def verdict_of_claim(claims: xr.Dataset, letter: str) -> str:
    """Return the verdict on a whole claim, over all its parts and all records of `study_claims`."""
    rows = claims["verdict"].values[claims["claim"].values == letter]
    return together([str(one) for one in rows.ravel()])
