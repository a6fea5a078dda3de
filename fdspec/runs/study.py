"""A study: everything one sweep needs, as a TOML file that a person writes."""

import difflib
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Final

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    PlainValidator,
    StrictBool,
    StrictStr,
    ValidationError,
    create_model,
)

from fdspec.errors import StudyError
from fdspec.model.building_file import LinkTable, TensionBraceTable
from fdspec.model.grid import GRID_FIELDS, Grid, checked, contradictions
from fdspec.model.link import Link, TensionBrace
from fdspec.model.motion import GroundMotion
from fdspec.model.toml_lines import key_lines, line_of, parsed
from fdspec.runs.after import NOTHING, After
from fdspec.runs.record_scaling import Scaling, scaling_of
from fdspec.runs.study_records import (
    STUDY_RECORDS,
    RecordFile,
    distinct,
    find_records,
    matching,
    record_field,
    unknown_records,
)
from fdspec.runs.study_text import (
    axis_text,
    bool_text,
    device_lines,
    even_axis,
    link_tables,
    records_text,
    scaling_text,
    strings_text,
)
from fdspec.variables import CUBE, device_variables

AXES: Final = ("stiffness_ratio", "pretension", "period", "intensity")


_OUTPUTS: Final = tuple(v for v in CUBE.values() if v.dims[:1] == ("record",) and len(v.dims) > 1)
DEMANDS: Final = tuple(v.name for v in device_variables(()))
"""What it computes of frames with columns that yield, gravity, slots or re-centring springs alone."""

OUTPUTS: Final = tuple(v.name for v in _OUTPUTS if not v.on_request and v.name not in DEMANDS)
"""What a study computes unless it names its outputs: what depends on more than the record."""

ON_REQUEST: Final = tuple(v.name for v in _OUTPUTS if v.on_request)
"""What it computes only where it is named."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Study:
    """Hold every argument of a sweep and the records it runs on; without arguments, the study of the nine.

    Parameters
    ----------
    grid : Grid
        Axes and scalars.
    records : tuple of str or RecordFile
        Names of the catalogue, or record files.
    scaled : bool
        Whether the catalogue's stand-ins are scaled to the study's PGA.
    scaling : Scaling or None
        Of every record that has none of its own, after that.
    outputs : tuple of str or None
        Variables of the cube; None for all.
    certify : bool
        Whether the energy balance of every history is checked.
    after : After
        Free vibration after every motion, and whether histories go on until the building is at rest.
    folder : Path
        Where relative paths start: the study file's folder.
    """

    grid: Grid = field(default_factory=Grid.study)
    records: tuple[str | RecordFile, ...] = STUDY_RECORDS
    scaled: bool = True
    scaling: Scaling | None = None
    outputs: tuple[str, ...] | None = None
    certify: bool = True
    after: After = NOTHING
    folder: Path = Path()

    @classmethod
    def read(cls, path: str | Path) -> "Study":
        """Read a study file; a field it does not name has the study's value.

        Raises
        ------
        StudyError
            When the file cannot be used; one line of text for each mistake, with field and line number.
        """
        path = Path(path)
        return cls.parse(text_of(path), name=str(path), folder=path.parent)

    @classmethod
    def parse(cls, text: str, *, name: str = "study", folder: Path = Path()) -> "Study":
        """Read a study from TOML text; `name` stands for the file in error messages."""
        try:
            table = parsed(text)
        except ValueError as error:
            raise StudyError(f"{name}: {error}") from None
        values: dict[str, Any] = {}
        try:
            values = dict(_StudyFile.model_validate(table))
        except ValidationError as error:
            mistakes = [
                mistake_of(detail["loc"], detail["type"], detail["msg"], _StudyFile.model_fields)
                for detail in error.errors()
            ]
        else:
            mistakes = [((key,), f"{key}: {sentence}") for key, sentence in contradictions(values)]
        if mistakes:
            if all(where[0] != "records" for where, _ in mistakes):
                mistakes += unknown_records(table.get("records"), folder)
            raise placed(name, text, mistakes)
        values["links"] += values.pop("tension_braces")
        values["records"], mistakes = matching(values["records"], folder)
        if mistakes:
            raise placed(name, text, mistakes)
        grid = Grid(**{key: values.pop(key) for key in GRID_FIELDS})
        after = After(values.pop("free_vibration"), values.pop("at_rest"))
        return cls(grid=grid, after=after, folder=folder, **values)

    def motions(self) -> tuple[GroundMotion, ...]:
        """Load the records, in order.

        Raises
        ------
        RecordError
            When some cannot be used; one line of text for each.
        """
        return find_records(self.records, folder=self.folder, scaled=self.scaled, scaling=self.scaling)

    def to_toml(self) -> str:
        """Return the study as the text of a study file, every field named, to be edited."""
        grid = self.grid
        kinetic = grid.kinetic_friction_coefficient
        outputs = OUTPUTS if self.outputs is None else self.outputs
        return f"""\
