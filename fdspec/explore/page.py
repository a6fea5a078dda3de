"""The page: one HTML text, with its numbers in it or with a server behind it."""

from __future__ import annotations

import base64
import html
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Final

from fdspec.explore.beside import Beside
from fdspec.explore.building_content import BuildingContent
from fdspec.explore.content import Content, embedded

Shown = Content | Beside | BuildingContent
"""What a page can be made of."""

SHARED: Final = ("units.js", "sent.js", "looks.js", "elements.js", "downloads.js", "cards.js", "controls.js")
"""Scripts of every page, in the order of their use."""

FRAMES: Final = ("numbers.js", "best.js", "words.js", "plots.js", "histories.js", "tables.js", "frames.js")
"""Scripts of the page of single-storey frames, which come after the shared ones."""

BUILDINGS: Final = ("buildings.js",)
"""Of the page of buildings likewise."""

SKETCH: Final = (
    "Drawing of a frame: a floor on columns, a chevron brace below it, and between them the friction damper, "
    "a slotted plate that bolts clamp between two others."
)

NO_NETWORK: Final = (
    "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval'; style-src 'unsafe-inline'; "
    "img-src data: blob:; connect-src data: blob:"
)
"""Content security policy of a page without a server: it can ask nobody for anything. The drawing library
compiles functions ('unsafe-eval') and makes pictures of itself (data:, blob:)."""


def served_page(content: Shown) -> str:
    """Return the page whose histories, and all records but the first, come from the server that sent it."""
    about = {**content.about, "served": True}
    return _page(content, embedded(about), '<script src="plotly.js"></script>', _numbers(content, 1), "")


def written_page(content: Shown) -> str:
    """Return the page that holds all records and the drawing library: it needs nothing else."""
    about = {**content.about, "served": False}
    policy = f'<meta http-equiv="Content-Security-Policy" content="{NO_NETWORK}">'
    return _page(content, embedded(about), f"<script>{plotly_script()}</script>", _numbers(content), policy)


def write_page(content: Shown, path: Path) -> None:
    """Write the page that needs no server to an HTML file, as a whole or not at all."""
    from fdspec.store.replacing import replacing

    with replacing(path, suffixes=(".html", ".htm")) as part:
        part.write_text(written_page(content), encoding="utf-8")


@cache
def plotly_script() -> str:
    """Return plotly.js, as the Python package plotly carries it."""
    from plotly.offline import get_plotlyjs

    return str(get_plotlyjs())


def own_script(scripts: tuple[str, ...]) -> str:
    """Return the shared scripts and these as one, in strict mode, whose names nobody else sees."""
    own = "\n".join(_asset(name) for name in (*SHARED, *scripts))
    return f'(() => {{\n"use strict";\n{own}\n}})();\n'


def _page(content: Shown, about: str, library: str, numbers: str, policy: str) -> str:
    frames = not isinstance(content, BuildingContent)
    kind = "frames" if frames else "buildings"
    parts = {
        "controls": _asset(f"controls-{kind}.html"),
        "options": _asset("options-frames.html") if frames else "",
        "help": _asset(f"help-{kind}.html"),
        "policy": policy,
        "title": html.escape(f"{content.name} - fdspec explore"),
        "style": f"<style>\n{_asset('page.css')}</style>",
        "sketch": f'<img id="sketch" alt="{SKETCH}" src="data:image/svg+xml;base64,{_drawing()}">',
        "about": f'<script type="application/json" id="about">{about}</script>',
        "numbers": numbers,
        "library": library,
        "script": f"<script>\n{own_script(FRAMES if frames else BUILDINGS)}</script>",
    }
    text = _asset("page.html")
    for name, part in parts.items():
        before, mark, after = text.partition(f"<!-- {name} -->")
        if not mark:
            raise AssertionError(f"page.html has no place for {name}")
        text = before + part + after
    return text


def _numbers(content: Shown, first: int | None = None) -> str:
    """Return the numbers of the first records, of all unless a count is given, as the page holds them."""
    return "\n".join(
        f'<script type="text/plain" id="record-{k}">{base64.b64encode(content.record(k)).decode()}</script>'
        for k in range(len(content.records))[:first]
    )


def _drawing() -> str:
    return base64.b64encode(_asset("sketch.svg").encode()).decode()


def _asset(name: str) -> str:
    return (files("fdspec.explore") / "assets" / name).read_text(encoding="utf-8")
