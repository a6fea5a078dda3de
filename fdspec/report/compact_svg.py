"""SVG of a picture in a quarter of its bytes; nothing moves by more than 1/200 of a point.

Matplotlib writes every corner of a line in absolute coordinates of six decimals, and an element for every dot
and every bar. A record of a minute has thousands of each.
"""

from __future__ import annotations

import re
from typing import Final

GRID: Final = 100
"""Steps of a point, 1/72 in: a corner moves by 1/14 400 in at most, less than any printer's dot."""

FEWEST: Final = 8
"""Equal marks in a row that are written as one path."""

PATH: Final = re.compile(r' d="([^"]*)"')

STEP: Final = re.compile(r"([MLQCz])([^MLQCz]*)")

MARKS: Final = re.compile(
    rf'(?:[ \t]*<use xlink:href="#(?P<of>\w+)" x="[^"]*" y="[^"]*" style="(?P<style>[^"]*)"/>\n)'
    rf'(?:[ \t]*<use xlink:href="#(?P=of)" x="[^"]*" y="[^"]*" style="(?P=style)"/>\n){{{FEWEST - 1},}}'
)

BARS: Final = re.compile(
    r'(?:[ \t]*<path d="M[^MQC"]*z\n?"(?P<look>[^>]*)/>\n)'
    rf'(?:[ \t]*<path d="M[^MQC"]*z\n?"(?P=look)/>\n){{{FEWEST - 1},}}'
)

BAR: Final = re.compile(r'<path d="([^"]*)"')

SEE_THROUGH: Final = "opacity"

EDGE: Final = re.compile(r"fill: (#\w+); stroke: (?!\1)")
"""Of a bar with an edge of another colour than its own."""

PLACE: Final = re.compile(r' x="([^"]*)" y="([^"]*)"')


def compact(svg: str) -> str:
    """Return matplotlib's SVG, lines in relative coordinates, equal marks or bars in a row as one path.

    Parameters
    ----------
    svg : str
        As matplotlib's backend writes it.

    Returns
    -------
    str
        The same picture: every corner and mark is there, rounded to 1/100 pt; of marks that then stand on one
        another one is left.
    """
    joined = BARS.sub(_bars, MARKS.sub(_marks, svg))
    return re.sub(r"\n\s*", "\n", PATH.sub(lambda found: f' d="{_relative(found[1])}"', joined))


def _relative(path: str) -> str:
    """Write a path of matplotlib's steps, M, L, Q, C and z, relative to where each begins."""
    written, at, start = "", (0, 0), (0, 0)
    for kind, told in STEP.findall(path):
        if kind == "z":
            written, at = f"{written}z", start
            continue
        numbers = [round(GRID * float(one)) for one in told.split()]
        end = (numbers[-2], numbers[-1])
        moved = [number - at[k % 2] for k, number in enumerate(numbers)]
        written += _line(*moved) if kind == "L" else f"{kind.lower()}{_joined(moved)}"
        at = end
        if kind == "M":
            start = at
    return written


def _line(across: int, down: int) -> str:
    """Write the step of a line, in the grid's steps."""
    if down == 0:
        return f"h{_joined([across])}" if across else ""
    return f"l{_joined([across, down])}" if across else f"v{_joined([down])}"


def _bars(found: re.Match[str]) -> str:
    """Write bars of one look as one path, unless edges or opacity would show where two overlap."""
    if SEE_THROUGH in found["look"] or EDGE.search(found["look"]):
        return found[0]
    return f'<path d="{" ".join(BAR.findall(found[0]))}"{found["look"]}/>\n'


def _marks(found: re.Match[str]) -> str:
    """Write marks in a row as one path that shows nothing but a mark at each corner."""
    if SEE_THROUGH in found["style"]:
        return found[0]
    places = [f"{x} {y}" for x, y in PLACE.findall(found[0])]
    rounded = {tuple(round(GRID * float(one)) for one in place.split()): place for place in places}
    name = f"{found['of']}-{found.start()}"
    path = f"M {' L '.join(rounded.values())}"
    return (
        f'<marker id="{name}" overflow="visible" markerUnits="userSpaceOnUse">'
        f'<use xlink:href="#{found["of"]}" style="{found["style"]}"/></marker>\n'
        f'<path d="{path}" style="fill: none; stroke: none; marker: url(#{name})"/>\n'
    )


def _joined(numbers: list[int]) -> str:
    """Write numbers of the grid with no more signs than it takes to tell them apart."""
    text = ""
    for number in numbers:
        one = f"{number / GRID:.2f}".rstrip("0").rstrip(".")
        one = re.sub(r"^(-?)0\.", r"\1.", one)
        text += one if not text or one.startswith("-") else f" {one}"
    return text
