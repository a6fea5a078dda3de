"""The history of a cell: the cube's own frame and motion, found again or said to be another."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import fdspec
from fdspec import store
from fdspec.errors import InvalidInput, RecordError
from fdspec.explore.best import packed_best
from fdspec.explore.motions import Found, Motions, read_given
from fdspec.explore.point import FIELDS, frame_at, packed_point, point_of
from fdspec.explore.rerun import Rerun
from fdspec.explore.traces import COMPARED, ENERGIES
from fdspec.model.motion import GroundMotion
from fdspec.units import G
from tests.explored import PERIOD, own_motion, small_cube, unpack

CHANGED = {
    "floor_mass": 31e3,
    "brace_mass": 120.0,
    "damping_ratio": 0.03,
    "friction_coefficient": 0.4,
    "kinetic_friction_coefficient": 0.3,
    "normal_force_factor": 2.0,
    "brace_damping_ratio": 0.01,
}


@pytest.fixture(scope="module")
def cube() -> xr.Dataset:
    return small_cube()


def write_text(motion: GroundMotion, path: Path, factor: float = 1.0) -> None:
    """Write two columns that say neither their unit nor anything else."""
    rows = np.column_stack([motion.time, motion.acceleration / factor])
    path.write_text("\n".join(f"{t:.4f} {a!r}" for t, a in rows.tolist()) + "\n")


def test_every_peak_of_a_history_is_the_cells(cube: xr.Dataset) -> None:
    rerun = Rerun(cube)
    random = np.random.default_rng(2)
    for _ in range(12):
        place = [int(random.integers(size)) for size in cube["peak_acceleration"].shape]
        about, arrays = unpack(rerun.packed(*place))
        assert about["notice"] == ""
        assert about["record"] == str(cube["record"].values[place[0]])
        assert len(about["compared"]) == len(COMPARED)
        for one in about["compared"]:
            assert one["history"] == pytest.approx(one["cube"], rel=1e-9, abs=1e-12), (place, one)
        peak = about["compared"][0]["history"]
        assert np.abs(arrays["acceleration"]).max() <= peak * (1 + 1e-12)


def test_all_parameters_of_the_frame_come_from_the_cube() -> None:
    cube = small_cube(own_motion("FSR1"), **CHANGED)
    rerun = Rerun(cube)
    frame = rerun.building(1, 2, 3)
    assert frame == fdspec.Building.single_storey(
        0.8,
        4.0,
        0.4 * 2.0 * 110e3,
        floor_mass=31e3,
        brace_mass=120.0,
        damping_ratio=0.03,
        kinetic_slip_force=0.3 * 2.0 * 110e3,
        brace_damping_ratio=0.01,
    )


def test_the_history_is_that_of_simulate(cube: xr.Dataset) -> None:
    history, notice = Rerun(cube).history(1, 0, 3, 4)
    frame = fdspec.Building.single_storey(period=1.2, stiffness_ratio=1.0, slip_force=105e3)
    assert notice == ""
    plain = fdspec.simulate(frame, fdspec.load_record("FMR1"))
    assert np.array_equal(history["displacement"].values, plain["displacement"].values)


def test_a_place_outside_the_cube(cube: xr.Dataset) -> None:
    with pytest.raises(InvalidInput, match="period must be a position from 0 to 5, got 6"):
        Rerun(cube).history(0, 0, 0, 6)


def test_records_as_recorded_are_found_too() -> None:
    cube = small_cube(fdspec.load_record("FHR2", scaled=False))
    assert Motions(cube, {}, Path()).find("FHR2").notice == ""


def test_a_record_of_the_catalogues_name_that_is_another_is_said(cube: xr.Dataset) -> None:
    found = Motions(small_cube(own_motion("FSR1")), {}, Path()).find("FSR1")
    assert "not the motion that the cube was made with: its checksum is " in found.notice
    assert found.motion == fdspec.load_record("FSR1")


def test_an_unknown_record_tells_how_to_name_its_file(tmp_path: Path) -> None:
    motions = Motions(small_cube(own_motion()), {}, tmp_path)
    with pytest.raises(RecordError, match="'mine' is not in the catalogue; start with --record mine=FILE"):
        motions.find("mine")


@pytest.mark.parametrize("factor", [1.0, 9.80665, 0.01])
def test_a_file_is_read_in_the_unit_that_gives_the_checksum(tmp_path: Path, factor: float) -> None:
    write_text(own_motion(), tmp_path / "some.txt", factor)
    units = {1.0: "m/s2", 9.80665: "g", 0.01: "cm/s2"}[factor]
    motion = fdspec.read_record(tmp_path / "some.txt", units=units, name="mine")
    found = Motions(small_cube(motion), {"mine": tmp_path / "some.txt"}, Path()).find("mine")
    assert found.notice == ""
    assert found.motion.checksum == motion.checksum
    assert found.motion.name == "mine"


def test_a_scaled_motion_is_found_by_the_cubes_factor(tmp_path: Path) -> None:
    write_text(own_motion(), tmp_path / "some.txt")
    motion = fdspec.read_record(tmp_path / "some.txt", units="m/s2", name="mine").scaled(1.7)
    found = Motions(small_cube(motion), {"mine": tmp_path / "some.txt"}, Path()).find("mine")
    assert found.notice == ""
    assert found.motion.scale_factor == 1.7


def test_the_file_that_the_cube_names_is_found_beside_it(tmp_path: Path) -> None:
    write_text(own_motion(), tmp_path / "some.txt")
    cube = small_cube(fdspec.read_record(tmp_path / "some.txt", units="m/s2"))
    assert Motions(cube, {}, tmp_path).find("some").notice == ""
    (tmp_path / "some.txt").unlink()
    with pytest.raises(RecordError, match=r"and its file some\.txt is not beside the cube"):
        Motions(cube, {}, tmp_path).find("some")


def test_a_file_of_another_motion_is_said_or_refused(tmp_path: Path) -> None:
    cube = small_cube(own_motion())
    write_text(own_motion().scaled(1.1), tmp_path / "silent.txt")
    with pytest.raises(RecordError, match=r"silent\.txt cannot be read as the motion that the cube was made"):
        Motions(cube, {"mine": tmp_path / "silent.txt"}, Path()).find("mine")
    file = next((Path(__file__).parents[2] / "records").glob("*.AT2"))  # says its unit: run, and said
    found = Motions(cube, {"mine": file}, Path()).find("mine")
    assert "its checksum is" in found.notice
    assert found.motion.name == "mine"


def test_files_are_given_by_name(tmp_path: Path, cube: xr.Dataset) -> None:
    file = tmp_path / "a=b.txt"
    file.write_text("1")
    assert read_given((f"mine={file}",)) == {"mine": file}
    with pytest.raises(InvalidInput, match="takes NAME=FILE, got 'mine'"):
        read_given(("mine",))
    with pytest.raises(InvalidInput, match="there is no file nowhere"):
        read_given(("mine=nowhere",))
    with pytest.raises(InvalidInput, match="the cube has no record 'mine'; it has FSR1, FMR1"):
        Rerun(cube, {"mine": file})


def test_a_cube_without_its_parameters(cube: xr.Dataset) -> None:
    with pytest.raises(InvalidInput, match=r"parameters does not tell floor_mass, .*fdspec sweep made"):
        Rerun(cube.assign_attrs(parameters='{"brace_mass": 1.0}'))


def test_the_drawn_loop_encloses_the_dissipated_energy(cube: xr.Dataset) -> None:
    about, arrays = unpack(Rerun(cube).packed(0, 1, 2, 2))
    dissipated = next(one["history"] for one in about["compared"] if "dissipated" in one["title"])
    drawn = np.trapezoid(arrays["loop_force"], arrays["loop_slip"]) / 1e3
    assert drawn == pytest.approx(dissipated, rel=0.02)


def test_a_lazily_opened_cube_serves_as_well(tmp_path: Path, cube: xr.Dataset) -> None:
    store.save(cube, tmp_path / "cube.nc")
    opened = store.open(tmp_path / "cube.nc", lazily=True)
    about, _ = unpack(Rerun(opened).packed(0, 1, 2, 2))
    opened.close()
    assert about["compared"][0]["cube"] == pytest.approx(about["compared"][0]["history"], rel=1e-12)


@pytest.mark.parametrize(
    ("index", "measure", "read"),
    [
        ("acceleration", "acceleration", lambda best: best["peak_acceleration"] / G),
        (
            "reduction_to_bare",
            "acceleration",
            lambda best: 100 * (1 - best["peak_acceleration"] / best["bare_acceleration"]),
        ),
        (
            "reduction_to_braced",
            "acceleration",
            lambda best: 100 * (1 - best["peak_acceleration"] / best["braced_acceleration"]),
        ),
        ("displacement", "displacement", lambda best: 1e3 * best["peak_displacement"]),
        ("rpi_index", "rpi", lambda best: best["index"]),
        ("dissipated_share", "dissipated_energy", lambda best: 100 * (1 - best["index"])),
    ],
)
def test_the_searched_best_is_that_of_the_package(cube: xr.Dataset, index: str, measure: str, read) -> None:
    about, found = unpack(packed_best(Rerun(cube), 0, 1, index))
    motion = fdspec.load_record("FSR1")
    best = fdspec.best_pretension(motion, period=PERIOD, stiffness_ratio=4.0, index=measure)
    best = best.isel(record=0, stiffness_ratio=0)
    assert about == {"index": index, "notice": ""}
    assert np.array_equal(found["pretension"], best["pretension"].values / 1e3)
    assert np.array_equal(found["end"], best["band_end"].values / 1e3)
    np.testing.assert_allclose(found["value"], read(best).values, rtol=1e-12)
    _, one = unpack(packed_best(Rerun(cube), 0, 1, index, 2))
    assert (one["pretension"], one["value"]) == (found["pretension"][2], found["value"][2])


def test_the_searched_best_takes_all_parameters_of_the_cube() -> None:
    motion = own_motion("FSR1")
    changed = {**CHANGED, "period": [0.3, 0.5], "stiffness_ratio": [4.0]}
    rerun = Rerun(small_cube(motion, **changed))
    rerun.motions._found["FSR1"] = Found(motion)
    _, found = unpack(packed_best(rerun, 0, 0, "acceleration"))
    best = fdspec.best_pretension(motion, **changed)
    assert np.array_equal(found["pretension"], best["pretension"].values.ravel() / 1e3)


@pytest.mark.parametrize("index", ["travel", "velocity", "none", ""])
def test_an_index_that_is_not_searched(cube: xr.Dataset, index: str) -> None:
    with pytest.raises(InvalidInput, match=f"index must be one that .* searches, got '{index}'"):
        packed_best(Rerun(cube), 0, 0, index)
    with pytest.raises(InvalidInput, match="record must be a position"):
        packed_best(Rerun(cube), 5, 0, "acceleration")


TYPED = {
    "period": "0.43",
    "stiffness_ratio": "5.5",
    "pretension": "77",
    "floor_mass": "35",
    "brace_mass": "80",
    "damping_ratio": "0.03",
    "friction_coefficient": "0.25",
}


def test_a_point_between_the_cubes_is_the_frame_that_was_typed(cube: xr.Dataset) -> None:
    rerun = Rerun(cube)
    point = point_of(TYPED)
    frame = fdspec.Building.single_storey(
        0.43, 5.5, 0.25 * 77e3, floor_mass=35e3, brace_mass=80.0, damping_ratio=0.03
    )
    assert frame_at(rerun, point) == frame
    about, arrays = unpack(packed_point(rerun, 0, point))
    history = fdspec.simulate(frame, fdspec.load_record("FSR1"))
    assert about["compared"][0]["history"] == pytest.approx(
        history["peak_acceleration"].item() / G, rel=1e-12
    )
    assert {one["cube"] for one in about["compared"]} == {None}
    for name in ENERGIES:
        assert arrays[name] == pytest.approx(history[name].values / 1e3, rel=1e-9, abs=1e-12)
    bare = fdspec.simulate(
        fdspec.Building.single_storey(0.43, 0.0, 0.0, floor_mass=35e3, brace_mass=0.0, damping_ratio=0.03),
        fdspec.load_record("FSR1"),
    )
    assert arrays["bare_displacement"] == pytest.approx(bare["displacement"].values[:, 0] * 1e3)


def test_kinetic_friction_keeps_its_share_at_a_point() -> None:
    rerun = Rerun(small_cube(own_motion("FSR1"), **CHANGED))
    frame = frame_at(rerun, point_of(TYPED))
    assert frame.slip_force.tolist() == pytest.approx([0.25 * 2.0 * 77e3])
    assert frame.kinetic_slip_force.tolist() == pytest.approx([0.75 * 0.25 * 2.0 * 77e3])


@pytest.mark.parametrize("field", [field.name for field in FIELDS])
@pytest.mark.parametrize("wrong", ["", "x", "nan", "inf", "-1", "1e30"])
def test_a_point_that_cannot_be(field: str, wrong: str) -> None:
    with pytest.raises(InvalidInput, match=r"must be (a number|from .* to .*), got"):
        point_of({**TYPED, field: wrong})
