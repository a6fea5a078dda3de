"""Save a Dataset as netCDF and open it again, the same to the bit."""

from __future__ import annotations

import json
import os
import warnings
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fdspec.errors import DamagedError, DiskError, FdspecError, InvalidInput, StoreError
from fdspec.store import checksums, chunks, description, layout
from fdspec.store.memory import check_size
from fdspec.store.origin import with_true_parameters
from fdspec.store.refusals import no_resources
from fdspec.store.replacing import replacing
from fdspec.store.undisturbed import undisturbed
from fdspec.variables import NOT_COMPUTED

if TYPE_CHECKING:
    import xarray as xr

FORMAT: Final = "fdspec_format"
"""Global attribute on disk alone: the version of the layout that `save` writes."""

LISTS: Final = "fdspec_lists"
"""Attribute on disk alone: the names of those beside it that are lists of one number."""

VERSION: Final = 2
"""Since 2 there are checksums."""

_MAGIC: Final = (b"\x89HDF\r\n\x1a\n", b"CDF\x01", b"CDF\x02", b"CDF\x05")


def save(dataset: xr.Dataset, path: str | os.PathLike[str], *, overwrite: bool = True) -> None:
    """Write a cube or a history to a netCDF-4 file.

    The file appears under its name only when it is complete; the same dataset gives the same bytes.  Every
    variable has a checksum in it, which `open` and ``fdspec check`` compare.  A part of a cube, as ``sel``
    and ``isel`` give it, is written with the parameters of that part; a cube joined or reduced by hand is
    refused as long as it has the parameters of another.
    Numbers are compressed with zlib, text is stored as characters, so that ncdump, R, Octave, nco and
    ParaView read it.

    Parameters
    ----------
    dataset : xarray.Dataset
        Numbers and text; attributes are text, numbers or lists of numbers.
    path : path
        The file, in a folder that exists: ``cube.nc``.
    overwrite : bool
        Whether a file of that name may be replaced; never by a cube with cells that were not computed.

    Raises
    ------
    StoreError
        When the file cannot be written, the dataset holds what netCDF cannot, or its parameters are not its
        own.
    InvalidInput
        For anything but a Dataset.

    Examples
    --------
    >>> import tempfile, xarray
    >>> cube = xarray.Dataset({"pga": ("record", [3.4])}, coords={"record": ["FSR1"]})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save(cube, f"{folder}/cube.nc")
    ...     open(f"{folder}/cube.nc").identical(cube)
    True
    """
    import xarray as xr

    given: object = dataset
    if not isinstance(given, xr.Dataset):
        hint = ', such as array.to_dataset(name="...")' if isinstance(given, xr.DataArray) else ""
        raise InvalidInput(f"dataset must be an xarray.Dataset{hint}, got {type(given).__name__}")
    if not is_complete(dataset):
        if os.path.lexists(path):
            raise StoreError(
                f"cannot write {os.fspath(path)}: cells of the cube were not computed, and a file is there "
                "that they would replace; give another name, or start the sweep again"
            )
        overwrite = False
    with replacing(path, overwrite=overwrite) as part:
        _check(dataset)
        dataset = with_true_parameters(dataset.drop_encoding())
        about = {FORMAT: np.int32(VERSION), checksums.CHECKSUMS: json.dumps(checksums.of_all(dataset))}
        write_netcdf(with_lists(layout.to_disk(dataset)).assign_attrs(about), part, path)


def is_complete(dataset: xr.Dataset) -> bool:
    """Whether all cells of a cube were computed; what has none is complete."""
    status = dataset.variables.get("status")
    if status is None or NOT_COMPUTED not in np.atleast_1d(status.attrs.get("flag_values", ())):
        return True
    return not bool((status == NOT_COMPUTED).any())


def with_lists(on_disk: xr.Dataset) -> xr.Dataset:
    """Mark attributes that are lists of one number: netCDF gives these back as a number."""
    marked = on_disk.copy(deep=False)
    owners: list[xr.Dataset | xr.Variable] = [marked, *marked.variables.values()]
    for owner in owners:
        lists = [str(key) for key, value in owner.attrs.items() if np.shape(value) == (1,)]
        if lists:
            owner.attrs = {**owner.attrs, LISTS: json.dumps(lists)}
    return marked


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
    try:
        store = description.is_store(path)
        if not store:
            _check_magic(Path(path))
    except (OSError, RuntimeError, ValueError) as error:  # a loop of links, a name too long, a NUL in it
        if isinstance(error, FdspecError):
            raise
        told = error.strerror if isinstance(error, OSError) else None
        raise StoreError(f"cannot open {os.fspath(path)}: {told or 'no file can have that name'}") from error
    try:
        with undisturbed():
            if store:
                return _read_store(path, lazily=lazily is not False)
            return _read(path, bool(lazily))
    except FdspecError:
        raise
    except MemoryError:
        raise StoreError(
            f"cannot open {os.fspath(path)}: not enough memory; open it with lazily=True"
        ) from None
    except Exception as error:
        # What the libraries raise on damaged files has no type of its own: KeyError, RuntimeError, ...
        if told := no_resources(error):
            raise DiskError(f"cannot open {os.fspath(path)}: {told}") from error
        kind, remedy = ("store", "'fdspec check' says where") if store else ("file", "write it again")
        raise StoreError(
            f"cannot open {os.fspath(path)}: the {kind} is damaged or incomplete; {remedy}"
        ) from error


