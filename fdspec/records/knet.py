"""K-NET and KiK-net ASCII: 17 lines of header, then counts, eight a line."""

from __future__ import annotations

import re
from types import MappingProxyType
from typing import Final

from fdspec.records.channel import Channel
from fdspec.records.keyed import whole_number
from fdspec.records.numbers import parse_block, parse_number
from fdspec.records.textfile import TextFile
from fdspec.records.units import to_si

NAME: Final = "K-NET or KiK-net"
HEADER_LINES: Final = 17
KEYS: Final = (
    "Origin Time", "Depth. (km)", "Mag.", "Station Code", "Sampling Freq(Hz)", "Duration Time(s)",
    "Scale Factor",
    "Max. Acc. (gal)", "Last Correction",
)  # fmt: skip
"""Half of them tell the format: a header that lost one must not pass for rows of numbers under words."""

DIRECTIONS: Final = MappingProxyType(
    {
        "1": "NS (borehole)",
        "2": "EW (borehole)",
        "3": "UD (borehole)",
        "4": "NS (surface)",
        "5": "EW (surface)",
        "6": "UD (surface)",
    }
)
"""KiK-net numbers its six instruments."""

_SCALE: Final = re.compile(r"([\d.]{1,12})\(gal\)/([\d.]{1,15})")


def recognises(text: TextFile) -> bool:
    """Say whether NIED's keys stand at the top."""
    heads = text.heads(1, HEADER_LINES + 3)
    return sum(any(head.startswith(key) for head in heads) for key in KEYS) >= len(KEYS) // 2


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read the one channel of the file, without the instrument's offset.

    The counts have an offset that is no ground motion; the header's own maximum is without it. It is the mean
    of the record.
    """
    for number, key in ((1, KEYS[0]), (11, KEYS[4]), (12, KEYS[5]), (14, KEYS[6])):
        if not text.line(number, repr(key)).startswith(key):
            raise text.refusal(number, f"expected {key!r}, found {text.head(number).strip()[:60]!r}")
    values = [line[18:].strip() for line in text.heads(1, HEADER_LINES)]
    rate = whole_number(text, {"Sampling Freq(Hz)": (11, values[10].removesuffix("Hz"))}, "Sampling Freq(Hz)")
    seconds = whole_number(text, {"Duration Time(s)": (12, values[11])}, "Duration Time(s)")
    match = _SCALE.fullmatch(values[13])
    scale = (parse_number(match[1]), parse_number(match[2])) if match else (None, None)
    if not scale[0] or not scale[1]:
        raise text.refusal(14, f"expected a Scale Factor like 3920(gal)/6182761, found {values[13]!r}")
    counts = parse_block(text, HEADER_LINES + 1, len(text.lines))
    if counts.size != rate * seconds:
        expected = f"expected {rate * seconds} values, {rate} Hz for {seconds} s"
        raise text.refusal(len(text.lines), f"{expected}, but found {counts.size}")
    offset = float(counts.mean())
    direction = DIRECTIONS.get(values[12], values[12])
    channel = Channel(
        name=direction,
        acceleration=to_si((counts - offset) * scale[0] / scale[1], "cm/s2"),
        dt=1.0 / rate,
        units="cm/s2",
        event=f"{values[0]} M{values[4]}",
        station=values[5],
        component=direction,
        processing=(f"offset of {offset:.1f} counts, the record's mean, removed on reading",),
    )
    return (channel,)