# A study of fdspec: every (record, stiffness ratio, pretension, period). Units are SI.
# A field left out has the value of the study on the nine records.

# Names of the catalogue (fdspec records list) or record files, relative to this file; what a file does not
# say of itself goes into a table: {{ path = "a.txt", units = "g", dt = 0.01, channel = "EW", name = "b" }};
# "*.AT2" stands for all files that match.
records = {records_text(self.records)}
# Scale the stand-ins of the catalogue to the study's peak ground acceleration.
scaled = {bool_text(self.scaled)}
# Scale every record: {{ factor }}, {{ pga }}, {{ sa, period }} or {{ target, period }}; m/s2, s. Two periods
# are the ends of a band; a record's own table may say the same of it alone, with pair = its other component.
{scaling_text(self.scaling)}

# Axes: a list, {{ start, stop, step }} or {{ start, stop, num }}, ends included.
# Brace over frame stiffness.
stiffness_ratio = {axis_text(grid.stiffness_ratio)}
# N, the total normal force on the sliding surface; 0 slides freely, inf never.
pretension = {axis_text(grid.pretension)}
# s, of the frame without its brace.
period = {axis_text(grid.period)}
# Factors on all records, a further axis of the cube; left out, there is none.
{"# intensity = [0.5, 1.0, 2.0]" if grid.intensity is None else f"intensity = {axis_text(grid.intensity)}"}

# kg
floor_mass = {grid.floor_mass!r}
# kg; 0.0 is the massless brace.
brace_mass = {grid.brace_mass!r}
# Of the frame without its brace.
damping_ratio = {grid.damping_ratio!r}
friction_coefficient = {grid.friction_coefficient!r}
# While sliding, at most the one above; left out, equal to it.
{"# kinetic_friction_coefficient = 0.4" if kinetic is None else f"kinetic_friction_coefficient = {kinetic!r}"}
# Newtons on the sliding surface for each newton of pretension.
normal_force_factor = {grid.normal_force_factor!r}
# Of the brace on its own.
brace_damping_ratio = {grid.brace_damping_ratio!r}

# Devices of all frames alike; left out, there are none. m, N, N/m.
{device_lines(grid)}
# Variables of the cube; left out, these. Only on request: {", ".join(ON_REQUEST)}.
{"# " if self.outputs is None else ""}outputs = {strings_text(outputs)}
# Check the energy balance of every history.
certify = {bool_text(self.certify)}
# s that each history goes on after its record, the ground at rest.
free_vibration = {self.after.free_vibration!r}
# Go on until no damper can slip any more, and give residuals there; twice the work.
at_rest = {bool_text(self.after.at_rest)}
{link_tables(grid)}"""


def text_of(path: Path) -> str:
    """Return what a study file says, or raise StudyError."""
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise StudyError(f"{path}: cannot be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise StudyError(f"{path}: is not a text file in UTF-8") from None


def placed(name: str, text: str, mistakes: Iterable[tuple[tuple[str | int, ...], str]]) -> StudyError:
    """Return the error that tells each mistake with its line, in the order of the file."""
    lines = key_lines(text)
    told = sorted(((line_of(lines, where), sentence) for where, sentence in mistakes), key=lambda one: one[0])
    return StudyError("\n".join(f"{name}, line {line}: {sentence}" for line, sentence in told))


def mistake_of(
    where: tuple[str | int, ...], kind: str, message: str, known: Iterable[str]
) -> tuple[tuple[str | int, ...], str]:
    """Turn one of pydantic's complaints into a sentence that names the field, one of the known."""
    name = str(where[0])
    if kind == "extra_forbidden":
        near = difflib.get_close_matches(name, known, n=1)
        hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(known)}"
        return where, f"{name}: is not a field of a study; {hint}"
    if kind == "value_error":
        return where, f"{name}: {message.removeprefix('Value error, ')}"
    at = f" at index {where[1]}" if len(where) > 1 else ""
    return where, f"{name}: {_TYPE_MISTAKES.get(kind, message)}{at}"


