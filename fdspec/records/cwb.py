"""Taiwan's CWB: lines of #Key: value, then time and three components in columns of ten characters."""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from fdspec.records.channel import Channel
from fdspec.records.keyed import number, split_key
from fdspec.records.numbers import parse_columns
from fdspec.records.textfile import TextFile
from fdspec.records.units import acceleration_unit, to_si

NAME: Final = "CWB"
MAX_HEADER: Final = 60
WIDTH: Final = 10

_SEQUENCE: Final = re.compile(r"Time\s+(.*)")


def recognises(text: TextFile) -> bool:
    """Say whether CWB's headings stand at the top."""
    return text.head(1).startswith("#Earthquake Information") and any(
        line.startswith("#DataSequence") for line in text.heads(1, MAX_HEADER)
    )


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read the three components."""
    keys: dict[str, tuple[int, str]] = {}
    first = 1
    for first, line in enumerate(text.heads(1, MAX_HEADER), start=1):
        if line.strip() and not line.startswith("#"):
            break
        if found := split_key(line):
            keys[found[0].removeprefix("#")] = (first, found[1])
    spelling = keys.get("AmplitudeUnit", (1, "nothing"))
    unit = acceleration_unit(spelling[1].split(".")[0])
    if unit is None:
        raise text.refusal(spelling[0], f"expected AmplitudeUnit: gal, found {spelling[1]!r}")
    sequence = _SEQUENCE.fullmatch(keys.get("DataSequence", (1, ""))[1])
    names = [name.strip().split("(")[0] for name in sequence[1].split(";")] if sequence else []
    if not names or not all(names) or keys.get("Data", (1, ""))[1] != f"{len(names) + 1}F10.3":
        raise text.refusal(first - 1, "expected DataSequence: Time U(+); N(+); E(+) and Data: 4F10.3")
    rate = number(text, keys, "SampleRate(Hz)")
    length = number(text, keys, "RecordLength(sec)")
    count = round(min(rate * length, 1e12))  # a product of two wild numbers may be infinite
    rows = len(text.lines) - first + 1
    if rows != count or count < 2:
        raise text.refusal(len(text.lines), f"expected {count} rows, rate times length, but found {rows}")
    width = len(names) + 1
    table = parse_columns(text, first, len(text.lines), WIDTH, count * width).reshape(-1, width)
    late = np.abs(table[:, 0] - np.arange(count) / rate) > 0.00051  # times are printed to 1 ms
    if late.any():
        row = int(np.argmax(late))
        raise text.refusal(first + row, f"expected the time {row / rate:.3f} s, found {table[row, 0]:.3f}")
    origin = keys.get("Origin Time(GMT+08)", (1, ""))[1]
    return tuple(
        Channel(
            name=name,
            acceleration=to_si(np.ascontiguousarray(table[:, k]), unit),
            dt=1.0 / rate,
            units=unit,
            event=origin and f"{origin} GMT+08",
            station=keys.get("StationCode", (1, ""))[1],
            component=name,
        )
        for k, name in enumerate(names, start=1)
    )
