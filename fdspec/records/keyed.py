"""Numbers out of headers that are made of keys and values."""

from __future__ import annotations

from collections.abc import Mapping

from fdspec.records.numbers import parse_number
from fdspec.records.textfile import TextFile


def number(text: TextFile, keys: Mapping[str, tuple[int, str]], key: str) -> float:
    """Return the positive number that stands behind `key`; `keys` maps each to its line and its text."""
    line, word = keys.get(key, (1, "nothing"))
    value = parse_number(word)
    if value is None or value <= 0.0:
        raise text.refusal(line, f"expected a positive number behind {key!r}, found {word[:40]!r}")
    return value


def whole_number(text: TextFile, keys: Mapping[str, tuple[int, str]], key: str) -> int:
    """Return the whole number, 2 or more, that stands behind `key`."""
    value = number(text, keys, key)
    if value != int(value) or value < 2.0:
        raise text.refusal(
            keys[key][0], f"expected a whole number of at least 2 behind {key!r}, found {value:g}"
        )
    return int(value)
