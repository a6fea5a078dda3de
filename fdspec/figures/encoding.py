"""A figure as the bytes of a picture file, the same for the same figure."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any, Final

import matplotlib as mpl

from fdspec.figures.fonts import give_glyphs

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DATELESS: Final[dict[str, dict[str, Any]]] = {
    "png": {},
    "pdf": {"CreationDate": None},
    "svg": {"Date": None},
}
"""For each kind of picture, the metadata that leave out when it was made."""

AUTHOR: Final = {"png": "Author", "pdf": "Author", "svg": "Creator"}
"""What each kind calls who made it."""


def encode(
    figure: Figure, kind: str, *, title: str = "", author: str = "", dpi: float | None = None
) -> bytes:
    """Return the picture as a file.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    kind : {"png", "pdf", "svg"}
    title : str
        Title in the file's metadata; the figure's own first line unless given.
    author : str
        Author in the metadata; fdspec and its version unless given.
    dpi : float, optional
        Dots per inch of a PNG; the figure's own unless given.

    Returns
    -------
    bytes
        The same for the same figure. Text in a PDF is embedded as TrueType (Type 42).
    """
    from fdspec.version import __version__

    told = title or next(iter(str(figure.get_label() or figure.get_suptitle()).splitlines()), "")
    metadata = {**DATELESS[kind], AUTHOR[kind]: author or f"fdspec {__version__}"}
    if told:
        metadata["Title"] = told
    give_glyphs(figure)
    file = io.BytesIO()
    # SVG names its parts after random numbers unless it has a salt; journals refuse the fonts of Type 3.
    with mpl.rc_context({"svg.hashsalt": "fdspec", "pdf.fonttype": 42}):
        figure.savefig(file, format=kind, metadata=metadata, dpi=figure.dpi if dpi is None else dpi)
    return file.getvalue()
