"""SAC, binary, through obspy, which only this reader and miniSEED's need: pip install 'fdspec[miniseed]'."""

from __future__ import annotations

import io
import struct
import warnings
from importlib import import_module
from typing import Final

import numpy as np

from fdspec.errors import RecordError
from fdspec.records.channel import Channel
from fdspec.records.given import Given
from fdspec.records.units import to_si

NAME: Final = "SAC"
HEADER: Final = 632
"""Bytes before the samples: 70 reals, 40 integers, 24 texts of 8 characters."""

COUNT, VERSION, FILE_TYPE, QUANTITY, EVEN = 79, 76, 85, 86, 105
"""Words of the header."""

TIME_SERIES: Final = 1
_OTHERS: Final = {6: "displacement", 7: "velocity"}


def recognises(content: bytes) -> bool:
    """Say whether the header has SAC's version, and the file the length that the header counts."""
    return _order(content) is not None


def _order(content: bytes) -> str | None:
    if len(content) < HEADER + 8:
        return None
    for order in "<>":
        (version,) = struct.unpack_from(f"{order}i", content, 4 * VERSION)
        (count,) = struct.unpack_from(f"{order}i", content, 4 * COUNT)
        if version in {6, 7} and 2 <= count <= len(content):
            return order
    return None


def read(content: bytes, name: str, given: Given) -> tuple[Channel, ...]:
    """Read the one channel; its unit must be given, for SAC says none that programs keep to."""
    order = _order(content)
    if order is None:
        raise RecordError(f"{name}: this is no SAC file")

    def word(k: int) -> int:
        return int(struct.unpack_from(f"{order}i", content, 4 * k)[0])

    if word(FILE_TYPE) != TIME_SERIES:
        raise RecordError(f"{name}: expected a time series, SAC's file type 1, found type {word(FILE_TYPE)}")
    if word(QUANTITY) in _OTHERS:
        raise RecordError(f"{name}: SAC says that this is {_OTHERS[word(QUANTITY)]}: expected acceleration")
    if word(EVEN) != 1:
        raise RecordError(f"{name}: expected samples at equal steps, which SAC's header denies")
    count = word(COUNT)
    if len(content) < HEADER + 4 * count:
        raise RecordError(f"{name}: expected {count} samples, as the header says, but the file ends before")
    if given.units is None:
        raise RecordError(
            f"{name}: SAC does not say the unit of its numbers: give units when they are acceleration; "
            "raw counts have to be corrected for the instrument first"
        )
    try:
        obspy = import_module("obspy")
    except ImportError as error:
        raise RecordError(f"{name}: SAC needs obspy: pip install 'fdspec[miniseed]'") from error
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            (trace,) = obspy.read(io.BytesIO(content), format="SAC")
        except Exception as error:  # a damaged file makes obspy raise nearly anything
            reason = " ".join(str(error).split())[:200]
            raise RecordError(f"{name}: obspy cannot read this as SAC ({reason})") from error
    values = np.asarray(trace.data, dtype=np.float64)
    # The step is kept in single precision; its shortest decimal is what was meant.
    dt = float(str(np.float32(struct.unpack_from(f"{order}f", content, 0)[0])))
    if values.size != count or not 0.0 < dt < np.inf:
        raise RecordError(
            f"{name}: expected {count} samples with a time step, found {values.size} and {dt!r} s"
        )
    return (
        Channel(
            name=trace.id,
            acceleration=to_si(values, given.units),
            dt=dt,
            units=given.units,
            station=trace.stats.station,
            component=trace.stats.channel,
        ),
    )
