"""Area and maximum of the strain energy: two formulations against each other, and against a plain history."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import simpson

import fdspec
from fdspec.engines import strain
from fdspec.engines.frame_strain import strain_of_frame
from fdspec.engines.strain import strain_of_storeys
from fdspec.model.building import Building
from fdspec.model.damping import ModalDamping
from fdspec.model.motion import GroundMotion
from fdspec.runs.sweep import ON_REQUEST, OUTPUTS, STRAIN
from tests.cells import Cell, draw

FINE = 512


def frame(cell: Cell) -> Building:
    return Building.single_storey(
        period=cell.period,
        stiffness_ratio=cell.stiffness_ratio,
        slip_force=cell.slip_force,
        kinetic_slip_force=cell.kinetic_slip_force,
        brace_mass=cell.brace_mass,
        damping_ratio=cell.damping_ratio,
        brace_damping_ratio=cell.brace_damping_ratio,
    )


@pytest.fixture(scope="module")
def motion() -> GroundMotion:
    """Five strong seconds."""
    record = fdspec.load_record("FSR1")
    return GroundMotion(record.acceleration[:500], record.dt, name="start")


def plain(building: Building, motion: GroundMotion) -> NDArray[np.float64]:
    """Area and maximum from a fine history: Simpson's rule, and a parabola over the three highest points."""
    history = fdspec.simulate(building, motion, dt_out=motion.dt / FINE)
    energy = history["strain_energy"].values
    top = int(energy.argmax())
    left, middle, right = energy[top - 1 : top + 2]
    peak = middle + (right - left) ** 2 / (8.0 * (2.0 * middle - left - right))
    return np.array([simpson(energy, dx=motion.dt / FINE), peak])


@pytest.mark.parametrize("number", range(40))
def test_one_storey_by_both_formulations(number: int) -> None:
    cell = draw(number)
    building = frame(cell)
    motion = GroundMotion(cell.acceleration, cell.dt)
    one = strain_of_storeys(np.array([building.storey]), motion)[0]
    assert one == pytest.approx(strain_of_frame(building.frame, motion), rel=1e-9)
    assert one == pytest.approx(
        strain_of_storeys(np.array([building.storey]), motion, radians=0.4)[0], rel=1e-9
    )


@pytest.mark.parametrize(
    ("period", "ratio", "slip_force"),
    [(0.5, 4.0, 5e3), (0.5, 4.0, 50e3), (0.2, 8.0, 30e3), (1.5, 1.0, np.inf)],
)
def test_a_plain_recomputation_from_the_history_agrees(
    motion: GroundMotion, period: float, ratio: float, slip_force: float
) -> None:
    building = Building.single_storey(period=period, stiffness_ratio=ratio, slip_force=slip_force)
    got = strain_of_storeys(np.array([building.storey]), motion)[0]
    assert got[:2] == pytest.approx(plain(building, motion), rel=1e-9)


@pytest.mark.parametrize("brace_mass", [23.0, 0.0])
def test_four_storeys_agree_with_a_plain_recomputation(motion: GroundMotion, brace_mass: float) -> None:
    building = Building.from_periods(
        [41610.0] * 3 + [40820.0], 1.006, 0.612, [90e3, 70e3, 50e3, 30e3], brace_mass, ModalDamping(0.02)
    )
    got = strain_of_frame(building.frame, motion)
    assert got[:2] == pytest.approx(plain(building, motion), rel=1e-9)


@pytest.mark.parametrize("kinetic", [20e3, 15e3])
def test_massless_braces_by_both_formulations(kinetic: float) -> None:
    cell = draw(3)
    motion = GroundMotion(cell.acceleration, cell.dt)
    building = Building.single_storey(0.5, 4.0, 20e3, kinetic_slip_force=kinetic, brace_mass=0.0)
    one = strain_of_storeys(np.array([building.storey]), motion)[0]
    assert one == pytest.approx(strain_of_frame(building.frame, motion), rel=1e-10)


def test_room_for_changes_of_phase_grows(motion: GroundMotion, monkeypatch: pytest.MonkeyPatch) -> None:
    building = Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=5e3)
    storeys = np.array([building.storey, building.storey._replace(slip_force=60e3, kinetic_slip_force=50e3)])
    roomy = strain_of_storeys(storeys, motion)
    monkeypatch.setattr(strain, "ROOM", 1)
    assert np.array_equal(strain_of_storeys(storeys, motion), roomy)


def test_a_sweep_gives_it_on_request(motion: GroundMotion) -> None:
    axes = {"period": [0.3, 0.5], "pretension": [0.0, 60e3, np.inf], "stiffness_ratio": [2, 4]}
    asked = (*ON_REQUEST, "peak_displacement", "peak_base_shear")
    cube = fdspec.sweep(motion, **axes, outputs=asked, columns_per_task=3)
    assert set(cube.data_vars) == {*asked, "status"}
    for period in axes["period"]:
        bare = fdspec.Building.single_storey(period, 0.0, 0.0, brace_mass=0.0)
        area, peak = strain_of_frame(bare.frame, motion)[:2]
        at = cube.sel(period=period)
        assert at["bare_strain_energy_area"].item() == pytest.approx(area, rel=1e-12)
        assert at["bare_peak_strain_energy"].item() == pytest.approx(peak, rel=1e-12)
        history = fdspec.simulate(bare, motion)
        for name in ("peak_displacement", "peak_base_shear"):
            assert at[f"bare_{name}"].item() == pytest.approx(history[name].item(), rel=1e-12)
        never = at.sel(pretension=np.inf)
        for name in ("peak_displacement", "peak_base_shear"):
            assert np.array_equal(at[f"braced_{name}"], never[name])
    building = Building.single_storey(0.5, 4.0, 30e3)
    cell = cube.sel(period=0.5, stiffness_ratio=4, pretension=60e3, record="start")
    assert [cell[name].item() for name in STRAIN] == pytest.approx(
        strain_of_frame(building.frame, motion)[:2]
    )


def test_a_sweep_leaves_it_out_unless_it_is_named(motion: GroundMotion) -> None:
    cube = fdspec.sweep(motion, period=0.5, pretension=60e3, stiffness_ratio=4)
    assert not set(ON_REQUEST) & set(cube.data_vars)
    assert set(OUTPUTS) == set(cube.data_vars)
