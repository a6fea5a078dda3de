"""Intensity as a dim: factors on the records give what the scaled records give."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import fdspec
from fdspec.cli.main import main
from fdspec.errors import InvalidInput
from fdspec.measures.fragility import fragility
from fdspec.measures.risk import hazard_curve, least_risk, risk
from fdspec.runs.study import Study
from fdspec.variables import BUILDING_CUBE, CUBE, HISTORY, INTENSITY_BUILDING_CUBE, INTENSITY_CUBE, Variable

AXES = {"stiffness_ratio": [1.0, 6.0], "pretension": [0.0, 20e3, 90e3, np.inf], "period": [0.3, 0.8]}
LEVELS = [0.3, 1.0, 1.7, 40.0]
EXACT = {"transitions", "status", "storey_transitions"}


def record(name: str, seed: int, samples: int = 150) -> fdspec.GroundMotion:
    rng = np.random.default_rng(seed)
    shake = np.convolve(rng.standard_normal(samples), np.ones(5) / 5.0, mode="same")
    return fdspec.GroundMotion(4.0 * shake / np.abs(shake).max(), 0.02, name=name)


MOTIONS = [record("a", 1), record("b", 2, 90)]


def assert_close(found: xr.Dataset, wanted: xr.Dataset) -> None:
    """Counts equal, numbers to rounding of the variable's largest; energies may cancel to nothing."""
    assert set(found.data_vars) == set(wanted.data_vars)
    for name in wanted.data_vars:
        one, other = found[name].values, wanted[name].values
        if name in EXACT:
            np.testing.assert_array_equal(one, other, err_msg=str(name))
        elif name == "energy_error":
            assert max(one.max(), other.max()) < 1e-9
        else:
            np.testing.assert_allclose(
                one, other, rtol=1e-11, atol=1e-12 * np.abs(other).max(), err_msg=str(name)
            )


def test_every_intensity_is_the_sweep_of_the_scaled_records() -> None:
    outputs = (
        *fdspec.runs.sweep.OUTPUTS,
        "strain_energy_area",
        "bare_peak_strain_energy",
        "peak_strain_energy",
    )
    cube = fdspec.sweep(MOTIONS, intensity=LEVELS, outputs=outputs, kinetic_friction_coefficient=0.4, **AXES)
    assert cube["peak_acceleration"].dims == (
        "record",
        "intensity",
        "stiffness_ratio",
        "pretension",
        "period",
    )
    assert cube["elastic_acceleration"].dims == ("record", "intensity", "period")
    for s in LEVELS:
        motions = [motion.times(s) for motion in MOTIONS]
        alone = fdspec.sweep(motions, outputs=outputs, kinetic_friction_coefficient=0.4, **AXES)
        assert_close(cube.sel(intensity=s).drop_vars("intensity"), alone)


def test_intensity_one_keeps_every_bit_and_no_intensity_no_trace() -> None:
    cube, plain = fdspec.sweep(MOTIONS, intensity=LEVELS, **AXES), fdspec.sweep(MOTIONS, **AXES)
    for name in plain.data_vars:
        np.testing.assert_array_equal(cube[name].sel(intensity=1.0).values, plain[name].values)
    assert "intensity" not in plain.variables
    assert "intensity" not in plain.attrs["parameters"]


def test_other_methods_run_the_scaled_record() -> None:
    axes = {"stiffness_ratio": [4.0], "pretension": [40e3], "period": [0.5]}
    cube = fdspec.sweep(MOTIONS[:1], method="bilinear", intensity=[0.5, 3.0], **axes)
    for s in (0.5, 3.0):
        alone = fdspec.sweep([MOTIONS[0].times(s)], method="bilinear", **axes)
        for name in alone.data_vars:
            np.testing.assert_array_equal(cube[name].sel(intensity=s).values, alone[name].values)


