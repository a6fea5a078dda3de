"""Profiles of buildings: drift, acceleration, slip and force over the height, of all records together."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from fdspec.errors import InvalidInput
from fdspec.figures.page import Figure
from fdspec.measures.summary import nearest_design
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

RECORD, MIDDLE = "0.75", "#0072B2"


class Profile(NamedTuple):
    """A panel: its axis, the factor from SI, and whether it is of floors rather than of storeys."""

    label: str
    scale: float
    of_floor: bool = False


PROFILES: Final = (
    ("peak_drift_ratio", Profile("drift ratio, %", 100.0)),
    ("peak_drift", Profile("drift, mm", 1e3)),
    ("peak_acceleration", Profile("acceleration, g", 1.0 / G, of_floor=True)),
    ("peak_slip", Profile("slip, mm", 1e3)),
    ("slip_travel", Profile("slip travel, mm", 1e3)),
    ("peak_brace_force", Profile("brace force, kN", 1e-3)),
    ("peak_storey_shear", Profile("storey shear, kN", 1e-3)),
)
"""Variables in their order; of drift, slip and force the first that the cube has is drawn."""

INSTEAD: Final = {
    "peak_drift": "peak_drift_ratio",
    "slip_travel": "peak_slip",
    "peak_storey_shear": "peak_brace_force",
}
"""Variable -> the one that is drawn in its place, where the cube has that."""


def plot_profiles(
    cube: xr.Dataset,
    building: str | None = None,
    *,
    stiffness_scale: float | None = None,
    slip_scale: float | None = None,
) -> Figure:
    """Draw what a building's storeys take: each record grey, median, and 16 to 84 % of the records as a band.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep_buildings` returns.
    building : str, optional
        Its name; may be left out where the cube has one.
    stiffness_scale, slip_scale : float, optional
        Factors on the dampers, on the cube's axes; unless given those nearest to 1, the design as it is.

    Raises
    ------
    InvalidInput
        For a building or factor that the cube does not have, or where no history ended well.
    """
    one = design_of(cube, building, stiffness_scale=stiffness_scale, slip_scale=slip_scale)
    good = one.isel(record=np.flatnonzero(one["status"].values == 0))
    if not good.sizes["record"]:
        raise InvalidInput(f"building {one['building'].item()}: no history ended well, nothing to be drawn")
    panels = [
        (name, panel)
        for name, panel in PROFILES
        if name in good and INSTEAD.get(name, "") not in good.data_vars
    ]
    figure = Figure(figsize=(2.6 * len(panels) + 0.6, 5.2), layout="constrained")
    axes = np.atleast_1d(figure.subplots(1, len(panels), sharey=True))
    storeys = good["storey"].values.astype(int)
    frames = good["stands_on"].values if "stands_on" in good.coords else storeys - 1
    for axis, (name, panel) in zip(axes, panels, strict=True):
        values = panel.scale * good[name].transpose("record", "storey").values
        _draw(axis, *_apart(values, storeys, frames), panel)
    axes[0].set_ylabel("storey")
    axes[0].set_yticks(storeys)
    axes[0].set_ylim(0.0, storeys[-1] + 0.6)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), frameon=False)
    figure.suptitle(_title(good))
    return figure


def design_of(
    cube: xr.Dataset,
    building: str | None = None,
    *,
    stiffness_scale: float | None = None,
    slip_scale: float | None = None,
) -> xr.Dataset:
    """Return one building of a cube at one pair of factors; raise InvalidInput where it is not there."""
    if "building" not in cube.dims or "storey" not in cube.dims:
        raise InvalidInput("profiles need a cube of buildings, as fdspec.sweep_buildings returns it")
    names = [str(name) for name in cube["building"].values]
    if building is None and len(names) > 1:
        raise InvalidInput(f"the cube has {len(names)} buildings; name one of {', '.join(names)}")
    if building is not None and building not in names:
        raise InvalidInput(f"the cube has no building {building!r}; it has {', '.join(names)}")
    one = cube.isel(building=0 if building is None else names.index(building))
    for name, value in (("stiffness_scale", stiffness_scale), ("slip_scale", slip_scale)):
        if value is None:
            continue
        held = one[name].values
        same = np.isclose(held, value, rtol=1e-9, atol=0.0)
        if not same.any():
            raise InvalidInput(
                f"the cube has no {name} {value:g}; it has {', '.join(f'{one:g}' for one in held)}"
            )
        one = one.isel({name: int(np.argmax(same))})
    return nearest_design(one)


def profiles_caption(one: xr.Dataset) -> str:
    """Return the words below a picture of `design_of`."""
    records = ", ".join(str(name) for name in one["record"].values)
    return (
        f"Building {one['building'].item()}, slip forces times {one['slip_scale'].item():g}, brace stiffness "
        f"times {one['stiffness_scale'].item():g}: peaks over the height under {records}. Grey: each record; "
        "line: median; band: 16 to 84 % of the records. Peaks of floors stand at the floor, of storeys "
        "between floors."
    )


def _apart(values: np.ndarray, storeys: np.ndarray, stands_on: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Put a gap, which no line crosses, before each storey that does not stand on the one before it."""
    gaps = np.flatnonzero(stands_on != storeys - 1)
    return np.insert(values, gaps, np.nan, axis=1), np.insert(storeys.astype(float), gaps, np.nan)


def _draw(axis: Axes, values: np.ndarray, storeys: np.ndarray, panel: Profile) -> None:
    # A floor's peak stands at its height, a storey's halfway up.
    height = storeys if panel.of_floor else storeys - 0.5
    for number, record in enumerate(values):
        axis.plot(record, height, color=RECORD, linewidth=0.7, label="each record" if number == 0 else None)
    low, middle, high = np.percentile(values, [16.0, 50.0, 84.0], axis=0)
    if len(values) > 1:
        axis.fill_betweenx(height, low, high, color=MIDDLE, alpha=0.2, linewidth=0.0, label="16 to 84 %")
    axis.plot(middle, height, color=MIDDLE, linewidth=1.8, marker="o", markersize=3.5, label="median")
    axis.set_xlim(left=0.0)
    axis.set_xlabel(panel.label)
    axis.grid(color="0.92", linewidth=0.6)
    axis.set_axisbelow(True)


def _title(one: xr.Dataset) -> str:
    count = one.sizes["record"]
    return (
        f"{one['building'].item()}: slip forces x {one['slip_scale'].item():g}, braces x "
        f"{one['stiffness_scale'].item():g}, {count} record{'s' if count > 1 else ''}"
    )
