"""Event, station and component, from lines that agencies and people write above the values."""

from __future__ import annotations

import re
from typing import Final

from fdspec.records.block import Block
from fdspec.records.textfile import TextFile

_STATION: Final = re.compile(
    r"\b(?:station|site|stazione|estacion)\b(?:\s(?:name|code|id))?(?:\s/\s\w{1,10})?\s{0,20}[:=]\s{0,20}(\S.{0,80})",
    re.IGNORECASE,
)
_EVENT: Final = re.compile(
    r"\b(?:event(?:\s?name|\sdate)?(?:\s&\s?time)?|earthquake(?:\sname)?)\s{0,20}[:=]\s{0,20}(\S.{0,80})",
    re.IGNORECASE,
)
_COMPONENT: Final = re.compile(
    r"\b(?:comp(?:onent)?\.?|orientation|direction)\s{0,20}(?:[:=]|\s)\s{0,20}([\w-]{1,12}(?:\s(?:deg(?:rees)?))?)\s*$",
    re.IGNORECASE,
)


def origin_of(text: TextFile, block: Block) -> tuple[str, str, str]:
    """Return event, station and component; the first line is the event's unless another says so."""
    last = block.heading_line - 1 if block.headings else block.table.first - 1
    lines = [
        " ".join(text.lines[number - 1][:300].split()) for number in range(block.start, max(last, 0) + 1)
    ]
    lines = [line.strip(' #%!*"') for line in lines]
    lines = [line for line in lines if any(char.isalpha() for char in line)]
    event = _first(_EVENT, lines)
    station = _first(_STATION, lines)
    component = _first(_COMPONENT, lines)
    if not event and lines and not _STATION.search(lines[0]) and lines[0][:200]:
        event = lines[0].strip(" .,")
    return event, station.strip(" ,;"), component


def _first(pattern: re.Pattern[str], lines: list[str]) -> str:
    return next((match[1].strip() for line in lines if (match := pattern.search(line))), "")
