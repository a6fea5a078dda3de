"""A study of buildings: everything one sweep over buildings needs, as a TOML file that a person writes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
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
)

from fdspec.errors import InvalidInput, StudyError
from fdspec.model.building import Building
from fdspec.model.building_file import Mistakes, building_of, is_building, read_building
from fdspec.model.building_grid import BuildingGrid
from fdspec.model.grid import FloatArray, axis
from fdspec.model.motion import GroundMotion
from fdspec.model.toml_lines import parsed
from fdspec.runs.after import NOTHING, After
from fdspec.runs.building_cube import DEMANDS, ON_REQUEST, OUTPUTS
from fdspec.runs.study import Study
from fdspec.runs.study_file import free_vibration_field, known_output, mistake_of, placed, text_of
from fdspec.runs.study_records import (
    STUDY_RECORDS,
    RecordFile,
    distinct,
    find_records,
    matching,
    record_field,
    unknown_records,
)
from fdspec.runs.study_text import axis_text, bool_text, even_axis, records_text, string_text, strings_text

BUILDINGS: Final = "buildings"
"""The field that makes a study one of buildings."""

Where = tuple[str | int, ...]


@dataclass(frozen=True, eq=False, kw_only=True)
class BuildingStudy:
    """Hold every argument of a sweep over buildings and the records it runs on.

    Parameters
    ----------
    grid : BuildingGrid
        Buildings, by name, and factors on their dampers.
    records : tuple of str or RecordFile
        Names of the catalogue, or record files.
    scaled : bool
        Whether the catalogue's stand-ins are scaled to the study's PGA.
    outputs : tuple of str or None
        Variables of the cube; None for all.
    certify : bool
        Whether the energy balance of every history is checked.
    after : After
        Free vibration after every motion, and whether histories go on until the building is at rest.
    folder : Path
        Where relative paths start: the study file's folder.
    sources : mapping
        Name of a building -> the file it was read from, where it was.
    """

    grid: BuildingGrid
    records: tuple[str | RecordFile, ...] = STUDY_RECORDS
    scaled: bool = True
    outputs: tuple[str, ...] | None = None
    certify: bool = True
    after: After = NOTHING
    folder: Path = Path()
    sources: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def read(cls, path: str | Path) -> BuildingStudy:
        """Read a study of buildings, or one building file, which is a study of that building.

        Raises
        ------
        StudyError
            When the file cannot be used; one line of text for each mistake, with field and line number.
        """
        path = Path(path)
        return cls.parse(text_of(path), name=str(path), folder=path.parent)

    @classmethod
    def parse(cls, text: str, *, name: str = "study", folder: Path = Path()) -> BuildingStudy:
        """Read a study of buildings from TOML text; `name` stands for the file in error messages."""
        try:
            table = parsed(text)
        except ValueError as error:
            raise StudyError(f"{name}: {error}") from None
        if is_building(table):
            stem = Path(name).stem
            try:
                building = building_of(table, design=True)
            except Mistakes as error:
                raise placed(name, text, error.found) from None
            return cls(grid=BuildingGrid({stem: building}, 1.0, 1.0), folder=folder, sources={stem: name})
        mistakes: list[tuple[Where, str]] = []
        values: dict[str, Any] = {}
        try:
            values = dict(_File.model_validate(table))
        except ValidationError as error:
            mistakes = [
                mistake_of(detail["loc"], detail["type"], detail["msg"], _File.model_fields)
                for detail in error.errors()
            ]
        buildings, sources, wrong = _buildings(table.get(BUILDINGS), folder)
        mistakes += wrong
        if not mistakes:
            values["records"], mistakes = matching(values["records"], folder)
        if not mistakes:
            scales = values.pop("stiffness_scale"), values.pop("slip_scale"), values.pop("intensity")
            del values[BUILDINGS]
            try:
                grid = BuildingGrid(buildings, *scales)
            except InvalidInput as error:
                mistakes = [((BUILDINGS,), str(error))]
            else:
                after = After(values.pop("free_vibration"), values.pop("at_rest"))
                return cls(grid=grid, after=after, folder=folder, sources=sources, **values)
        if all(where[0] != "records" for where, _ in mistakes):
            mistakes += unknown_records(table.get("records"), folder)
        raise placed(name, text, mistakes)

    def motions(self) -> tuple[GroundMotion, ...]:
        """Load the records, in order.

        Raises
        ------
        RecordError
            When some cannot be used; one line of text for each.
        """
        return find_records(self.records, folder=self.folder, scaled=self.scaled)

    def to_toml(self) -> str:
        """Return the study as the text of a study file, to be edited; buildings stay in their files."""
        if unnamed := [name for name in self.grid.names if name not in self.sources]:
            raise StudyError(f"building {unnamed[0]!r} was read from no file: there is nothing to name it by")
        outputs = OUTPUTS if self.outputs is None else self.outputs
        files = ", ".join(f"{string_text(name)} = {string_text(file)}" for name, file in self.sources.items())
        return f"""\
# A study of buildings: every (record, building, factor on braces, factor on slip forces). Units are SI.

# Building files by name, relative to this file; a list of files takes their names.
buildings = {{ {files} }}
# Names of the catalogue (fdspec records list) or record files, relative to this file, or "*.AT2".
records = {records_text(self.records)}
# Scale the stand-ins of the catalogue to the study's peak ground acceleration.
scaled = {bool_text(self.scaled)}

