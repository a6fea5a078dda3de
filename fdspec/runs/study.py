"""A study: everything one sweep needs, as a TOML file that a person writes."""

import difflib
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from decimal import Decimal
from functools import partial
from glob import glob, has_magic
from pathlib import Path
from typing import Annotated, Any, Final

import numpy as np
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

from fdspec.errors import InvalidInput, RecordError, StudyError
from fdspec.model.grid import GRID_FIELDS, FloatArray, Grid, checked, contradictions
from fdspec.model.motion import GroundMotion
from fdspec.model.toml_lines import key_lines, line_of, parsed
from fdspec.records import catalogue, load_record, read_record
from fdspec.records.suites import SUITES, is_of_suite, suite_names
from fdspec.runs.after import NOTHING, After
from fdspec.runs.record_scaling import SCALING_FIELDS, Scaling, scaling_of
from fdspec.variables import CUBE, device_variables

AXES: Final = ("stiffness_ratio", "pretension", "period", "intensity")

STUDY_RECORDS: Final = ("FSR1", "FSR2", "FSR3", "FMR1", "FMR2", "FMR3", "FHR1", "FHR2", "FHR3")

_OUTPUTS: Final = tuple(v for v in CUBE.values() if v.dims[:1] == ("record",) and len(v.dims) > 1)
DEMANDS: Final = tuple(v.name for v in device_variables(()))
"""What it computes of frames with columns that yield, gravity, slots or re-centring springs alone."""

OUTPUTS: Final = tuple(v.name for v in _OUTPUTS if not v.on_request and v.name not in DEMANDS)
"""What a study computes unless it names its outputs: what depends on more than the record."""

ON_REQUEST: Final = tuple(v.name for v in _OUTPUTS if v.on_request)
"""What it computes only where it is named."""

MAX_AXIS: Final = 1_000_000
"""Points of one axis; a step with a slipped decimal is refused before it fills the memory."""


@dataclass(frozen=True)
class RecordFile:
    """Name a record file and what it does not say of itself; see `fdspec.read_record`.

    `path` is relative to the study file's folder, `units` one of g, m/s2, cm/s2, mm/s2 and others, `dt` and
    `resample_to` in s, `skip` a number of lines.
    """

    path: str
    units: str | None = None
    dt: float | None = None
    channel: str | None = None
    name: str | None = None
    skip: int | None = None
    layout: str | None = None
    resample_to: float | None = None
    scaling: Scaling | None = None


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
{_scaling_text(self.scaling)}

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
{_device_lines(grid)}
# Variables of the cube; left out, these. Only on request: {", ".join(ON_REQUEST)}.
{"# " if self.outputs is None else ""}outputs = {strings_text(outputs)}
# Check the energy balance of every history.
certify = {bool_text(self.certify)}
# s that each history goes on after its record, the ground at rest.
free_vibration = {self.after.free_vibration!r}
# Go on until no damper can slip any more, and give residuals there; twice the work.
at_rest = {bool_text(self.after.at_rest)}
"""


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


def is_catalogued(record: str) -> bool:
    """Say whether this is a name of the catalogue, upper or lower case."""
    return any(record.upper() == entry.name for entry in catalogue())


def find_record(
    record: str | RecordFile, *, folder: Path = Path(), scaled: bool = True, scaling: Scaling | None = None
) -> GroundMotion:
    """Load a record by its name in the catalogue or, when it is none, by its path relative to `folder`.

    scaling: of a record that has none of its own.

    Raises
    ------
    RecordError
        When there is no such name and no such file, or the file cannot be used.
    """
    own = None if isinstance(record, str) else record.scaling
    scaling = own or scaling
    motion = _found(record, folder, scaled)
    if scaling is None:
        return motion

    def other(path: str, channel: str | None) -> GroundMotion:
        about = RecordFile(path) if isinstance(record, str) else replace(record, path=path, name=None)
        return _found(replace(about, channel=channel or about.channel), folder, scaled)

    try:
        return scaling.applied(motion, folder, other)
    except InvalidInput as error:
        raise RecordError(f"{motion.name}: {error}") from None


def _found(record: str | RecordFile, folder: Path, scaled: bool) -> GroundMotion:
    path = record if isinstance(record, str) else record.path
    if is_catalogued(path) or not _is_path(path, folder):
        return load_record(path, scaled=scaled)
    given = {} if isinstance(record, str) else vars(record)
    about = {key: value for key, value in given.items() if key not in ("path", "scaling")}
    return read_record(folder / path, **about)


def find_records(
    records: Iterable[str | RecordFile],
    *,
    folder: Path = Path(),
    scaled: bool = True,
    scaling: Scaling | None = None,
) -> tuple[GroundMotion, ...]:
    """Load records in order; raise RecordError with one line for each that cannot be used."""
    found, mistakes = [], []
    for record in records:
        try:
            found.append(find_record(record, folder=folder, scaled=scaled, scaling=scaling))
        except (InvalidInput, RecordError) as error:
            mistakes.append(str(error))
    if mistakes:
        raise RecordError("\n".join(mistakes))
    return tuple(found)


def even_axis(spec: Mapping[str, Any]) -> FloatArray:
    """Return the points of { start, stop, step } or { start, stop, num }, both ends included.

    Steps are counted in decimals, so that 0.05, 0.10, ... are the floats one would write.
    """
    if unknown := [key for key in spec if key not in {"start", "stop", "step", "num"}]:
        raise ValueError(
            f"unknown key {unknown[0]!r}; {{ start, stop, step }} or {{ start, stop, num }} is known"
        )
    if "start" not in spec or "stop" not in spec or ("step" in spec) == ("num" in spec):
        raise ValueError(f"needs start, stop and one of step and num, got {', '.join(spec) or 'nothing'}")
    for key, value in spec.items():
        if not _finite(value):
            raise ValueError(f"{key} must be a finite number, got {value!r:.60}")
    start, stop = Decimal(repr(spec["start"])), Decimal(repr(spec["stop"]))
    if "num" in spec:
        if not isinstance(spec["num"], int) or not 2 <= spec["num"] <= MAX_AXIS:
            raise ValueError(f"num must be an integer from 2 to {MAX_AXIS}, got {spec['num']!r:.60}")
        steps = spec["num"] - 1
        return np.array([float(start + (stop - start) * k / steps) for k in range(steps + 1)])
    step = Decimal(repr(spec["step"]))
    if step <= 0 or stop < start:
        raise ValueError(f"step must be positive and stop not before start, got {start} to {stop} by {step}")
    if (stop - start) / step >= MAX_AXIS:
        raise ValueError(f"has more than {MAX_AXIS} points: {start} to {stop} by {step}")
    if (stop - start) % step:
        raise ValueError(f"steps of {step} from {start} do not end on {stop}")
    return np.array([float(start + step * k) for k in range(int((stop - start) / step) + 1)])


def _finite(value: object) -> bool:
    """Say whether this is a number, and one that a float can hold."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    try:
        return math.isfinite(float(value))
    except OverflowError:
        return False


