"""The figure that all pictures are drawn on: matplotlib's, which notebooks show without pyplot."""

from __future__ import annotations

import matplotlib.figure

from fdspec.figures.encoding import encode


class Figure(matplotlib.figure.Figure):
    """Show itself where it is the value of a notebook's cell."""

    def _repr_png_(self) -> bytes:
        return encode(self, "png")
