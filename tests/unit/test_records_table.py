"""The table of the records after a sweep is the same however many records are read at once."""

from __future__ import annotations

from pathlib import Path

import pytest

from fdspec.cli import outcome
from tests.cubes import synthetic_cube


def test_records_are_told_alike_one_by_one_and_together(monkeypatch: pytest.MonkeyPatch) -> None:
    cube = synthetic_cube()
    together = outcome.summary(cube, Path(__file__), 1.0)
    monkeypatch.setattr(outcome, "AT_ONCE", 1)
    assert outcome.summary(cube, Path(__file__), 1.0) == together
    for name in cube["record"].values:
        assert sum(line.startswith(str(name)) for line in together.splitlines()) == 1
