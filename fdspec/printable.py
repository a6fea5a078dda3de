"""Text of unknown origin, made safe for a terminal: names and comments come out of other people's files."""

from __future__ import annotations

import re
from typing import Final

UNSAFE: Final = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f"  # what moves the cursor, sets titles, answers questions; not tab, newline
    "\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069"  # what turns the direction of writing, or starts a line
    "\ud800-\udfff]"  # halves of characters, as in paths that are no UTF-8: they cannot be printed at all
)


def printable(text: str) -> str:
    r"""Return the text with everything that a terminal would act on written as Python writes it.

    Examples
    --------
    >>> print(printable("a\x1b[2Jb"))
    a\x1b[2Jb
    """
    return UNSAFE.sub(lambda found: ascii(found[0])[1:-1], text)