_TYPE_MISTAKES: Final = {
    "bool_type": "must be true or false",
    "string_type": "must be a string",
    "tuple_type": "must be a list",
}
"""What pydantic calls a wrong type, in the words of TOML."""


def _field(name: str, value: object) -> object:
    if name in AXES and isinstance(value, dict):
        value = even_axis(value)
    if name == "links":
        return tuple(_of_table(LinkTable, table) for table in _tables(name, value))
    return checked(name, value)


def _tables(name: str, value: object) -> list[object]:
    if not isinstance(value, list):
        raise ValueError(f"must be tables, [[{name}]], got {value!r:.60}")
    return value


def _of_table(kind: type[LinkTable | TensionBraceTable], table: object) -> Link | TensionBrace:
    """Return the link of a table; raise ValueError for what it cannot be."""
    try:
        link = kind.model_validate(table).made()
    except ValidationError as error:
        told = [(detail["loc"][0] if detail["loc"] else "table", detail["msg"]) for detail in error.errors()]
        raise ValueError("; ".join(f"{key}: {sentence}" for key, sentence in told)) from None
    checked("links", [link])
    return link


def _tension_braces(value: object) -> tuple[Link | TensionBrace, ...]:
    return tuple(_of_table(TensionBraceTable, table) for table in _tables("tension_braces", value))


def free_vibration_field(value: object) -> float:
    """Return the seconds of free vibration of a study file; raise ValueError for what they cannot be."""
    if isinstance(value, bool) or not (isinstance(value, int | float) and 0.0 <= value < math.inf):
        raise ValueError(f"must be zero or a positive time in s, got {value!r:.60}")
    return float(value)


def _output(value: str) -> str:
    return known_output(value, (*OUTPUTS, *DEMANDS, *ON_REQUEST))


def known_output(value: str, known: Sequence[str]) -> str:
    """Return the name of an output; raise ValueError, with what was meant, where it is none of the known."""
    if value not in known:
        near = difflib.get_close_matches(value, known, n=1)
        hint = f"did you mean {near[0]!r}?" if near else f"known are {', '.join(known)}"
        raise ValueError(f"does not know {value!r:.60}; {hint}")
    return value


def _study_file() -> type[BaseModel]:
    """Build the model of a study file from the fields of `Grid`, so that there is one list of them."""
    study = Grid.study()
    scalars_and_axes: Any = {
        name: (Annotated[Any, PlainValidator(partial(_field, name))], getattr(study, name))
        for name in GRID_FIELDS
    }
    records = Annotated[tuple[Annotated[Any, PlainValidator(record_field)], ...], AfterValidator(distinct)]
    output = Annotated[StrictStr, AfterValidator(_output)]
    outputs = Annotated[tuple[output, ...], AfterValidator(distinct)]
    return create_model(
        "StudyFile",
        __config__=ConfigDict(extra="forbid"),
        records=(records, STUDY_RECORDS),
        scaled=(StrictBool, True),
        scaling=(Annotated[Any, PlainValidator(scaling_of)], None),
        outputs=(outputs | None, None),
        certify=(StrictBool, True),
        free_vibration=(Annotated[Any, PlainValidator(free_vibration_field)], 0.0),
        at_rest=(StrictBool, False),
        tension_braces=(Annotated[Any, PlainValidator(_tension_braces)], ()),
        **scalars_and_axes,
    )


_StudyFile: Final = _study_file()
