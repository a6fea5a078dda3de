"""A cube or a history as a file of Matlab's: arrays over the dims that stand beside them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fdspec.errors import StoreError
from fdspec.store.history_csv import meaning_of
from fdspec.store.layout import is_text

if TYPE_CHECKING:
    import xarray as xr

MATLAB_SUFFIXES: Final = (".mat",)

LARGEST: Final = 2**31 - 2**20
"""Bytes of a variable that the format of Matlab 5 holds, with room for its head."""


def write_matlab(one: xr.Dataset, part: Path) -> None:
    """Write every variable as an array over its dims, text as cells.

    Three structures say the rest, by the variables' names: ``dims``, ``units`` and ``meanings``; ``about``
    holds where the dataset comes from.

    Raises
    ------
    StoreError
        For a variable that the format cannot hold.
    """
    from scipy.io import savemat

    held: dict[str, Any] = {}
    dims, units, meanings = {}, {}, {}
    for key, variable in one.variables.items():
        name = str(key)
        if variable.nbytes > LARGEST:
            raise StoreError(
                f"{name} has {variable.nbytes / 2**30:.1f} GiB, more than a variable of a .mat file holds: "
                "export one record, or netCDF"
            )
        values = variable.values
        held[name] = values.astype(object) if is_text(variable) and values.ndim else values
        if is_text(variable) and not values.ndim:
            held[name] = str(values)
        dims[name] = ", ".join(map(str, variable.dims))
        units[name] = str(variable.attrs.get("units", ""))
        meanings[name] = meaning_of(name, variable.attrs)
    about = {
        str(name): value if isinstance(value, np.ndarray) else str(value) for name, value in one.attrs.items()
    }
    held |= {"dims": dims, "units": units, "meanings": meanings, "about": about}
    with part.open("wb") as file:
        savemat(file, held, do_compression=True, oned_as="column", long_field_names=True)
