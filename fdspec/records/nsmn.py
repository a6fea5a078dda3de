"""Turkey's national network (NSMN, AFAD): lines of KEY : value, then three components side by side in gal."""

from __future__ import annotations

from typing import Final

import numpy as np

from fdspec.records.channel import Channel
from fdspec.records.keyed import number, split_key, whole_number
from fdspec.records.numbers import parse_block
from fdspec.records.textfile import TextFile
from fdspec.records.units import to_si

NAME: Final = "NSMN (Turkey)"
MAX_HEADER: Final = 60
KEYS: Final = ("EARTHQUAKE DATE", "STATION ID", "NUMBER OF DATA", "SAMPLING INTERVAL", "RAW PGA VALUES")
"""Three of them tell the format, too: without its title, a cut file would pass for rows under words."""

COMPONENTS: Final = ("N-S", "E-W", "U-D")


def recognises(text: TextFile) -> bool:
    """Say whether title or count are the network's: without its title, a cut file would pass for columns."""
    title = text.head(1).strip().upper().startswith("STRONG GROUND MOTION RECORDS OF TURK")
    heads = text.heads(1, MAX_HEADER)
    return title or sum(any(head.lstrip().startswith(key) for head in heads) for key in KEYS) >= 3


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read the three components."""
    keys: dict[str, tuple[int, str]] = {}
    for line, content in enumerate(text.heads(1, MAX_HEADER), start=1):
        if tuple(content.split()) == COMPONENTS:
            heading = line
            break
        if found := split_key(content):
            keys[found[0]] = (line, found[1])
    else:
        raise text.refusal(
            None, f"expected the heading {'  '.join(COMPONENTS)} in the first {MAX_HEADER} lines"
        )
    if not any("(gal)" in key for key in keys):
        raise text.refusal(heading, "expected RAW PGA VALUES (gal) above, which tell the unit")
    count = whole_number(text, keys, "NUMBER OF DATA")
    dt = number(text, keys, "SAMPLING INTERVAL (sec)")
    rows = len(text.lines) - heading
    values = parse_block(text, heading + 1, len(text.lines))
    if rows != count or values.size != 3 * count:
        shown = f"{rows} rows with {values.size} values"
        raise text.refusal(
            len(text.lines), f"expected {count} rows of 3, as NUMBER OF DATA says, found {shown}"
        )
    event = keys.get("EARTHQUAKE DATE", (1, ""))[1]
    station = keys.get("STATION ID", (1, ""))[1]
    return tuple(
        Channel(name, to_si(np.ascontiguousarray(column), "cm/s2"), dt, "cm/s2", event, station, name)
        for name, column in zip(COMPONENTS, values.reshape(-1, 3).T, strict=True)
    )
