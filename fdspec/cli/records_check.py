"""`fdspec records check`."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from fdspec.cli.echo import echo
from fdspec.cli.table import counted, table
from fdspec.errors import FdspecError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fdspec.records.check import Check
    from fdspec.records.links import Link

HEAD: Final = ("name", "event", "status", "file", "channel", "why")

CANDIDATES: Final = 3
"""Candidates shown for one record; JSON has all."""

UNREAD: Final = 8
"""Files shown that are no records; JSON has all."""

LINE: Final = 110
"""Letters of a reason that a terminal shows in one line."""


@click.command("check")
@click.argument("folder", metavar="DIR")
@click.option("--link", is_flag=True, help="From now on load those found in place of the stand-ins.")
@click.option("--json", "as_json", is_flag=True, help="All matches and all files that are none, as JSON.")
def check_records(folder: str, link: bool, as_json: bool) -> None:
    """Look through a folder of your own files, and those in it, for the study's nine records.

    A record is found when event, station, component and PGA agree. The study does not name the stations of
    FMR1, FMR3 and FHR2: components of the same event with the same PGA are candidates, as are near misses of
    the others. --link takes what was found, never a candidate; `fdspec records link` takes one.
    """
    from fdspec.records.check import check_folder, files_below, link_found
    from fdspec.records.links import links
    from fdspec.scheduling.progress import progress

    files, _ = files_below(folder)
    with progress(len(files), "files") as done:
        check = check_folder(folder, on_file=lambda _: done(1))
    new = link_found(check) if link else {}
    report = _as_json if as_json else _as_text
    echo(report(folder, check, links()))
    if link and not new:
        raise FdspecError(f"{folder} has none of the study's records for certain: nothing was linked")


def _as_json(folder: str, check: Check, known: Mapping[str, Link]) -> str:
    from fdspec.records import catalogue
    from fdspec.records.links import links_file

    content = {
        "folder": folder,
        "files": check.files,
        "records": [
            {
                "name": entry.name,
                "event": entry.event,
                "study_pga_g": entry.pga_g,
                "status": check.status(entry.name),
                "linked": str(known[entry.name].path) if entry.name in known else None,
                "matches": [dataclasses.asdict(match) for match in check.of(entry.name)],
            }
            for entry in catalogue()
        ],
        "unread": [{"file": str(path), "reason": reason} for path, reason in check.unread],
        "links_file": str(links_file()),
    }
    return json.dumps(content, indent=2, default=str)


def _as_text(folder: str, check: Check, known: Mapping[str, Link]) -> str:
    from fdspec.cli.records_link import linked_lines
    from fdspec.records import catalogue

    lines = [table(HEAD, _rows(folder, check), left=HEAD), "", _count(check)]
    if check.unread:
        lines += ["", f"not read ({len(check.unread)}):"]
        lines += [f"  {_short(reason)}" for _, reason in check.unread[:UNREAD]]
        if len(check.unread) > UNREAD:
            lines.append(f"  and {len(check.unread) - UNREAD} more; --json lists all")
    told = linked_lines(known)
    if not known and any(match.status == "found" for match in check.matches):
        told = ["", "--link loads those found in place of the stand-ins from now on."]
    if any(entry.name not in known and check.status(entry.name) == "candidate" for entry in catalogue()):
        told += ["", "fdspec records link NAME FILE links a candidate that you know to be the one."]
    return "\n".join(lines + told)


def _rows(folder: str, check: Check) -> list[tuple[str, ...]]:
    """Return a row for each match; a record without any has one as well."""
    from fdspec.records import catalogue

    root = Path(folder).resolve()
    rows: list[tuple[str, ...]] = []
    for entry in catalogue():
        event = f"{entry.event} {entry.date.year}"
        matches = check.of(entry.name)
        if not matches:
            rows.append((entry.name, event, "missing", "", "", f"the study's PGA is {entry.pga_g:.3f} g"))
        for k, match in enumerate(matches[:CANDIDATES]):
            path = match.path.relative_to(root) if match.path.is_relative_to(root) else match.path
            first = (entry.name, event) if k == 0 else ("", "")
            rows.append((*first, match.status, str(path), match.channel, match.reason))
        if len(matches) > CANDIDATES:
            more = f"and {len(matches) - CANDIDATES} more; --json lists all"
            rows.append(("", "", "", more, "", ""))
    return rows


def _count(check: Check) -> str:
    from fdspec.records import catalogue

    statuses = [check.status(entry.name) for entry in catalogue()]
    told = (f"{statuses.count(status)} {status}" for status in ("found", "candidate", "missing"))
    return f"{counted(check.files, 'file')} looked through: {', '.join(told)}"


def _short(reason: str) -> str:
    return reason if len(reason) <= LINE else f"{reason[: LINE - 3]}..."
