"""Where results go: checked before the work starts, and never over a file that the user did not give up."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, ParamSpec, TypeVar

import click

from fdspec.errors import StoreError

if TYPE_CHECKING:
    from fdspec.figures.page import Figure

P = ParamSpec("P")
R = TypeVar("R")

PICTURES = (".png", ".pdf", ".svg")


def force_option(command: Callable[P, R]) -> Callable[P, R]:
    """Add the option without which a file that exists is not replaced."""
    return click.option("--force", is_flag=True, help="Replace output files that exist.")(command)


def free(path: str | Path, *, force: bool, suffixes: tuple[str, ...] | None = None) -> Path:
    """Return the path when a file can be written there, or raise StoreError."""
    from fdspec.store import check_writable

    path = Path(path)
    if is_there(path) and not force:
        raise StoreError(f"{path} exists already; name another with -o, or replace it with --force")
    if suffixes is None:
        check_writable(path)
        return path
    if not path.suffix:
        raise StoreError(f"cannot write {path}: the name should end in {' or '.join(suffixes)}")
    check_writable(path, suffixes=suffixes)
    return path


def is_there(path: Path) -> bool:
    """Whether there is such a file; a name that no file can have is none."""
    try:
        return path.is_file()
    except OSError:
        return False


def made_folder(path: str | Path) -> Path:
    """Return a folder for results, made if absent."""
    folder = Path(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        told = "there is a file of that name" if isinstance(error, FileExistsError) else error.strerror
        raise StoreError(f"cannot make the folder {folder}: {told}") from error
    return folder


def save_picture(figure: Figure, path: Path) -> None:
    """Write a figure as a whole or not at all; two runs give the same bytes."""
    from fdspec.figures import encode

    write_picture(encode(figure, path.suffix.lower().removeprefix(".")), path)


def write_picture(picture: bytes, path: Path) -> None:
    """Write the bytes of a picture as a whole or not at all."""
    from fdspec.store.replacing import replacing

    with replacing(path, suffixes=PICTURES) as part:
        part.write_bytes(picture)
