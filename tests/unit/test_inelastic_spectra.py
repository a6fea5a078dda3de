"""Inelastic spectra as a user meets them: Dataset, arguments, command, file and picture."""

import math

import numpy as np
import pytest
from click.testing import CliRunner

import fdspec
from fdspec.cli.commands import fdspec as command
from fdspec.errors import InvalidInput
from fdspec.figures.inelastic import plot_fragility, plot_ida, plot_inelastic_spectra
from fdspec.measures.dynamic_curves import ida_curves
from fdspec.measures.fragility import fragility
from fdspec.runs.inelastic_spectra import inelastic_spectra
from fdspec.runs.spectra_variables import registry
from fdspec.signals.spectra import elastic_spectra
from fdspec.variables import describe
from tests.unit.test_fragility import _random_cube


@pytest.fixture(scope="module")
def motion():
    return fdspec.load_record("FHR2")


@pytest.fixture(scope="module")
def constant_ductility(motion):
    return inelastic_spectra(motion, [0, 0.2, 0.5, 1.0], ductility=[1, 2, 4])


def test_the_strength_gives_the_ductility(constant_ductility):
    swings = constant_ductility.sel(period=slice(0.1, None))
    assert swings.ductility.values == pytest.approx(
        np.broadcast_to([1, 2, 4], swings.ductility.shape), rel=1e-12
    )
    assert (swings.roots >= 1).all()
    assert swings.energy_error.max().item() <= 1e-9
    assert (swings.status == 0).all()
    largest = swings.root_strength.max("root")
    assert (largest == swings.strength).all()


def test_a_rigid_block_has_the_strength_of_the_ground(constant_ductility, motion):
    rigid = constant_ductility.sel(period=0.0)
    assert (rigid.strength == motion.pga).all()
    assert (rigid.peak_displacement == 0.0).all()
    assert (rigid.peak_acceleration == motion.pga).all()


def test_constant_strength_and_reduction_factor_agree(motion, constant_ductility):
    strength = constant_ductility.strength.sel(period=0.5, ductility_target=4).item()
    by_strength = inelastic_spectra(motion, 0.5, strength=[strength])
    assert by_strength.ductility.item() == pytest.approx(4.0, rel=1e-12)
    factor = by_strength.reduction_factor.item()
    by_factor = inelastic_spectra(motion, 0.5, reduction_factor=[factor])
    assert by_factor.peak_displacement.item() == pytest.approx(
        by_strength.peak_displacement.item(), rel=1e-10
    )


def test_a_reduction_factor_of_one_is_elastic(motion):
    spectra = inelastic_spectra(motion, [0.1, 0.7], reduction_factor=1.0)
    elastic = elastic_spectra(motion, [0.1, 0.7], after="peak")
    assert spectra.peak_displacement.values.ravel() == pytest.approx(
        elastic.spectral_displacement.values.ravel(), rel=1e-12
    )
    assert spectra.hysteretic_energy.values.ravel() == pytest.approx([0.0, 0.0], abs=1e-12)


def test_a_softening_spring_collapses_where_its_force_is_used_up(motion):
    spectra = inelastic_spectra(motion, 0.3, reduction_factor=[1, 6], hardening_ratio=-0.1)
    assert spectra.status.values.ravel().tolist() == [0, 1]
    assert spectra.ductility.values.ravel()[1] >= 1.0 + 1.0 / 0.1


