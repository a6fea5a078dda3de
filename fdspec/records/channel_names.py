"""Names of the channels of a building, as CSMIP writes them."""

from __future__ import annotations

import re
from typing import Final

_NUMBER: Final = re.compile(r"^\s*chan\s{0,4}\w{1,6}:\s*", re.IGNORECASE)
_STATION_CHANNEL: Final = re.compile(r"\(\s*sta\s{0,3}chn:?\s{0,6}\w{0,6}\s*\)", re.IGNORECASE)
_LOCATION: Final = re.compile(r"\blocation:", re.IGNORECASE)


def channel_name(line: str) -> str:
    """Return direction and place of 'Chan  6:  Up   (Sta Chn: 11)   Location: Deck', with single blanks."""
    rest = _STATION_CHANNEL.sub(" ", _NUMBER.sub("", line))
    direction, _, place = (" ".join(part.split()) for part in _parted(rest))
    return f"{direction}, {place}" if place else direction


def _parted(line: str) -> tuple[str, str, str]:
    match = _LOCATION.search(line)
    return (line, "", "") if match is None else (line[: match.start()], match[0], line[match.end() :])
