"""A record file as numbered lines: what every reader works on, and how it refuses."""

from __future__ import annotations

import os
from array import array
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, overload

from fdspec.errors import RecordError
from fdspec.records.encoding import decoded

MAX_BYTES: Final = 200_000_000
"""An hour of three channels at 200 Hz is 40 MB of text; far beyond that it is no record."""
MAX_LINE: Final = 10_000
"""Characters of a line with words in it; a line of numbers alone may be of any length."""
MAX_HEAD: Final = 1000
"""Characters of a line that are searched for words."""
_OF_NUMBERS: Final = frozenset("0123456789+-.,;|EeDd \t'\"")


class Lines(Sequence[str]):
    """The lines of a text, cut out of it on demand: a str for each would take ten times its room."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._starts = array("I", [0])
        at = text.find("\n")
        while at >= 0:
            self._starts.append(at + 1)
            at = text.find("\n", at + 1)
        self._starts.append(len(text) + 1)

    def __len__(self) -> int:
        return len(self._starts) - 1

    @overload
    def __getitem__(self, index: int) -> str: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[str, ...]: ...
    def __getitem__(self, index: int | slice) -> str | tuple[str, ...]:
        if isinstance(index, slice):
            first, last, step = index.indices(len(self))
            if step == 1:
                return tuple(self.block(first, last).split("\n")) if last > first else ()
            return tuple(self[k] for k in range(first, last, step))
        k = index + len(self) if index < 0 else index
        if not 0 <= k < len(self):
            raise IndexError(index)
        return self._text[self._starts[k] : self._starts[k + 1] - 1]

    def longer_than(self, length: int) -> list[int]:
        """Return the numbers, counted from 1, of lines of more characters than `length`."""
        if len(self._text) <= length:
            return []
        return [k for k in range(1, len(self) + 1) if self._starts[k] - self._starts[k - 1] - 1 > length]

    def block(self, first: int, last: int) -> str:
        """Return lines `first` to `last` (counted from 0, `last` excluded) in one text."""
        return self._text[self._starts[first] : self._starts[last] - 1]


@dataclass(frozen=True)
class TextFile:
    """The lines of a file, without line ends, and the name that error messages give it.

    `taken` collects, line by line, what the readers took each heading and statement for.
    """

    name: str
    lines: Sequence[str]
    taken: list[str] = field(default_factory=list, compare=False)

    def line(self, number: int, expected: str) -> str:
        """Return the head of line `number` (counted from 1), or refuse a file that ends before it."""
        if number > len(self.lines):
            raise self.refusal(number, f"the file ends before {expected}")
        return self.head(number)

    def head(self, number: int) -> str:
        """Return what a search looks at in line `number`: no heading is longer, and no search takes long."""
        return self.lines[number - 1][:MAX_HEAD]

    def heads(self, first: int, last: int) -> list[str]:
        """Return the heads of lines `first` to `last`, as far as there are such lines."""
        return [self.head(number) for number in range(first, min(last, len(self.lines)) + 1)]

    def block(self, first: int, last: int) -> str:
        """Return lines `first` to `last` (counted from 1, both included) as one text."""
        last = min(last, len(self.lines))
        if last < first:
            return ""
        if isinstance(self.lines, Lines):
            return self.lines.block(first - 1, last)
        return "\n".join(self.lines[first - 1 : last])

    def refusal(self, number: int | None, problem: str) -> RecordError:
        """Return the error for a problem in line `number` (counted from 1), or in the whole file."""
        where = self.name if number is None else f"{self.name}, line {number}"
        return RecordError(f"{where}: {problem}")

    def take(self, number: int | None, meaning: str) -> None:
        """Note what line `number`, or the whole file, was taken for."""
        said = meaning if number is None else f"line {number}: {meaning}"
        if said not in self.taken:
            self.taken.append(said)


def read_bytes(path: str | os.PathLike[str]) -> bytes:
    """Return the content of a record file; refuse what cannot be one before any of it is in memory."""
    file = Path(path)
    try:
        if not file.exists():
            raise RecordError(f"{file}: there is no such file")
        if not file.is_file():
            raise RecordError(f"{file}: is not a regular file")
        size = file.stat().st_size
        if size == 0:
            raise RecordError(f"{file}: the file is empty")
        if size > MAX_BYTES:
            limit = f"expected at most {MAX_BYTES / 1e6:.0f} MB"
            raise RecordError(f"{file}: {size / 1e6:.0f} MB is no single record; {limit}")
        return file.read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a path with a null character
        if isinstance(error, RecordError):
            raise
        raise RecordError(f"{file}: cannot be read ({getattr(error, 'strerror', None) or error})") from error


def decode(content: bytes, name: str) -> TextFile:
    """Return the content as lines; a binary file is refused."""
    characters, encoding = decoded(content, name)
    # str.splitlines would also split at form feeds and the like, and line numbers would be off.
    if not characters.strip():
        raise RecordError(f"{name}: the file has no text")
    lines = Lines(characters)
    text = TextFile(name, lines)
    text.take(None, f"encoding: {encoding}")
    for number in lines.longer_than(MAX_LINE):
        line = lines[number - 1]
        if not _OF_NUMBERS.issuperset(line):
            raise text.refusal(
                number, f"expected lines of words of at most {MAX_LINE} characters, found {len(line)}"
            )
    return text
