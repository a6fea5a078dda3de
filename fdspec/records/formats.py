"""The formats that `read_record` knows, most specific first. A new one is a module and an entry here."""

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
    miniseed,
    nsmn,
    sac,
    smc,
    unam,
    usgs,
    written,
)
from fdspec.records.channel import Channel
from fdspec.records.given import Given
from fdspec.records.textfile import TextFile


@dataclass(frozen=True)
class Format:
    """A text format that says its own units and time step: how to tell it and how to read it."""

    name: str
    recognises: Callable[[TextFile], bool]
    read: Callable[[TextFile], tuple[Channel, ...]]


@dataclass(frozen=True)
class BinaryFormat:
    """A binary format: how to tell it; `read` takes the bytes, the file's name, and what was given."""

    name: str
    recognises: Callable[[bytes], bool]
    read: Callable[[bytes, str, Given], tuple[Channel, ...]]


FORMATS: Final = tuple(
    Format(module.NAME, module.recognises, module.read)
    for module in (at2, cosmos, csmip, csmip_v1, smc, esm, knet, geonet, cwb, nsmn, unam, bhrc, usgs, written)
)

BINARY_FORMATS: Final = tuple(
    BinaryFormat(module.NAME, module.recognises, module.read) for module in (miniseed, sac)
)
