"""read_record: any supported file, recognised by its content."""

from __future__ import annotations

import os
import re
import warnings
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from fdspec.errors import InvalidInput, RecordError
from fdspec.model.motion import GroundMotion
from fdspec.records.channel import Channel
from fdspec.records.formats import BINARY_FORMATS, FORMATS
from fdspec.records.given import Given, given
from fdspec.records.resampling import at_equal_steps
from fdspec.records.textfile import TextFile, decode, read_bytes

_BEGINS_AS_ROW: Final = re.compile(r"\s*[\"']?[+-]?[\d.]")

LIKE_G: Final = (0.02, 0.8)
"""Peaks of strong motions in g; in m/s2 they would hardly be felt."""

MANY: Final = 100
"""Samples from which a motion is no sketch."""


@dataclass(frozen=True)
class Reading:
    """A file that was read: format, what each line and column was taken for, motions by channel."""

    format_name: str
    taken: tuple[str, ...]
    motions: dict[str, GroundMotion]


def read_record(
    path: str | os.PathLike[str],
    *,
    channel: str | None = None,
    units: str | None = None,
    dt: float | None = None,
    name: str | None = None,
    skip: int | None = None,
    layout: str | None = None,
    resample_to: float | None = None,
) -> GroundMotion:
    """Read a ground motion from a file; its format is recognised by content, not by its ending.

    Parameters
    ----------
    path : path
        The file.
    channel : str, optional
        Which channel, when the file has several; without it such a file is refused and the text names them.
    units : str, optional
        Unit of acceleration of a file that does not say it: g, m/s2, cm/s2, mm/s2, gal, mgal, mg, %g, ft/s2
        or in/s2, in any spelling.
    dt : float, optional
        Time step of a file that does not say it, s.
    name : str, optional
        Name of the motion, else the file's name without ending.
    skip : int, optional
        Lines above the first row of numbers, for a header that misleads; what they state is not believed
        then, but headings of columns are.
    layout : {"columns", "rows"}, optional
        Whether several numbers a row are as many columns, or one series that runs on along the rows, for a
        file that does not show it.
    resample_to : float, optional
        Step, s, to which samples at unequal times are interpolated, on the lines between them.

    Returns
    -------
    GroundMotion
        In m/s2, with event, station and component as far as the file says; what the agency did to the samples
        opens its history. A file of `fdspec records convert` with the ending .txt brings back its history.

    Raises
    ------
    RecordError
        When the file is damaged, of unknown format, holds no acceleration over time, or does not fit the
        arguments; with file and line, and what to give where that helps.
    InvalidInput
        When an argument cannot be used at all.
    """
    file = Path(path)
    options = given(units, dt, skip, layout, resample_to)
    format_name, _, channels = _load(path, options)
    chosen = _choose(file, channels, channel)
    motion = _motion(
        file, format_name, channels, at_equal_steps(file.name, chosen, options.resample_to), name
    )
    if options.units == "m/s2" and motion.n >= MANY and LIKE_G[0] < motion.pga < LIKE_G[1]:
        warnings.warn(
            f"{file.name}: units are given as m/s2 and the peak is {motion.pga:.4g}: the numbers look like g",
            UserWarning,
            stacklevel=2,
        )
    return motion


def read_channels(
    path: str | os.PathLike[str],
    *,
    units: str | None = None,
    dt: float | None = None,
    skip: int | None = None,
    layout: str | None = None,
    resample_to: float | None = None,
) -> dict[str, GroundMotion]:
    """Read every channel of a file; the keys are what `read_record` takes as `channel`.

    Arguments and errors are those of `read_record`.
    """
    return read_file(path, units=units, dt=dt, skip=skip, layout=layout, resample_to=resample_to).motions


def read_file(
    path: str | os.PathLike[str],
    *,
    units: str | None = None,
    dt: float | None = None,
    skip: int | None = None,
    layout: str | None = None,
    resample_to: float | None = None,
) -> Reading:
    """Read every channel of a file, and say what each line and column was taken for.

    Arguments and errors are those of `read_record`. The notes of an error (PEP 678) say what was taken for
    what before it.
    """
    file = Path(path)
    options = given(units, dt, skip, layout, resample_to)
    format_name, taken, channels = _load(path, options)
    motions = {
        channel.name: _motion(
            file, format_name, channels, at_equal_steps(file.name, channel, options.resample_to), None
        )
        for channel in channels
    }
    return Reading(format_name, taken, motions)


def _load(path: str | os.PathLike[str], options: Given) -> tuple[str, tuple[str, ...], tuple[Channel, ...]]:
    name = Path(path).name
    content = read_bytes(path)
    taken: list[str] = []
    with np.errstate(over="ignore", invalid="ignore"):  # what overflows is refused when it is made a motion
        for known in BINARY_FORMATS:
            if known.recognises(content):
                format_name, channels = known.name, known.read(content, name, options)
                break
        else:
            text = decode(content, name)
            del content  # the characters are enough
            taken = text.taken
            try:
                format_name, channels = _read_text(text, options)
                _refuse_contradictions(name, channels, options)
            except RecordError as error:
                for note in taken:
                    error.add_note(note)
                raise
    _refuse_contradictions(name, channels, options)
    return format_name, tuple(taken), _distinct(channels)


def _read_text(text: TextFile, options: Given) -> tuple[str, tuple[Channel, ...]]:
    if options.skip is None:
        for known in FORMATS:
            if known.recognises(text):
                text.take(None, f"format: {known.name}")
                return known.name, known.read(text)
    from fdspec.records import (
        text as rows_of_text,
    )  # its patterns take longer to compile than a record to read

    if options.skip is not None or rows_of_text.recognises(text):
        text.take(None, f"format: {rows_of_text.NAME}")
        return rows_of_text.NAME, rows_of_text.read(text, options)
    names = ", ".join([known.name for known in FORMATS] + [known.name for known in BINARY_FORMATS])
    odd = next((k for k, head in enumerate(text.heads(1, 200), start=1) if _BEGINS_AS_ROW.match(head)), None)
    if odd is not None:
        found = text.head(odd).strip()[:60]
        raise text.refusal(
            odd, f"the format is not recognised: expected {names} or rows of numbers, found {found!r}"
        )
    found = text.head(1).strip()[:60]
    raise text.refusal(
        1, f"the format is not recognised: expected {names} or rows of numbers, found {found!r}"
    )


def _refuse_contradictions(name: str, channels: tuple[Channel, ...], options: Given) -> None:
    """Refuse an argument that contradicts what the file says of itself."""
    for channel in channels:
        if options.units is not None and options.units != channel.units:
            raise RecordError(
                f"{name}: units are given as {options.units}, but the file is in {channel.units}"
            )
        if options.dt is not None and abs(options.dt - channel.dt) > 1e-6 * channel.dt:
            raise RecordError(f"{name}: dt is given as {options.dt!r} s, but the file says {channel.dt!r} s")


def _distinct(channels: tuple[Channel, ...]) -> tuple[Channel, ...]:
    """Return the channels with names that differ: those without one, or with another's, are numbered."""
    names = [" ".join(channel.name.split()).casefold() for channel in channels]
    counts = {name: names.count(name) for name in set(names)}
    numbered = []
    for k, channel in enumerate(channels, start=1):
        name = " ".join(channel.name.split())
        unique = name and counts[name.casefold()] == 1
        numbered.append(replace(channel, name=name if unique else f"{name} ({k})".strip()))
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
        if channel.name.casefold() == " ".join(wanted.split()).casefold():
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
