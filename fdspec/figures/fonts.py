"""Glyphs for names in other scripts: a font that has them where there is one, else the name in ASCII."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, findfont, fontManager
from matplotlib.ft2font import FT2Font
from matplotlib.text import Text

FIRST_TRIED: Final = (
    "Noto Sans CJK JP", "Noto Sans CJK SC", "Noto Sans JP", "Noto Sans SC", "Source Han Sans",
    "Microsoft YaHei",
    "SimHei", "PingFang SC", "Hiragino Sans", "Yu Gothic", "MS Gothic", "Malgun Gothic", "WenQuanYi Zen Hei",
    "WenQuanYi Micro Hei", "IPAexGothic", "TakaoGothic", "Droid Sans Fallback", "Arial Unicode MS",
)  # fmt: skip
"""Families without serifs, before any other that has the glyphs."""


def give_glyphs(figure: Figure) -> None:
    """Give every text of a figure a family that has its glyphs; where there is none, write it in ASCII."""
    for text in figure.findobj(Text):
        missing = missing_glyphs(text.get_text(), text.get_fontproperties())
        if not missing:
            continue
        family = family_with(missing)
        if family is None:
            text.set_text(in_ascii(text.get_text(), missing))
        else:
            text.set_fontfamily([*text.get_fontfamily(), family])


def missing_glyphs(words: str, properties: FontProperties) -> str:
    """Return the characters of a text that its fonts have no glyph for, sorted, each once."""
    characters = {char for char in words if ord(char) > 0x7E}
    if not characters:
        return ""
    for family in properties.get_family():
        one = properties.copy()
        one.set_family(family)
        characters -= _held(findfont(one), "".join(sorted(characters)))
    return "".join(sorted(characters))


@lru_cache(maxsize=64)
def family_with(characters: str) -> str | None:
    """Return a family that has a glyph for each of these characters, None when none has."""
    rank = {family: k for k, family in enumerate(FIRST_TRIED)}
    entries = sorted(fontManager.ttflist, key=lambda entry: (rank.get(entry.name, len(rank)), entry.name))
    for entry in entries:
        if entry.style == "normal" and len(_held(entry.fname, characters)) == len(characters):
            return str(entry.name)
    return None


@lru_cache(maxsize=1024)
def _held(path: str, characters: str) -> frozenset[str]:
    """Return those of the characters that a font file has glyphs for."""
    try:
        font = FT2Font(path)
    except (OSError, RuntimeError):  # a font that went since the list was made, or one that cannot be read
        return frozenset()
    return frozenset(char for char in characters if font.get_char_index(ord(char)))


def in_ascii(words: str, missing: str) -> str:
    r"""Return a text with those characters as their escapes: 汶川 becomes \u6c76\u5ddd."""
    return "".join(
        char.encode("ascii", "backslashreplace").decode("ascii") if char in missing else char
        for char in words
    )
