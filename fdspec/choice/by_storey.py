"""What each storey of a design goes through under each record: what slots and braces are cut by."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.choice.bench import Bench
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion

FloatArray = NDArray[np.float64]

DEMANDS: Final = {
    "storey_acceleration": "peak_acceleration",
    "storey_drift": "peak_drift",
    "storey_slip": "peak_slip",
    "storey_residual_slip": "residual_slip",
    "storey_brace_force": "peak_brace_force",
}
"""Variable of a choice -> what an engine calls it."""

OF_DAMPERS: Final = ("storey_slip", "storey_residual_slip", "storey_brace_force")
"""Which of them a storey without a brace does not have."""


def demands_of(buildings: Sequence[Building], bench: Bench) -> dict[str, FloatArray]:
    """Return the peaks (buildings, records, N) of the continuous motion, by the names of `DEMANDS`.

    They are NaN where a history did not end well, and 0 of dampers and braces that are not there.
    """
    shape = (len(buildings), len(bench.motions), bench.storeys)
    found = {name: np.full(shape, np.nan) for name in DEMANDS}
    for b, building in enumerate(buildings):
        for r, motion in enumerate(bench.motions):
            peaks, ended_well = _peaks(building, motion)
            if not ended_well:
                continue
            for name, of in DEMANDS.items():
                found[name][b, r] = np.abs(peaks[of])
        for name in OF_DAMPERS:
            found[name][b, :, building.brace_stiffness == 0.0] = 0.0
    return found


def _peaks(building: Building, motion: GroundMotion) -> tuple[dict[str, FloatArray], bool]:
    """Integrate one history by itself: rows (N,) by name, and whether its status is ok."""
    if building.has_devices:
        from fdspec.engines.devices import peaks_of as with_devices

        storeys, whole = with_devices(building, motion)
        return storeys, whole["status"] == 0.0
    if building.n_storeys == 1:
        from fdspec.engines.batch import integrate_columns
        from fdspec.kernels.storey.history import RESULTS

        frame = np.array([building.storey[:6]])
        _, rows = integrate_columns(
            frame, building.slip_force, building.kinetic_slip_force, motion, certify=False
        )
        single = {name: rows[0, :, k] for k, name in enumerate(RESULTS)}
        return {**single, "peak_drift": single["peak_displacement"]}, bool(single["status"][0] == 0.0)
    from fdspec.engines.many_storeys import peaks_of
    from fdspec.kernels.frame.results import STOREY_RESULTS, TOTAL

    by_storey, totals = peaks_of(building.frame, motion, certify=False)
    return dict(zip(STOREY_RESULTS, by_storey, strict=True)), bool(totals[TOTAL.status] == 0.0)
