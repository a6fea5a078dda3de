"""A Zarr store as one netCDF file, block by block: never more than a block is in memory."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fdspec.errors import DiskError
from fdspec.store import chunks, layout
from fdspec.store.netcdf import FORMAT, VERSION, write_netcdf
from fdspec.store.replacing import replacing

if TYPE_CHECKING:
    import xarray as xr


CACHE: Final = 1 << 20
"""Bytes that HDF5 may keep of a variable."""


def to_netcdf(store: str | os.PathLike[str], path: str | os.PathLike[str], *, overwrite: bool = True) -> None:
    """Write the cube of a store to a netCDF file, which `open` reads to the same bits.

    The file's chunks are those of the store.
    """
    import netCDF4

    cube = chunks.open_store(store)
    blocks, _ = chunks.described(store)
    coordinates = layout.to_disk(cube.drop_vars(list(cube.data_vars)))
    coordinates.attrs[FORMAT] = np.int32(VERSION)
    with replacing(path, overwrite=overwrite) as part:
        write_netcdf(coordinates, part, path)
        try:
            with netCDF4.Dataset(part, "a") as file:
                file.delncattr("coordinates")  # each variable names its own
                for name, array in cube.data_vars.items():
                    _declare(file, str(name), array, coordinates, blocks.edges)
                for number in range(len(blocks)):
                    block = cube.isel(blocks.slices(number))
                    for name, array in block.data_vars.items():
                        if blocks.owns(number, array.variable):
                            region = blocks.region(number, array.variable)
                            file[str(name)][region] = array.values
        except (RuntimeError, ValueError) as error:
            raise DiskError(f"cannot write {os.fspath(path)}: {error}") from error


def _declare(
    file: Any, name: str, array: xr.DataArray, coordinates: xr.Dataset, edges: Mapping[str, int]
) -> None:
    along = [str(key) for key in coordinates.coords if key not in coordinates.dims]
    told = sorted(key for key in along if set(coordinates[key].dims) <= set(array.dims))
    stored = file.createVariable(
        name,
        array.dtype.newbyteorder("="),
        array.dims,
        zlib=True,
        complevel=1,
        shuffle=True,
        fletcher32=True,
        chunksizes=[edges[str(dim)] for dim in array.dims],
        fill_value=False,
    )
    stored.set_auto_maskandscale(False)
    # Whole chunks are written, each once: nothing is to be kept for later.
    stored.set_var_chunk_cache(size=CACHE)
    stored.setncatts({**array.attrs, "coordinates": " ".join(told)})
