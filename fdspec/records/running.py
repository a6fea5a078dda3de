"""One series of values, any number a row, that runs on along the rows."""

from __future__ import annotations

from fdspec.records.block import Block
from fdspec.records.channel import Channel
from fdspec.records.given import Given
from fdspec.records.origin import origin_of
from fdspec.records.series import check_count, refuse_other_quantities, remarks, stated_step, unit_of_column
from fdspec.records.textfile import TextFile
from fdspec.records.units import to_si


def read_running(text: TextFile, block: Block, given: Given) -> Channel:
    """Read one channel; unit and step must stand above, or be given."""
    table = block.table
    refuse_other_quantities(text, block)
    check_count(text, block, table.values.size, "values")
    unit = unit_of_column(text, block, None, given)
    step = stated_step(text, block, given)
    if step is None:
        raise text.refusal(None, "the file does not say the time step: give dt, in s")
    text.take(
        table.first,
        f"to line {table.last}: {table.values.size} values of acceleration in {unit}, {table.width} a row",
    )
    event, station, component = origin_of(text, block)
    return Channel(
        component,
        to_si(table.values, unit),
        step,
        unit,
        event=event,
        station=station,
        component=component,
        processing=remarks(block),
    )
