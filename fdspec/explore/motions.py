"""The ground motions of a cube, found again: in the catalogue, or in files; told by their checksum."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from fdspec.errors import InvalidInput, RecordError
from fdspec.model.motion import GroundMotion
from fdspec.records import catalogue, load_record
from fdspec.records.reading import read_channels

if TYPE_CHECKING:
    import xarray as xr

UNITS: Final = (None, "g", "m/s2", "cm/s2", "mm/s2")


@dataclass(frozen=True)
class Found:
    """A motion and what a reader must know of it; `notice` is empty where it is the cube's own."""

    motion: GroundMotion
    notice: str = ""


class Motions:
    """Find the motions that a cube was made with.

    Parameters
    ----------
    cube : xarray.Dataset
        With the coordinates ``record``, ``checksum``, ``scale_factor``, ``dt`` and ``source``.
    files : mapping of str to path
        Record name -> its file, for those that no catalogue has.
    folder : path
        Where a file that the cube's ``source`` names is looked for: the cube's own folder.

    Raises
    ------
    InvalidInput
        When `files` names a record that the cube has not.
    """

    def __init__(self, cube: xr.Dataset, files: Mapping[str, Path], folder: Path) -> None:
        self.names = tuple(str(name) for name in cube["record"].values)
        if unknown := [name for name in files if name not in self.names]:
            raise InvalidInput(f"the cube has no record {unknown[0]!r}; it has {', '.join(self.names)}")
        self.about = cube.coords.to_dataset()
        self.files = dict(files)
        self.folder = folder
        self._found: dict[str, Found] = {}

    def find(self, name: str) -> Found:
        """Return the motion of this name.

        Raises
        ------
        RecordError
            When it cannot be found; the text says what would help.
        """
        if name not in self._found:
            self._found[name] = self._find(name)
        return self._found[name]

    def _find(self, name: str) -> Found:
        checksum = self._told(name, "checksum")
        plain: GroundMotion | None = None
        for motion, as_told in self._candidates(name):
            if motion.checksum == checksum:
                return Found(replace(motion, name=name))
            if as_told and plain is None:
                plain = motion
        if plain is None:
            raise RecordError(self._not_found(name))
        return Found(
            replace(plain, name=name),
            f"{plain.source or name} is not the motion that the cube was made with: its checksum is "
            f"{plain.checksum[:12]}, the cube has {checksum[:12] or 'none'}. "
            "The history may differ from the cube.",
        )

    def _candidates(self, name: str) -> Iterator[tuple[GroundMotion, bool]]:
        """Give motions that may be the cube's, and whether each is read as its source itself says."""
        file = self.files.get(name)
        if file is None and any(name == entry.name for entry in catalogue()):
            yield load_record(name), True
            yield load_record(name, scaled=False), True
        file = file or self._source_file(name)
        if file is not None:
            for motion, as_told in _readings(file, float(self._told(name, "dt") or 0.0)):
                factor = float(self._told(name, "scale_factor") or 1.0)
                if factor not in (1.0, motion.scale_factor):
                    yield motion.scaled(factor), as_told
                yield motion, as_told

    def _not_found(self, name: str) -> str:
        if name in self.files:
            return (
                f"record {name!r}: {self.files[name]} cannot be read as the motion that the cube "
                "was made with, in any unit of acceleration; name the file it came from"
            )
        file, _, _ = self._told(name, "source").rpartition(" (")
        looked = f", and its file {file} is not beside the cube" if file else ""
        return (
            f"record {name!r} is not in the catalogue{looked}; "
            f"start with --record {name}=FILE to see its histories"
        )

    def _told(self, name: str, what: str) -> str:
        one = self.about.isel(record=self.names.index(name))
        return str(one[what].item()) if what in one.coords else ""

    def _source_file(self, name: str) -> Path | None:
        """Return the file that the cube's source names, where it lies beside the cube or here."""
        file, _, _ = self._told(name, "source").rpartition(" (")
        if not file or Path(file).name != file:
            return None
        places = (self.folder / file, Path(file))
        return next((place for place in places if place.is_file()), None)


def _readings(file: Path, dt: float) -> Iterator[tuple[GroundMotion, bool]]:
    """Give every motion that a file can be read as; True where the file leaves no choice.

    What a file does not say of itself is tried: the checksum tells which reading was the cube's.
    """
    for units in UNITS:
        for step in (None, dt):
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", UserWarning)  # a wrong unit, tried, looks implausible
                    motions = list(read_channels(file, units=units, dt=step).values())
            except InvalidInput:
                continue
            for motion in motions:
                yield motion, units is None and step is None and len(motions) == 1


def read_given(pairs: tuple[str, ...]) -> dict[str, Path]:
    """Return name -> file of options ``NAME=FILE``; raise InvalidInput where one is none or names no file."""
    files: dict[str, Path] = {}
    for pair in pairs:
        name, equals, file = pair.partition("=")
        if not (name and equals and file):
            raise InvalidInput(f"--record takes NAME=FILE, got {pair!r}")
        if not Path(file).is_file():
            raise InvalidInput(f"--record {name}: there is no file {file}")
        files[name] = Path(file)
    return files
