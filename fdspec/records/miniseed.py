"""miniSEED, through obspy, which only this reader needs: pip install 'fdspec[miniseed]'."""

from __future__ import annotations

import io
import re
import warnings
from importlib import import_module
from typing import Any, Final

import numpy as np

from fdspec.errors import RecordError
from fdspec.records.channel import Channel
from fdspec.records.given import Given
from fdspec.records.units import to_si

NAME: Final = "miniSEED"

_FIRST_RECORD: Final = re.compile(rb"[0-9 \0]{6}[DRQM][ \0]")


def recognises(content: bytes) -> bool:
    """Say whether the content starts with a data record of miniSEED."""
    return _FIRST_RECORD.match(content) is not None


def read(content: bytes, name: str, given: Given) -> tuple[Channel, ...]:
    """Read one channel a trace; its unit must be given, for the file has none."""
    unit = given.units
    if unit is None:
        raise RecordError(
            f"{name}: miniSEED does not say the unit of its numbers: give units when they are acceleration; "
            "raw counts have to be corrected for the instrument first"
        )
    traces = _traces(content, name)
    identifiers = [trace.id for trace in traces]
    channels = []
    for trace in traces:
        if identifiers.count(trace.id) > 1:
            raise RecordError(
                f"{name}: channel {trace.id} has a gap or an overlap; expected one unbroken trace"
            )
        dt = float(trace.stats.delta)
        values = np.asarray(trace.data)
        if values.dtype.kind not in "iuf" or values.size < 2 or not 0.0 < dt < np.inf:
            raise RecordError(f"{name}: channel {trace.id} has no samples of numbers with a time step")
        channels.append(
            Channel(
                name=trace.id,
                acceleration=to_si(values.astype(np.float64), unit),
                dt=dt,
                units=unit,
                station=trace.stats.station,
                component=trace.stats.channel,
            )
        )
    if not channels:
        raise RecordError(f"{name}: there is no trace in the file")
    return tuple(channels)


def _traces(content: bytes, name: str) -> list[Any]:
    try:
        obspy = import_module("obspy")
    except ImportError as error:
        raise RecordError(f"{name}: miniSEED needs obspy: pip install 'fdspec[miniseed]'") from error
    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore"
        )  # damaged blocks are warned of, then left out: the count below shows it
        try:
            stream = obspy.read(io.BytesIO(content), format="MSEED")
        except Exception as error:  # a damaged file makes obspy raise nearly anything
            reason = " ".join(str(error).split())[:200]
            raise RecordError(f"{name}: obspy cannot read this as miniSEED ({reason})") from error
    return list(stream)
