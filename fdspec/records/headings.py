"""The heading of a column: which quantity stands below it, in which unit.

A heading is words or a symbol, and perhaps a unit: in brackets, after a comma, a slash, an underscore, "in"
or a blank. What could be read in two ways, such as V for vertical or velocity, is settled by its neighbours.
"""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass, replace
from typing import Final

from fdspec.records import vocabulary as words
from fdspec.records.units import Unit, unit_of

MAX_HEADING: Final = 120
"""Characters of one heading that are looked at."""

_BRACKETS: Final = re.compile(r"[(\[{<]([^()\[\]{}<>]*)[)\]}>]")
_BOUNDARY: Final = re.compile(r"\bin\b|[,/_:;=-]|\s")
_NOT_MEASURED: Final = re.compile(
    r"counts?|digits?|bits?|lsb|dn|volts?|m?v|mv|raw|adc|units?", re.IGNORECASE | re.ASCII
)
_SYMBOL: Final = re.compile(rf"(a|v|d|u|x|y|z|g|w|s)[_ ]?(g|gr|t|{words.AXIS[3:-1]})?(?:\(t\))?", re.ASCII)
_TWICE_DERIVED: Final = re.compile(r"[uxyzdvw]g?_?(?:g_?)?(?:''|\"|ddot|_?tt|pp)|d2[uxyz]g?/dt2?", re.ASCII)
_ONCE_DERIVED: Final = re.compile(r"[uxyzdw]g?_?(?:g_?)?(?:'|dot)|d[uxyz]g?/dt", re.ASCII)
_CLEAR_DIRECTIONS: Final = frozenset(
    [
        "ns",
        "ew",
        "ud",
        "n-s",
        "e-w",
        "u-d",
        "e",
        "z",
        "l",
        "r",
        "h1",
        "h2",
        "up",
        "north",
        "east",
        "vert",
        "vertical",
        "hne",
        "hnn",
        "hnz",
        "long",
        "trans",
    ]
)


@dataclass(frozen=True)
class Heading:
    """One heading: as written, its name without the unit, and what it was taken for.

    `other` is another reading of a symbol, "" when there is none. `unit_text` is what stands where a unit
    should when it is none that is known. `contradiction` says that words and unit name different quantities.
    """

    text: str
    name: str
    quantity: str
    unit: Unit | None = None
    unit_text: str = ""
    other: str = ""
    subscript: bool = False
    contradiction: bool = False

    @property
    def said(self) -> str:
        """Quantity and unit in words."""
        unit = self.unit.name if self.unit else self.unit_text
        return f"{self.quantity} in {unit}" if unit else self.quantity


def heading_of(cell: str) -> Heading:
    """Return what one heading means by itself."""
    text = " ".join(cell.strip(' \t\r#%!*"`').split())[:MAX_HEADING]
    if text.startswith("'"):  # two behind a symbol derive it
        text = text.strip("'")
    unit: Unit | None = None
    unit_text = ""
    rest = text
    for match in list(_BRACKETS.finditer(text))[::-1]:
        found = unit_of(match[1].strip().removeprefix("in ").removeprefix("unit: ").removeprefix("units: "))
        if found is not None and unit is not None and found != unit and found.quantity == unit.quantity:
            unit_text = f"{match[1]} and {unit.name}"
        elif found is not None and unit is None and not _is_argument(text, match):
            unit = found
        elif _NOT_MEASURED.fullmatch(match[1].strip()):
            unit_text = match[1].strip()
        elif not re.fullmatch(r"\s*(?:[a-z]{1,3}|[NSEWUDZ-]{1,3}|\d+)?\s*", match[1]):
            continue
        else:
            if _is_argument(text, match):
                continue
            if match[1].strip():
                continue
        rest = rest[: match.start()] + " " + rest[match.end() :]
    rest = " ".join(rest.split())
    subscript = False
    if unit is None and not unit_text:
        rest, unit, subscript = _unit_behind(rest)
    name = rest.strip(" ,/:;-=([")
    quantity, other = _quantity(name)
    if unit is None and not name and text:
        unit = unit_of(text)
    if unit_text:
        unit = None
    heading = Heading(text, name or text, quantity, unit, unit_text, other, subscript)
    return _with_unit(heading)


