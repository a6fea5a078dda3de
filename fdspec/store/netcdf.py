"""Save a Dataset as netCDF and open it again, the same to the bit."""

from __future__ import annotations

import os
import warnings
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fdspec.errors import DiskError, StoreError
from fdspec.store import chunks, layout
from fdspec.store.replacing import replacing
from fdspec.store.undisturbed import undisturbed

if TYPE_CHECKING:
    import xarray as xr

FORMAT: Final = "fdspec_format"
"""Global attribute on disk alone: the version of the layout that `save` writes."""

VERSION: Final = 1

_MAGIC: Final = (b"\x89HDF\r\n\x1a\n", b"CDF\x01", b"CDF\x02", b"CDF\x05")


def save(dataset: xr.Dataset, path: str | os.PathLike[str], *, overwrite: bool = True) -> None:
    """Write a cube or a history to a netCDF-4 file.

    The file appears under its name only when it is complete; the same dataset gives the same bytes.
    Numbers are compressed with zlib, text is stored as characters, so that ncdump, R, Octave, nco and
    ParaView read it.

    Parameters
    ----------
    dataset : xarray.Dataset
        Numbers and text; attributes are text, numbers or lists of numbers.
    path : path
        The file, in a folder that exists: ``cube.nc``.
    overwrite : bool
        Whether a file of that name may be replaced.

    Raises
    ------
    StoreError
        When the file cannot be written or the dataset holds what netCDF cannot.

    Examples
    --------
    >>> import tempfile, xarray
    >>> cube = xarray.Dataset({"pga": ("record", [3.4])}, coords={"record": ["FSR1"]})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save(cube, f"{folder}/cube.nc")
    ...     open(f"{folder}/cube.nc").identical(cube)
    True
    """
    with replacing(path, overwrite=overwrite) as part:
        _check(dataset)
        on_disk = layout.to_disk(dataset.drop_encoding())
        write_netcdf(on_disk.assign_attrs({FORMAT: np.int32(VERSION)}), part, path)


def open(path: str | os.PathLike[str], *, lazily: bool | None = None) -> xr.Dataset:  # noqa: A001
    """Read a file that `save` wrote, or the Zarr store of a sweep.

    Parameters
    ----------
    path : path
        The file, or the store's folder.
    lazily : bool, optional
        Read numbers when they are used, for a cube that does not fit into memory; a file then stays open
        until ``close()`` is called on the dataset. Otherwise all is read and the file is closed. Unless said
        otherwise a file is read and a store is not.

    Returns
    -------
    xarray.Dataset
        What was saved: values, types, coordinates, attributes and their order.

    Raises
    ------
    StoreError
        When the file is missing, damaged or not one of fdspec's.

    Warns
    -----
    UserWarning
        When a store's sweep has not come to its end; cells not computed yet say so in their status.
    """
    if chunks.is_store(path):
        return _read_store(path, lazily=lazily is not False)
    lazily = bool(lazily)
    _check_magic(Path(path))
    try:
        with undisturbed():
            return _read(path, lazily)
    except StoreError:
        raise
    except (OSError, RuntimeError, ValueError) as error:
        raise StoreError(
            f"cannot open {os.fspath(path)}: the file is damaged or incomplete ({error}); write it again"
        ) from error


def _read_store(path: str | os.PathLike[str], lazily: bool) -> xr.Dataset:
    left, blocks = chunks.unfinished(path), len(chunks.described(path)[0])
    if left:
        warnings.warn(
            f"{os.fspath(path)}: {left} of {blocks} blocks are not computed yet; start the sweep again",
            UserWarning,
            stacklevel=3,
        )
    try:
        cube = chunks.open_store(path)
        return cube if lazily else cube.load()
    except (OSError, RuntimeError, ValueError) as error:
        raise StoreError(
            f"cannot open {os.fspath(path)}: the store is damaged ({error}); 'fdspec check' says where"
        ) from error


