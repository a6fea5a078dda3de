"""read_record: any supported file, recognised by its content."""

from __future__ import annotations

import os
from pathlib import Path

from fdspec.motion import GroundMotion, positive_number
from fdspec.records import text as columns
from fdspec.records.channel import Channel
from fdspec.records.formats import FORMATS
from fdspec.records.textfile import TextFile, decode, read_bytes
from fdspec.records.units import unit_named


def read_record(
    path: str | os.PathLike[str],
    *,
    channel: str | None = None,
    units: str | None = None,
    dt: float | None = None,
    name: str | None = None,
) -> GroundMotion:
    """Read a ground motion from a file; its format is recognised by content, not by its ending.

    Parameters
    ----------
    path : path
        The file.
    channel : str, optional
        Which channel, when the file has several; without it such a file is refused and the text names them.
    units : {"g", "m/s2", "cm/s2", "mm/s2"}, optional
        Unit of acceleration of a file that does not say it; "gal" is cm/s2.
    dt : float, optional
        Time step of a file that does not say it, s.
    name : str, optional
        Name of the motion, else the file's name without ending.

    Returns
    -------
    GroundMotion
        In m/s2, with event, station and component as far as the file says; what the agency did to the samples
        opens its history.

    Raises
    ------
    RecordError
        When the file is damaged, of unknown format, or does not fit the arguments; with file and line.
    InvalidInput
        When an argument cannot be used at all.
    """
    unit = None if units is None else unit_named(units)
    step = None if dt is None else positive_number("dt", dt, "s")
    file = Path(path)
    text = decode(read_bytes(file), file.name)
    format_name, channels = _channels(text, unit, step)
    chosen = _choose(text, channels, channel)
    which = format_name if len(channels) == 1 else f"{format_name}, channel {chosen.name}"
    return GroundMotion(
        chosen.acceleration,
        chosen.dt,
        file.stem if name is None else name,
        event=chosen.event,
        station=chosen.station,
        component=chosen.component,
        source=f"{file.name} ({which})",
        history=chosen.processing,
    )


def _channels(text: TextFile, unit: str | None, dt: float | None) -> tuple[str, tuple[Channel, ...]]:
    for known in FORMATS:
        if known.recognises(text):
            channels = known.read(text)
            _agree(text, channels, unit, dt)
            return known.name, channels
    if text.name.lower().endswith(".at2"):
        # Some sites give their own layouts PEER's ending; what the header means there is anybody's guess.
        expected = "expected 'ACCELERATION TIME HISTORY IN UNITS OF G'"
        third = text.line(3, expected).strip()[:60]
        raise text.refusal(
            3, f"the ending says PEER AT2, but the content does not: {expected}, found {third!r}"
        )
    if columns.recognises(text):
        return columns.NAME, columns.read(text, units=unit, dt=dt)
    names = ", ".join(known.name for known in FORMATS)
    found = text.lines[0].strip()[:60]
    raise text.refusal(
        1, f"the format is not recognised: expected {names} or columns of numbers, found {found!r}"
    )


def _agree(text: TextFile, channels: tuple[Channel, ...], unit: str | None, dt: float | None) -> None:
    """Refuse an argument that contradicts what the file says of itself."""
    for channel in channels:
        if unit is not None and unit != channel.units:
            raise text.refusal(None, f"units are given as {unit}, but the file is in {channel.units}")
        if dt is not None and abs(dt - channel.dt) > 1e-6 * channel.dt:
            raise text.refusal(None, f"dt is given as {dt!r} s, but the file says {channel.dt!r} s")


def _choose(text: TextFile, channels: tuple[Channel, ...], wanted: str | None) -> Channel:
    if wanted is None:
        if len(channels) == 1:
            return channels[0]
        listed = ", ".join(repr(channel.name) for channel in channels)
        raise text.refusal(None, f"the file has {len(channels)} channels: give channel, one of {listed}")
    found = [channel for channel in channels if channel.name.casefold() == wanted.strip().casefold()]
    if len(found) != 1:
        listed = ", ".join(repr(channel.name) for channel in channels)
        raise text.refusal(None, f"there is no channel {wanted!r}: it has {listed}")
    return found[0]
