"""What commands print for people: labels in words, numbers no longer than a reader takes in."""

import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import fdspec
from fdspec import store
from fdspec.cli import main
from fdspec.cli.commands import COMMANDS
from fdspec.cli.records import COMMANDS as RECORD_COMMANDS
from fdspec.figures.inelastic import plot_fragility, plot_ida
from fdspec.figures.labels import axis_label
from fdspec.measures.dynamic_curves import ida_curves
from fdspec.measures.fragility import fragility
from fdspec.printable import rounded
from tests.cubes import synthetic_building_cube, synthetic_cube

FILE = re.compile(r"\S*(?:/|\.(?:nc|csv|html|AT2|at2|txt|toml|png)\b)\S*")
CHECKSUM = re.compile(r"\b(?=\d*[a-f])[0-9a-f]{12,}\b")
SNAKE = re.compile(r"\b[A-Za-z]\w*_\w+")
NUMBER = re.compile(r"(?<![\w.])\d+\.\d+")
DIGITS = 6


def faults(text: str) -> list[str]:
    """Return labels of programs, and numbers of more digits than tell anything; files have any name."""
    text = CHECKSUM.sub("", FILE.sub("", text))
    long = [one for one in NUMBER.findall(text) if len(one.replace(".", "").strip("0")) > DIGITS]
    return SNAKE.findall(text) + long


SHOWN = {
    "simulate": "simulate --record FSR1 --period 0.5 --stiffness-ratio 4 --pretension 100e3 -o h.nc",
    "sweep": "sweep study.toml -o swept.nc",
    "claims": "claims a.nc",
    "summary": "summary cube.nc",
    "combine": "combine a.nc b.nc -o both.nc",
    "check": "check cube.nc",
    "fragility": "fragility cube.nc --demand peak_displacement --limit 0.0125 --hazard hazard.csv",
    "choose": "choose --record FSR1 --limit acceleration=0.5g --limit drift=20mm",
    "figures": "figures a.nc --list",
    "spectra": "spectra FSR1 --period 0.5,1.0",
    "export": "export cube.nc --record FSR1 -o one.csv",
    "records list": "records list",
    "records show": "records show FSR1",
    "records check": "records check .",
    "records convert": "records convert FSR1 --pga-g 0.123456789 -o fsr1.at2",
    "records link": "records link FSR1 kakogawa.AT2",
    "records unlink": "records unlink",
    "records figures": "records figures -o pictures --format png",
}
"""One call of each command that prints for people."""

SILENT = {"explore", "verify", "records"}
"""A server; the package's own tests, a minute long; a group."""


def risk_cube() -> xr.Dataset:
    """Return demands of 20 records over intensity, lognormal, for two pretensions."""
    random = np.random.default_rng(3)
    levels = np.array([0.25, 0.5, 1.0, 1.5, 2.0, 3.0])
    capacity = 1.2 * np.exp(0.4 * random.normal(size=(2, 20, 1)))
    demand = (("pretension", "record", "intensity"), 0.02 * levels / capacity, {"units": "m"})
    cube = xr.Dataset(
        {"peak_displacement": demand},
        {"pretension": [12345.678901, 2e4], "record": [f"r{k}" for k in range(20)], "intensity": levels},
    )
    cube["pretension"].attrs["units"] = "N"
    return cube.assign_coords(pga=("record", np.linspace(1.0, 4.0, 20), {"units": "m/s^2"}))