# Axes: a list, {{ start, stop, step }} or {{ start, stop, num }}, ends included.
# Factors on the stiffness of all braces.
stiffness_scale = {axis_text(self.grid.stiffness_scale)}
# Factors on the slip forces of all dampers; 0 slides freely, inf never.
slip_scale = {axis_text(self.grid.slip_scale)}
# Factors on all records, a further axis of the cube; left out, there is none.
{_intensity_text(self.grid.intensity)}

# Variables of the cube; left out, these.
{"# " if self.outputs is None else ""}outputs = {strings_text(outputs)}
# Check the energy balance of every history.
certify = {bool_text(self.certify)}
# s that each history goes on after its record, the ground at rest.
free_vibration = {self.after.free_vibration!r}
# Go on until no damper can slip any more, and give residuals there; twice the work.
at_rest = {bool_text(self.after.at_rest)}
"""


def _intensity_text(intensity: FloatArray | None) -> str:
    return "# intensity = [0.5, 1.0, 2.0]" if intensity is None else f"intensity = {axis_text(intensity)}"


def read_study(path: str | Path) -> Study | BuildingStudy:
    """Read a study file of either kind: one that names buildings, or is a building, is of buildings.

    Raise StudyError when it cannot be used.
    """
    path = Path(path)
    text = text_of(path)
    try:
        table = parsed(text)
    except ValueError as error:
        raise StudyError(f"{path}: {error}") from None
    kind = BuildingStudy if BUILDINGS in table or is_building(table) else Study
    return kind.parse(text, name=str(path), folder=path.parent)


def _buildings(
    given: object, folder: Path
) -> tuple[dict[str, Building], dict[str, str], list[tuple[Where, str]]]:
    """Return the buildings of a study by name, the files they are from, and what is wrong with them."""
    buildings: dict[str, Building] = {}
    sources: dict[str, str] = {}
    mistakes: list[tuple[Where, str]] = []
    for where, name, value in _named(given, mistakes):
        try:
            if isinstance(value, dict):
                buildings[name] = building_of(value, design=True)
            else:
                buildings[name] = read_building(folder / value, design=True)
                sources[name] = value
        except Mistakes as error:
            mistakes += [
                ((*where, *key), f"{BUILDINGS}: {name}: {sentence}") for key, sentence in error.found
            ]
        except InvalidInput as error:
            mistakes += [(where, f"{BUILDINGS}: {sentence}") for sentence in str(error).splitlines()]
    return buildings, sources, mistakes


def _named(given: object, mistakes: list[tuple[Where, str]]) -> list[tuple[Where, str, Any]]:
    """Return where each building stands, its name, and its file or table; append what is wrong."""
    found: list[tuple[Where, str, Any]] = []
    if isinstance(given, str):
        given = [given]
    if isinstance(given, dict):
        found = [((BUILDINGS, name), name, value) for name, value in given.items()]
    elif isinstance(given, list):
        found = [
            ((BUILDINGS, index), Path(value).stem if isinstance(value, str) else "", value)
            for index, value in enumerate(given)
        ]
    if not found and given is not None:
        mistakes.append(((BUILDINGS,), f"{BUILDINGS}: must be building files, or a table of them by name"))
    if given is None:
        mistakes.append(((BUILDINGS,), f"{BUILDINGS}: must be given, building files or tables by name"))
    seen: set[str] = set()
    for where, name, value in found:
        of_list = isinstance(where[-1], int)
        if not isinstance(value, str | dict) or (of_list and isinstance(value, dict)):
            wanted = "a file" if of_list else "a file or a table"
            mistakes.append((where, f"{BUILDINGS}: {name or where[-1]} must be {wanted}, got {value!r:.60}"))
        elif name in seen:
            mistakes.append(
                (
                    where,
                    f"{BUILDINGS}: two are called {name!r}; name them in a table, {{ a = {value!r}, ... }}",
                )
            )
        seen.add(name)
    return [] if mistakes else found


def _scale(free: bool, value: object) -> FloatArray:
    if isinstance(value, dict):
        value = even_axis(value)
    if isinstance(value, bool) or not isinstance(value, int | float | list | np.ndarray):
        raise ValueError(f"must be numbers, got {value!r:.60}")
    return axis(value, zero=free, infinite=free)


class _File(BaseModel):
    """What a study of buildings may hold."""

    model_config = ConfigDict(extra="forbid", arbitrary_types_allowed=True)

    buildings: Any = None
    records: Annotated[tuple[Annotated[Any, PlainValidator(record_field)], ...], AfterValidator(distinct)] = (
        STUDY_RECORDS
    )
    scaled: StrictBool = True
    stiffness_scale: Annotated[Any, PlainValidator(partial(_scale, False))] = np.ones(1)
    slip_scale: Annotated[Any, PlainValidator(partial(_scale, True))] = np.ones(1)
    intensity: Annotated[Any, PlainValidator(partial(_scale, False))] | None = None
    outputs: (
        Annotated[
            tuple[
                Annotated[
                    StrictStr, AfterValidator(partial(known_output, known=(*OUTPUTS, *ON_REQUEST, *DEMANDS)))
                ],
                ...,
            ],
            AfterValidator(distinct),
        ]
        | None
    ) = None
    certify: StrictBool = True
    free_vibration: Annotated[Any, PlainValidator(free_vibration_field)] = 0.0
    at_rest: StrictBool = False
