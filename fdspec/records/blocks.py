"""Files of one block a channel, each under a title of its own."""

from __future__ import annotations

import re
from collections.abc import Callable

from fdspec.records.channel import Channel
from fdspec.records.textfile import TextFile


def read_blocks(
    text: TextFile,
    title: re.Pattern[str],
    expected: str,
    read_block: Callable[[TextFile, int], tuple[Channel, int]],
) -> tuple[Channel, ...]:
    """Read block after block to the end of the file.

    title: matches the first line of a block, and `expected` says so in an error; read_block: takes the file
    and the number of that line, returns the channel and the number of the line behind the block.
    """
    channels: list[Channel] = []
    number = 1
    while number <= len(text.lines):
        if channels and not text.head(number).strip():
            number += 1
            continue
        line = text.head(number)
        if title.match(line) is None:
            raise text.refusal(number, f"expected {expected}, found {line[:60]!r}")
        channel, number = read_block(text, number)
        channels.append(channel)
    return tuple(channels)
