"""Files pass the CF checker without error or warning."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from fdspec import store
from tests.cubes import synthetic_building_cube, synthetic_cube, synthetic_history

CHECKER = Path(sys.executable).with_name("compliance-checker")


def complaints(path: Path, report: Path) -> list[str]:
    """Return what the checker has to say, each with its section."""
    command = [
        CHECKER,
        "--test",
        "cf:1.11",
        "--criteria",
        "strict",
        "--format",
        "json",
        "--output",
        report,
        path,
    ]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert report.exists(), run.stderr
    result = json.loads(report.read_text(encoding="utf-8"))["cf:1.11"]
    assert result["possible_points"] > 0
    return [
        f"{check['name']}: {text}"
        for priority in ["high_priorities", "medium_priorities", "low_priorities"]
        for check in result[priority]
        for text in check["msgs"]
    ]


@pytest.mark.parametrize(
    "dataset",
    [
        synthetic_cube(),
        synthetic_building_cube(),
        synthetic_history(),
        synthetic_history(transitions=0, storeys=1),
    ],
    ids=["cube", "cube of buildings", "history", "history without transitions"],
)
def test_saved_files(tmp_path, dataset):
    path = tmp_path / "file.nc"
    store.save(dataset, path)
    assert complaints(path, tmp_path / "report.json") == []


def test_exported_files(tmp_path):
    path = tmp_path / "file.nc"
    store.export(synthetic_cube(), path, record="FSR1")
    assert complaints(path, tmp_path / "report.json") == []


def test_the_checker_complains_where_it_should(tmp_path):
    path = tmp_path / "file.nc"
    synthetic_cube().to_netcdf(path)
    assert complaints(path, tmp_path / "report.json")
