"""read_record: any supported file, recognised by its content."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import numpy as np

from fdspec.errors import InvalidInput, RecordError
from fdspec.model.motion import GroundMotion
from fdspec.model.number_check import positive_number
from fdspec.records import miniseed
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
        opens its history. A file of `fdspec records convert` with the ending .txt brings back its history.

    Raises
    ------
    RecordError
        When the file is damaged, of unknown format, or does not fit the arguments; with file and line.
    InvalidInput
        When an argument cannot be used at all.
    """
    format_name, channels = _load(path, units, dt)
    return _motion(Path(path), format_name, channels, _choose(Path(path), channels, channel), name)


def read_channels(
    path: str | os.PathLike[str], *, units: str | None = None, dt: float | None = None
) -> dict[str, GroundMotion]:
    """Read every channel of a file; the keys are what `read_record` takes as `channel`.

    Arguments and errors are those of `read_record`.
    """
    format_name, channels = _load(path, units, dt)
    return {channel.name: _motion(Path(path), format_name, channels, channel, None) for channel in channels}


def _load(
    path: str | os.PathLike[str], units: str | None, dt: float | None
) -> tuple[str, tuple[Channel, ...]]:
    unit = None if units is None else unit_named(units)
    step = None if dt is None else positive_number("dt", dt, "s")
    name = Path(path).name
    content = read_bytes(path)
    with np.errstate(over="ignore", invalid="ignore"):  # what overflows is refused when it is made a motion
        if miniseed.recognises(content):
            format_name, channels = miniseed.NAME, miniseed.read(content, name, unit)
        else:
            format_name, channels = _read_text(decode(content, name), unit, step)
    _refuse_contradictions(name, channels, unit, step)
    return format_name, _distinct(channels)


def _read_text(text: TextFile, unit: str | None, dt: float | None) -> tuple[str, tuple[Channel, ...]]:
    for known in FORMATS:
        if known.recognises(text):
            return known.name, known.read(text)
    if text.name.lower().endswith(".at2"):
        # Some sites give their own layouts PEER's ending; what the header means there is anybody's guess.
        expected = "expected 'ACCELERATION TIME HISTORY IN UNITS OF G'"
        third = text.line(3, expected).strip()[:60]
        raise text.refusal(
            3, f"the ending says PEER AT2, but the content does not: {expected}, found {third!r}"
        )
    if columns.recognises(text):
        return columns.NAME, columns.read(text, units=unit, dt=dt)
    names = ", ".join([known.name for known in FORMATS] + [miniseed.NAME])
    found = text.lines[0].strip()[:60]
    raise text.refusal(
        1, f"the format is not recognised: expected {names} or columns of numbers, found {found!r}"
    )


def _refuse_contradictions(
    name: str, channels: tuple[Channel, ...], unit: str | None, dt: float | None
) -> None:
    """Refuse an argument that contradicts what the file says of itself."""
    for channel in channels:
        if unit is not None and unit != channel.units:
            raise RecordError(f"{name}: units are given as {unit}, but the file is in {channel.units}")
        if dt is not None and abs(dt - channel.dt) > 1e-6 * channel.dt:
            raise RecordError(f"{name}: dt is given as {dt!r} s, but the file says {channel.dt!r} s")


def _distinct(channels: tuple[Channel, ...]) -> tuple[Channel, ...]:
    """Return the channels with names that differ: those without one, or with another's, are numbered."""
    names = [channel.name.casefold() for channel in channels]
    numbered = []
    for k, channel in enumerate(channels, start=1):
        unique = channel.name and names.count(channel.name.casefold()) == 1
        numbered.append(channel if unique else replace(channel, name=f"{channel.name} ({k})".strip()))
    return tuple(numbered)


def _choose(file: Path, channels: tuple[Channel, ...], wanted: str | None) -> Channel:
    if wanted is None and len(channels) == 1:
        return channels[0]
    listed = ", ".join(repr(channel.name) for channel in channels)
    if wanted is None:
        raise RecordError(
            f"{file.name}: the file has {len(channels)} channels: give channel, one of {listed}"
        )
    for channel in channels:
        if channel.name.casefold() == wanted.strip().casefold():
            return channel
    raise RecordError(f"{file.name}: there is no channel {wanted!r}: it has {listed}")


def _motion(
    file: Path, format_name: str, channels: tuple[Channel, ...], channel: Channel, name: str | None
) -> GroundMotion:
    which = format_name if len(channels) == 1 else f"{format_name}, channel {channel.name}"
    try:
        return GroundMotion(
            channel.acceleration,
            channel.dt,
            file.stem if name is None else name,
            event=channel.event,
            station=channel.station,
            component=channel.component,
            source=", made from ".join(filter(None, (f"{file.name} ({which})", channel.source))),
            history=channel.processing,
            scale_factor=channel.scale_factor,
        )
    except InvalidInput as error:  # numbers that fit the format and still make no motion
        raise RecordError(f"{file.name}: {error}") from error
