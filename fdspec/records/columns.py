"""Columns with headings, or without: which is time, which are accelerations, each in its own unit."""

from __future__ import annotations

from fractions import Fraction
from typing import Final

import numpy as np

from fdspec.records import vocabulary as words
from fdspec.records.block import Block
from fdspec.records.channel import Channel
from fdspec.records.given import Given
from fdspec.records.headings import Heading
from fdspec.records.layout import counts_rows
from fdspec.records.origin import origin_of
from fdspec.records.rows import Table, always_rises, printed_times, rises
from fdspec.records.series import (
    STEP_TOLERANCE,
    check_count,
    refuse_other_quantities,
    remarks,
    stated_step,
    unit_of_column,
)
from fdspec.records.textfile import TextFile
from fdspec.records.time_step import PrintedTimes, refuse_backward_steps, uniform_step
from fdspec.records.units import to_si

NO_MOTION: Final = frozenset({words.PERIOD, words.FREQUENCY, words.SPECTRAL})
WHOLE_STEP: Final = 1.0
"""s; times without a unit that step by as much may be ms, samples or s."""


def read_columns(text: TextFile, block: Block, given: Given) -> tuple[Channel, ...]:
    """Read one channel for each column of acceleration."""
    table = block.table
    if table.ragged is not None or table.short_last:
        line = table.ragged or table.last
        found = len(table.dialect.numbers(text.lines[line - 1]) or [])
        raise text.refusal(line, f"expected {table.width} columns as in line {table.first}, found {found}")
    headings = block.headings or [Heading("", "", words.UNKNOWN)] * table.width
    for k, heading in enumerate(block.headings or ()):
        text.take(block.heading_line, f"heading of column {k + 1}, {heading.text!r}: {heading.said}")
    if block.headings is None or table.width == 1:
        refuse_other_quantities(text, block)
    check_count(text, block, table.rows, "rows")
    time = _time_column(text, block, headings, given)
    chosen = _accelerations(text, block, headings, time, given)
    step, times, refusal = _step(text, block, headings, time, given)
    event, station, component = origin_of(text, block)
    names = _names(block, headings, chosen)
    channels = []
    for k, name in zip(chosen, names, strict=True):
        unit = unit_of_column(text, block, headings[k] if block.headings else None, given)
        said = f"{headings[k].text!r}: " if headings[k].text else ""
        text.take(
            block.heading_line or None, f"column {k + 1}, {said}acceleration in {unit}, channel {name!r}"
        )
        channels.append(
            Channel(
                name,
                to_si(np.ascontiguousarray(table.columns[:, k]), unit),
                step,
                unit,
                event=event,
                station=station,
                component=name if len(chosen) > 1 else component,
                processing=_processing(block, headings[k], unit),
                times=times,
                refusal=refusal,
            )
        )
    for k, heading in enumerate(headings):
        if k not in chosen and k != time and block.headings:
            text.take(block.heading_line, f"column {k + 1}, {heading.text!r}: {heading.said}, passed over")
    return tuple(channels)


def _time_column(text: TextFile, block: Block, headings: list[Heading], given: Given) -> int | None:
    table = block.table
    if block.headings is None:
        return _first_column_of_times(text, block, given)
    said = [k for k, heading in enumerate(headings) if heading.quantity == words.TIME]
    if len(said) > 1:
        first = table.columns[:, said[0]]
        if any((table.columns[:, k] != first).any() for k in said[1:]):
            shown = " and ".join(repr(headings[k].text) for k in said)
            raise text.refusal(
                block.heading_line, f"expected one column of times, found {shown}, which differ"
            )
    if said:
        return said[0]
    if (
        headings[0].text == ""
        and table.width > 1
        and not _numbers_rows(text, table, 0)
        and rises(table.columns[:, 0])
    ):
        return 0  # a row of headings for the accelerations alone
    return None


