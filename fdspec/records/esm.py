"""ESM, ITACA and AFAD ASCII (DYNA): lines of KEY: value in any order, then one value a line."""

from __future__ import annotations

from typing import Final

from fdspec.records.channel import Channel
from fdspec.records.keyed import number, split_key, whole_number
from fdspec.records.numbers import parse_block, parse_number
from fdspec.records.textfile import TextFile
from fdspec.records.units import acceleration_unit, to_si

NAME: Final = "ESM or ITACA ASCII"
MAX_HEADER: Final = 150
KEYS: Final = frozenset(
    {"EVENT_NAME", "STATION_CODE", "SAMPLING_INTERVAL_S", "NDATA", "STREAM", "UNITS", "DATA_TYPE"}
)
"""Half of them tell the format: a header that lost one must not pass for rows under words."""


def recognises(text: TextFile) -> bool:
    """Say whether the keys of DYNA stand at the top, in whatever order."""
    keys = {found[0].upper() for line in text.heads(1, MAX_HEADER) if (found := split_key(line))}
    return len(keys & KEYS) >= len(KEYS) // 2


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read the one channel of the file."""
    keys: dict[str, tuple[int, str]] = {}
    first = 1
    for first, line in enumerate(text.heads(1, MAX_HEADER), start=1):
        found = split_key(line)
        if found is not None:
            keys.setdefault(found[0].upper(), (first, found[1]))
        elif parse_number(line.strip()) is not None:
            break
    quantity = keys.get("DATA_TYPE", (1, "nothing"))
    if quantity[1].upper() != "ACCELERATION":
        raise text.refusal(quantity[0], f"expected DATA_TYPE: ACCELERATION, found {quantity[1]!r}")
    spelling = keys.get("UNITS", (1, "nothing"))
    unit = acceleration_unit(spelling[1])
    if unit is None:
        raise text.refusal(spelling[0], f"expected UNITS: cm/s^2, found {spelling[1]!r}")
    count = whole_number(text, keys, "NDATA")
    dt = number(text, keys, "SAMPLING_INTERVAL_S")
    values = parse_block(text, first, len(text.lines))
    if values.size != count:
        raise text.refusal(
            len(text.lines), f"expected {count} values, as NDATA says, but found {values.size}"
        )
    text.take(spelling[0], f"UNITS: acceleration in {unit}")
    text.take(keys["NDATA"][0], f"NDATA: {count} values")
    text.take(keys["SAMPLING_INTERVAL_S"][0], f"SAMPLING_INTERVAL_S: time step {dt:.10g} s")
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
    def of(key: str) -> str:
        # AFAD puts its own keys above those of DYNA, which are then empty.
        return keys.get(key) or keys.get(f"AAD_{key}", "")

    steps = []
    if baseline := of("BASELINE_CORRECTION"):
        steps.append(f"by the agency: {baseline.lower()}")
    if (low := of("LOW_CUT_FREQUENCY_HZ")) and (high := of("HIGH_CUT_FREQUENCY_HZ")):
        kind = f"{of('FILTER_TYPE').capitalize()} of order {of('FILTER_ORDER') or '?'}"
        steps.append(f"filtered by the agency: {low} to {high} Hz, {kind}")
    return tuple(steps)