@pytest.fixture(scope="module")
def cubes() -> dict[str, xr.Dataset]:
    """Sweep 3 records over intensity, and two of them alone; numbers of many digits on every axis."""
    axes = {"period": [0.3, 0.6123456789], "pretension": [20e3, 50123.456789], "stiffness_ratio": [1.0, 4.0]}
    motions = [fdspec.load_record(name) for name in ("FSR1", "FMR1", "FHR1")]
    return {
        "cube": fdspec.sweep(motions, **axes, intensity=[0.1, 0.2, 0.3, 0.31, 0.33, 0.4, 1.0]),
        "a": fdspec.sweep(motions[:1], **axes),
        "b": fdspec.sweep(motions[1:2], **axes),
    }


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, cubes: dict[str, xr.Dataset]) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("FDSPEC_RECORDS", str(tmp_path / "links.toml"))
    for name, cube in cubes.items():
        store.save(cube, f"{name}.nc")
    store.save(synthetic_cube(["FSR1"], (2, 3, 4)), "random.nc")  # its statuses are of every kind
    store.save(synthetic_building_cube(["a", "b"]), "buildings.nc")
    Path("hazard.csv").write_text("intensity,rate\n0.1,0.01\n0.5,0.001\n2.0,0.0001\n8.0,1e-5\n")
    Path("study.toml").write_text(
        'records = ["FSR1"]\nperiod = [0.3, 0.6123456789]\npretension = [20e3, 50123.456789]\n'
        "stiffness_ratio = [4.0]\n"
    )
    rows = "\n".join(f"{0.345 * np.exp(-0.1 * k) * np.cos(k):.7E}" for k in range(40))
    Path("kakogawa.AT2").write_text(
        "PEER NGA STRONG MOTION DATABASE RECORD\nKOBE 01/16/95 2046, KAKOGAWA, 090\n"
        f"ACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 40, DT= .01 SEC\n{rows}\n"
    )
    return tmp_path


def test_every_command_is_looked_at() -> None:
    every = {*COMMANDS, *(f"records {name}" for name in RECORD_COMMANDS)}
    assert every - SILENT == set(SHOWN)


@pytest.mark.parametrize("name", SHOWN)
def test_labels_are_words_and_numbers_are_short(
    folder: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = SHOWN[name].split()
    main(arguments)
    out, err = capsys.readouterr()
    assert out.strip(), err
    assert not faults(out), out


def test_storeys_of_a_building_too(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["summary", "buildings.nc", "--at", "building=office"]) == 0
    out, _ = capsys.readouterr()
    assert "peak drift" in out
    assert not faults(out), out


def test_statuses_are_words(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["check", "random.nc"])
    out, _ = capsys.readouterr()
    told = out[out.index("statuses") : out.index("numbers")]
    assert "iteration not converged" in told
    assert not faults(told), told


def test_the_check_sees_what_it_is_for() -> None:
    assert faults("pga_g  0.345") == ["pga_g"]
    assert faults("scaled by 1.6280035485758506") == ["1.6280035485758506"]
    assert faults("cube_1.nc: 0.345 of 2e68152d60ee0734e34b658fcb6b9cce") == []


def test_a_result_may_be_named_in_words(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["summary", "cube.nc", "--variable", "peak displacement"]) == 0
    out, _ = capsys.readouterr()
    assert "peak displacement" in out
    assert "peak velocity" not in out


@pytest.mark.parametrize(
    ("text", "short"),
    [
        ("scaled by 1.6280035485758506 to a PGA", "scaled by 1.628 to a PGA"),
        ("at 0.00000123456789 s", "at 1.23457e-06 s"),
        ("version 1.10.123456789 of v2.123456789", "version 1.10.123456789 of v2.123456789"),
        ("4096 samples, 20250101", "4096 samples, 20250101"),
    ],
)
def test_long_numbers_are_cut_and_nothing_else(text: str, short: str) -> None:
    assert rounded(text) == short


def test_measures_stand_at_axes_in_words() -> None:
    assert axis_label("pga", "m/s^2") == "peak ground acceleration, m/s²"
    fit = fragility(risk_cube().isel(pretension=0), demand="peak_displacement", limit=0.02, measure="pga")
    axis = plot_fragility(fit).axes[0]
    assert axis.get_xlabel() == "peak ground acceleration, m/s²"
    assert axis.get_title() == "peak displacement beyond 0.02 m"
    curves = ida_curves(risk_cube().isel(pretension=0), demand="peak_displacement")
    assert plot_ida(curves).axes[0].get_xlabel() == "peak displacement, m"