def _is_argument(text: str, bracket: re.Match[str]) -> bool:
    """Say whether a bracket holds the argument of a function, a(t), and no unit."""
    return bracket[1].strip() == "t" and bracket.start() > 0 and text[bracket.start() - 1].isalpha()


def _unit_behind(text: str) -> tuple[str, Unit | None, bool]:
    """Return the words before a unit, the unit, and whether it may be a subscript: a_g."""
    whole = unit_of(text)
    if whole is not None and not _symbol(text)[0]:
        return "", whole, False
    for boundary in _BOUNDARY.finditer(text):
        before, behind = text[: boundary.start()].strip(), text[boundary.end() :].strip(" .")
        if not before or not behind:
            continue
        if boundary[0] == "_":
            behind = behind.replace("_", "/") if behind.count("_") == 1 and "s2" in behind else behind
            # acc_cm_s2 and acc_cms2 are what programs make of cm/s2.
            behind = re.sub(r"^(m|cm|mm|in|ft)(s|sec)2$", r"\1/\g<2>2", behind, flags=re.IGNORECASE)
        if boundary[0] == "-" and words.quantity_of(before) in {words.DIRECTION, words.UNKNOWN}:
            continue  # N-S is no N in seconds
        unit = unit_of(behind)
        if unit is not None:
            short = boundary[0] == "_" and bool(_symbol(before)[0])
            return before, unit, short and behind.casefold() in {"g", "s", "m"}
    return text, None, False


def _symbol(name: str) -> tuple[str, str]:
    """Return quantity, and the other reading, of a symbol; "" when the name is none."""
    decomposed = unicodedata.normalize("NFD", name)
    letters = [char for char in decomposed if char.isalpha()]
    if len(letters) <= 2 and "\u0308" in decomposed:
        return words.ACCELERATION, ""
    if len(letters) <= 2 and "\u0307" in decomposed:
        return words.VELOCITY, ""
    small = words.plain(name).replace(" ", "")
    if _TWICE_DERIVED.fullmatch(small):
        return words.ACCELERATION, ""
    if _ONCE_DERIVED.fullmatch(small):
        return words.VELOCITY, ""
    single = {
        "t": (words.TIME, words.PERIOD if name == "T" else words.DIRECTION),
        "f": (words.FREQUENCY, ""),
        "k": (words.SAMPLE, ""),
        "i": (words.SAMPLE, ""),
        "j": (words.SAMPLE, ""),
        "tn": (words.PERIOD, ""),
        "n": (
            words.SAMPLE if name == "n" else words.DIRECTION,
            words.DIRECTION if name == "n" else words.SAMPLE,
        ),
        "v": (words.VELOCITY, words.DIRECTION),
        "u": (words.DISPLACEMENT, words.DIRECTION),
        "d": (words.DISPLACEMENT, words.DIRECTION),
        "x": (words.DISPLACEMENT, words.DIRECTION),
        "y": (words.DISPLACEMENT, words.DIRECTION),
        "z": (words.DISPLACEMENT, words.DIRECTION),
        "s": (words.UNKNOWN, ""),
        "g": (words.UNKNOWN, ""),
        "w": (words.UNKNOWN, words.DIRECTION),
    }
    if small in single:
        return single[small]
    match = _SYMBOL.fullmatch(small)
    if match is None or small in {"dt", "dx", "ut", "wn"}:
        return "", ""
    meanings = {
        "a": (words.ACCELERATION, ""),
        "v": (words.VELOCITY, words.DIRECTION if match[2] in {"1", "2", "3"} else ""),
        "d": (words.DISPLACEMENT, ""),
        "u": (words.DISPLACEMENT, ""),
        "g": (words.OTHER, ""),  # of a gyroscope
        "w": (words.OTHER, ""),
    }
    return meanings.get(match[1], ("", ""))


