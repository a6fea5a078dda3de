"""Text for people: made safe for a terminal, names of variables as words, numbers cut to what tells."""

from __future__ import annotations

import re
import textwrap
from typing import Final

UNSAFE: Final = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f"  # what moves the cursor, sets titles, answers questions; not tab, newline
    "\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069"  # what turns the direction of writing, or starts a line
    "\ud800-\udfff]"  # halves of characters, as in paths that are no UTF-8: they cannot be printed at all
)


LONG: Final = re.compile(r"(?<![\w.])\d+\.\d+(?:[eE][+-]?\d+)?(?![\w.]*\w)")
"""A number with a decimal point that stands alone: not part of a version, a name or a checksum."""


UNPARTED: Final = re.compile(r"(?<=\d) (?=(?:\d{3}|%|kN|MN|mm|kg|m/s2|ms|s|g|t)(?!\w))")
"""Between a number and its unit, or its own thousands."""


def lines_of(text: str, width: int, *, first: str = "", rest: str = "") -> list[str]:
    """Return running text in lines; `first` and `rest` begin them, and no number is parted from its unit.

    Examples
    --------
    >>> lines_of("the response is within 5 % of it", 24)
    ['the response is within', '5 % of it']
    """
    lines = textwrap.wrap(
        UNPARTED.sub("\u00a0", text),
        width,
        initial_indent=first,
        subsequent_indent=rest,
        break_on_hyphens=False,
        break_long_words=False,
    )
    return [line.replace("\u00a0", " ") for line in lines]


def in_words(name: str) -> str:
    """Return the name of a variable, an axis or a status as words.

    Examples
    --------
    >>> in_words("stiffness_ratio")
    'stiffness ratio'
    """
    return name.replace("_", " ")


def rounded(text: str) -> str:
    """Return the text with its decimal numbers to six digits, as many as a reader takes in.

    Examples
    --------
    >>> rounded("scaled by 1.6280035485758506 to a PGA of 3.38329425 m/s2")
    'scaled by 1.628 to a PGA of 3.38329 m/s2'
    """
    return LONG.sub(lambda found: f"{float(found[0]):.6g}", text)


def printable(text: str) -> str:
    r"""Return the text with everything that a terminal would act on written as Python writes it.

    Examples
    --------
    >>> print(printable("a\x1b[2Jb"))
    a\x1b[2Jb
    """
    return UNSAFE.sub(lambda found: ascii(found[0])[1:-1], text)
