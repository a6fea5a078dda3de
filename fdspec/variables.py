"""Every variable that fdspec puts into a Dataset: its dims, units, type and one sentence.

`CUBE` holds what `sweep` returns, `BUILDING_CUBE` what `sweep_buildings` returns, `HISTORY` what `simulate`
returns; each maps a name to a `Variable`. `describe` checks a Dataset against one of them and writes the CF
attributes. A new output is one more entry.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np

from fdspec.errors import InvalidInput

if TYPE_CHECKING:
    import xarray as xr

TEXT: Final = "str"
"""The dtype of a variable that holds text, whichever way numpy stores it."""

STUDY_DIMS: Final = ("record", "stiffness_ratio", "pretension", "period")
"""The dims of the study's cube, slowest first."""


INTENSITY: Final = "intensity"
"""The dim of factors on the ground motions: second, after the record, in cubes that have it."""


@dataclass(frozen=True, slots=True)
class Variable:
    """One variable of a Dataset.

    `units` is empty for text and for flags, which have none; `attributes` come on top of units and long_name.
    """

    name: str
    dims: tuple[str, ...]
    units: str
    long_name: str
    dtype: str = "float64"
    attributes: Mapping[str, object] = field(default_factory=dict)
    on_request: bool = False
    """Whether a sweep computes it only where its outputs name it."""
    degree: int | None = None
    """Power of s by which it grows when the motion and all strengths are s times as large; None where it is
    no result of a history."""

    @property
    def cf_attributes(self) -> dict[str, object]:
        """The attributes as they stand in a file."""
        units = {"units": self.units} if self.units else {}
        return {**units, "long_name": self.long_name, **self.attributes}


Registry = Mapping[str, Variable]


def registry_of(*groups: Iterable[Variable]) -> Registry:
    """Return one registry of all these variables; a name that comes twice raises InvalidInput."""
    variables = [variable for group in groups for variable in group]
    names = [variable.name for variable in variables]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InvalidInput(f"each variable is registered once, but not {', '.join(twice)}")
    return MappingProxyType({variable.name: variable for variable in variables})


def _flags(codes: Mapping[int, str]) -> dict[str, object]:
    return {"flag_values": np.array(list(codes), dtype=np.int8), "flag_meanings": " ".join(codes.values())}


PHASES: Final = MappingProxyType({-1: "slip_backward", 0: "stick", 1: "slip_forward"})
"""Phase code -> meaning; forward is a floor that moves faster than its brace."""

STATUSES: Final = MappingProxyType(
    {
        0: "ok",
        1: "transition_cap_reached",
        2: "non_finite_state",
        3: "iteration_not_converged",
        4: "energy_not_closed",
        5: "collapsed",
    }
)
"""Status code -> meaning, as the kernels return them."""

NOT_COMPUTED: Final = -1
"""Status of a cell that no sweep has come to yet."""


def motion_variables(dims: tuple[str, ...]) -> tuple[Variable, ...]:
    """Return what is told of a ground motion: over ("record",) in a cube, over () in a history."""
    return (
        Variable("record", dims, "", "name of the ground motion", TEXT),
        Variable("pga", dims, "m/s^2", "peak ground acceleration, as applied"),
        Variable("dt", dims, "s", "sampling interval of the ground motion"),
        Variable("duration", dims, "s", "duration of the ground motion"),
        Variable("samples", dims, "1", "number of samples of the ground motion", "int64"),
        Variable("scale_factor", dims, "1", "factor by which the recorded acceleration was multiplied"),
        Variable("event", dims, "", "earthquake that was recorded", TEXT),
        Variable("station", dims, "", "station that recorded the ground motion", TEXT),
        Variable("component", dims, "", "component of the ground motion", TEXT),
        Variable("source", dims, "", "file or collection that the ground motion was read from", TEXT),
        Variable("history", dims, "", "what was done to the ground motion since it was read", TEXT),
        Variable("checksum", dims, "", "SHA-256 of the applied acceleration and its sampling interval", TEXT),
    )


