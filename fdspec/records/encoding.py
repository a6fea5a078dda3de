"""From bytes to characters: which encoding a record file is in, and what ends its lines."""

from __future__ import annotations

import codecs
from typing import Final

from fdspec.errors import RecordError
from fdspec.records.vocabulary import has_known_word

_MARKS: Final = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),  # before UTF-16, whose mark it begins with
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_REGIONAL: Final = (
    "gb18030", "shift_jis", "euc_jp", "big5", "euc_kr", "cp1251", "koi8-r", "cp1253", "cp1254",
)  # fmt: skip
"""Encodings that are told from Latin-1 only by the words they give."""

_HEAD: Final = 20_000
"""Bytes in which a regional encoding must show a word that is known."""


def decoded(content: bytes, name: str) -> tuple[str, str]:
    """Return the characters of a file, its lines ended by line feeds, and the name of its encoding.

    Raises
    ------
    RecordError
        When the file is binary: null bytes other than those that pad its end.
    """
    encoding = _wide_or_marked(content)
    if encoding is None:
        content = content.rstrip(b"\0\x1a \t\r\n\f")
        if b"\0" in content:
            raise RecordError(f"{name}: this is a binary file; expected text")
        encoding = _narrow(content)
    try:
        text = content.decode(encoding)
    except UnicodeDecodeError as error:
        raise RecordError(f"{name}: is not the {encoding} text that it begins as ({error.reason})") from error
    text = text.rstrip("\0\x1a \t\r\n\f")
    if "\0" in text:
        raise RecordError(f"{name}: this is a binary file; expected text")
    if "\r" in text:
        text = text.replace("\r\r\n", "\n").replace("\r\n", "\n").replace("\r", "\n")
    return text, encoding.removesuffix("-sig")


def _wide_or_marked(content: bytes) -> str | None:
    for mark, encoding in _MARKS:
        if content.startswith(mark):
            return encoding
    # UTF-16 without its mark: every other byte of Latin text is zero.
    middle = len(content) // 4 * 2
    for part in (content[:400], content[middle : middle + 400]):  # headings may be Greek, rows are not
        if len(part) < 8:
            continue
        even, odd = part[0::2], part[1::2]
        if odd.count(0) > 0.9 * len(odd) and even.count(0) < 0.1 * len(even):
            return "utf-16-le"
        if even.count(0) > 0.9 * len(even) and odd.count(0) < 0.1 * len(odd):
            return "utf-16-be"
    return None


def _narrow(content: bytes) -> str:
    if content.isascii():
        return "ascii"
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        pass
    else:
        return "utf-8"
    head = content[:_HEAD]
    head = head[: head.rfind(b"\n") + 1] or head
    for encoding in _REGIONAL:
        try:
            words = head.decode(encoding)
            if has_known_word(words) and content.decode(encoding):
                return encoding
        except UnicodeDecodeError:
            continue
    return "latin-1"