def checksums_of(path: str | os.PathLike[str]) -> dict[str, str] | None:
    """Return the checksums that a netCDF file of fdspec's tells; None for one older than they are."""
    import netCDF4

    with netCDF4.Dataset(os.fspath(path)) as file:
        text = file.getncattr(checksums.CHECKSUMS) if checksums.CHECKSUMS in file.ncattrs() else None
    return None if text is None else _told(text)


def _told(text: object) -> dict[str, str]:
    told = json.loads(str(text))
    if not isinstance(told, dict):
        raise TypeError("no table of checksums")
    return told


def _read_store(path: str | os.PathLike[str], lazily: bool) -> xr.Dataset:
    cube, left, blocks = chunks.open_store(path)
    if left:
        warnings.warn(
            f"{os.fspath(path)}: {left} of {blocks} blocks are not computed yet; start the sweep again",
            UserWarning,
            stacklevel=4,
        )
    if lazily:
        return cube
    check_size(cube, path)
    with cube:
        return cube.load()


def _read(path: str | os.PathLike[str], lazily: bool) -> xr.Dataset:
    import xarray as xr

    # Values as they are: no decoding of fill values, scales or times, which `save` never writes.
    on_disk = xr.open_dataset(
        path, engine="netcdf4", mask_and_scale=False, decode_times=False, decode_timedelta=False, cache=False
    )
    with ExitStack() as closing:
        closing.callback(on_disk.close)
        version = _check_format(on_disk, path)
        told = on_disk.attrs.get(checksums.CHECKSUMS)
        if (told is None) != (version < 2):
            raise DamagedError(f"cannot open {os.fspath(path)}: the file is damaged; write it again")
        if not lazily:
            check_size(on_disk, path)
        opened = layout.from_disk(_without_marks(on_disk))
        if not lazily:
            opened = opened.load()
        opened = opened.drop_encoding()
        if told is not None:
            # Numbers that are read later are compared by `fdspec check`, and guarded by HDF5.
            names = opened.coords if lazily else opened.variables
            if wrong := checksums.differing(opened, _told(told), names):
                raise DamagedError(
                    f"cannot open {os.fspath(path)}: the file is damaged: {', '.join(wrong)} "
                    "not as written; write it again"
                )
        if lazily:
            opened.set_close(closing.pop_all().close)
        return opened


def _without_marks(on_disk: xr.Dataset) -> xr.Dataset:
    """Take out what stands on disk alone, and give lists of one number back as lists."""
    plain = on_disk.copy(deep=False)
    owners: list[xr.Dataset | xr.Variable] = [plain, *plain.variables.values()]
    for owner in owners:
        lists = json.loads(owner.attrs.get(LISTS, "[]"))
        drop = {LISTS, FORMAT, checksums.CHECKSUMS}
        if lists or drop & owner.attrs.keys():
            owner.attrs = {
                key: np.atleast_1d(value) if key in lists else value
                for key, value in owner.attrs.items()
                if key not in drop
            }
    return plain


def write_netcdf(on_disk: xr.Dataset, part: Path, path: str | os.PathLike[str]) -> None:
    """Write a dataset whose text is already fixed-width to `part`; `path` is the name errors speak of."""
    encoding = {
        name: _encoding(variable, name in on_disk.coords) for name, variable in on_disk.variables.items()
    }
    try:
        with undisturbed():
            on_disk.to_netcdf(part, mode="w", format="NETCDF4", engine="netcdf4", encoding=encoding)
    except FdspecError:
        raise
    except (OSError, RuntimeError) as error:
        told = no_resources(error) or "the disk is full, or refuses it"
        raise DiskError(f"cannot write {os.fspath(path)}: {told}") from error
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise StoreError(
            f"cannot write {os.fspath(path)}: the dataset holds a name or value that netCDF has no place for"
        ) from error


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
        if name in {FORMAT, LISTS, checksums.CHECKSUMS, layout.LABELS, layout.DTYPE, layout.DIM}:
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
        if path.exists() and not path.is_file():  # a pipe would be waited on
            raise StoreError(f"cannot open {path}: it is no regular file; name a file that fdspec saved")
        with path.open("rb") as file:
            start = file.read(8)
    except FileNotFoundError as error:
        raise StoreError(f"cannot open {path}: there is no such file") from error
    except StoreError:
        raise
    except OSError as error:
        told = no_resources(error) or error.strerror or "the disk refuses it"
        raise StoreError(f"cannot open {path}: {told}") from error
    if not start.startswith(_MAGIC):
        raise StoreError(f"cannot open {path}: it is not a netCDF file; name one that fdspec saved")


def _check_format(on_disk: xr.Dataset, path: str | os.PathLike[str]) -> int:
    if FORMAT not in on_disk.attrs:
        raise StoreError(
            f"cannot open {os.fspath(path)}: it is an export or another program's netCDF file; "
            "name one that fdspec saved, or read it with xarray.open_dataset"
        )
    version = on_disk.attrs[FORMAT]
    if not isinstance(version, int | np.integer) or version < 1:
        raise DamagedError(f"cannot open {os.fspath(path)}: the file is damaged: its layout has no version")
    if version > VERSION:
        raise StoreError(
            f"cannot open {os.fspath(path)}: its layout is version {version}, this fdspec knows {VERSION}; "
            "upgrade fdspec"
        )
    return int(version)