def response_variables(grid: tuple[str, ...], storey: tuple[str, ...] = ()) -> tuple[Variable, ...]:
    """Return what one history of a single storey or of a building leaves in a sweep over `grid`.

    `storey` holds the extra dims of what each storey has of its own: none for single-storey frames,
    ("storey",) for buildings.
    """
    each = (*grid, *storey)
    dampers = "all dampers" if storey else "the damper"
    return (
        Variable("peak_acceleration", each, "m/s^2", "peak absolute acceleration of the floor", degree=1),
        Variable(
            "peak_displacement", each, "m", "peak displacement of the floor relative to the ground", degree=1
        ),
        Variable("peak_velocity", each, "m/s", "peak velocity of the floor relative to the ground", degree=1),
        Variable(
            "peak_base_shear", grid, "N", "peak shear force on the ground, frame and brace together", degree=1
        ),
        Variable(
            "residual_displacement",
            each,
            "m",
            "displacement of the floor relative to the ground at the record's end",
            degree=1,
        ),
        Variable("slip_travel", each, "m", "total distance slipped in the damper", degree=1),
        Variable("transitions", grid, "1", f"number of changes of phase of {dampers}", "int64", degree=0),
        Variable("dissipated_energy", grid, "J", f"energy dissipated by friction in {dampers}", degree=2),
        Variable(
            "input_energy", grid, "J", "energy put in by the ground motion, in the ground's frame", degree=2
        ),
        Variable(
            "energy_error", grid, "1", "error of the energy balance relative to the energy in play", degree=0
        ),
        Variable("status", grid, "", "how the integration ended", "int8", _flags(STATUSES), degree=0),
        *demand_variables(each, on_request=bool(storey)),
    )


def demand_variables(each: tuple[str, ...], *, on_request: bool = False) -> tuple[Variable, ...]:
    """Return what a designer reads off of each storey, beside the floor's peaks.

    on_request: whether a sweep computes the peaks only where they are named.
    """
    return (
        Variable(
            "peak_slip",
            each,
            "m",
            "largest slip of the damper from where it was fastened",
            on_request=on_request,
            degree=1,
        ),
        Variable("residual_slip", each, "m", "final slip offset of the damper", degree=1),
        Variable(
            "peak_brace_force",
            each,
            "N",
            "peak force in the spring and dashpot of the brace",
            on_request=on_request,
            degree=1,
        ),
        Variable(
            "peak_column_shear",
            each,
            "N",
            "peak shear force of the columns, without P-delta",
            on_request=on_request,
            degree=1,
        ),
    )


def device_variables(each: tuple[str, ...]) -> tuple[Variable, ...]:
    """Return what only buildings with devices have of each storey."""
    return (
        Variable("peak_column_deformation", each, "m", "peak drift of the columns that can yield", degree=1),
        Variable("plastic_drift", each, "m", "final plastic drift of the columns", degree=1),
        Variable("ductility", each, "1", "peak drift over yield drift of the columns", degree=0),
        Variable("column_energy", each, "J", "energy dissipated by yielding of the columns", degree=2),
        Variable(
            "column_events", each, "1", "number of times the columns yielded or unloaded", "int64", degree=0
        ),
        Variable(
            "slot_events",
            each,
            "1",
            "number of contacts and releases at the ends of the slot",
            "int64",
            degree=0,
        ),
        Variable("peak_drift_ratio", each, "1", "peak drift over the height of the storey", degree=1),
    )


def link_variables(each: tuple[str, ...]) -> tuple[Variable, ...]:
    """Return what only buildings with links have of each link."""
    slip = "largest slip of the link from where it was fastened"
    return (
        Variable("peak_link_slip", each, "m", slip, degree=1),
        Variable("residual_link_slip", each, "m", "final slip offset of the link", degree=1),
        Variable("peak_link_force", each, "N", "peak force in the brace of the link", degree=1),
        Variable("link_energy", each, "J", "energy dissipated in the link", degree=2),
        Variable("link_events", each, "1", "number of changes of phase of the link", "int64", degree=0),
        Variable(
            "link_contacts", each, "1", "number of contacts and releases in the link", "int64", degree=0
        ),
    )


