"""Find the study's records among the user's own files.

The study prints event, soil, magnitude and PGA of each record, but no station. Six are known from event,
direction and PGA; for the others, components of the same event with the same PGA are candidates.
"""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Final

from fdspec.errors import RecordError
from fdspec.model.motion import GroundMotion
from fdspec.records.catalogue import CatalogueEntry, catalogue, catalogue_entry
from fdspec.records.links import Link, checksum, save_links
from fdspec.records.reading import read_channels, read_record
from fdspec.units import G

FOUND: Final = "found"
CANDIDATE: Final = "candidate"
MISSING: Final = "missing"

PGA_TOLERANCE: Final = 0.015
"""Relative; two processings of one recording differ by that much: Calexico 225 has 0.2770 or 0.275 g."""


@dataclass(frozen=True)
class _Origin:
    """Patterns of a station's name, and the azimuth of the component, degrees."""

    station: str
    azimuth: int


_EVENTS: Final = MappingProxyType(
    {
        "Kobe": r"kobe",
        "Imperial Valley": r"imperial\s*valley|impvall",
        "Northridge": r"northr",
        "Chi-Chi": r"chi-?chi",
        "Loma Prieta": r"loma\s*prieta|lomap",
        "Kocaeli": r"kocaeli",
    }
)

_ORIGINS: Final = MappingProxyType(
    {
        "FSR1": _Origin(r"kakogawa|\bkak(?=\d|_|\b)", 90),
        "FSR2": _Origin(r"kakogawa|\bkak(?=\d|_|\b)", 0),
        "FSR3": _Origin(r"el\s*centro\s*(?:array\s*)?#\s*3\b|h-?e03", 230),
        "FMR2": _Origin(r"calexico|h-?cxo", 225),
        "FHR1": _Origin(r"gilroy\s*(?:array\s*)?#\s*1\b|\bg01", 0),
        "FHR3": _Origin(r"gebze|gbz", 0),
    }
)
"""What PEER's database holds under the study's event, direction and PGA. FMR1, FMR3 and FHR2 stay open."""


@dataclass(frozen=True)
class Match:
    """One component of the user's files that is, or may be, a record of the study.

    `status` is "found" or "candidate", `reason` says why; `pga_g` in g as computed from the file.
    """

    name: str
    status: str
    path: Path
    channel: str
    pga_g: float
    reason: str


@dataclass(frozen=True)
class Check:
    """What `check_folder` saw: matches by name of the study's records, and files that are no records."""

    matches: tuple[Match, ...]
    unread: tuple[tuple[Path, str], ...]
    files: int

    def of(self, name: str) -> tuple[Match, ...]:
        """Return the matches of one record: those found, or else the candidates, nearest PGA first."""
        own = [match for match in self.matches if match.name == name]
        best = [match for match in own if match.status == FOUND] or own
        pga_g = {entry.name: entry.pga_g for entry in catalogue()}[name]
        return tuple(
            sorted(best, key=lambda match: (abs(match.pga_g - pga_g), str(match.path), match.channel))
        )

    def status(self, name: str) -> str:
        """Return "found", "candidate" or "missing" for one record."""
        own = self.of(name)
        return own[0].status if own else MISSING


def check_folder(folder: str | Path, *, on_file: Callable[[Path], None] | None = None) -> Check:
    """Look through a folder, and those in it, for records of the study.

    Parameters
    ----------
    folder : path
    on_file : callable, optional
        Called with each file before it is read, for a progress bar.

    Returns
    -------
    Check

    Raises
    ------
    RecordError
        When `folder` is no folder. Files that cannot be read are listed in the result, not raised.
    """
    root = Path(folder)
    if not root.is_dir():
        raise RecordError(f"{root}: is not a folder")
    matches: list[Match] = []
    files, unread = files_below(root)
    for path in files:
        if on_file is not None:
            on_file(path)
        try:
            motions = read_channels(path)
        except RecordError as error:
            unread.append((path, str(error)))
            continue
        matches += matches_of(path, motions.items())
    return Check(tuple(matches), tuple(unread), len(files))


def files_below(folder: str | Path) -> tuple[list[Path], list[tuple[Path, str]]]:
    """Return the files of a folder and of those in it, and which folders cannot be opened, with reasons."""
    closed: list[tuple[Path, str]] = []

    def refused(error: OSError) -> None:
        closed.append((Path(error.filename), f"{error.filename}: cannot be read ({error.strerror})"))

    paths = (Path(parent, name) for parent, _, names in os.walk(folder, onerror=refused) for name in names)
    return sorted(filter(_may_be_record, paths)), closed


