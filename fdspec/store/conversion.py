"""A Zarr store as one netCDF file, block by block: never more than a block is in memory."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import DiskError, StoreError
from fdspec.store import checksums, chunks, description, layout
from fdspec.store.blocks import Blocks
from fdspec.store.netcdf import FORMAT, VERSION, with_lists, write_netcdf
from fdspec.store.refusals import no_resources
from fdspec.store.replacing import replacing

if TYPE_CHECKING:
    import xarray as xr


CACHE: Final = 1 << 20
"""Bytes that HDF5 may keep of a variable."""


def to_netcdf(store: str | os.PathLike[str], path: str | os.PathLike[str], *, overwrite: bool = True) -> None:
    """Write the cube of a store to a netCDF file, which `open` reads to the same bits.

    The file's chunks are those of the store.  A store whose sweep has not come to its end is refused.
    """
    import netCDF4

    cube, left, count = chunks.open_store(store)
    with cube:
        if left:
            raise StoreError(
                f"cannot write {os.fspath(path)}: {left} of {count} blocks of {os.fspath(store)} are "
                "not computed"
            )
        blocks, _ = description.described(store)
        coordinates = layout.to_disk(cube.drop_vars(list(cube.data_vars)))
        coordinates.attrs[FORMAT] = np.int32(VERSION)
        with replacing(path, overwrite=overwrite) as part:
            write_netcdf(with_lists(coordinates), part, path)
            try:
                with netCDF4.Dataset(part, "a") as file:
                    file.delncattr("coordinates")  # each variable names its own
                    for name, array in cube.data_vars.items():
                        _declare(file, str(name), array, coordinates, blocks.edges)
                    told = _fill(file, cube, blocks)
                    told[""] = checksums.of_dataset(cube)
                    told |= {str(name): checksums.of_variable(cube[name].variable) for name in cube.coords}
                    file.setncattr(checksums.CHECKSUMS, json.dumps(told))
            except (RuntimeError, ValueError) as error:
                told_why = no_resources(error) or "the disk is full, or refuses it"
                raise DiskError(f"cannot write {os.fspath(path)}: {told_why}") from error


def _fill(file: Any, cube: xr.Dataset, blocks: Blocks) -> dict[str, str]:
    """Write all blocks; return the checksums of the variables, taken in the order of their numbers."""
    running = {str(name): checksums.started(array.variable) for name, array in cube.data_vars.items()}
    row: dict[str, list[NDArray[Any]]] = {name: [] for name in running}
    fastest = list(blocks.sizes)[-1]
    for number in range(len(blocks)):
        block = cube.isel(blocks.slices(number))
        for key, array in block.data_vars.items():
            name = str(key)
            if not blocks.owns(number, array.variable):
                continue
            values = array.values
            file[name][blocks.region(number, array.variable)] = values
            # Blocks come in the order of numbers but for those beside each other along the last dim.
            row[name].append(values)
            if blocks.slices(number)[fastest].stop == blocks.sizes[fastest]:
                whole = np.concatenate(row[name], axis=-1)
                running[name] = checksums.of_values(whole, running[name])
                row[name].clear()
    return {name: f"{checksum:08x}" for name, checksum in running.items()}


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