def _variables_of_indices() -> tuple[Variable, ...]:
    """Return what performance indices need beside the responses, the bare frame's share included."""
    bare, braced = ("record", "period"), ("record", "stiffness_ratio", "period")
    area, peak = "area under the history of elastic energy in", "peak elastic energy in"
    displacement = "peak displacement of the floor relative to the ground"
    shear = "peak shear force on the ground"
    never, without = "with a damper that never slips", "of the frame without brace"
    asked = (
        ("strain_energy_area", STUDY_DIMS, "J s", f"{area} frame and brace"),
        ("peak_strain_energy", STUDY_DIMS, "J", f"{peak} frame and brace"),
        ("bare_peak_displacement", bare, "m", f"{displacement}, {without}"),
        ("bare_peak_base_shear", bare, "N", f"{shear}, {without}"),
        ("bare_strain_energy_area", bare, "J s", f"{area} the frame without brace"),
        ("bare_peak_strain_energy", bare, "J", f"{peak} the frame without brace"),
        ("braced_peak_displacement", braced, "m", f"{displacement}, {never}"),
        ("braced_peak_base_shear", braced, "N", f"{shear}, {never}"),
    )
    return tuple(
        Variable(name, dims, units, text, on_request=True, degree=2 if units.startswith("J") else 1)
        for name, dims, units, text in asked
    )


_INTENSITY_OF_ALL: Final = Variable(INTENSITY, (), "1", "factor on the ground motion")


CUBE: Final[Registry] = registry_of(
    motion_variables(("record",)),
    (
        _INTENSITY_OF_ALL,
        Variable(
            "stiffness_ratio", ("stiffness_ratio",), "1", "stiffness of the brace over that of the frame"
        ),
        Variable("pretension", ("pretension",), "N", "pretension of the damper"),
        Variable("period", ("period",), "s", "natural period of the frame without its brace"),
        Variable("slip_force", ("pretension",), "N", "friction force at which the damper starts to slip"),
        Variable("kinetic_slip_force", ("pretension",), "N", "friction force of the damper while it slips"),
    ),
    response_variables(STUDY_DIMS),
    device_variables(STUDY_DIMS),
    (
        Variable(
            "elastic_acceleration",
            ("record", "period"),
            "m/s^2",
            "peak absolute acceleration of the floor with a damper that slides without friction",
            degree=1,
        ),
        Variable(
            "braced_acceleration",
            ("record", "stiffness_ratio", "period"),
            "m/s^2",
            "peak absolute acceleration of the floor with a damper that never slips",
            degree=1,
        ),
    ),
    _variables_of_indices(),
)
"""The variables of a sweep over single-storey frames, dims (record, stiffness_ratio, pretension, period)."""

BUILDING_DIMS: Final = ("record", "building", "stiffness_scale", "slip_scale")
"""The dims of a cube of buildings, slowest first; ``storey`` comes after them where each has its own."""

_EACH_STOREY: Final = (*BUILDING_DIMS, "storey")

STANDS_ON: Final = "floor that the storey stands on, 0 the ground; there with frames beside each other"

BUILDING_CUBE: Final[Registry] = registry_of(
    motion_variables(("record",)),
    (
        _INTENSITY_OF_ALL,
        Variable("building", ("building",), "", "name of the building", TEXT),
        Variable("stiffness_scale", ("stiffness_scale",), "1", "factor on the stiffness of all braces"),
        Variable("slip_scale", ("slip_scale",), "1", "factor on the slip forces of all dampers"),
        Variable("storey", ("storey",), "1", "storey, counted from 1 at the ground", "int64"),
        Variable(
            "slip_force",
            ("building", "slip_scale", "storey"),
            "N",
            "friction force at which the damper starts to slip",
        ),
        Variable(
            "kinetic_slip_force",
            ("building", "slip_scale", "storey"),
            "N",
            "friction force of the damper while it slips",
        ),
        Variable("stands_on", ("building", "storey"), "1", STANDS_ON, "int64"),
        Variable(
            "brace_stiffness", ("building", "stiffness_scale", "storey"), "N/m", "stiffness of the brace"
        ),
        Variable("bare_period", ("building",), "s", "first natural period of the frame without braces"),
        Variable(
            "braced_period",
            ("building", "stiffness_scale"),
            "s",
            "first natural period with dampers that never slip",
        ),
    ),
    response_variables(BUILDING_DIMS, ("storey",)),
    (
        Variable(
            "peak_drift",
            _EACH_STOREY,
            "m",
            "peak displacement of the floor relative to the floor below",
            degree=1,
        ),
        Variable(
            "peak_storey_shear", _EACH_STOREY, "N", "peak shear force of frame and brace together", degree=1
        ),
        Variable(
            "peak_brace_displacement",
            _EACH_STOREY,
            "m",
            "peak displacement of the brace relative to the ground",
            degree=1,
        ),
        Variable(
            "residual_drift",
            _EACH_STOREY,
            "m",
            "final displacement of the floor relative to the floor below",
            degree=1,
        ),
        Variable(
            "storey_transitions",
            _EACH_STOREY,
            "1",
            "number of changes of phase of the damper",
            "int64",
            degree=0,
        ),
        Variable(
            "storey_friction_energy",
            _EACH_STOREY,
            "J",
            "energy dissipated by friction in the damper",
            degree=2,
        ),
        Variable(
            "elastic_acceleration",
            ("record", "building", "storey"),
            "m/s^2",
            "peak absolute acceleration of the floor of the frame without braces",
            degree=1,
        ),
        Variable(
            "braced_acceleration",
            ("record", "building", "stiffness_scale", "storey"),
            "m/s^2",
            "peak absolute acceleration of the floor with dampers that never slip",
            degree=1,
        ),
    ),
    device_variables(_EACH_STOREY),
    (Variable("link", ("link",), "", "name of the link", TEXT),),
    link_variables((*BUILDING_DIMS, "link")),
)
"""The variables of a sweep over buildings: dims (record, building, stiffness_scale, slip_scale), and storey
or link where each has its own."""