def _numbers_rows(text: TextFile, table: Table, column: int) -> bool:
    return counts_rows(table, column, printed_times(text, table, column).decimals)


def _first_column_of_times(text: TextFile, block: Block, given: Given) -> int | None:
    """Return the column of times among columns without headings."""
    table = block.table
    if table.width == 1:
        return None
    time = None
    if rises(table.columns[:, 0]):
        time = 0
        if _numbers_rows(text, table, 0):
            step = given.dt or next((step for _, step, _ in block.stated.steps if step is not None), None)
            if step is None:
                raise text.refusal(
                    table.first,
                    "the first column, 0, 1, 2, ... without a heading, counts rows or seconds: give dt",
                )
            if step != WHOLE_STEP:
                text.take(None, "column 1 counts the rows")
                time = 1 if table.width > 2 and rises(table.columns[:, 1]) else -1
    for k in range(table.width):
        if k not in {0, time} and table.rows >= 10 and always_rises(table.columns[:, k]):
            raise text.refusal(
                table.first,
                f"column {k + 1} rises like times, but no heading says so: give the columns headings",
            )
    return time


def _accelerations(
    text: TextFile, block: Block, headings: list[Heading], time: int | None, given: Given
) -> list[int]:
    """Return the columns of acceleration, or refuse rows that have none over time."""
    if block.headings is None:
        skip = {time} if time is None or time >= 0 else {0}
        if time is not None and time > 0:
            skip |= {0}
        return [k for k in range(block.table.width) if k not in skip]
    _refuse_spectra(text, block, headings, time)
    explicit = [
        k
        for k, h in enumerate(headings)
        if h.quantity == words.ACCELERATION and not _raw(h) and not _is_magnitude(block, h, k)
    ]
    if explicit:
        return explicit
    others = {words.VELOCITY, words.DISPLACEMENT, words.OTHER}
    units = {unit.quantity for _, unit, _ in block.stated.units}
    mislabelled = words.ACCELERATION in block.stated.mentioned and given.units is not None
    stated = words.ACCELERATION in units or words.ACCELERATION in block.stated.mentioned
    directions = [
        k
        for k, h in enumerate(headings)
        if k != time
        and not _raw(h)
        and (h.quantity == words.DIRECTION or (h.quantity == words.UNKNOWN and stated and h.text))
    ]
    if mislabelled and not directions:
        directions = [
            k for k, h in enumerate(headings)
            if k != time and h.quantity in others and words.quantity_of(h.name) == words.DIRECTION
        ]  # fmt: skip
    if directions:
        if block.stated.mentioned and words.ACCELERATION not in block.stated.mentioned:
            refuse_other_quantities(text, block)
        return directions
    said = ", ".join(f"{heading.text!r} ({heading.said})" for heading in headings)
    raise text.refusal(block.heading_line, f"no heading says acceleration: {said}")


def _is_magnitude(block: Block, heading: Heading, column: int) -> bool:
    """Say whether an absolute acceleration is the length of a vector, which is never negative."""
    absolute = any(word.startswith("abs") for word in words.tokens(heading.name))
    return absolute and bool((block.table.columns[:, column] >= 0.0).all())


def _raw(heading: Heading) -> bool:
    return bool(heading.unit_text)


def _refuse_spectra(text: TextFile, block: Block, headings: list[Heading], time: int | None) -> None:
    found = [h for h in headings if h.quantity in NO_MOTION]
    accelerates = any(h.quantity == words.ACCELERATION for h in headings)
    doubtful = time is not None and headings[time].other == words.PERIOD
    if found and (time is None or doubtful or not accelerates):
        raise text.refusal(
            block.heading_line, f"{found[0].text!r} is a {found[0].quantity}: expected acceleration over time"
        )
    spectral = words.SPECTRAL in block.stated.mentioned
    if spectral and (time is None or doubtful) and not block.stated.steps:
        line = min(block.stated.mentioned[words.SPECTRAL])
        raise text.refusal(line, "these are spectral amplitudes: expected acceleration over time")
    if doubtful:
        columns = block.table.columns
        values = columns[:, [k for k in range(columns.shape[1]) if k != time]]
        if not ((values > 0.0).any() and (values < 0.0).any()):
            raise text.refusal(
                block.heading_line,
                f"{headings[time or 0].text!r} may be time or period, and no value is negative: write which",
            )


