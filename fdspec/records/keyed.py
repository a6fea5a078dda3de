"""Headers that are made of keys and values."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final

from fdspec.records.numbers import parse_number
from fdspec.records.textfile import TextFile
from fdspec.records.vocabulary import plain

_NO_LETTERS: Final = re.compile(r"[^a-z0-9]+")


def split_key(line: str, mark: str = ":") -> tuple[str, str] | None:
    """Return key and value of a line, without blanks around them; None when it has no key."""
    key, found, value = line.partition(mark)
    return (key.strip(), value.strip()) if found and key.strip() else None


def canonical(key: str) -> str:
    """Return a key as letters and digits alone: spelling, accents and punctuation of agencies vary."""
    return _NO_LETTERS.sub(" ", plain(key)).strip()


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