def test_after_the_record(motion):
    """A record cut short leaves its largest peak of a slow oscillator behind its end."""
    cut = np.append(motion.acceleration[: motion.n // 4], 0.0)
    short = fdspec.GroundMotion(cut, motion.dt, name="cut")
    while_it_lasts = elastic_spectra(short, [3.0, 6.0], 0.02)
    at_last = elastic_spectra(short, [3.0, 6.0], 0.02, after="peak")
    longer = fdspec.GroundMotion(np.append(short.acceleration, np.zeros(4000)), short.dt, name="longer")
    lasting = elastic_spectra(longer, [3.0, 6.0], 0.02)
    assert (at_last.spectral_displacement >= while_it_lasts.spectral_displacement).all()
    assert at_last.spectral_displacement.values == pytest.approx(
        lasting.spectral_displacement.values, rel=1e-11
    )


def test_period_zero_is_the_ground(motion):
    spectra = elastic_spectra(motion, [0.0, 1.0])
    zero = spectra.sel(period=0.0)
    assert zero.absolute_acceleration.item() == zero.pseudo_acceleration.item() == motion.pga
    assert zero.spectral_displacement.item() == 0.0


@pytest.mark.parametrize("kind", ["strength", "ductility", "reduction_factor"])
def test_every_variable_is_registered(motion, kind):
    spectra = inelastic_spectra(motion, [0.3], **{kind: [1.0, 2.0]})
    assert describe(spectra, registry(kind)).equals(spectra)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({}, "give one of strength, ductility and reduction_factor; none was given"),
        ({"ductility": 2, "strength": 1}, "strength and ductility was given"),
        ({"ductility": 0.5}, "ductility must be 1 or more, not 0.5"),
        ({"strength": 0}, "strength must be positive, not 0"),
        ({"ductility": [4, 2]}, "ductility must be strictly increasing"),
        ({"ductility": 2, "damping_ratio": 5}, "damping_ratio must be at least 0 and below 1, not 5"),
        ({"ductility": 2, "hardening_ratio": 1.0}, "hardening_ratio must be below 1, not 1"),
        ({"ductility": 2, "period": 1e-5}, "period must be 0 or at least"),
        ({"ductility": 2, "collapse_ductility": 0.5}, "collapse_ductility must be more than 1"),
        ({"ductility": "x"}, "ductility must be a number or a sequence of numbers, not 'x'"),
    ],
)
def test_arguments_that_cannot_be_used(motion, change, message):
    with pytest.raises(InvalidInput, match=message):
        inelastic_spectra(motion, **{"period": [0.5], **change})


def test_the_command(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run = CliRunner().invoke(
        command, ["spectra", "FSR1", "--period", "0,0.2:1:3", "--ductility", "2,4", "-o", "a.csv"]
    )
    assert run.exit_code == 0, run.output
    header, *rows = (tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()
    assert header.startswith("record,period,ductility_target,")
    assert len(rows) == 4 * 2
    run = CliRunner().invoke(command, ["spectra", "FSR1", "--period", "0.2,1", "-o", "a.nc"])
    assert run.exit_code == 0, run.output
    elastic = fdspec.open("a.nc")
    assert elastic.spectral_displacement.sizes["period"] == 2


@pytest.mark.parametrize("text", ["x", "1:2", "2:1:5", "0:1:5", "1:2:x"])
def test_numbers_that_cannot_be_read(text):
    run = CliRunner().invoke(command, ["spectra", "FSR1", "--period", text])
    assert run.exit_code == 2
    assert "Traceback" not in run.output


def test_fragility_from_a_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("fdspec.store.open", lambda path: _random_cube(4))
    (tmp_path / "hazard.csv").write_text("im,rate\n0.1,0.01\n1,0.001\n5,0.00001\n", encoding="utf-8")
    arguments = [
        "fragility",
        "cube.nc",
        "--demand",
        "peak_drift",
        "--limit",
        "0.02",
        "--hazard",
        "hazard.csv",
    ]
    for output in ("f.nc", "f.csv", "f.png"):
        run = CliRunner().invoke(command, [*arguments, "-o", output])
        assert run.exit_code == 0, run.output
        assert (tmp_path / output).stat().st_size > 100
    assert "rate a year" in run.output
    assert run.output.count("%") == 2


def test_pictures(motion, constant_ductility):
    spectra = plot_inelastic_spectra(constant_ductility)
    assert [axis.get_ylabel() for axis in spectra.axes] == ["yield strength, g", "peak displacement, mm"]
    assert [text.get_text() for text in spectra.axes[0].get_legend().get_texts()] == ["1", "2", "4"]
    fit = fragility(_random_cube(2), demand="peak_drift", limit=0.02)
    assert plot_fragility(fit).axes[0].get_title() == "peak drift beyond 0.02 m"
    curves = plot_ida(ida_curves(_random_cube(2), demand="peak_drift"), limit=0.02)
    assert [text.get_text() for text in curves.axes[0].get_legend().get_texts()] == [
        "16 %",
        "50 %",
        "84 %",
        "limit",
    ]
    assert math.isclose(curves.axes[0].get_ylim()[1], 3.0)
