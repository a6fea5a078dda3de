"""Numbers as Fortran and C programs print them; nothing in a file is ever evaluated."""

from __future__ import annotations

import math
import re
from array import array
from itertools import chain
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.records.textfile import TextFile

CHUNK: Final = 5_000
"""Lines read at once: lists of Python floats for all of them would take ten times the file's room."""

_UNSIGNED: Final = r"(?:\d+\.?\d*|\.\d+)(?:[EeDd][+-]?\d{1,4})?"
_NUMBER: Final = re.compile(rf"[+-]?{_UNSIGNED}", re.ASCII)
# Values that fill their columns touch: 1.234-5.678. Only a sign can part them, and only numbers with a
# decimal point are taken apart, because 1.234-105 may also be Fortran's way to write 1.234E-105.
_STUCK: Final = re.compile(r"[+-]?(?:\d+\.\d*|\.\d+)(?:[EeDd][+-]?\d{1,4})?", re.ASCII)
_ONLY_NUMBERS: Final = re.compile(r"[0-9+\-.Ee \t\n]*", re.ASCII)


def parse_number(word: str) -> float | None:
    """Return the finite number that `word` is, or None."""
    if not _NUMBER.fullmatch(word):
        return None
    value = float(word.replace("D", "E").replace("d", "e"))
    return value if math.isfinite(value) else None


def parse_words(text: TextFile, number: int) -> list[float]:
    """Return all values of line `number`, separated by blanks or stuck together."""
    words = text.lines[number - 1].split()
    return list(chain.from_iterable(_parse_word(text, number, word) for word in words))


def parse_block(text: TextFile, first: int, last: int) -> NDArray[np.float64]:
    """Return all values of lines `first` to `last` (counted from 1, both included)."""
    last = min(last, len(text.lines))
    parts = [
        _parse_lines(text, start, min(start + CHUNK - 1, last)) for start in range(first, last + 1, CHUNK)
    ]
    return np.concatenate(parts) if parts else np.empty(0)


def _parse_lines(text: TextFile, first: int, last: int) -> NDArray[np.float64]:
    block = text.block(first, last)
    if _ONLY_NUMBERS.fullmatch(block):  # the common case, twenty times faster
        try:
            values = np.array([float(word) for word in block.split()])
        except ValueError:
            pass  # some value is odd or stuck: find it, with its line, below
        else:
            if np.isfinite(values).all():
                return values
    rows = (parse_words(text, number) for number in range(first, last + 1))
    return np.array(list(chain.from_iterable(rows)), dtype=np.float64)


def parse_columns(text: TextFile, first: int, last: int, width: int, count: int) -> NDArray[np.float64]:
    """Return `count` values printed in columns of `width` characters, as many a line as fit.

    Fixed columns are read by position: values may touch without a sign between them.
    """
    values = array("d")
    for number in range(first, min(last, len(text.lines)) + 1):
        line = text.lines[number - 1].rstrip()
        for start in range(0, len(line), width):
            word = line[start : start + width].strip()
            value = parse_number(word)
            if value is None:
                place = f"columns {start + 1} to {start + width}"
                raise text.refusal(number, f"expected a finite number in {place}, found {word!r}")
            values.append(value)
    if len(values) != count:
        end = min(last, len(text.lines))
        raise text.refusal(end, f"expected {count} values up to here, found {len(values)}")
    return np.array(values, dtype=np.float64)


def _parse_word(text: TextFile, number: int, word: str) -> list[float]:
    value = parse_number(word)
    if value is not None:
        return [value]
    parts = stuck_words(word)
    if parts is None:
        raise text.refusal(number, f"expected a finite number, found {word[:40]!r}")
    return [parsed for part in parts if (parsed := parse_number(part)) is not None]


def stuck_words(word: str) -> list[str] | None:
    """Return the numbers that touch in a word, None when it can be read in another way or not at all."""
    parts = []
    position = 0
    while match := _STUCK.match(word, position):
        if position and word[position] not in "+-":
            return None
        if parse_number(match.group()) is None:
            return None
        parts.append(match.group())
        position = match.end()
    return parts if parts and position == len(word) else None