def unknown_records(given: object, folder: Path) -> list[tuple[tuple[str | int, ...], str]]:
    """Mistakes of a study's records that can be seen without reading any."""
    found: list[tuple[tuple[str | int, ...], str]] = []
    for index, record in enumerate(given if isinstance(given, list) else []):
        path = record.get("path") if isinstance(record, dict) else record
        if not isinstance(path, str):
            continue  # told already
        if path in SUITES or is_of_suite(path):
            continue
        if is_pattern(path, folder):
            found += [(("records", index), sentence) for sentence in _unmatched(path, folder)]
        elif _is_path(path, folder):
            if not (folder / path).exists():
                found.append((("records", index), f"records: there is no file {folder / path}"))
        elif not is_catalogued(path):
            try:
                load_record(path)
            except RecordError as error:
                found.append((("records", index), f"records: {error}"))
    return found


def is_pattern(path: str, folder: Path) -> bool:
    """Say whether a path stands for all files that it matches: it has a wildcard, and is no file itself."""
    return has_magic(path) and not (folder / path).exists()


def matching(
    records: tuple[str | RecordFile, ...], folder: Path
) -> tuple[tuple[str | RecordFile, ...], list[tuple[tuple[str | int, ...], str]]]:
    """Return the records with the files, in order, in place of each pattern, and what is wrong with them."""
    found: list[str | RecordFile] = []
    mistakes: list[tuple[tuple[str | int, ...], str]] = []
    for index, record in enumerate(records):
        path = record if isinstance(record, str) else record.path
        if path in SUITES and isinstance(record, str):
            found += suite_names(path)
            continue
        if not is_pattern(path, folder):
            found.append(record)
            continue
        files = _files(path, folder)
        mistakes += [(("records", index), sentence) for sentence in _unmatched(path, folder)]
        if isinstance(record, RecordFile) and record.name is not None and len(files) > 1:
            sentence = (
                f"records: {path!r} matches {len(files)} files, which cannot all be named {record.name!r}"
            )
            mistakes.append((("records", index), sentence))
        found += [file if isinstance(record, str) else replace(record, path=file) for file in files]
    try:
        return distinct(tuple(found)) if not mistakes else (), mistakes
    except ValueError as error:
        return (), [(("records",), f"records: {error}")]


def _files(pattern: str, folder: Path) -> list[str]:
    """Return the files that a pattern matches, in order, relative to the folder as it is."""
    names = glob(pattern, root_dir=folder, recursive=True)  # noqa: PTH207  keeps what was typed
    return sorted(name for name in names if (folder / name).is_file())


def _unmatched(pattern: str, folder: Path) -> list[str]:
    if _files(pattern, folder):
        return []
    return [f"records: no file matches {pattern!r} in {folder.resolve()}"]


