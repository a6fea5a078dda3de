"""The variables of what a choice comes to: best pretensions and slip forces."""

from __future__ import annotations

from typing import Final

from fdspec.variables import CUBE, TEXT, Registry, Variable, motion_variables, registry_of

_RECORD: Final = ("record",)
_POINT: Final = ("stiffness_ratio", "period")
_EACH: Final = (*_RECORD, *_POINT)


def _best(dims: tuple[str, ...], of_whom: str) -> tuple[Variable, ...]:
    return (
        Variable("pretension", dims, "N", f"pretension with the least index {of_whom}"),
        Variable("slip_force", dims, "N", "friction force at which the damper then starts to slip"),
        Variable("index", dims, "1", f"the least index {of_whom}"),
        Variable("band_start", dims, "N", "least pretension of the stretch about the best with a good index"),
        Variable("band_end", dims, "N", "largest pretension of that stretch; inf where it has no end"),
        Variable(
            "bands",
            (*dims, "stretch", "bound"),
            "N",
            "every stretch of pretensions with a good index; NaN where there are fewer",
        ),
    )


_RESPONSES: Final = ("peak_acceleration", "peak_displacement", "peak_base_shear", "residual_displacement")
_SHARED: Final = (
    CUBE["stiffness_ratio"],
    CUBE["period"],
    Variable("stretch", ("stretch",), "1", "number of the stretch, from 1 upwards in pretension", "int64"),
    Variable("bound", ("bound",), "", "which end of the stretch", TEXT),
    *(Variable(name, _EACH, CUBE[name].units, f"{CUBE[name].long_name}, at the best") for name in _RESPONSES),
    Variable(
        "bare_acceleration", ("record", "period"), "m/s^2", "peak acceleration of the frame without brace"
    ),
    Variable("braced_acceleration", _EACH, "m/s^2", "peak acceleration with a damper that never slips"),
)

BEST: Final[Registry] = registry_of(motion_variables(_RECORD), _best(_EACH, "of the record"), _SHARED)
"""The best pretension of each record."""

BEST_FOR_ALL: Final[Registry] = registry_of(
    motion_variables(_RECORD),
    _best(_POINT, "of all records together"),
    _SHARED,
    (
        Variable("index_of_record", _EACH, "1", "index of the record at that pretension"),
        Variable("regret", _EACH, "1", "index of the record above its own least, as a share of that"),
    ),
)
"""The best pretension of an ensemble."""

_STOREY: Final = ("storey",)

OPTIMUM: Final[Registry] = registry_of(
    motion_variables(_RECORD),
    (
        Variable("storey", _STOREY, "1", "storey, counted from 1 at the ground", "int64"),
        Variable("distribution", ("distribution",), "", "how slip forces differ from storey to storey", TEXT),
        Variable("slip_force", _STOREY, "N", "friction force at which the damper starts to slip"),
        Variable("index", (), "1", "index of all records together"),
        Variable("index_of_record", _RECORD, "1", "index of the record"),
        Variable(
            "start_slip_force",
            ("distribution", "storey"),
            "N",
            "best slip forces of the distributions begun with",
        ),
        Variable("start_index", ("distribution",), "1", "index of all records together with those"),
        Variable("generation", ("generation",), "1", "generation of the search, the start being 0", "int64"),
        Variable("generation_index", ("generation",), "1", "least index up to that generation"),
        Variable("evaluations", (), "1", "sets of slip forces tried", "int64"),
    ),
)
"""The best distribution of slip forces over a building."""

_CASE: Final = ("case", "record")
_EACH_STOREY: Final = (*_CASE, "storey")

CHOICE: Final[Registry] = registry_of(
    motion_variables(_RECORD),
    (
        Variable("storey", _STOREY, "1", "storey, counted from 1 at the ground", "int64"),
        Variable("bound", ("bound",), "", "which end of the band", TEXT),
        Variable("case", ("case",), "", "what the slip forces are", TEXT),
        Variable("slip_force", _STOREY, "N", "recommended friction force at which the damper starts to slip"),
        Variable("pretension", _STOREY, "N", "recommended pretension"),
        Variable(
            "band_slip_force", ("bound", "storey"), "N", "ends of the band of slip forces that are good"
        ),
        Variable(
            "band_pretension", ("bound", "storey"), "N", "ends of the band of pretensions that are good"
        ),
        Variable("brace_stiffness", _STOREY, "N/m", "stiffness of the brace"),
        Variable(
            "brace_force", _STOREY, "N", "force that the brace must carry at the upper bound of friction"
        ),
        Variable("stiffness_scale", ("stiffness_scale",), "1", "factor on the stiffness of all braces"),
        Variable("scaled_index", ("stiffness_scale",), "1", "least index with braces so much stiffer"),
        Variable("scaled_pretension", ("stiffness_scale", "storey"), "N", "pretensions of that"),
        Variable("trial_pretension", ("trial", "storey"), "N", "pretensions tried, ascending"),
        Variable("trial_index", ("trial",), "1", "index of all records together"),
        Variable("trial_index_of_record", ("trial", "record"), "1", "index of the record"),
        Variable("index", ("case",), "1", "index of all records together"),
        Variable("index_of_record", _CASE, "1", "index of the record"),
        Variable("regret", _RECORD, "1", "index over the least that the record has in any trial, less 1"),
        Variable("peak_acceleration", _CASE, "m/s^2", "largest peak absolute acceleration of any floor"),
        Variable(
            "peak_drift", _CASE, "m", "largest peak displacement of any floor relative to the one below"
        ),
        Variable("peak_base_shear", _CASE, "N", "peak shear force on the ground"),
        Variable("residual_drift", _CASE, "m", "largest final displacement relative to the floor below"),
        Variable("slip_travel", _CASE, "m", "largest total distance slipped in any damper"),
        Variable("dissipated_energy", _CASE, "J", "energy dissipated by friction in all dampers"),
        Variable("storey_level", (), "1", "factor on the records under which demands of storeys are told"),
        Variable("storey_acceleration", _EACH_STOREY, "m/s^2", "peak absolute acceleration of the floor"),
        Variable("storey_drift", _EACH_STOREY, "m", "peak displacement relative to the floor below"),
        Variable(
            "storey_slip",
            _EACH_STOREY,
            "m",
            "largest distance of the damper from where it was fastened: what a slot leaves to either side",
        ),
        Variable("storey_residual_slip", _EACH_STOREY, "m", "distance at which the damper was left"),
        Variable("storey_brace_force", _EACH_STOREY, "N", "peak force in the brace"),
    ),
    (
        Variable("level", ("level",), "1", "factor on the records at which limits hold"),
        Variable("limited", ("limited",), "", "demand that has a limit", TEXT),
        Variable("used", ("level", "limited"), "1", "demand over its limit, the largest over the bounds"),
        Variable("limits_met", (), "1", "1 where all limits are met, 0 where no slip force does", "int64"),
        Variable(
            "meeting_slip_force",
            ("stretch", "bound", "storey"),
            "N",
            "ends of every stretch of slip forces that meet all limits; inf where it has no end",
        ),
        Variable("stretch", ("stretch",), "1", "number of the stretch, from 1 upwards in force", "int64"),
    ),
)
"""What `fdspec.choose` recommends, and why."""
