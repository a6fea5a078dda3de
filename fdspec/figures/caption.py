"""Captions: the words below a picture, in lines that fit it."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIZE: Final = 7.5
"""Points of a caption's letters."""

LETTERS_PER_INCH: Final = 17.0
"""Of matplotlib's own font at that size, less a margin."""

LINE: Final = 0.15
"""Inches of a caption's line."""


def wrapped(text: str, width: float) -> str:
    """Return the text in lines for a picture of this width, in."""
    return textwrap.fill(text, int(LETTERS_PER_INCH * (width - 0.3)), break_on_hyphens=False)


def height(text: str, width: float) -> float:
    """Return the height that the text takes below a picture of this width, in."""
    return LINE * (wrapped(text, width).count("\n") + 1) + 0.1 if text else 0.0


def add_caption(figure: Figure, text: str) -> None:
    """Put a caption below a picture whose layout is constrained, which makes room for it."""
    if not text:
        return
    width, tall = figure.get_size_inches()
    figure.set_size_inches(width, tall + height(text, width))
    figure.supxlabel(wrapped(text, width), x=0.15 / width, ha="left", fontsize=SIZE, linespacing=1.3)
