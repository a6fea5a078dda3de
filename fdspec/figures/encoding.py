"""A figure as the bytes of a picture file, the same for the same figure."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any, Final

import matplotlib as mpl

from fdspec.figures.fonts import give_glyphs

if TYPE_CHECKING:
    from matplotlib.figure import Figure

UNDATED: Final[dict[str, dict[str, Any]]] = {
    "png": {},
    "pdf": {"CreationDate": None},
    "svg": {"Date": None},
}
"""For each kind of picture, the metadata that leave out when it was made."""


def encode(figure: Figure, kind: str) -> bytes:
    """Return the picture as a file of this kind: png, pdf or svg."""
    give_glyphs(figure)
    file = io.BytesIO()
    # SVG names its parts after random numbers unless it has a salt.
    with mpl.rc_context({"svg.hashsalt": "fdspec"}):
        figure.savefig(file, format=kind, metadata=UNDATED[kind])
    return file.getvalue()
