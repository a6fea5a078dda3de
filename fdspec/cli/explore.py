"""`fdspec explore`: a cube in the browser, with the history of any cell at a click."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import click

from fdspec.cli.echo import echo
from fdspec.errors import InvalidInput
from fdspec.stopping import Stopped


@click.command()
@click.argument("cubes", metavar="CUBE.nc...", nargs=-1, required=True)
@click.option(
    "--record",
    "records",
    multiple=True,
    metavar="NAME=FILE",
    help="The file of a record that is not in the catalogue, for its histories; repeat it for several.",
)
@click.option(
    "--host", default="127.0.0.1", show_default=True, metavar="ADDRESS", help="Address to listen on."
)
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    default=0,
    metavar="N",
    help="Port to listen on.  [default: a free one]",
)
@click.option("--no-browser", is_flag=True, help="Only print the address; open no browser.")
def explore(cubes: tuple[str, ...], records: tuple[str, ...], host: str, port: int, no_browser: bool) -> None:
    """Show a cube in the browser: maps, surfaces, best pretension, histories at a click.

    Cubes over the same axes stand beside each other on one page, with the same controls and colours. Of a
    cube of buildings the page shows profiles over the height.
    Prints the page's address and serves it until Ctrl-C. It is reached from this machine alone unless --host
    says otherwise. `fdspec export CUBE.nc --html` writes a page that needs no server.
    """
    from fdspec import store

    try:
        from fdspec.explore import Rerun, serve
        from fdspec.explore.beside import Beside, Reruns, files_of
        from fdspec.explore.building_content import BuildingContent
        from fdspec.explore.motions import read_given
        from fdspec.explore.opened import content_of
        from fdspec.explore.page import Shown
        from fdspec.explore.server import is_loopback
    except ModuleNotFoundError as error:
        raise InvalidInput(needs_extra(error)) from None

    files = read_given(records)
    opened = [store.open(cube, lazily=True) for cube in cubes]
    contents = [content_of(*one) for one in zip(opened, cubes, _names(cubes), strict=True)]
    of_frames = [one for one in contents if not isinstance(one, BuildingContent)]
    content: Shown
    rerun: Rerun | Reruns | None
    if len(of_frames) < len(contents):
        if len(contents) > 1:
            raise InvalidInput("a cube of buildings has a page of its own; name one cube")
        if files:
            raise InvalidInput("--record is for histories, which the page of buildings has none of")
        content, rerun = contents[0], None
    elif len(contents) == 1:
        content, rerun = contents[0], Rerun(opened[0], files, Path(cubes[0]).parent)
    else:
        content = Beside(of_frames)
        given = files_of(files, [one.records for one in contents])
        folders = [Path(path).parent for path in cubes]
        rerun = Reruns([Rerun(*one) for one in zip(opened, given, folders, strict=True)])
    if not is_loopback(host):
        echo(f"fdspec: warning: whoever reaches {host} can read this cube and run histories", err=True)

    def ready(address: str) -> None:
        echo(f"{address}  (Ctrl-C ends)")
        sys.stdout.flush()
        if not no_browser and _has_browser():
            import webbrowser

            webbrowser.open(address)

    try:
        serve(content, rerun, host=host, port=port, ready=ready)
    except Stopped:
        raise
    except KeyboardInterrupt:  # the way to end it
        echo()


def _names(cubes: tuple[str, ...]) -> list[str]:
    """Return what the page calls the cubes: their files' names, where these differ."""
    names = [Path(path).name for path in cubes]
    return names if len(set(names)) == len(names) else list(cubes)


def needs_extra(error: ModuleNotFoundError) -> str:
    """Say which package is missing, and how to get it."""
    return f"the page needs {error.name}: pip install 'fdspec[explore]'"


def _has_browser() -> bool:
    """Say whether a person sits here with a screen: text browsers would take the terminal."""
    if not sys.stdout.isatty():
        return False
    if sys.platform in {"darwin", "win32"}:
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
