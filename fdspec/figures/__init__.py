"""Figures: a Dataset goes in, a matplotlib Figure comes out; no files, no data made here."""

from fdspec.figures.encoding import encode
from fdspec.figures.history import plot_history
from fdspec.figures.maps import plot_acceleration_maps
from fdspec.figures.surfaces import plot_acceleration_surfaces

__all__ = ["encode", "plot_acceleration_maps", "plot_acceleration_surfaces", "plot_history"]
