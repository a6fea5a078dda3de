"""ESM and ITACA ASCII (DYNA): lines of KEY: value, then one value a line."""

from __future__ import annotations

import re
from typing import Final

from fdspec.records.channel import Channel
from fdspec.records.keyed import number, whole_number
from fdspec.records.numbers import parse_block
from fdspec.records.textfile import TextFile
from fdspec.records.units import UNITS, to_si

NAME: Final = "ESM or ITACA ASCII"
MAX_HEADER: Final = 100

_KEY: Final = re.compile(r"([A-Z][A-Z0-9_/^ ]*):\s*(.*?)\s*$")


def recognises(text: TextFile) -> bool:
    """Say whether the keys of DYNA stand at the top."""
    return text.lines[0].startswith("EVENT_NAME:") and any(
        line.startswith("SAMPLING_INTERVAL_S:") for line in text.lines[:MAX_HEADER]
    )


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read the one channel of the file."""
    keys: dict[str, tuple[int, str]] = {}
    first = 1
    for first, line in enumerate(text.lines[:MAX_HEADER], start=1):
        match = _KEY.match(line)
        if match is None:
            break
        keys[match[1]] = (first, match[2])
    quantity = keys.get("DATA_TYPE", (1, "nothing"))
    if quantity[1].upper() != "ACCELERATION":
        raise text.refusal(quantity[0], f"expected DATA_TYPE: ACCELERATION, found {quantity[1]!r}")
    spelling = keys.get("UNITS", (1, "nothing"))
    unit = UNITS.get(spelling[1].lower())
    if unit is None:
        raise text.refusal(spelling[0], f"expected UNITS: cm/s^2, found {spelling[1]!r}")
    count = whole_number(text, keys, "NDATA")
    dt = number(text, keys, "SAMPLING_INTERVAL_S")
    values = parse_block(text, first, len(text.lines))
    if values.size != count:
        raise text.refusal(
            len(text.lines), f"expected {count} values, as NDATA says, but found {values.size}"
        )
    event, stream = keys.get("EVENT_NAME", (1, ""))[1], keys.get("STREAM", (1, ""))[1]
    channel = Channel(
        name=stream,
        acceleration=to_si(values, unit),
        dt=dt,
        units=unit,
        event=f"{event} {keys.get('EVENT_DATE_YYYYMMDD', (1, ''))[1]}".strip(),
        station=keys.get("STATION_CODE", (1, ""))[1],
        component=stream,
        processing=_processing({key: value for key, (_, value) in keys.items()}),
    )
    return (channel,)


def _processing(keys: dict[str, str]) -> tuple[str, ...]:
    steps = []
    if baseline := keys.get("BASELINE_CORRECTION"):
        steps.append(f"by the agency: {baseline.lower()}")
    if (low := keys.get("LOW_CUT_FREQUENCY_HZ")) and (high := keys.get("HIGH_CUT_FREQUENCY_HZ")):
        kind = f"{keys.get('FILTER_TYPE', '').capitalize()} of order {keys.get('FILTER_ORDER', '?')}"
        steps.append(f"filtered by the agency: {low} to {high} Hz, {kind}")
    return tuple(steps)
