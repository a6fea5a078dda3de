"""Reading of study files: every field checked, every mistake told with its line."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable, Sequence
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
from fdspec.model.toml_lines import key_lines, line_of, parsed
from fdspec.runs.after import After
from fdspec.runs.record_scaling import scaling_of
from fdspec.runs.study_outputs import DEMANDS, ON_REQUEST, OUTPUTS
from fdspec.runs.study_records import (
    STUDY_RECORDS,
    distinct,
    matching,
    record_field,
    unknown_records,
)
from fdspec.runs.study_text import even_axis

AXES: Final = ("stiffness_ratio", "pretension", "period", "intensity")


def fields_of(text: str, name: str, folder: Path) -> dict[str, Any]:
    """Return the fields of the `Study` that a TOML text says, but for its folder; `name` stands for the file.

    Raises
    ------
    StudyError
        One line of text for each mistake, with field and line number.
    """
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
    return {"grid": grid, "after": after, **values}


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
