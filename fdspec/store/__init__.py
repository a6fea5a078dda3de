"""Datasets in files: netCDF there and back to the bit, exports for other tools, provenance."""

from typing import TYPE_CHECKING

from fdspec.on_demand import submodules
from fdspec.store.chunks import remove
from fdspec.store.combine import combine
from fdspec.store.conversion import to_netcdf
from fdspec.store.export import export
from fdspec.store.netcdf import open, save  # noqa: A004
from fdspec.store.provenance import provenance
from fdspec.store.replacing import check_writable

__all__ = ["check_writable", "combine", "export", "open", "provenance", "remove", "save", "to_netcdf"]

if not TYPE_CHECKING:
    __getattr__ = submodules(__name__)