def test_frames_with_devices_run_the_scaled_record() -> None:
    axes = {"stiffness_ratio": [4.0], "pretension": [20e3, 60e3], "period": [0.5]}
    devices = {"storey_height": 3.0, "yield_shear": 30e3, "slot_length": 0.004, "slot_stiffness": 5e6}
    levels = [0.5, 1.0, 2.5]
    cube = fdspec.sweep(MOTIONS[1:], intensity=levels, **devices, **axes)
    assert cube["ductility"].dims == ("record", "intensity", "stiffness_ratio", "pretension", "period")
    for s in levels:
        alone = fdspec.sweep([MOTIONS[1].times(s)], **devices, **axes)
        for name in alone.data_vars:
            np.testing.assert_array_equal(cube[name].sel(intensity=s).values, alone[name].values)
    grown = cube["peak_displacement"].sel(intensity=2.5) / cube["peak_displacement"].sel(intensity=0.5)
    assert abs(grown - 5.0).max() > 0.1


def test_buildings() -> None:
    building = fdspec.Building.from_periods([30e3, 20e3], 0.5, 0.3, slip_force=[40e3, 20e3], brace_mass=50.0)
    axes = {"slip_scale": [0.5, 2.0], "stiffness_scale": [1.0, 2.0]}
    cube = fdspec.sweep_buildings(MOTIONS, building, intensity=[0.4, 1.0, 2.5], **axes)
    dims = ("record", "intensity", "building", "stiffness_scale", "slip_scale", "storey")
    assert cube["peak_drift"].dims == dims
    assert cube["elastic_acceleration"].dims == ("record", "intensity", "building", "storey")
    for s in (0.4, 1.0, 2.5):
        alone = fdspec.sweep_buildings([motion.times(s) for motion in MOTIONS], building, **axes)
        for name in alone.data_vars:
            np.testing.assert_array_equal(cube[name].sel(intensity=s).values, alone[name].values)


def test_the_identity_holds_for_buildings_by_the_degrees_of_the_registry() -> None:
    building = fdspec.Building.from_periods([30e3, 20e3], 0.5, 0.3, slip_force=[40e3, 20e3], brace_mass=50.0)
    s = 1.7
    loud = fdspec.sweep_buildings([MOTIONS[0].times(s)], building, slip_scale=1.0, stiffness_scale=1.0)
    soft = fdspec.sweep_buildings(MOTIONS[:1], building, slip_scale=1.0 / s, stiffness_scale=1.0)
    for name in soft.data_vars:
        soft[name] = soft[name] * s ** BUILDING_CUBE[str(name)].degree
    assert_close(soft, loud)


@pytest.mark.parametrize("registry", [CUBE, BUILDING_CUBE])
def test_every_result_has_a_degree(registry: dict[str, Variable]) -> None:
    results = [v for v in registry.values() if v.dims[:1] == ("record",) and len(v.dims) > 1]
    assert results
    assert [v.name for v in results if v.degree is None] == []


def test_the_registries_with_the_dim_differ_in_it_alone() -> None:
    for plain, along in ((CUBE, INTENSITY_CUBE), (BUILDING_CUBE, INTENSITY_BUILDING_CUBE)):
        for name, variable in plain.items():
            kept = tuple(dim for dim in along[name].dims if dim != "intensity")
            assert kept == variable.dims
            assert ("intensity" in along[name].dims) == (variable.degree is not None or name == "intensity")
    assert "intensity" not in HISTORY


def test_a_store_is_the_cube_and_goes_on(tmp_path: Path) -> None:
    wanted = fdspec.sweep(MOTIONS, intensity=LEVELS, **AXES)
    path = tmp_path / "cube.zarr"
    for _ in range(2):
        with fdspec.sweep(MOTIONS, intensity=LEVELS, store=path, columns_per_task=1, **AXES) as cube:
            xr.testing.assert_identical(cube.load().drop_attrs(), wanted.drop_attrs())


