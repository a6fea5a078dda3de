"""The user's own files that stand under the study's names: which, and that they are still the same."""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from fdspec.errors import DiskError, RecordError
from fdspec.locks import locked

VARIABLE: Final = "FDSPEC_RECORDS"
"""Environment variable that names the file of links, in place of the one in the user's configuration."""

PATIENCE: Final = 30.0
"""s that another process may take to change its links."""


@dataclass(frozen=True)
class Link:
    """One record of the study, found among the user's files; `sha256` is that of the file.

    `units` and `dt`, s, are told of a file that does not say them itself.
    """

    path: Path
    channel: str
    sha256: str
    units: str | None = None
    dt: float | None = None


def links_file() -> Path:
    """Return where links are kept: $FDSPEC_RECORDS, else records.toml in the user's configuration."""
    if named := os.environ.get(VARIABLE):
        return Path(named)
    home = os.environ.get("XDG_CONFIG_HOME") or os.environ.get("APPDATA") or Path.home() / ".config"
    return Path(home) / "fdspec" / "records.toml"


def links() -> dict[str, Link]:
    """Return the links by name of the study's record; none when nothing was ever linked."""
    file = links_file()
    try:
        tables = tomllib.loads(file.read_text(encoding="utf-8"))
        return {name: _link(table) for name, table in tables.items()}
    except FileNotFoundError:
        return {}
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise RecordError(
            f"{file}: the file of links cannot be read ({error}); correct or delete it"
        ) from error


def _link(table: Mapping[str, Any]) -> Link:
    units, dt = table.get("units"), table.get("dt")
    return Link(
        Path(table["path"]),
        str(table["channel"]),
        str(table["sha256"]),
        None if units is None else str(units),
        None if dt is None else float(dt),
    )


def linked(name: str) -> Link | None:
    """Return the link of one record, or None; a file that is gone or was changed is refused."""
    link = links().get(name)
    if link is None:
        return None
    advice = f"link it again or give it up with `fdspec records unlink {name}`"
    if not link.path.is_file():
        raise RecordError(f"{name} is linked to {link.path}, which is not there: {advice}")
    if checksum(link.path) != link.sha256:
        raise RecordError(f"{name} is linked to {link.path}, which was changed since: {advice}")
    return link


def save_links(added: Mapping[str, Link]) -> Path:
    """Add links to those there are, and return the file they are kept in."""
    with _changing():
        return _write_links({**links(), **added})


def remove_links(names: tuple[str, ...] | None = None) -> Path:
    """Take out the links of these names, or all, so that the stand-ins are loaded again."""
    with _changing() as file:
        kept = {} if names is None else {name: link for name, link in links().items() if name not in names}
        if kept:
            return _write_links(kept)
        try:
            file.unlink(missing_ok=True)
        except OSError as error:
            raise RecordError(f"{file}: the file of links cannot be deleted ({error.strerror})") from error
    return file


@contextmanager
def _changing() -> Iterator[Path]:
    """Hold the file of links from reading to writing: of two that link at a time none is lost."""
    file = links_file()
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with locked(file, wait=PATIENCE):
            yield file
    except DiskError as error:
        raise RecordError(f"{file}: links cannot be written ({error})") from error
    except OSError as error:
        raise RecordError(f"{file}: links cannot be written ({error.strerror})") from error


def checksum(path: Path) -> str:
    """Return the SHA-256 of a file, hexadecimal."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _write_links(kept: Mapping[str, Link]) -> Path:
    lines = ["# Records of the study among the user's own files; written by fdspec."]
    for name, link in sorted(kept.items()):
        # A JSON string is a TOML string, whatever the path holds.
        lines += ["", f"[{name}]", f"path = {json.dumps(str(link.path))}"]
        lines += [f"channel = {json.dumps(link.channel)}", f'sha256 = "{link.sha256}"']
        lines += [] if link.units is None else [f"units = {json.dumps(link.units)}"]
        lines += [] if link.dt is None else [f"dt = {link.dt!r}"]
    return _write("\n".join(lines) + "\n")


def _write(text: str) -> Path:
    file = links_file()
    try:
        with tempfile.NamedTemporaryFile("w", dir=file.parent, delete=False, encoding="utf-8") as temporary:
            temporary.write(text)
        Path(temporary.name).replace(file)
    except OSError as error:
        raise RecordError(f"{file}: links cannot be written ({error})") from error
    return file
