"""Figures: a Dataset or ground motions go in, a matplotlib Figure comes out; no files, no data made here."""

from fdspec.figures.chart import plot_chart
from fdspec.figures.choice import plot_before_after, plot_choice_index, plot_choice_records
from fdspec.figures.contact_sheet import plot_contact_sheet
from fdspec.figures.encoding import encode
from fdspec.figures.energy import plot_energy
from fdspec.figures.ensemble import plot_histories, plot_spectra
from fdspec.figures.grazing import plot_grazing, shortest_stick
from fdspec.figures.history import plot_history
from fdspec.figures.hysteresis import plot_hysteresis
from fdspec.figures.journal import plot_acceleration_print
from fdspec.figures.maps import plot_acceleration_maps
from fdspec.figures.page import at_width, lettering
from fdspec.figures.profiles import design_of, plot_profiles, profiles_caption
from fdspec.figures.record import plot_record
from fdspec.figures.sketch import plot_sketch, sketch_caption
from fdspec.figures.surfaces import acceleration_caption, plot_acceleration
from fdspec.figures.together import ensemble_caption, plot_ensemble
from fdspec.figures.validation import plot_bare_and_damped, plot_brace_displacements

__all__ = [
    "acceleration_caption",
    "at_width",
    "design_of",
    "encode",
    "ensemble_caption",
    "lettering",
    "plot_acceleration",
    "plot_acceleration_maps",
    "plot_acceleration_print",
    "plot_bare_and_damped",
    "plot_before_after",
    "plot_brace_displacements",
    "plot_chart",
    "plot_choice_index",
    "plot_choice_records",
    "plot_contact_sheet",
    "plot_energy",
    "plot_ensemble",
    "plot_grazing",
    "plot_histories",
    "plot_history",
    "plot_hysteresis",
    "plot_profiles",
    "plot_record",
    "plot_sketch",
    "plot_spectra",
    "profiles_caption",
    "shortest_stick",
    "sketch_caption",
]
