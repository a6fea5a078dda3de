"""Two columns as fdspec writes them: keys that bring back the whole motion, then time and acceleration."""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from fdspec.model.motion import GroundMotion
from fdspec.records.channel import Channel
from fdspec.records.keyed import number, whole_number
from fdspec.records.numbers import parse_number
from fdspec.records.textfile import TextFile
from fdspec.records.time_step import uniform_step

NAME: Final = "columns of fdspec"
TITLE: Final = "Ground motion written by fdspec"
HEADING: Final = "time, s; acceleration, m/s2"
"""Without the brackets of plain columns: when the title is damaged, no unit is told, and the file refused."""

_KEY: Final = re.compile(r"([A-Z][a-z ]*):\s*(.*?)\s*$")


def recognises(text: TextFile) -> bool:
    """Say whether the first line is our title."""
    return text.lines[0].strip() == TITLE


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read the one channel of the file."""
    keys: dict[str, tuple[int, str]] = {}
    steps = []
    for line, content in enumerate(text.lines[1:], start=2):
        if content.strip() == HEADING:
            heading = line
            break
        match = _KEY.match(content)
        if match is None:
            raise text.refusal(line, f"expected 'Key: value' or {HEADING!r}, found {content.strip()[:60]!r}")
        if match[1] == "Done":
            steps.append(match[2])
        else:
            keys[match[1]] = (line, match[2])
    else:
        raise text.refusal(len(text.lines), f"the file ends before {HEADING!r}")
    count = whole_number(text, keys, "Samples")
    rows = [line.split() for line in text.lines[heading:]]
    if len(rows) != count:
        raise text.refusal(len(text.lines), f"expected {count} rows, as Samples says, found {len(rows)}")
    values = np.empty(count)
    for k, row in enumerate(rows):
        parsed = [parse_number(word) for word in row]
        if len(parsed) != 2 or parsed[0] is None or parsed[1] is None:
            found = text.lines[heading + k].strip()[:60]
            raise text.refusal(heading + 1 + k, f"expected a time and an acceleration, found {found!r}")
        values[k] = parsed[1]
    dt = number(text, keys, "Time step")
    about = {key: value for key, (_, value) in keys.items()}
    return (
        Channel(
            name=about.get("Component", ""),
            acceleration=values,
            dt=uniform_step(text, heading + 1, [row[0] for row in rows], dt),
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
