"""Many pictures on one page."""

from __future__ import annotations

import io
import math
from collections.abc import Mapping
from typing import Final

from PIL import Image

from fdspec.errors import InvalidInput
from fdspec.figures.page import Figure

COLUMNS: Final = 3

WIDTH, HEIGHT = 4.3, 3.3
"""Of one picture with its name, in."""

DPI: Final = 200


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
    figure = Figure(figsize=(width, tall), dpi=DPI)
    for k, (name, png) in enumerate(pictures.items()):
        row, column = divmod(k, columns)
        left, bottom = column * WIDTH + 0.06, (rows - 1 - row) * HEIGHT + 0.06
        axis = figure.add_axes(
            (left / width, bottom / tall, (WIDTH - 0.12) / width, (HEIGHT - 0.3) / tall), label=name
        )
        image = Image.open(io.BytesIO(png)).convert("RGB")
        # Once here rather than for each kind of file by matplotlib, which takes most of the time.
        image.thumbnail((round(DPI * (WIDTH - 0.12)), round(DPI * (HEIGHT - 0.3))), Image.Resampling.LANCZOS)
        axis.imshow(image, interpolation="none")
        axis.set_axis_off()
        axis.set_title(name, fontsize=10, pad=3)
    if title:
        figure.suptitle(title, y=1.0 - 0.12 / tall, fontsize=11, va="top")
    return figure
