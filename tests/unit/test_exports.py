"""Workbooks, Matlab files and scripts of other programs: read back, or run."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.io

import fdspec
from fdspec import store
from fdspec.cli.main import main
from fdspec.errors import InvalidInput, StoreError
from fdspec.exchange.opensees import opensees_script
from fdspec.exchange.simcenter import simcenter_script
from fdspec.model.building import Building
from fdspec.model.building_file import building_of
from fdspec.model.motion import GroundMotion
from fdspec.model.toml_lines import parsed
from fdspec.store import excel
from tests.cubes import synthetic_building_cube, synthetic_cube, synthetic_history

TWO = """
floor_mass = [20e3, 15e3]
storey_stiffness = [9e6, 7e6]
brace_stiffness = [20e6, 16e6]
brace_mass = [50.0, 40.0]
slip_force = [40e3, 25e3]
damping_ratio = 0.03
storey_height = 3.0
"""


def record(samples: int = 300) -> GroundMotion:
    rng = np.random.default_rng(3)
    shake = np.convolve(rng.standard_normal(samples), np.ones(5) / 5.0, mode="same")
    return GroundMotion(4.0 * shake / np.abs(shake).max(), 0.02, name="shake")


def sheet(path, name):
    openpyxl = pytest.importorskip("openpyxl", reason="openpyxl is in the extra excel")
    book = openpyxl.load_workbook(path, read_only=True)
    head, *rows = [list(row) for row in book[name].iter_rows(values_only=True)]
    book.close()
    return head, rows


def test_a_workbook_holds_every_cell(tmp_path):
    cube = synthetic_building_cube(records=["FSR1", "=1+1"])
    cube["peak_drift"].values[0, 0, 0, 0, 0] = np.nan
    store.export(cube, tmp_path / "cube.xlsx")
    head, rows = sheet(tmp_path / "cube.xlsx", "cube")
    dims = ("record", "building", "stiffness_scale", "slip_scale", "storey")
    assert tuple(head[:5]) == dims
    columns = dict(zip(head, zip(*rows, strict=True), strict=True))
    expected = cube["peak_drift"].transpose(*dims).to_numpy().ravel()
    assert columns["peak_drift"][0] is None
    written = np.array(columns["peak_drift"][1:], float)
    np.testing.assert_allclose(written, expected[1:], rtol=5e-16)  # openpyxl writes 16 digits
    assert set(columns["record"]) == {"FSR1", "=1+1"}  # text, no formula
    assert "inf" in columns["slip_scale"]
    _, about = sheet(tmp_path / "cube.xlsx", "about")
    assert any(line[0].startswith("peak_drift [m]") for line in about)


def test_a_workbook_of_a_history_has_its_changes_of_phase(tmp_path):
    history = synthetic_history()
    store.export(history, tmp_path / "history.xlsx")
    head, rows = sheet(tmp_path / "history.xlsx", "history")
    assert head[0] == "time"
    assert [row[0] for row in rows] == history["time"].values.tolist()
    head, rows = sheet(tmp_path / "history.xlsx", "transitions")
    assert len(rows) == history.sizes["transition"]


def test_a_sheet_that_is_too_small_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(excel, "ROWS", 50)
    with pytest.raises(StoreError, match="72 rows of .* do not fit a sheet, which holds 49"):
        store.export(synthetic_cube(), tmp_path / "cube.xlsx")
    assert not list(tmp_path.iterdir())


def test_without_openpyxl_the_extra_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(StoreError, match=r"pip install 'fdspec\[excel\]'"):
        store.export(synthetic_cube(), tmp_path / "cube.xlsx")


def text_of(value):
    """Return what Matlab holds of a text: no letters are an empty array."""
    return value if isinstance(value, str) else "".join(value)


@pytest.mark.parametrize("given", [synthetic_cube(), synthetic_history()], ids=["cube", "history"])
def test_matlab_files_hold_every_number_to_the_bit(tmp_path, given):
    store.export(given, tmp_path / "given.mat")
    read = scipy.io.loadmat(tmp_path / "given.mat", simplify_cells=True)
    for name, variable in given.variables.items():
        values = np.asarray(read[name], None if variable.dtype.kind in "UTO" else variable.dtype)
        if variable.dtype.kind in "UTO":
            assert np.atleast_1d(values).tolist() == np.atleast_1d(variable.values).tolist()
            continue
        assert values.ravel().tobytes() == np.squeeze(variable.values).ravel().tobytes(), name
        assert text_of(read["dims"][name]) == ", ".join(variable.dims)
        assert text_of(read["units"][name]) == variable.attrs.get("units", "")
    assert read["about"]["title"] == given.attrs["title"]


def test_forms_by_name_and_by_suffix(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    store.save(synthetic_cube(), "cube.nc")
    for form, name in (("csv", "cube.csv"), ("matlab", "cube.mat"), ("excel", "cube.xlsx")):
        assert main(["export", "cube.nc", "--format", form]) == 0
        assert capsys.readouterr().out == f"{name}\n"
        assert Path(name).is_file()
    assert main(["export", "cube.nc", "--format", "netcdf", "--record", "FSR1"]) == 0
    assert main(["export", "cube.nc", "--format", "excel", "-o", "other.csv"]) == 2
    assert "should end in .xlsx" in capsys.readouterr().err
    for wrong in (
        ["cube.nc", "--format", "opensees", "--record", "FSR1"],
        ["two.toml", "--format", "opensees"],
        ["two.toml", "--format", "simcenter", "--record", "FSR1"],
        ["two.toml", "--format", "simcenter", "--at", "slip_scale=1"],
    ):
        assert main(["export", *wrong]) == 2
    assert capsys.readouterr().err.count("Traceback") == 0


# ---- scripts ----


@pytest.mark.parametrize("massless", [False, True])
def test_opensees_comes_to_the_same_peaks(tmp_path, massless):
    pytest.importorskip(
        "openseespy.opensees", reason="openseespy is not installed, or no libblas3", exc_type=ImportError
    )
    text = TWO.replace("[50.0, 40.0]", "0.0") if massless else TWO
    building = building_of(parsed(text), design=True)
    motion = record()
    (tmp_path / "two.py").write_text(opensees_script(building, motion), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "two.py", "--step", "2e-4"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-800:]
    peaks = json.loads(done.stdout[done.stdout.index("{") : done.stdout.rindex("}") + 1])
    history = fdspec.simulate(building, motion)
    assert history["transitions"].item() > 50
    for name, values in peaks.items():
        np.testing.assert_allclose(values, history[name].values, rtol=5e-3, err_msg=name)


def test_the_script_is_python_and_holds_the_whole_building():
    building = Building.from_periods([20e3, 15e3], 0.6, 0.35, [40e3, np.inf], brace_mass=25.0)
    motion = record()
    script = opensees_script(building, motion, name='a "b"\\c\nd')
    held: dict[str, object] = {}
    body = script[: script.index("LOCK =")].replace("import openseespy.opensees as ops", "")
    exec(compile(body, "script", "exec"), held)
    compile(script, "script", "exec")
    np.testing.assert_array_equal(held["GROUND"], motion.acceleration)
    np.testing.assert_array_equal(held["FRAME_STIFFNESS"], building.stiffness_matrix)
    np.testing.assert_array_equal(held["FRAME_DAMPING"], building.damping_matrix)
    np.testing.assert_array_equal(held["SLIP_FORCE"], building.slip_force)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"kinetic_slip_force": 10e3}, "kinetic_slip_force must equal slip_force"),
        ({"slot_length": 0.01, "slot_stiffness": 1e8}, "slots"),
        ({"brace_mass": 0.0, "brace_damping": 100.0}, "massless brace"),
    ],
)
def test_what_opensees_elements_cannot_be(change, message):
    building = building_of(parsed(TWO), design=True).with_changes(**change)
    with pytest.raises(InvalidInput, match=message):
        opensees_script(building, record())


def test_simcenter_s_script_gives_the_demands_of_the_history():
    script: dict[str, object] = {}
    exec(compile(simcenter_script(TWO), "script", "exec"), script)
    motion = record()
    event = {
        "name": "rec",
        "timeSeries": [{"name": "x", "dT": motion.dt, "data": (100.0 * motion.acceleration[1:]).tolist()}],
        "pattern": [{"timeSeries": "x", "dof": 1, "type": "UniformAcceleration"}],
    }
    about = {"GeneralInformation": {"units": {"length": "cm"}}}
    found = script["custom_analysis"](BIM=about, EVENT=event, SAM={}, EDP={})
    same = GroundMotion(np.append(0.0, motion.acceleration[1:]), motion.dt, name="same")
    history = fdspec.simulate(building_of(parsed(TWO), design=True), same)
    for k in range(2):
        floor = f"{k + 1}-1"
        assert found[f"1-PFA-{floor}"] == pytest.approx(100.0 * history["peak_acceleration"][k].item())
        assert found[f"1-PFD-{floor}"] == pytest.approx(100.0 * history["peak_displacement"][k].item())
        assert found[f"1-PID-{floor}"] == pytest.approx(history["peak_drift"][k].item() / 3.0)
    assert found["1-PRD-1-1"] == pytest.approx(history["peak_displacement"][-1].item() / 6.0)
    assert found["1-PFA-0-1"] == pytest.approx(100.0 * same.pga)
    assert set(found) == {
        "1-PFA-0-1", "1-PRD-1-1",
        *(f"1-{kind}-{k}-1" for kind in ("PFA", "PFD", "PID", "RID") for k in (1, 2)),
    }  # fmt: skip


def test_the_command_writes_scripts(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("two.toml").write_text(TWO, encoding="utf-8")
    assert main(["export", "two.toml", "--format", "simcenter", "-o", "custom.py"]) == 0
    assert main(["export", "two.toml", "--format", "opensees", "--record", "FSR1"]) == 0
    assert capsys.readouterr().out == "custom.py\ntwo-opensees.py\n"
    assert "def custom_analysis(" in Path("custom.py").read_text(encoding="utf-8")


@pytest.mark.foreign
def test_pelicun_loads_and_calibrates_the_table(tmp_path):
    pytest.importorskip("pelicun", reason="pelicun, with its old pandas, goes into an environment of its own")
    from pelicun.assessment import Assessment

    motions = [record(300 + 20 * k) for k in range(5)]
    motions = [GroundMotion(m.acceleration, m.dt, name=f"m{k}") for k, m in enumerate(motions)]
    building = building_of(parsed(TWO), design=True)
    cube = fdspec.sweep_buildings(motions, {"two": building}, slip_scale=1.0, stiffness_scale=1.0)
    from fdspec.store.pelicun import write_pelicun

    write_pelicun(cube, tmp_path / "demands.csv", storey_height=3.0)
    assessment = Assessment({"PrintLog": False, "Seed": 1})
    assessment.demand.load_sample(str(tmp_path / "demands.csv"))
    sample, units = assessment.demand.save_sample(save_units=True)
    assert len(sample) == 5
    one = cube.squeeze(["building", "stiffness_scale", "slip_scale"])
    for k in (1, 2):
        ours = one["peak_acceleration"].sel(storey=k).values
        np.testing.assert_allclose(sample[("PFA", str(k), "1")], ours, rtol=1e-12)
        drift = one["peak_drift"].sel(storey=k).values / 3.0
        np.testing.assert_allclose(sample[("PID", str(k), "1")], drift, rtol=1e-12)
    assert set(units.values) == {"mps2", "rad"}
    assessment.demand.calibrate_model({"ALL": {"DistributionFamily": "lognormal"}})