def _is_path(record: str, folder: Path) -> bool:
    """Say whether a text that names no record of the catalogue is meant as a file."""
    return bool(Path(record).suffix) or len(Path(record).parts) > 1 or (folder / record).exists()


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
    return checked(name, value)


def record_field(value: object) -> str | RecordFile:
    """Return what a study file tells of a record; raise ValueError for what it cannot be."""
    if isinstance(value, str):
        return value
    if not isinstance(value, dict):
        raise ValueError(f"must be a name, a path or a table, got {value!r:.60}")
    known = [field.name for field in fields(RecordFile) if field.name != "scaling"]
    if unknown := [key for key in value if key not in known and key not in SCALING_FIELDS]:
        raise ValueError(
            f"unknown key {unknown[0]!r} of a record; known are {', '.join((*known, *SCALING_FIELDS))}"
        )
    scaling = {key: part for key, part in value.items() if key in SCALING_FIELDS}
    value = {key: part for key, part in value.items() if key in known}
    if "path" not in value:
        raise ValueError("a record given as a table needs path, its file")
    for key, part in value.items():
        seconds = key in {"dt", "resample_to"}
        if seconds and not (_finite(part) and part > 0):
            raise ValueError(f"{key} of a record must be positive seconds, got {part!r:.60}")
        if key == "skip" and (isinstance(part, bool) or not isinstance(part, int) or part < 0):
            raise ValueError(f"skip of a record must be a whole number of lines, 0 or more, got {part!r:.60}")
        if not seconds and key != "skip" and not isinstance(part, str):
            raise ValueError(f"{key} of a record must be a string, got {part!r:.60}")
    return RecordFile(**value, scaling=scaling_of(scaling) if scaling else None)


def free_vibration_field(value: object) -> float:
    """Return the seconds of free vibration of a study file; raise ValueError for what they cannot be."""
    if isinstance(value, bool) or not (isinstance(value, int | float) and 0.0 <= value < math.inf):
        raise ValueError(f"must be zero or a positive time in s, got {value!r:.60}")
    return float(value)


def distinct(values: tuple[Any, ...]) -> tuple[Any, ...]:
    """Return the values; raise ValueError where there are none, or one comes twice."""
    if not values:
        raise ValueError("must name at least one, is empty")
    seen = set()
    for value in values:
        if value in seen:
            raise ValueError(f"names {value!r:.200} twice")
        seen.add(value)
    return values


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
        **scalars_and_axes,
    )


_StudyFile: Final = _study_file()


_DEVICE_EXAMPLES: Final = {
    "storey_height": 3.0,
    "yield_shear": 100e3,
    "hardening_ratio": 0.02,
    "gravity_load": 200e3,
    "slot_length": 0.03,
    "slot_stiffness": 50e6,
    "recentring_stiffness": 1e6,
}


def _device_lines(grid: Grid) -> str:
    given = grid.devices
    return "".join(
        f"{name} = {given[name]!r}\n" if name in given else f"# {name} = {example!r}\n"
        for name, example in _DEVICE_EXAMPLES.items()
    )


def axis_text(axis: FloatArray) -> str:
    """Write an axis as { start, stop, step } where that gives the same floats, else as a list."""
    if axis.size > 3:
        start, second, stop = (Decimal(repr(float(axis[k]))) for k in (0, 1, -1))
        spec = {"start": float(start), "stop": float(stop), "step": float(second - start)}
        try:
            even = np.array_equal(even_axis(spec), axis)
        except ValueError:
            even = False
        if even:
            return "{ " + ", ".join(f"{key} = {value!r}" for key, value in spec.items()) + " }"
    return "[" + ", ".join(repr(float(value)) for value in axis) + "]"


def records_text(records: tuple[str | RecordFile, ...]) -> str:
    """Write a TOML list of records."""
    return (
        "["
        + ", ".join(string_text(one) if isinstance(one, str) else _table_text(one) for one in records)
        + "]"
    )


def _table_text(record: RecordFile) -> str:
    given = {key: value for key, value in vars(record).items() if value is not None and key != "scaling"}
    return _inline({**given, **({} if record.scaling is None else record.scaling.given)})


def _scaling_text(scaling: Scaling | None) -> str:
    if scaling is None:
        return "# scaling = { sa = 4.0, period = [0.2, 1.5] }"
    return f"scaling = {_inline(scaling.given)}"


def _inline(given: Mapping[str, Any]) -> str:
    parts = [
        f"{key} = {string_text(value) if isinstance(value, str) else repr(value)}"
        for key, value in given.items()
    ]
    return "{ " + ", ".join(parts) + " }"


def string_text(value: str) -> str:
    """Write a TOML string: JSON's escapes are TOML's, but for the delete character."""
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007F")


def strings_text(values: tuple[str, ...]) -> str:
    """Write a TOML list of strings."""
    return "[" + ", ".join(map(string_text, values)) + "]"


def bool_text(value: bool) -> str:
    """Write a TOML boolean."""
    return "true" if value else "false"
