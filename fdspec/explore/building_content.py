"""What the page shows of a cube of buildings: axes, quantities over the height, and each record's numbers."""

from __future__ import annotations

import gzip
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from fdspec.errors import InvalidInput
from fdspec.explore.content import about_record
from fdspec.explore.packing import pack
from fdspec.measures.cells import ended_well
from fdspec.store.suitable import loaded
from fdspec.units import G
from fdspec.variables import BUILDING_DIMS, INTENSITY

if TYPE_CHECKING:
    import xarray as xr


class Quantity(NamedTuple):
    """A variable over the height: words, the page's unit, factor to it, and whether it is of floors."""

    title: str
    unit: str
    factor: float
    of_floor: bool = False


QUANTITIES: Final = {
    "peak_drift_ratio": Quantity("Peak drift ratio", "%", 100.0),
    "peak_drift": Quantity("Peak drift", "mm", 1e3),
    "peak_acceleration": Quantity("Peak absolute acceleration", "g", 1.0 / G, of_floor=True),
    "peak_displacement": Quantity("Peak displacement", "mm", 1e3, of_floor=True),
    "peak_slip": Quantity("Peak slip", "mm", 1e3),
    "slip_travel": Quantity("Slip travel", "m", 1.0),
    "peak_brace_force": Quantity("Peak brace force", "kN", 1e-3),
    "peak_storey_shear": Quantity("Peak storey shear", "kN", 1e-3),
    "ductility": Quantity("Ductility of the columns", "", 1.0),
    "residual_drift": Quantity("Residual drift", "mm", 1e3),
    "storey_friction_energy": Quantity("Energy dissipated by friction", "kJ", 1e-3),
}
"""Variables of a cube, in the order of their pictures; residuals are shown without their sign."""


class BuildingContent:
    """Hold a cube of buildings as the page takes it.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep_buildings` returns; may be opened lazily, a record is read when it is asked for.
        Infinite factors on slip forces are left out: no slider has a place for them.
    name : str
        What the page calls it, such as its file's name.

    Raises
    ------
    InvalidInput
        When the cube is none of buildings, or has nothing over the height.
    """

    def __init__(self, cube: xr.Dataset, name: str) -> None:
        lacking = [dim for dim in (*BUILDING_DIMS, "storey") if not cube.sizes.get(dim)]
        if lacking:
            raise InvalidInput(f"{name} has no {lacking[0]}; there is nothing to show")
        finite = np.flatnonzero(np.isfinite(cube["slip_scale"].values))
        if not finite.size:
            raise InvalidInput(f"{name} has no finite slip_scale; its dampers never slip")
        self.cube = cube.isel(slip_scale=finite) if finite.size < cube.sizes["slip_scale"] else cube
        self.name = name
        self.quantities = {
            name: quantity
            for name, quantity in QUANTITIES.items()
            if name in cube and "storey" in cube[name].dims
        }
        if not self.quantities:
            raise InvalidInput(f"{name} has none of the results over the height that can be shown")
        self.records = tuple(str(record) for record in cube["record"].values)
        self.axes = ("building", "stiffness_scale", "slip_scale", INTENSITY, "storey")

    @property
    def about(self) -> dict[str, Any]:
        """Everything but the numbers of the cells; plain enough for JSON."""
        cube = self.cube
        levels = cube[INTENSITY].values.tolist() if INTENSITY in cube.dims else [1.0]
        beside = {"stands_on": cube["stands_on"].values.tolist()} if "stands_on" in cube.coords else {}
        return beside | {
            "name": self.name,
            "cubes": [
                {
                    "name": self.name,
                    "title": str(cube.attrs.get("title", "")),
                    "made": str(cube.attrs.get("history", "")),
                    "comment": str(cube.attrs.get("comment", "")),
                }
            ],
            "axes": {
                "building": [str(name) for name in cube["building"].values],
                "stiffness_scale": cube["stiffness_scale"].values.tolist(),
                "slip_scale": cube["slip_scale"].values.tolist(),
                "intensity": levels,
                "storey": cube["storey"].values.tolist(),
            },
            "records": [about_record(cube, k) for k in range(len(self.records))],
            "quantities": [
                {"name": name, "title": one.title, "unit": one.unit, "floor": one.of_floor}
                for name, one in self.quantities.items()
            ],
        }

    def record(self, k: int) -> bytes:
        """Return the numbers of one record, packed and compressed.

        Each quantity over (building, stiffness_scale, slip_scale, intensity, storey), the last two one where
        the cube has them not; NaN where a history did not end well.
        """
        one = loaded(self.cube.isel(record=[k]), self.name)
        arrays = {}
        for name, quantity in self.quantities.items():
            values = abs(ended_well(one, name)).isel(record=0) * quantity.factor
            if INTENSITY not in values.dims:
                values = values.expand_dims(INTENSITY)
            arrays[name] = values.transpose(*self.axes).values
        return gzip.compress(pack({"record": self.records[k]}, arrays), compresslevel=1, mtime=0)