def _step(
    text: TextFile, block: Block, headings: list[Heading], time: int | None, given: Given
) -> tuple[float, np.ndarray | None, str]:
    """Return the step, or the times of unequal steps with the text that refuses them."""
    stated = stated_step(text, block, given)
    if time is None or time < 0:
        if stated is None:
            raise text.refusal(None, "there is no column of times: give dt, in s")
        return stated, None, ""
    heading = headings[time]
    unit = heading.unit.factor if heading.unit is not None and heading.unit.quantity == words.TIME else None
    times = printed_times(text, block.table, time)
    if unit is None and given.dt is None and stated is None:
        _refuse_whole_steps(text, block, times)
    size = unit or _size(times, stated)
    where = f"column {time + 1}" + (f", {heading.text!r}" if heading.text else "")
    try:
        step = uniform_step(text, times, given.dt, size)
    except Exception as error:
        if given.resample_to is None and given.dt is None:
            refuse_backward_steps(text, times)
        if given.resample_to is None or given.dt is not None:
            raise
        refuse_backward_steps(text, times)
        seconds = times.values * float(size)
        text.take(block.heading_line or None, f"{where}: time, at unequal steps")
        return float(np.median(np.diff(seconds))), seconds, str(error)
    if stated is not None and given.dt is None:
        if abs(stated - step) > max(STEP_TOLERANCE * step, 0.0):
            line, _, phrase = block.stated.steps[0]
            raise text.refusal(line, f"{phrase!r} says {stated:.6g} s, but the times step by {step:.6g} s")
        step = stated if abs(stated - step) <= 1e-9 * step else step
    text.take(block.heading_line or None, f"{where}: time{_in_units(size)}, step {step:.10g} s")
    return step, None, ""


def _in_units(size: Fraction) -> str:
    names = {Fraction(1): "s", Fraction(1, 1000): "ms", Fraction(60): "min", Fraction(1, 10**6): "us"}
    return f" in {names.get(size, f'{float(size):g} s')}"


def _size(times: PrintedTimes, stated: float | None) -> Fraction:
    """Return the unit of times that say none: s, or ms where the stated step shows it."""
    step = float(times.values[-1] - times.values[0]) / (len(times.values) - 1)
    if stated is not None and step >= 1.0 and abs(step / 1000.0 - stated) <= STEP_TOLERANCE * stated:
        return Fraction(1, 1000)
    return Fraction(1)


def _refuse_whole_steps(text: TextFile, block: Block, times: PrintedTimes) -> None:
    step = float(times.values[-1] - times.values[0]) / (len(times.values) - 1)
    if step >= WHOLE_STEP and times.decimals <= 0:
        raise text.refusal(
            block.heading_line or block.table.first,
            f"the times step by {step:g} and have no unit (s, ms, samples?): give dt, or write it there",
        )


def _names(block: Block, headings: list[Heading], chosen: list[int]) -> list[str]:
    """Return the names of the accelerations: those of their headings, else listed above, else numbers."""
    names = [" ".join(headings[k].name.split()) for k in chosen]
    if all(names) and len(set(names)) == len(names):
        return names
    for _, listed in block.stated.components:
        if len(listed) == len(chosen) and len(set(listed)) == len(listed):
            return listed
    return [str(k + 1) for k in range(len(chosen))]


def _processing(block: Block, heading: Heading, unit: str) -> tuple[str, ...]:
    steps = remarks(block)
    if heading.contradiction:
        steps += (f"on reading, taken in {unit}, as given, although its heading is {heading.text!r}",)
    return steps
