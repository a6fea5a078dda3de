"""Write a motion to a file that `read_record` reads back, to the last digit of what the layout can hold."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from types import MappingProxyType
from typing import Final

from fdspec.errors import InvalidInput, RecordError
from fdspec.model.motion import GroundMotion
from fdspec.records import written
from fdspec.records.written import one_line
from fdspec.units import G


def as_at2(motion: GroundMotion) -> str:
    """Return PEER's AT2: g, 17 digits, five a line; m/s2 come back within one rounding of the conversion."""
    origin = [one_line(text).replace(",", " ") for text in (motion.event, motion.station, motion.component)]
    words = [f"{x:25.16E}" for x in (motion.acceleration / G).tolist()]
    rows = ["".join(words[k : k + 5]) for k in range(0, len(words), 5)]
    header = [
        "PEER STRONG MOTION DATABASE RECORD. WRITTEN BY FDSPEC",
        ", ".join(origin),
        "ACCELERATION TIME HISTORY IN UNITS OF G",
        f"NPTS= {motion.n}, DT= {motion.dt!r} SEC",
    ]
    return "\n".join(header + rows) + "\n"


LAYOUTS: Final = MappingProxyType({"at2": as_at2, "txt": written.write})
"""Name of a layout, also the ending of its files -> what makes the text."""


def write_record(motion: GroundMotion, path: str | os.PathLike[str], layout: str | None = None) -> Path:
    """Write a motion as PEER AT2 ("at2") or two columns of text ("txt"), as the ending says if not `layout`.

    Raises
    ------
    InvalidInput
        When the layout is unknown.
    RecordError
        When the file cannot be written; none is left half-written.
    """
    file = Path(path)
    chosen = (layout or file.suffix.lstrip(".")).lower()
    make: Callable[[GroundMotion], str] | None = LAYOUTS.get(chosen)
    if make is None:
        raise InvalidInput(
            f"layout must be one of {', '.join(LAYOUTS)}, as an option or as ending, not {chosen!r}"
        )
    text = make(motion)
    partial = file.with_name(f".{file.name}.{os.getpid()}.part")
    try:
        partial.write_text(text, encoding="utf-8", newline="\n")
        partial.replace(file)
    except OSError as error:
        partial.unlink(missing_ok=True)
        raise RecordError(f"{file}: cannot be written ({error})") from error
    return file
