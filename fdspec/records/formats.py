"""The formats that `read_record` knows, most specific first."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from fdspec.records import (
    at2,
    bhrc,
    cosmos,
    csmip,
    csmip_v1,
    cwb,
    esm,
    geonet,
    knet,
    nsmn,
    smc,
    unam,
    written,
)
from fdspec.records.channel import Channel
from fdspec.records.textfile import TextFile


@dataclass(frozen=True)
class Format:
    """A file format that says its own units and time step: how to tell it and how to read it."""

    name: str
    recognises: Callable[[TextFile], bool]
    read: Callable[[TextFile], tuple[Channel, ...]]


FORMATS: Final = tuple(
    Format(module.NAME, module.recognises, module.read)
    for module in (at2, cosmos, csmip, csmip_v1, smc, esm, knet, geonet, cwb, nsmn, unam, bhrc, written)
)
