"""Figures: a Dataset or ground motions go in, a matplotlib Figure comes out; no files, no data made here."""

from fdspec.figures.encoding import encode
from fdspec.figures.ensemble import plot_histories, plot_spectra
from fdspec.figures.history import plot_history
from fdspec.figures.maps import plot_acceleration_maps
from fdspec.figures.record import plot_record
from fdspec.figures.surfaces import plot_acceleration_surfaces

__all__ = [
    "encode",
    "plot_acceleration_maps",
    "plot_acceleration_surfaces",
    "plot_histories",
    "plot_history",
    "plot_record",
    "plot_spectra",
]
