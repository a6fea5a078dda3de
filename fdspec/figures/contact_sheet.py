"""Many pictures on one page."""

from __future__ import annotations

import io
import math
from collections.abc import Mapping
from typing import Any, Final

from matplotlib.image import imread

from fdspec.errors import InvalidInput
from fdspec.figures.page import Figure

COLUMNS: Final = 3

WIDTH, HEIGHT = 4.3, 3.3
"""Of one picture with its name, in."""


def plot_contact_sheet(pictures: Mapping[str, bytes], *, title: str = "") -> Figure:
    """Put pictures side by side, each with its name.

    Parameters
    ----------
    pictures : mapping of str to bytes
        PNG files by the words above them.
    title : str

    Returns
    -------
    matplotlib.figure.Figure
        Three a row.

    Raises
    ------
    InvalidInput
        When there is no picture.
    """
    if not pictures:
        raise InvalidInput("pictures must name one or more, not none")
    columns = min(COLUMNS, len(pictures))
    rows = math.ceil(len(pictures) / columns)
    width, tall = columns * WIDTH, rows * HEIGHT + (0.4 if title else 0.1)
    figure = Figure(figsize=(width, tall), dpi=200)
    for k, (name, png) in enumerate(pictures.items()):
        row, column = divmod(k, columns)
        left, bottom = column * WIDTH + 0.06, (rows - 1 - row) * HEIGHT + 0.06
        axis = figure.add_axes(
            (left / width, bottom / tall, (WIDTH - 0.12) / width, (HEIGHT - 0.3) / tall), label=name
        )
        image = imread(io.BytesIO(png), format="png")
        if image.shape[1] > 2.0 * figure.dpi * WIDTH:
            image = _halved(image)
        axis.imshow(image, interpolation="hanning")
        axis.set_axis_off()
        axis.set_title(name, fontsize=10, pad=3)
    if title:
        figure.suptitle(title, y=1.0 - 0.12 / tall, fontsize=11, va="top")
    return figure


def _halved(image: Any) -> Any:
    """Average blocks of 2 x 2 points: thumbnails need no more, and resampling takes most of the time."""
    rows, columns = 2 * (image.shape[0] // 2), 2 * (image.shape[1] // 2)
    blocks = image[:rows, :columns].reshape(rows // 2, 2, columns // 2, 2, -1)
    return blocks.mean(axis=(1, 3))
