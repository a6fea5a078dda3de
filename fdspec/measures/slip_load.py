"""Slip-load spectra: the best slip force, made dimensionless, against period."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from fdspec.errors import InvalidInput

if TYPE_CHECKING:
    import xarray as xr


def slip_load_spectrum(
    best: xr.Dataset, floor_mass: float, motion_period: Mapping[str, float] | None = None
) -> xr.Dataset:
    """Make the best slip force dimensionless: over mass and peak ground acceleration, against period.

    Filiatrault and Cherry (1990), J. Struct. Eng. 116(5), found the best slip load to go with the peak
    ground acceleration, and its spectrum to depend on the period over that of the ground motion.

    Parameters
    ----------
    best : xarray.Dataset
        What `fdspec.best_pretension` returns for each record: `slip_force` over record, and its `pga`.
    floor_mass : float, kg
    motion_period : mapping of record to float, s, optional
        A period of each ground motion, such as `fdspec.signals.intensity.mean_period`.

    Returns
    -------
    xarray.Dataset
        `slip_coefficient`, slip force / (floor_mass PGA), 1; with motion_period, `period_ratio`,
        period / motion period, 1, over (record, period).

    Raises
    ------
    InvalidInput
        When a variable or a record's period is missing.
    """
    import xarray as xr

    for name in ("slip_force", "pga", "period"):
        if name not in best:
            raise InvalidInput(
                f"the best pretensions have no {name}; use fdspec.best_pretension record by record"
            )
    if "record" not in best["slip_force"].dims:
        raise InvalidInput("slip_force has no dimension record: a spectrum is one record's")
    if not floor_mass > 0.0:
        raise InvalidInput(f"floor_mass must be positive, in kg, got {floor_mass!r}")
    found = xr.Dataset({"slip_coefficient": best["slip_force"] / (floor_mass * best["pga"])})
    found["slip_coefficient"].attrs = {"units": "1", "long_name": "best slip force over mass times PGA"}
    if motion_period is None:
        return found
    names = [str(name) for name in best["record"].values]
    if missing := [name for name in names if name not in motion_period]:
        raise InvalidInput(f"motion_period has no {missing[0]!r}; it must name every record")
    of_records = xr.DataArray([float(motion_period[name]) for name in names], {"record": best["record"]})
    ratio = (best["period"] / of_records).transpose("record", "period")
    return found.assign_coords(
        period_ratio=ratio.assign_attrs(units="1", long_name="period over that of the ground motion")
    )
