"""Unit, step and quantity of a block: what headings, header and caller say, and that they agree."""

from __future__ import annotations

from typing import Final

from fdspec.records import vocabulary as words
from fdspec.records.block import Block
from fdspec.records.given import Given
from fdspec.records.headings import Heading
from fdspec.records.textfile import TextFile
from fdspec.records.units import KNOWN

STEP_TOLERANCE: Final = 1e-3
"""Relative; a header's rate or step may be rounded: 409.8 a second for 0.00244 s."""

SHORT_HEADER: Final = 6
"""Lines; in a longer one a unit in brackets may be of anything."""

GIVE_UNITS: Final = f"give units, one of {', '.join(KNOWN)}"


def refuse_other_quantities(text: TextFile, block: Block) -> None:
    """Refuse rows without headings when the words above say that they are no acceleration over time."""
    said = block.stated.mentioned
    others = [q for q in (words.SPECTRAL, words.VELOCITY, words.DISPLACEMENT) if q in said]
    measured = {unit.quantity for _, unit, _ in block.stated.units}
    accelerates = words.ACCELERATION in said or words.ACCELERATION in measured
    if words.SPECTRAL in said and not block.stated.steps:
        line = min(said[words.SPECTRAL])
        raise text.refusal(line, "these are spectral amplitudes: expected acceleration over time")
    if others and not accelerates:
        line = min(said[others[0]])
        raise text.refusal(line, f"this is {others[0]}: expected acceleration over time")
    if measured and not accelerates:
        line, unit, phrase = block.stated.units[0]
        raise text.refusal(
            line, f"{phrase!r} is a unit of {unit.quantity}: expected one of acceleration, over time"
        )


def unit_of_column(text: TextFile, block: Block, heading: Heading | None, given: Given) -> str:
    """Return the unit of a column of acceleration: its heading's, else the header's, else the one given."""
    if heading is not None and heading.unit is not None and heading.unit.quantity == words.ACCELERATION:
        return _agreed(text, block.heading_line, f"the heading {heading.text!r}", heading.unit.name, given)
    if heading is not None and (heading.contradiction or heading.unit_text):
        told = heading.unit_text or heading.text
        if heading.unit_text:
            raise text.refusal(
                block.heading_line,
                f"the heading {heading.text!r} says {told!r}, which is no unit of acceleration",
            )
        if given.units is None:
            raise text.refusal(
                block.heading_line,
                f"the heading {heading.text!r} names a unit of another quantity: {GIVE_UNITS}",
            )
        text.take(
            block.heading_line, f"{heading.text!r}: its unit is overruled by the one given, {given.units}"
        )
        return given.units
    said = [entry for entry in block.stated.units if entry[1].quantity == words.ACCELERATION]
    bracketed = block.stated.bracketed if len(block.header) <= SHORT_HEADER else []
    stated = {unit.name: (line, phrase) for line, unit, phrase in said or bracketed}
    own = {
        h.unit.name
        for h in block.headings or ()
        if h.unit is not None and h.unit.quantity == words.ACCELERATION
    }
    if not stated and len(own) == 1:
        return _agreed(text, block.heading_line, "a heading beside it", own.pop(), given)
    if len(stated) > 1:
        if given.units in stated:
            return str(given.units)
        says = " and ".join(f"{name} (line {line})" for name, (line, _) in sorted(stated.items()))
        raise text.refusal(
            None, f"the file contradicts itself on the unit of acceleration, {says}: {GIVE_UNITS}"
        )
    if stated:
        ((name, (line, phrase)),) = stated.items()
        text.take(line, f"{phrase!r}: unit of acceleration {name}")
        return _agreed(text, line, f"line {line}", name, given)
    if given.units is not None:
        text.take(None, f"unit of acceleration {given.units}, as given")
        return given.units
    others = [(line, phrase) for line, unit, phrase in block.stated.units]
    if others:
        line, phrase = others[0]
        raise text.refusal(line, f"{phrase!r} is no unit of acceleration: {GIVE_UNITS}")
    raise text.refusal(None, f"the file does not say the unit of acceleration: {GIVE_UNITS}")


def _agreed(text: TextFile, line: int, where: str, unit: str, given: Given) -> str:
    if given.units is not None and given.units != unit:
        raise text.refusal(line, f"units are given as {given.units}, but {where} says {unit}")
    return unit


def stated_step(text: TextFile, block: Block, given: Given) -> float | None:
    """Return the step that header or caller say, s, None when neither does; refuse two that differ."""
    if unclear := [(line, phrase) for line, step, phrase in block.stated.steps if step is None]:
        if given.dt is None:
            line, phrase = unclear[0]
            raise text.refusal(line, f"{phrase!r} is no time step in s of an accelerogram: give dt")
        text.take(unclear[0][0], f"{unclear[0][1]!r}: passed over, dt is given")
        return given.dt
    steps = [(line, step, phrase) for line, step, phrase in block.stated.steps if step is not None]
    if not steps:
        return given.dt
    line, step, phrase = min(
        steps, key=lambda entry: len(repr(entry[1]))
    )  # the one with fewest digits is no quotient
    for other_line, other, other_phrase in steps:
        if abs(other - step) > STEP_TOLERANCE * step:
            raise text.refusal(
                other_line,
                f"{other_phrase!r} contradicts line {line}, {phrase!r}: {other:.6g} s and {step:.6g} s",
            )
    text.take(line, f"{phrase!r}: time step {step:.10g} s")
    if given.dt is not None and abs(given.dt - step) > 1e-6 * step:
        raise text.refusal(line, f"dt is given as {given.dt!r} s, but the file says {step!r} s")
    return step


def check_count(text: TextFile, block: Block, found: int, what: str) -> None:
    """Refuse a count in the header that is not the number of rows or values that are there."""
    if not block.stated.counts:
        return
    for line, count, phrase in block.stated.counts:
        if count == found:
            text.take(line, f"{phrase!r}: number of {what}, as found")
            return
    line, count, phrase = block.stated.counts[0]
    raise text.refusal(
        block.table.last, f"expected {count} {what}, as line {line} says ({phrase!r}), but found {found}"
    )


def remarks(block: Block) -> tuple[str, ...]:
    """Return what was passed over among the rows, for the history."""
    lines = block.table.remarks
    if not lines:
        return ()
    shown = "; ".join(f"line {number}: {line!r}" for number, line in lines[:3])
    more = f" and {len(lines) - 3} more" if len(lines) > 3 else ""
    return (f"on reading, lines among the rows that hold no numbers were passed over: {shown}{more}",)
