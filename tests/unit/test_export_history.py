"""A history as tables: a row for each time, never times storey times transition."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from fdspec import store
from fdspec.cli import main
from tests.cubes import synthetic_history


def rows(path: Path) -> list[dict[str, str]]:
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


@pytest.mark.parametrize("storeys", [1, 3])
def test_a_row_for_each_time(tmp_path: Path, storeys: int) -> None:
    history = synthetic_history(samples=40, storeys=storeys, transitions=70)
    store.export(history, tmp_path / "h.csv")
    table = rows(tmp_path / "h.csv")
    assert len(table) == 40
    assert [float(row["time"]) for row in table] == history.time.values.tolist()
    for k in range(storeys):
        column = f"drift_{k + 1}" if storeys > 1 else "drift"
        assert [float(row[column]) for row in table] == history.drift.values[:, k].tolist()
    heading = [line for line in (tmp_path / "h.csv").read_text().splitlines() if line.startswith("#")]
    peaks = ", ".join(map(repr, history.peak_drift.values.tolist()))
    assert any(line.startswith("# peak_drift [m] ") and line.endswith(peaks) for line in heading)
    changes = rows(tmp_path / "h-transitions.csv")
    assert [float(row["transition_time"]) for row in changes] == history.transition_time.values.tolist()
    assert list(changes[0]) == ["transition_time", "transition_storey", "transition_phase"]


def test_neither_file_is_replaced_unasked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "h.nc"
    store.save(synthetic_history(), source)
    (tmp_path / "h-transitions.csv").write_text("mine")
    assert main(["export", str(source), "-o", str(tmp_path / "h.csv")]) == 2
    assert "h-transitions.csv exists already" in capsys.readouterr().err
    assert not (tmp_path / "h.csv").exists()
    assert main(["export", str(source), "-o", str(tmp_path / "h.csv"), "--force"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        str(tmp_path / "h.csv"),
        str(tmp_path / "h-transitions.csv"),
    ]
