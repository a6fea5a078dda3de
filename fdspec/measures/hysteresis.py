"""Hysteresis loops with their true corners, from the instants at which a damper slips and stops."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput

if TYPE_CHECKING:
    import xarray as xr

FloatArray = NDArray[np.float64]


def hysteresis(history: xr.Dataset, storey: int = 1) -> xr.Dataset:
    """Return the loop of one damper, corner by corner.

    Coulomb friction draws nothing but level and upright lines: while the damper slips its force is the
    kinetic slip force, while it sticks its slip is constant. Only the instants of change decide where they
    meet, and those are in the history; joining its outputs would cut every corner that falls between two.

    Parameters
    ----------
    history : xarray.Dataset
        What `fdspec.simulate` returns.
    storey : int
        The storey, counted from 1 at the ground.

    Returns
    -------
    xarray.Dataset
        Over ``point``: ``slip``, m, floor less brace, and ``force``, N, positive against forward slip. Slip
        is that of the outputs within a stick; where a stick has none it is interpolated between outputs,
        and a smaller `dt_out` of the simulation makes it finer. A damper that never changes its phase has
        no corners: its outputs are returned.

    Raises
    ------
    InvalidInput
        When the history has no such storey.

    Examples
    --------
    >>> import fdspec
    >>> frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=50e3)
    >>> loop = hysteresis(fdspec.simulate(frame, fdspec.load_record("FSR1"), dt_out=1e-3))
    >>> float(abs(loop.force).max())
    50000.0
    """
    import xarray as xr

    if storey not in history["storey"].values:
        raise InvalidInput(f"storey must be from 1 to {history.sizes['storey']}, got {storey}")
    one = history.sel(storey=storey)
    time = np.asarray(one["time"].values)
    slip = np.asarray(one["displacement"].values - one["brace_displacement"].values)
    force = np.asarray(one["friction_force"].values)
    here = history["transition_storey"].values == storey
    instants = np.asarray(history["transition_time"].values[here])
    if instants.size:
        phases = np.concatenate(([int(one["phase"].values[0])], history["transition_phase"].values[here]))
        static, kinetic = float(one["slip_force"]), float(one["kinetic_slip_force"])
        slip, force = _corners(time, slip, force, instants, phases, static, kinetic)
    loop = xr.Dataset({"slip": ("point", slip), "force": ("point", force)})
    loop["slip"].attrs = {"units": "m", "long_name": "slip of the damper, floor less brace"}
    loop["force"].attrs = {"units": "N", "long_name": "force of the damper, positive against forward slip"}
    return loop


def _corners(
    time: FloatArray,
    slip: FloatArray,
    force: FloatArray,
    instants: FloatArray,
    phases: NDArray[np.int64],
    static: float,
    kinetic: float,
) -> tuple[FloatArray, FloatArray]:
    """Walk from change to change: outputs (n,), instants (k,), phases before and after them (k + 1,)."""
    first = np.searchsorted(time, np.concatenate(([time[0]], instants)), side="left")
    last = np.searchsorted(time, np.concatenate((instants, [time[-1]])), side="right")
    at = np.interp(instants, time, slip)
    for k, (begin, end) in enumerate(zip(first, last, strict=True)):
        inside = slip[begin:end]
        if phases[k] == 0 and inside.size:  # a stick with outputs knows its slip, at both of its ends
            middle = float(inside[inside.size // 2])
            if k > 0:
                at[k - 1] = middle
            if k < instants.size:
                at[k] = middle
    points: list[tuple[float, float]] = []
    for k, (begin, end, phase) in enumerate(zip(first, last, phases, strict=True)):
        start = at[k - 1] if k > 0 else slip[0]
        stop = at[k] if k < instants.size else slip[-1]
        if phase == 0:
            points += [(start, value) for value in _turns(force[begin:end])]
            if k < instants.size:
                points.append((stop, float(phases[k + 1]) * static))
        else:
            points += [(start, float(phase) * kinetic), (stop, float(phase) * kinetic)]
    corners = np.array(points)
    return corners[:, 0], corners[:, 1]


def _turns(values: FloatArray) -> FloatArray:
    """Return the first and last of values (n,), and those at which they turn: the ends of upright lines."""
    if values.size < 3:
        return values
    steps = np.sign(np.diff(values))
    return values[np.concatenate(([True], steps[1:] != steps[:-1], [True]))]