def test_a_cube_over_intensities_is_saved_opened_and_checked(tmp_path: Path) -> None:
    from fdspec.store.check import check

    cube = fdspec.sweep(MOTIONS, intensity=LEVELS, **AXES)
    for name, one in (("all.nc", cube), ("one.nc", cube.sel(intensity=1.7))):
        fdspec.save(one, tmp_path / name)
        with fdspec.open(tmp_path / name) as back:
            xr.testing.assert_equal(back.load(), one)
        assert [finding for finding in check(tmp_path / name) if not finding.passed] == []


@pytest.mark.parametrize("wrong", [[0.0, 1.0], [2.0, 1.0], [-1.0], [np.nan], []])
def test_factors_that_are_none(wrong: list[float]) -> None:
    with pytest.raises(InvalidInput, match="intensity: "):
        fdspec.sweep(MOTIONS, intensity=wrong, **AXES)
    with pytest.raises(InvalidInput, match="intensity: "):
        fdspec.sweep_buildings(
            MOTIONS,
            fdspec.Building.single_storey(0.5, 4, 1e4),
            intensity=wrong,
            slip_scale=1,
            stiffness_scale=1,
        )


def test_study_files_name_intensities() -> None:
    study = Study.parse("intensity = { start = 0.5, stop = 2.0, step = 0.5 }")
    np.testing.assert_array_equal(study.grid.intensity, [0.5, 1.0, 1.5, 2.0])
    np.testing.assert_array_equal(Study.parse(study.to_toml()).grid.intensity, study.grid.intensity)
    assert Study.parse(Study().to_toml()).grid.intensity is None


STUDY = """\
records = ["FSR1", "FSR2", "FSR3", "FMR1", "FMR2", "FMR3", "FHR1"]
stiffness_ratio = [4]
pretension = [40e3, 120e3, 400e3]
period = [0.5]
intensity = [0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.0, 3.0]
"""


def test_from_a_study_file_to_fragility_and_least_risk(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study, path = tmp_path / "ida.toml", str(tmp_path / "ida.nc")
    study.write_text(STUDY)
    assert main(["sweep", str(study), "-o", path]) == 0
    assert "8 intensities" in capsys.readouterr().out
    (tmp_path / "hazard.csv").write_text("pga,rate\n0.1,0.05\n0.5,0.004\n1,0.001\n3,0.0001\n")
    told = ["--demand", "peak_displacement", "--limit", "0.05", "--hazard", str(tmp_path / "hazard.csv")]
    assert main(["fragility", path, *told]) == 0
    assert "rate a year" in capsys.readouterr().out
    with fdspec.open(path) as cube:
        fit = fragility(cube, demand="peak_displacement", limit=0.05)
        exceeds = (cube["peak_displacement"] > 0.05).sum("record").squeeze(["stiffness_ratio", "period"])
        np.testing.assert_array_equal(
            fit["exceedances"].squeeze().transpose("intensity", "pretension"), exceeds
        )
        hazard = hazard_curve(np.array([0.1, 0.5, 1.0, 3.0]), np.array([0.05, 0.004, 0.001, 0.0001]))
        best = least_risk(cube, fit, hazard, scenario=1.0)
        rates = risk(fit, hazard)["annual_rate"].squeeze()
        assert float(best["by_risk"].squeeze()) == float(rates.idxmin("pretension"))
        mean = cube["peak_displacement"].sel(intensity=1.0).mean("record").squeeze()
        assert float(best["by_scenario"].squeeze()) == float(mean.idxmin("pretension"))


@pytest.mark.parametrize("command", ["claims", "figures"])
def test_what_needs_one_intensity_says_so(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cube = fdspec.sweep(MOTIONS, intensity=[1.0, 2.0], **AXES)
    fdspec.save(cube, tmp_path / "cube.nc")
    extra = ["-o", str(tmp_path / "out")] if command == "figures" else []
    assert main([command, str(tmp_path / "cube.nc"), *extra]) == 2
    assert "over intensities (1, 2)" in capsys.readouterr().err