def over_intensity(registry: Registry) -> Registry:
    """Return the registry of a cube that has the dim ``intensity`` after ``record`` too."""

    def along(variable: Variable) -> Variable:
        if variable.name == INTENSITY:
            return replace(variable, dims=(INTENSITY,))
        if variable.degree is None:
            return variable
        return replace(variable, dims=(variable.dims[0], INTENSITY, *variable.dims[1:]))

    return registry_of(along(variable) for variable in registry.values())


INTENSITY_CUBE: Final = over_intensity(CUBE)
"""The variables of a sweep over single-storey frames and intensities."""

INTENSITY_BUILDING_CUBE: Final = over_intensity(BUILDING_CUBE)
"""The variables of a sweep over buildings and intensities."""

_OVER_TIME: Final = ("time",)
_EACH: Final = ("time", "storey")
_STOREY: Final = ("storey",)
_LINK: Final = ("link",)
_EACH_LINK: Final = ("time", "link")
_TRANSITION: Final = ("transition",)

HISTORY: Final[Registry] = registry_of(
    motion_variables(()),
    (
        Variable("time", _OVER_TIME, "s", "time since the start of the ground motion"),
        Variable("storey", _STOREY, "1", "storey, counted from 1 at the ground", "int64"),
        Variable("slip_force", _STOREY, "N", "friction force at which the damper starts to slip"),
        Variable("kinetic_slip_force", _STOREY, "N", "friction force of the damper while it slips"),
        Variable("ground_acceleration", _OVER_TIME, "m/s^2", "acceleration of the ground"),
        Variable("displacement", _EACH, "m", "displacement of the floor relative to the ground"),
        Variable("velocity", _EACH, "m/s", "velocity of the floor relative to the ground"),
        Variable("acceleration", _EACH, "m/s^2", "absolute acceleration of the floor"),
        Variable("drift", _EACH, "m", "displacement of the floor relative to the floor below"),
        Variable("storey_shear", _EACH, "N", "shear force of frame and brace together"),
        Variable("brace_displacement", _EACH, "m", "displacement of the brace relative to the ground"),
        Variable("brace_velocity", _EACH, "m/s", "velocity of the brace relative to the ground"),
        Variable("friction_force", _EACH, "N", "force of the damper, positive against forward slip"),
        Variable("slip", _EACH, "m", "slip of the damper from where it was fastened, positive forward"),
        Variable("brace_force", _EACH, "N", "force in the spring and dashpot of the brace"),
        Variable("column_shear", _EACH, "N", "shear force of the columns, without P-delta"),
        Variable("phase", _EACH, "", "phase of the damper", "int8", _flags(PHASES)),
        Variable("slip_travel", _EACH, "m", "distance slipped in the damper so far"),
        Variable("kinetic_energy", _OVER_TIME, "J", "kinetic energy relative to the ground"),
        Variable("strain_energy", _OVER_TIME, "J", "elastic energy in frame and braces"),
        Variable("viscous_energy", _OVER_TIME, "J", "energy dissipated by viscous damping"),
        Variable("friction_energy", _OVER_TIME, "J", "energy dissipated by friction in all dampers"),
        Variable("storey_friction_energy", _EACH, "J", "energy dissipated by friction in the damper"),
        Variable(
            "input_energy", _OVER_TIME, "J", "energy put in by the ground motion, in the ground's frame"
        ),
        Variable(
            "end_state", ("state",), "1", "state of the engine at the end, for a history that goes on from it"
        ),
        Variable("transition_time", _TRANSITION, "s", "instant of the change of phase"),
        Variable("transition_storey", _TRANSITION, "1", "storey of the change of phase", "int64"),
        Variable("transition_phase", _TRANSITION, "", "phase after the change", "int8", _flags(PHASES)),
        Variable("peak_acceleration", _STOREY, "m/s^2", "peak absolute acceleration of the floor"),
        Variable("peak_displacement", _STOREY, "m", "peak displacement of the floor relative to the ground"),
        Variable("peak_velocity", _STOREY, "m/s", "peak velocity of the floor relative to the ground"),
        Variable("peak_drift", _STOREY, "m", "peak displacement of the floor relative to the floor below"),
        Variable("peak_storey_shear", _STOREY, "N", "peak shear force of frame and brace together"),
        Variable("peak_base_shear", (), "N", "peak shear force on the ground, frame and brace together"),
        Variable(
            "residual_displacement",
            _STOREY,
            "m",
            "displacement of the floor relative to the ground at the history's end",
        ),
        Variable(
            "residual_drift", _STOREY, "m", "final displacement of the floor relative to the floor below"
        ),
        Variable("storey_transitions", _STOREY, "1", "number of changes of phase of the damper", "int64"),
        Variable("transitions", (), "1", "number of changes of phase of all dampers", "int64"),
        Variable("dissipated_energy", (), "J", "energy dissipated by friction in all dampers, in total"),
        Variable("energy_error", (), "1", "error of the energy balance relative to the energy in play"),
        Variable("status", (), "", "how the integration ended", "int8", _flags(STATUSES)),
    ),
    demand_variables(_STOREY),
    device_variables(_STOREY),
    (
        Variable("plastic_deformation", _EACH, "m", "plastic drift of the columns so far"),
        Variable("bearing_energy", _OVER_TIME, "J", "elastic energy in the ends of all slots"),
        Variable("gravity_energy", _OVER_TIME, "J", "work done by gravity on the leaning frame"),
        Variable("yielding_energy", _OVER_TIME, "J", "energy dissipated by yielding of all columns"),
        Variable("links_energy", _OVER_TIME, "J", "energy dissipated in all links"),
        Variable("stands_on", _STOREY, "1", STANDS_ON, "int64"),
        Variable("link", _LINK, "", "name of the link", TEXT),
        Variable("link_slip", _EACH_LINK, "m", "slip offset of the link, of a one-sided brace its slack"),
        Variable("link_force", _EACH_LINK, "N", "force in the brace of the link"),
        Variable("link_phase", _EACH_LINK, "", "phase of the link", "int8", _flags(PHASES)),
    ),
    link_variables(_LINK),
)
"""The variables of one simulated history, dims time, storey, transition and, where there are any, link."""


def describe(dataset: xr.Dataset, registry: Registry) -> xr.Dataset:
    """Return `dataset` with the registry's attributes on every variable, coordinates included.

    The values are shared with the input; attributes that its variables had are replaced, global ones stay.
    Raise InvalidInput for a variable the registry does not know, or knows with other dims or another dtype.
    Variables of the registry may be missing: a sweep computes what it was asked for.
    """
    described = dataset.copy(deep=False)
    for key, array in described.variables.items():
        name = str(key)
        if name not in registry:
            raise InvalidInput(f"variable {name!r} is not registered; known are {', '.join(registry)}")
        variable = registry[name]
        if array.dims != variable.dims:
            raise InvalidInput(f"variable {name!r} has dims {array.dims}; it should have {variable.dims}")
        if not _holds(array.dtype, variable.dtype):
            raise InvalidInput(f"variable {name!r} has dtype {array.dtype}; it should have {variable.dtype}")
        described[name].attrs = variable.cf_attributes
    return described


def _holds(dtype: np.dtype[np.generic], wanted: str) -> bool:
    if wanted == TEXT:
        return getattr(dtype, "kind", "O") in "UOT"
    return dtype == np.dtype(wanted)
