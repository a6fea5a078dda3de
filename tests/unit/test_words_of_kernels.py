"""Kernels have one word for a thing: those of the page for developers, and none of those they replaced."""

from __future__ import annotations

import io
import keyword
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]

REPLACED = {
    "calm": "no_new_peak",
    "crest": "bound",
    "crests": "deferred",
    "kick": "onset",
    "loose": "spring_only",
    "piece": "segment",
    "pieces": "segments",
    "quiet": "uneventful",
    "shelf": "plans",
    "swift": "closed form",
    "walk": "take_step",
    "walks": "eventful",
}
"""Word that no identifier of a kernel may have in it -> what it is called now."""


def identifiers(source: str) -> Iterator[str]:
    """Return every name in a module's source."""
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.NAME and not keyword.iskeyword(token.string):
            yield token.string


def words(identifier: str) -> set[str]:
    """Return the words of a name, as of ``has_no_new_peak`` or ``TensionBrace``."""
    return {word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+", identifier)}


def replaced(source: str) -> dict[str, str]:
    """Return the names that have a replaced word in them, with the word in its place."""
    return {
        name: REPLACED[word] for name in identifiers(source) for word in sorted(words(name) & REPLACED.keys())
    }


def test_no_kernel_has_a_replaced_word() -> None:
    found = {
        path.relative_to(ROOT).as_posix(): names
        for folder in ("kernels", "engines", "compiler")
        for path in sorted((ROOT / "fdspec" / folder).rglob("*.py"))
        if (names := replaced(path.read_text(encoding="utf-8")))
    }
    assert found == {}


def test_a_replaced_word_is_found_wherever_it_stands() -> None:
    source = "def is_calm(KICK):\n    wholePiece = KICK  # walk\n    return 'shelf'\n"
    assert replaced(source) == {"is_calm": "no_new_peak", "KICK": "onset", "wholePiece": "segment"}


def test_no_replaced_word_is_defined() -> None:
    page = (ROOT / "docs" / "developers.md").read_text(encoding="utf-8")
    defined = re.findall(r"^\| ([^|]+) \|", page.partition("## Words")[2], flags=re.MULTILINE)
    assert "onset" in defined
    assert not set(defined) & REPLACED.keys()