def _read(path: str | os.PathLike[str], lazily: bool) -> xr.Dataset:
    import xarray as xr

    # Values as they are: no decoding of fill values, scales or times, which `save` never writes.
    on_disk = xr.open_dataset(
        path, engine="netcdf4", mask_and_scale=False, decode_times=False, decode_timedelta=False, cache=False
    )
    with ExitStack() as closing:
        closing.callback(on_disk.close)
        _check_format(on_disk, path)
        opened = layout.from_disk(on_disk)
        del opened.attrs[FORMAT]
        if not lazily:
            return opened.load().drop_encoding()
        opened = opened.drop_encoding()
        opened.set_close(closing.pop_all().close)
        return opened


def write_netcdf(on_disk: xr.Dataset, part: Path, path: str | os.PathLike[str]) -> None:
    """Write a dataset whose text is already fixed-width to `part`; `path` is the name errors speak of."""
    encoding = {
        name: _encoding(variable, name in on_disk.coords) for name, variable in on_disk.variables.items()
    }
    try:
        with undisturbed():
            on_disk.to_netcdf(part, mode="w", format="NETCDF4", engine="netcdf4", encoding=encoding)
    except (OSError, RuntimeError) as error:
        raise DiskError(f"cannot write {os.fspath(path)}: {error}") from error
    except (ValueError, TypeError) as error:
        raise StoreError(f"cannot write {os.fspath(path)}: {error}") from error


def _encoding(variable: xr.Variable, coordinate: bool) -> dict[str, Any]:
    if layout.is_text(variable):
        return {"dtype": "S1"}
    if coordinate or variable.ndim == 0:
        return {"_FillValue": None}
    return {"_FillValue": None, "zlib": True, "complevel": 1, "shuffle": True, "fletcher32": True}


def _check(dataset: xr.Dataset) -> None:
    """Refuse what netCDF cannot give back as it was, before anything is written."""
    _check_attributes("the dataset", dataset.attrs)
    for name, variable in dataset.variables.items():
        _check_attributes(f"variable {name!r}", variable.attrs)
        if not layout.is_text(variable) and variable.dtype.kind not in "biuf":
            raise StoreError(
                f"variable {name!r} has dtype {variable.dtype}; a file holds numbers and text only"
            )


def _check_attributes(owner: str, attributes: dict[Any, Any]) -> None:
    for name, value in attributes.items():
        if name in {FORMAT, layout.LABELS, layout.DTYPE, layout.DIM}:
            raise StoreError(f"a file needs the attribute {name!r} for itself; rename the one of {owner}")
        if not isinstance(value, str) and (
            np.asarray(value).dtype.kind not in "iuf" or np.ndim(value) > 1 or np.size(value) == 0
        ):
            raise StoreError(
                f"attribute {name!r} of {owner} is {value!r}; a file holds text, numbers, lists of numbers, "
                "and anything else as JSON text"
            )


def _check_magic(path: Path) -> None:
    if path.is_dir():
        raise StoreError(f"cannot open {path}: it is a folder; name a netCDF file in it, or a Zarr store")
    try:
        with path.open("rb") as file:
            start = file.read(8)
    except FileNotFoundError as error:
        raise StoreError(f"cannot open {path}: there is no such file") from error
    except OSError as error:
        raise StoreError(f"cannot open {path}: {error.strerror or error}") from error
    if not start.startswith(_MAGIC):
        raise StoreError(f"cannot open {path}: it is not a netCDF file; name one that fdspec saved")


def _check_format(on_disk: xr.Dataset, path: str | os.PathLike[str]) -> None:
    if FORMAT not in on_disk.attrs:
        raise StoreError(
            f"cannot open {os.fspath(path)}: it is an export or another program's netCDF file; "
            "name one that fdspec saved, or read it with xarray.open_dataset"
        )
    version = int(on_disk.attrs[FORMAT])
    if version > VERSION:
        raise StoreError(
            f"cannot open {os.fspath(path)}: its layout is version {version}, this fdspec knows {VERSION}; "
            "upgrade fdspec"
        )