def _may_be_record(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # no permission to ask: let its reader say so
        return True


def matches_of(path: Path, motions: Iterable[tuple[str, GroundMotion]]) -> list[Match]:
    """Return what the channels of one file may be."""
    found = []
    for channel, motion in motions:
        for entry in catalogue():
            judged = _judge(entry, path, motion)
            if judged is not None:
                status, reason = judged
                found.append(Match(entry.name, status, path.resolve(), channel, motion.pga / G, reason))
    return found


def link_found(check: Check) -> dict[str, Match]:
    """Link every record that was found, so that `load_record` gives it from now on; return which."""
    chosen = {
        entry.name: check.of(entry.name)[0] for entry in catalogue() if check.status(entry.name) == FOUND
    }
    link_matches(chosen.values())
    return chosen


def link_matches(matches: Iterable[Match]) -> Path | None:
    """Link these matches, also candidates that the user knows better; return the file of links."""
    added = {match.name: Link(match.path, match.channel, checksum(match.path)) for match in matches}
    return save_links(added) if added else None


def link_file(
    name: str,
    path: str | Path,
    *,
    channel: str | None = None,
    units: str | None = None,
    dt: float | None = None,
) -> Match:
    """Link one file that the user knows to be a record of the study, whatever it says of itself.

    Parameters
    ----------
    name : str
        Of the study's record, such as "FMR3".
    path : path
        The file; it must be readable.
    channel, units, dt
        As `read_record` takes them.

    Returns
    -------
    Match
        What was linked; `status` is "found" when the file says so itself, else "candidate".

    Raises
    ------
    RecordError
        When the name is unknown, or the file cannot be read or is zero throughout.

    Warns
    -----
    UserWarning
        When neither event nor PGA speak for the file.
    """
    entry = catalogue_entry(name)
    channels = tuple(read_channels(path, units=units, dt=dt))
    if channel is None and len(channels) == 1:
        channel = channels[0]
    motion = read_record(path, channel=channel, units=units, dt=dt)  # refused while it is unclear which
    if motion.pga == 0.0:
        raise RecordError(f"{path}: is zero throughout: no factor gives it the PGA of {entry.name}")
    judged = _judge(entry, Path(path), motion)
    if judged is None:
        pga = f"PGA {motion.pga / G:.4f} g, the study's is {entry.pga_g:.3f}"
        told = " ".join(filter(None, (motion.event, motion.station, motion.component))) or "no origin"
        study = f"{entry.name}, of {entry.event} {entry.date.year}"
        warnings.warn(f"{path} does not look like {study}: it says {told}, {pga}", UserWarning, stacklevel=2)
        judged = CANDIDATE, pga
    status, reason = judged
    match = Match(entry.name, status, Path(path).resolve(), str(channel), motion.pga / G, reason)
    save_links({entry.name: Link(match.path, match.channel, checksum(match.path), units, dt)})
    return match


def _judge(entry: CatalogueEntry, path: Path, motion: GroundMotion) -> tuple[str, str] | None:
    """Return status and reason, or None when this is another record."""
    # Old files name the station in the file's name alone.
    words = " ".join((motion.event, motion.station, motion.component, path.stem.replace("_", " ")))
    if not re.search(_EVENTS[entry.event], words, re.IGNORECASE):
        return None
    pga_g = motion.pga / G
    near = abs(pga_g / entry.pga_g - 1.0) <= PGA_TOLERANCE
    pga = f"PGA {pga_g:.4f} g, the study's is {entry.pga_g:.3f}"
    origin = _ORIGINS.get(entry.name)
    if origin is None:
        return (CANDIDATE, f"same event, {pga}; the study does not name the station") if near else None
    station = re.search(origin.station, words, re.IGNORECASE) is not None
    if station and _azimuth(motion, path) == origin.azimuth:
        return (FOUND if near else CANDIDATE), f"event, station and component agree, {pga}"
    return (CANDIDATE, f"same event, {pga}; another station or component") if near else None


def _azimuth(motion: GroundMotion, path: Path) -> int | None:
    """Return the direction of a component, degrees from north, from its name, station or file."""
    named = {"EW": 90, "E": 90, "E-W": 90, "NS": 0, "N": 0, "N-S": 0}.get(motion.component.strip().upper())
    if named is not None:
        return named
    for words in (motion.component, motion.station, path.stem):
        if match := re.search(r"(?<![0-9])([0-3]?[0-9]{1,2})(?![0-9])\D*$", words):
            return int(match[1]) % 360
    return None
