"""A record file as numbered lines: what every reader works on, and how it refuses."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from fdspec.errors import RecordError

MAX_BYTES: Final = 200_000_000
"""An hour of three channels at 200 Hz is 40 MB of text; far beyond that it is no record."""
MAX_LINE: Final = 10_000
"""Characters; no format has such lines, and the time of a search in one stays bounded."""


@dataclass(frozen=True)
class TextFile:
    """The lines of a file, without line ends, and the name that error messages give it."""

    name: str
    lines: tuple[str, ...]

    def line(self, number: int, expected: str) -> str:
        """Return line `number` (counted from 1), or refuse a file that ends before it."""
        if number > len(self.lines):
            raise self.refusal(number, f"the file ends before {expected}")
        return self.lines[number - 1]

    def refusal(self, number: int | None, problem: str) -> RecordError:
        """Return the error for a problem in line `number` (counted from 1), or in the whole file."""
        where = self.name if number is None else f"{self.name}, line {number}"
        return RecordError(f"{where}: {problem}")


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
    if b"\0" in content:
        raise RecordError(f"{name}: this is a binary file; expected text")
    try:
        characters = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        characters = content.decode("latin-1")
    # str.splitlines would also split at form feeds and the like, and line numbers would be off.
    lines = characters.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    while lines and not lines[-1].strip("\x1a \t\f"):  # DOS files may end in Ctrl-Z
        lines.pop()
    if not lines:
        raise RecordError(f"{name}: the file has no text")
    text = TextFile(name, tuple(lines))
    for number, line in enumerate(lines, start=1):
        if len(line) > MAX_LINE:
            raise text.refusal(number, f"expected lines of at most {MAX_LINE} characters, found {len(line)}")
    return text
