"""Records: readers for files, and the catalogue of the study's nine."""

from typing import TYPE_CHECKING

from fdspec.on_demand import submodules
from fdspec.records.catalogue import CatalogueEntry, StandIn, catalogue, load_record
from fdspec.records.reading import read_channels, read_record

__all__ = ["CatalogueEntry", "StandIn", "catalogue", "load_record", "read_channels", "read_record"]

if not TYPE_CHECKING:
    __getattr__ = submodules(__name__)