def _quantity(name: str) -> tuple[str, str]:
    quantity, other = _symbol(name)
    if quantity:
        return quantity, other
    found = words.quantity_of(name)
    # "Beschleunigung a" and "Zeit t" say a word and its symbol.
    return found, ""


def _with_unit(heading: Heading) -> Heading:
    """Settle words and unit that say different things."""
    unit, said = heading.unit, heading.quantity
    if unit is None or heading.subscript:
        return heading
    if said in {words.SPECTRAL, words.OTHER}:
        return heading
    if said == words.PERIOD:
        return replace(heading, contradiction=unit.quantity != words.TIME)
    if said == unit.quantity:
        return heading if heading.other == words.PERIOD else replace(heading, other="")
    if said in {words.DIRECTION, words.UNKNOWN, words.SAMPLE} or heading.other:
        if said == words.TIME and heading.other == words.PERIOD and unit.quantity == words.TIME:
            return heading
        return replace(heading, quantity=unit.quantity, other="")
    if said == words.TIME and unit.quantity == words.ACCELERATION:  # "time series (g)"
        return replace(heading, quantity=words.ACCELERATION)
    return replace(heading, contradiction=True)


_SECONDS_UNDERSCORED: Final = re.compile(r"_\s*(?:s|sec|ms)$", re.IGNORECASE)
_UNDERSCORED: Final = re.compile(r"_[^\s()\[\]{},;]+$")
"""A heading that ends with what may be a unit behind an underscore."""


def row_of(cells: list[str]) -> list[Heading]:
    """Return the headings of a row of cells, each settled with the help of its neighbours."""
    headings = [heading_of(cell) for cell in cells]
    sure = [h for h in headings if h.unit is not None and not h.subscript]
    by_underscore = any(_SECONDS_UNDERSCORED.search(h.text) for h in sure) or any(
        h.subscript and h.text.casefold() == "t_s" for h in headings
    )
    # H1_G beside V_G, or acc_g beside v_g: what is surely a unit for one is so for the other.
    units = {h.unit for h in sure if _UNDERSCORED.search(h.text)}
    headings = [_settled_subscript(h, by_underscore or h.unit in units) for h in headings]
    accelerates = any(h.quantity == words.ACCELERATION for h in headings)
    clear = any(
        (h.quantity == words.DIRECTION and not h.other) or set(words.tokens(h.name)) & _CLEAR_DIRECTIONS
        for h in headings
    )
    axes = sum(h.name.casefold() in {"x", "y", "z"} for h in headings) >= 2
    settled = []
    for k, heading in enumerate(headings):
        new = heading
        if heading.other == words.DIRECTION and not accelerates and heading.unit is None:
            is_axis = axes and heading.name.casefold() in {"x", "y", "z"}
            first_time = k == 0 and heading.quantity == words.TIME
            if (clear or is_axis) and not first_time:
                new = replace(heading, quantity=words.DIRECTION, other="")
        elif heading.text == "T" and k > 0 and clear and not accelerates:
            new = replace(heading, quantity=words.DIRECTION, other="")
        elif heading.quantity == words.DIRECTION and heading.other == words.SAMPLE:
            new = (
                replace(heading, other="")
                if clear or not accelerates
                else replace(heading, quantity=words.SAMPLE)
            )
        settled.append(new)
    return settled


def _settled_subscript(heading: Heading, by_underscore: bool) -> Heading:
    """Believe a_g to be a in g where a neighbour is t_s; else it may be the ground's acceleration."""
    if not heading.subscript:
        return heading
    if by_underscore:
        return _with_unit(replace(heading, subscript=False))
    return replace(heading, unit=None, subscript=False, name=heading.text)


def is_unit_row(cells: list[str]) -> bool:
    """Say whether every cell is a unit, or says that there is none."""
    found = 0
    for cell in cells:
        inner = cell.strip().strip("()[]{}<>").strip()
        if unit_of(inner) is not None:
            found += 1
        elif inner not in {"", "-", "--", "#"} and not _NOT_MEASURED.fullmatch(inner):
            return False
    return found > 0
