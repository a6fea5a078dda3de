"""Where each key of a TOML text is written: tomllib keeps no positions, and an error should name its line."""

import re
import tomllib
from collections.abc import Iterator, Mapping
from typing import Any, Final

_BARE: Final = r"""(?:[A-Za-z0-9_-]+|"[^"]*"|'[^']*')"""
_DOTTED: Final = rf"(?P<name>{_BARE}(?:\s*\.\s*{_BARE})*)"
_HEADER: Final = re.compile(rf"\s*\[\[?\s*{_DOTTED}\s*\]\]?\s*(?:#.*)?$")
_KEY: Final = re.compile(rf"\s*{_DOTTED}\s*=")


def parsed(text: str) -> dict[str, Any]:
    """Read TOML, or raise ValueError with what is wrong."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"is not TOML: {error}") from None
    except RecursionError:
        raise ValueError("lists or tables stand in one another too deeply") from None
    except ValueError:  # Python's own limit, for the time that it takes
        raise ValueError("has a number of too many digits") from None


def key_lines(text: str) -> dict[tuple[str, ...], int]:
    """Map each key of TOML text, as (table, ..., key), to the line it is first written on.

    The text is read line by line, which is exact for keys that start a line and for table headers: all that a
    study file holds.
    """
    lines: dict[tuple[str, ...], int] = {}
    table: tuple[str, ...] = ()
    for number, line in enumerate(text.splitlines(), start=1):
        if header := _HEADER.match(line):
            table = tuple(_parts(header["name"]))
            lines.setdefault(table, number)
        elif key := _KEY.match(line):
            path = (*table, *_parts(key["name"]))
            for depth in range(1, len(path) + 1):
                lines.setdefault(path[:depth], number)
    return lines


def line_of(lines: Mapping[tuple[str, ...], int], where: tuple[str | int, ...]) -> int:
    """Return the line of the innermost key of `where` that is written somewhere."""
    keys = tuple(str(part) for part in where)
    for depth in range(len(keys), 0, -1):
        if keys[:depth] in lines:
            return lines[keys[:depth]]
    return 1


def _parts(name: str) -> Iterator[str]:
    for part in re.findall(_BARE, name):
        yield part.strip("\"'")
