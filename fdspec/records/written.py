"""Two columns as fdspec writes them: keys that bring back the whole motion, then time and acceleration."""

from __future__ import annotations

from typing import Final

import numpy as np

from fdspec.model.motion import GroundMotion
from fdspec.records.channel import Channel
from fdspec.records.keyed import number, split_key, whole_number
from fdspec.records.numbers import parse_number
from fdspec.records.rows import Dialect, printed_times, table_from
from fdspec.records.textfile import TextFile
from fdspec.records.time_step import uniform_step

NAME: Final = "columns of fdspec"
TITLE: Final = "Ground motion written by fdspec"
MAX_HEADER: Final = 400
KEYS: Final = ("Source", "Scale factor", "Time step", "Samples")
"""All but one of them tell the format, too."""

HEADING: Final = "time, s; acceleration, m/s2"
"""Without the brackets of plain columns: when the title is damaged, no unit is told, and the file refused."""


def recognises(text: TextFile) -> bool:
    """Say whether title or keys are ours: a damaged title must not hide the keys."""
    if text.head(1).strip() == TITLE:
        return True
    heads = text.heads(1, MAX_HEADER)
    return sum(any(head.startswith(f"{key}:") for head in heads) for key in KEYS) >= len(KEYS) - 1


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read the one channel of the file."""
    if text.head(1).strip() != TITLE:
        raise text.refusal(1, f"expected {TITLE!r}, found {text.head(1).strip()[:60]!r}")
    keys: dict[str, tuple[int, str]] = {}
    steps = []
    for line in range(2, len(text.lines) + 1):
        content = text.lines[line - 1]
        if content.strip() == HEADING:
            heading = line
            break
        found = split_key(content)
        if found is None or not found[0].isascii() or not found[0][0].isupper():
            raise text.refusal(line, f"expected 'Key: value' or {HEADING!r}, found {content.strip()[:60]!r}")
        if found[0] == "Done":
            steps.append(found[1])
        else:
            keys[found[0]] = (line, found[1])
    else:
        raise text.refusal(len(text.lines), f"the file ends before {HEADING!r}")
    count = whole_number(text, keys, "Samples")
    rows = len(text.lines) - heading
    if rows != count:
        raise text.refusal(len(text.lines), f"expected {count} rows, as Samples says, found {rows}")
    table, behind = table_from(text, heading + 1, Dialect())
    if behind <= len(text.lines) or table.width != 2 or table.ragged or table.short_last or table.skipped:
        line = table.ragged or (table.last if table.short_last or behind > len(text.lines) else behind)
        line = table.skipped[0] if table.skipped else line
        shown = text.lines[line - 1].strip()[:60]
        raise text.refusal(line, f"expected a time and an acceleration, found {shown!r}")
    dt = number(text, keys, "Time step")
    about = {key: value for key, (_, value) in keys.items()}
    return (
        Channel(
            name=about.get("Component", ""),
            acceleration=np.ascontiguousarray(table.columns[:, 1]),
            dt=uniform_step(text, printed_times(text, table, 0), dt),
            units="m/s2",
            event=about.get("Event", ""),
            station=about.get("Station", ""),
            component=about.get("Component", ""),
            processing=tuple(steps),
            source=about.get("Source", ""),
            scale_factor=_scale_factor(text, keys),
        ),
    )


def _scale_factor(text: TextFile, keys: dict[str, tuple[int, str]]) -> float:
    line, word = keys.get("Scale factor", (1, "nothing"))
    value = parse_number(word)
    if value is None:
        raise text.refusal(line, f"expected a number behind 'Scale factor', found {word[:40]!r}")
    return value


def write(motion: GroundMotion) -> str:
    """Return the text of a motion; every number comes back to the bit."""
    # Times as k dt would print rounding errors; the digits of dt are enough for each.
    decimals = max(len(f"{motion.dt:.15f}".rstrip("0").split(".")[1]), 1)
    header = [
        TITLE,
        f"Event: {one_line(motion.event)}",
        f"Station: {one_line(motion.station)}",
        f"Component: {one_line(motion.component)}",
        f"Source: {one_line(motion.source)}",
        *[f"Done: {one_line(step)}" for step in motion.history],
        f"Scale factor: {motion.scale_factor!r}",
        f"Time step: {motion.dt!r}",
        f"Samples: {motion.n}",
        HEADING,
    ]
    rows = [f"{k * motion.dt:.{decimals}f}\t{x!r}" for k, x in enumerate(motion.acceleration.tolist())]
    return "\n".join(header + rows) + "\n"


def one_line(text: str) -> str:
    """Return text that fits one line of a header."""
    return " ".join(text.split())
