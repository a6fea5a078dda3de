"""The records of a study: names of the catalogue, files, patterns of files, and what is wrong with them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from glob import glob, has_magic
from pathlib import Path
from typing import Any, Final

from fdspec.errors import InvalidInput, RecordError
from fdspec.model.motion import GroundMotion
from fdspec.records import catalogue, load_record, read_record
from fdspec.records.suites import SUITES, is_of_suite, suite_names
from fdspec.runs.record_scaling import SCALING_FIELDS, Scaling, scaling_of

STUDY_RECORDS: Final = ("FSR1", "FSR2", "FSR3", "FMR1", "FMR2", "FMR3", "FHR1", "FHR2", "FHR3")


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


def _found(record: str | RecordFile, folder: Path, scaled: bool) -> GroundMotion:
    path = record if isinstance(record, str) else record.path
    if is_catalogued(path) or not _is_path(path, folder):
        return load_record(path, scaled=scaled)
    given = {} if isinstance(record, str) else vars(record)
    about = {key: value for key, value in given.items() if key not in ("path", "scaling")}
    return read_record(folder / path, **about)


def _is_path(record: str, folder: Path) -> bool:
    """Say whether a text that names no record of the catalogue is meant as a file."""
    return bool(Path(record).suffix) or len(Path(record).parts) > 1 or (folder / record).exists()


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
        if seconds and not (is_finite(part) and part > 0):
            raise ValueError(f"{key} of a record must be positive seconds, got {part!r:.60}")
        if key == "skip" and (isinstance(part, bool) or not isinstance(part, int) or part < 0):
            raise ValueError(f"skip of a record must be a whole number of lines, 0 or more, got {part!r:.60}")
        if not seconds and key != "skip" and not isinstance(part, str):
            raise ValueError(f"{key} of a record must be a string, got {part!r:.60}")
    return RecordFile(**value, scaling=scaling_of(scaling) if scaling else None)


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


def is_finite(value: object) -> bool:
    """Say whether this is a number, and one that a float can hold."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    try:
        return math.isfinite(float(value))
    except OverflowError:
        return False
