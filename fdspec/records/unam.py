"""UNAM's standard acceleration file (ASA 2.0): lines of KEY : value, then channels side by side."""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from fdspec.records.channel import Channel
from fdspec.records.numbers import parse_columns, parse_number
from fdspec.records.textfile import TextFile
from fdspec.records.units import UNITS, to_si

NAME: Final = "UNAM ASA"
MAX_HEADER: Final = 200

_KEY: Final = re.compile(r"([A-Z][^:]*?)\s*:\s*(.*?)\s*$")
_FORMAT: Final = re.compile(r"(\d{1,2})F(\d{1,2})\.\d+")


def recognises(text: TextFile) -> bool:
    """Say whether the title of the standard stands near the top."""
    return any(line.startswith("ARCHIVO ESTANDAR DE ACELERACION") for line in text.lines[:12])


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read all channels, which have one time step."""
    keys: dict[str, tuple[int, str]] = {}
    for line, content in enumerate(text.lines[:MAX_HEADER], start=1):
        if content.startswith("DATOS DE ACELERACION:"):
            heading = line
            break
        if match := _KEY.match(content):
            keys[match[1]] = (line, match[2])
    else:
        raise text.refusal(None, f"expected DATOS DE ACELERACION in the first {MAX_HEADER} lines")
    names = text.line(heading + 3, "the directions of the channels").split()
    line, spelling = keys.get("UNIDADES DE LOS DATOS", (1, "nothing"))
    unit = UNITS.get(spelling.split("(")[0].strip().lower())
    if unit is None:
        raise text.refusal(line, f"expected UNIDADES DE LOS DATOS: Gal, found {spelling!r}")
    steps = _each(text, keys, "INTERVALO DE MUESTREO, C1-C6 (s)", len(names))
    counts = _each(text, keys, "NUM. TOTAL DE MUESTRAS, C1-C6", len(names))
    layouts = [value for key, value in keys.items() if key.startswith("FORMATO DATOS")]
    layout = _FORMAT.fullmatch(layouts[0][1]) if layouts else None
    if layout is None or int(layout[1]) != len(names) or int(layout[2]) < 2:
        raise text.refusal(layouts[0][0] if layouts else 1, f"expected FORMATO DATOS: {len(names)}F10.4")
    if len(set(steps)) > 1 or len(set(counts)) > 1:
        raise text.refusal(heading, "expected one time step and one number of samples for all channels")
    count = counts[0]
    first = heading + 5
    rows = len(text.lines) - first + 1
    if rows != count or count < 2:
        raise text.refusal(
            len(text.lines), f"expected {count:g} rows, as NUM. TOTAL DE MUESTRAS says, found {rows}"
        )
    table = parse_columns(text, first, len(text.lines), int(layout[2]), rows * len(names))
    return tuple(
        Channel(
            name=name,
            acceleration=to_si(np.ascontiguousarray(column), unit),
            dt=steps[0],
            units=unit,
            event=" ".join(_of(keys, "FECHA DEL SISMO [GMT]", "HORA EPICENTRO (GMT)", "MAGNITUD(ES)")),
            station=_of(keys, "CLAVE DE LA ESTACION")[0],
            component=name,
        )
        for name, column in zip(names, table.reshape(rows, -1).T, strict=True)
    )


def _each(text: TextFile, keys: dict[str, tuple[int, str]], key: str, count: int) -> list[float]:
    """Return the positive numbers of an entry like /200/200/200, one a channel."""
    line, words = keys.get(key, (1, ""))
    values = [parse_number(word) for word in words.strip("/").split("/")]
    if len(values) != count or count < 1 or not all(value is not None and value > 0.0 for value in values):
        raise text.refusal(line, f"expected {count} positive numbers behind {key!r}, found {words[:40]!r}")
    return [value for value in values if value is not None]


def _of(keys: dict[str, tuple[int, str]], *names: str) -> list[str]:
    return [keys.get(name, (1, ""))[1].strip("/ ") for name in names]
