"""Mexico's standard acceleration file (ASA 2.0): lines of KEY : value, then channels side by side.

Networks spell its keys in their own ways, print exponents, and some write one sample more than they count.
"""

from __future__ import annotations

import re
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.records.channel import Channel
from fdspec.records.keyed import canonical, split_key
from fdspec.records.numbers import parse_columns, parse_number
from fdspec.records.textfile import TextFile
from fdspec.records.units import acceleration_unit, to_si

NAME: Final = "UNAM ASA"
MAX_HEADER: Final = 200
STEP, COUNT = "intervalo de muestreo c1 c6 s", "num total de muestras c1 c6"
LENGTH: Final = "duracion del registro s c1 c6"
PEAKS, PEAKS_AT = "acel max gal c1 c6", "acel max c1 c6 en la muestra"
UNITS, FORMAT = "unidades de los datos", "formato datos"

_FORMAT: Final = re.compile(r"(\d{1,2})[FEGD](\d{1,2})\.\d{1,2}", re.IGNORECASE)


def recognises(text: TextFile) -> bool:
    """Say whether the title of the standard stands near the top."""
    return any(canonical(line).startswith("archivo estandar de aceleracion") for line in text.heads(1, 30))


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read all channels, which have one time step."""
    keys: dict[str, tuple[int, str]] = {}
    for line, content in enumerate(text.heads(1, MAX_HEADER), start=1):
        if canonical(content).startswith("datos de aceleracion"):
            heading = line
            break
        if found := split_key(content):
            keys.setdefault(canonical(found[0]), (line, found[1]))
    else:
        raise text.refusal(None, f"expected DATOS DE ACELERACION in the first {MAX_HEADER} lines")
    names = [word.split(";")[0] for word in text.line(heading + 3, "the directions of the channels").split()]
    line, spelling = keys.get(UNITS, (1, "nothing"))
    unit = acceleration_unit(spelling.split("(")[0])
    if unit is None:
        raise text.refusal(line, f"expected UNIDADES DE LOS DATOS: Gal, found {spelling!r}")
    steps = _each(text, keys, STEP, len(names))
    counts = _each(text, keys, COUNT, len(names))
    layouts = [value for key, value in keys.items() if key.startswith(FORMAT)]
    layout = _FORMAT.fullmatch(layouts[0][1]) if layouts else None
    if layout is None or int(layout[1]) != len(names) or int(layout[2]) < 2:
        raise text.refusal(layouts[0][0] if layouts else 1, f"expected FORMATO DATOS: {len(names)}F10.4")
    if len(set(steps)) > 1 or len(set(counts)) > 1:
        raise text.refusal(heading, "expected one time step and one number of samples for all channels")
    count = counts[0]
    first = heading + 5
    rows = len(text.lines) - first + 1
    if rows < 2 or count < 2 or rows not in {count, count + 1}:
        raise text.refusal(
            len(text.lines), f"expected {count:g} rows, as NUM. TOTAL DE MUESTRAS says, found {rows}"
        )
    table = parse_columns(text, first, len(text.lines), int(layout[2]), rows * len(names)).reshape(rows, -1)
    processing: tuple[str, ...] = ()
    if rows == count + 1:
        _refuse_doubled_row(text, keys, table, unit, steps[0], count)
        processing = (
            f"on reading, {rows} samples were found where the header counts {count:g}: all were taken",
        )
    text.take(line, f"{spelling}: acceleration in {unit}")
    text.take(keys[STEP][0], f"time step {steps[0]:.10g} s")
    text.take(keys[COUNT][0], f"{count:g} rows of {len(names)} channels: {', '.join(names)}")
    return tuple(
        Channel(
            name=name,
            acceleration=to_si(np.ascontiguousarray(column), unit),
            dt=steps[0],
            units=unit,
            event=" ".join(
                filter(None, _of(keys, "fecha del sismo gmt", "hora epicentro gmt", "magnitud es"))
            ),
            station=_of(keys, "clave de la estacion")[0],
            component=name,
            processing=processing,
        )
        for name, column in zip(names, table.T, strict=True)
    )


def _refuse_doubled_row(
    text: TextFile,
    keys: dict[str, tuple[int, str]],
    table: NDArray[np.float64],
    unit: str,
    dt: float,
    count: float,
) -> None:
    """Refuse a row more than the count, unless length and peaks show that the header counts the steps.

    Some networks write a sample at time zero and at the end of a record whose length they divide by the step.
    """
    columns = table.shape[1]
    length = [parse_number(word) for word in keys.get(LENGTH, (1, ""))[1].strip("/ ").split("/")]
    peaks = [parse_number(word.strip()) for word in keys.get(PEAKS, (1, ""))[1].strip("/ ").split("/")]
    places = [parse_number(word.strip()) for word in keys.get(PEAKS_AT, (1, ""))[1].strip("/ ").split("/")]
    whole = length[0] is not None and abs(length[0] - count * dt) < 0.5 * dt
    found = len(peaks) == len(places) == columns and unit == "cm/s2"
    for k, (peak, place) in enumerate(zip(peaks, places, strict=False)):
        found = found and peak is not None and place is not None and 1 <= place <= table.shape[0] - 1
        near = table[int(place or 1) - 1 : int(place or 1) + 1, k] if found else table[:0, k]
        found = found and bool((np.abs(near - (peak or 0.0)) <= 0.006).any())
    if not (whole and found):
        raise text.refusal(
            len(text.lines),
            f"expected {count:g} rows, as NUM. TOTAL DE MUESTRAS says, found {table.shape[0]}",
        )


def _each(text: TextFile, keys: dict[str, tuple[int, str]], key: str, count: int) -> list[float]:
    """Return the positive numbers of an entry like /200/200/200, one a channel."""
    line, words = keys.get(key, (1, ""))
    values = [parse_number(word.strip()) for word in words.strip("/ ").split("/")]
    if len(values) != count or count < 1 or not all(value is not None and value > 0.0 for value in values):
        raise text.refusal(line, f"expected {count} positive numbers behind {key!r}, found {words[:40]!r}")
    return [value for value in values if value is not None]


def _of(keys: dict[str, tuple[int, str]], *names: str) -> list[str]:
    return [keys.get(name, (1, ""))[1].strip("/ ") for name in names]
