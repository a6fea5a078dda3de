"""The figure that all pictures are drawn on: matplotlib's, which notebooks show without pyplot."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import matplotlib as mpl
import matplotlib.figure

from fdspec.figures.encoding import encode


class Figure(matplotlib.figure.Figure):
    """Show itself where it is the value of a notebook's cell."""

    def _repr_png_(self) -> bytes:
        return encode(self, "png")


@contextmanager
def lettering(points: float) -> Iterator[None]:
    """Draw with letters of this size in the block, and others in proportion."""
    with mpl.rc_context({"font.size": points}):
        yield


def at_width(figure: matplotlib.figure.Figure, width: float) -> None:
    """Bring a figure whose layout is constrained to a width, mm, in its own proportions, at 600 dpi."""
    across, tall = figure.get_size_inches()
    inches = width / 25.4
    figure.set_size_inches(inches, tall * inches / across)
    figure.set_dpi(600)
