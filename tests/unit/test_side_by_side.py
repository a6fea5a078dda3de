"""Frames beside each other: each by itself where nothing joins them, and one frame where all does."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fdspec
from fdspec import Building, Link, ModalDamping, RayleighDamping, TensionBrace
from fdspec.errors import InvalidInput
from fdspec.model.building_file import read_building
from fdspec.model.springs import Linkage
from fdspec.model.standing import carried, drifts, spring_matrix
from tests.unit.test_devices import SHORT

LOW: dict[str, Any] = {
    "floor_mass": [40e3, 30e3],
    "storey_stiffness": [40e6, 25e6],
    "brace_mass": [60.0, 0.0],
    "brace_stiffness": [80e6, 50e6],
    "slip_force": [60e3, 40e3],
    "damping": ModalDamping(0.03),
    "storey_height": 3.0,
}
HIGH: dict[str, Any] = {
    "floor_mass": [25e3, 20e3, 15e3],
    "storey_stiffness": [30e6, 25e6, 20e6],
    "brace_mass": [40.0, 0.0, 40.0],
    "brace_stiffness": [50e6, 0.0, 40e6],
    "slip_force": [50e3, 0.0, 25e3],
    "damping": RayleighDamping(0.02, 0.5, 0.1),
    "storey_height": [4.0, 3.0, 3.0],
    "yield_shear": [120e3, math.inf, 60e3],
    "hardening_ratio": 0.05,
    "gravity_load": [600e3, 350e3, 150e3],
}
STOREYS = (
    "peak_acceleration",
    "peak_displacement",
    "peak_velocity",
    "peak_drift",
    "peak_storey_shear",
    "peak_slip",
    "residual_slip",
    "peak_brace_force",
    "peak_column_shear",
    "residual_drift",
    "peak_drift_ratio",
    "storey_transitions",
)


def pair(**links: Any) -> Building:
    return fdspec.side_by_side(Building(**LOW), Building(**HIGH), **links)


@pytest.mark.parametrize(
    ("stands_on", "text"),
    [
        ([0], "stands_on must be 2 whole numbers, one a storey"),
        ([0, 0.5], "stands_on must be 2 whole numbers"),
        ([[0, 1]], "stands_on must be 2 whole numbers"),
        ([0, 2], "counted before the storey's own, but storey 2 stands on 2"),
        ([1, 0], "storey 1 stands on 1"),
        ([0, -1], "storey 2 stands on -1"),
    ],
)
def test_what_no_storey_stands_on(stands_on: Any, text: str) -> None:
    with pytest.raises(InvalidInput, match=text):
        Building(**LOW, stands_on=stands_on)


def test_one_building_is_no_pair() -> None:
    with pytest.raises(InvalidInput, match="two buildings or more"):
        fdspec.side_by_side(Building(**LOW))


def test_a_chain_that_is_told_is_the_building() -> None:
    plain, told = Building(**LOW), Building(**LOW, stands_on=[0, 1])
    assert plain == told
    assert not told.has_devices
    assert "stands_on" not in told.parameters


def test_matrices_of_frames_beside_each_other() -> None:
    building = pair()
    assert building.stands_on.tolist() == [0, 1, 0, 3, 4]
    parts = Building(**LOW), Building(**HIGH)
    for name in ("stiffness_matrix", "damping_matrix"):
        whole = getattr(building, name)
        np.testing.assert_array_equal(whole[:2, :2], getattr(parts[0], name))
        np.testing.assert_array_equal(whole[2:, 2:], getattr(parts[1], name))
        assert not whole[:2, 2:].any()
    for name in ("bare_periods", "braced_periods"):
        each = np.concatenate([getattr(part, name) for part in parts])
        np.testing.assert_allclose(getattr(building, name), np.sort(each)[::-1], rtol=1e-12)
    np.testing.assert_array_equal(building.floor_height, [3.0, 6.0, 4.0, 7.0, 10.0])
    np.testing.assert_array_equal(carried(building.stands_on)[2], [0, 0, 0, 1, 1, 1])
    assert carried(building.stands_on)[5].sum() == 5


@pytest.mark.parametrize("stands_on", [[0, 1, 0, 3, 4], [0, 0, 0, 0, 0], [0, 0, 1, 2, 2], [0, 1, 1, 1, 3]])
def test_a_matrix_falls_into_springs(stands_on: list[int]) -> None:
    rng = np.random.default_rng(5)
    storey, ground = rng.uniform(1.0, 2.0, 5), rng.uniform(0.0, 1.0, 5)
    on = np.array(stands_on)
    ground[on == 0] = 0.0
    matrix = np.diag(ground) + spring_matrix(storey, on)
    found = Linkage.of(matrix, on)
    np.testing.assert_allclose(found.storey, storey, rtol=1e-12)
    np.testing.assert_allclose(found.ground, ground, atol=1e-12)
    matrix[0, 4] = matrix[4, 0] = -0.5
    assert Linkage.of(matrix, on).dense.any()


def test_drifts_are_those_from_the_floor_below() -> None:
    displacement = np.array([[1.0, 3.0, 10.0, 14.0, 20.0]])
    np.testing.assert_array_equal(
        drifts(displacement, np.array([0, 1, 0, 3, 4])), [[1.0, 2.0, 10.0, 4.0, 6.0]]
    )


@pytest.fixture(scope="module")
def histories() -> tuple[Any, Any, Any]:
    apart = pair(links=[Link(2, 5, 1e3, 0.0)])
    return tuple(fdspec.simulate(one, SHORT) for one in (apart, Building(**LOW), Building(**HIGH)))  # type: ignore[return-value]


@pytest.mark.parametrize("name", STOREYS)
def test_frames_that_nothing_joins_are_each_by_itself(histories: tuple[Any, Any, Any], name: str) -> None:
    both, low, high = histories
    each = np.concatenate([low[name].values, high[name].values])
    np.testing.assert_allclose(both[name], each, rtol=1e-9, atol=1e-12 * np.abs(each).max())


@pytest.mark.parametrize("name", ["drift", "storey_shear", "brace_force", "column_shear", "slip"])
def test_their_histories_too(histories: tuple[Any, Any, Any], name: str) -> None:
    both, low, high = histories
    each = np.concatenate([low[name].values, high[name].values], axis=1)
    np.testing.assert_allclose(both[name], each, rtol=0.0, atol=1e-9 * np.abs(each).max())


def test_the_base_shear_is_that_of_all_frames(histories: tuple[Any, Any, Any]) -> None:
    both = histories[0]
    together = np.abs(both["storey_shear"][:, 0] + both["storey_shear"][:, 2]).max().item()
    peak = both["peak_base_shear"].item()
    assert together <= peak * (1.0 + 1e-12)
    assert peak < 1.02 * together
    assert peak < 0.999 * (both["peak_storey_shear"][0] + both["peak_storey_shear"][2]).item()


def test_joined_for_good_they_are_one_frame() -> None:
    """A link that never slips is a spring: a building from matrices has it in its stiffness."""
    frame = {"brace_stiffness": 0.0, "brace_mass": 0.0, "slip_force": 0.0}
    low, high = (
        Building(**{**one, **frame, "yield_shear": None, "gravity_load": None}) for one in (LOW, HIGH)
    )
    joined = fdspec.side_by_side(low, high, links=[Link(2, 4, 30e6, math.inf)])
    across = np.zeros((5, 5))
    across[np.ix_([1, 3], [1, 3])] = 30e6 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    whole = Building.from_matrices(
        joined.floor_mass, joined.stiffness_matrix + across, joined.damping_matrix, **frame
    )
    one, other = fdspec.simulate(joined, SHORT), fdspec.simulate(whole, SHORT)
    for name in ("peak_acceleration", "peak_displacement"):
        np.testing.assert_allclose(one[name], other[name], rtol=1e-10)


def test_how_floors_are_counted_plays_no_part() -> None:
    order = [0, 2, 1, 3, 4]  # the second frame's first storey comes before the first frame's second
    links = [Link(2, 4, 40e6, 20e3), TensionBrace(5, 1, 10e6)]
    one = pair(links=links)
    place = np.argsort(order) + 1
    taken = {
        name: np.asarray(getattr(one, name))[order]
        for name in (
            "floor_mass",
            "storey_stiffness",
            "brace_mass",
            "brace_stiffness",
            "slip_force",
            "yield_shear",
            "hardening_ratio",
            "gravity_load",
            "storey_height",
        )
    }
    other = Building(
        **taken,
        damping=fdspec.DampingMatrix(one.damping_matrix[np.ix_(order, order)]),
        stands_on=[0, 0, 1, 2, 4],
        links=[Link(int(place[1]), int(place[3]), 40e6, 20e3), TensionBrace(int(place[4]), 1, 10e6)],
    )
    first, second = fdspec.simulate(one, SHORT), fdspec.simulate(other, SHORT)
    assert int(first["link_events"].sum()) > 10
    assert int(first["transitions"]) == int(second["transitions"])
    for name in STOREYS:
        values = first[name].values[order]
        np.testing.assert_allclose(second[name], values, rtol=1e-8, atol=1e-11 * np.abs(values).max())
    np.testing.assert_allclose(first["peak_base_shear"], second["peak_base_shear"], rtol=1e-10)


def test_a_cube_of_frames_beside_each_other() -> None:
    """Its limits are those of the frames by themselves, its cells those of histories."""
    elastic = {**HIGH, "yield_shear": None, "gravity_load": None}
    frames = Building(**LOW), Building(**elastic)
    building = fdspec.side_by_side(*frames, links=[Link(2, 5, 20e6, 15e3)])
    cube = fdspec.sweep_buildings([SHORT], building, stiffness_scale=[0.5, 1.0], slip_scale=[0.5, 1.0])
    for limit in ("elastic_acceleration", "braced_acceleration"):
        alone = [
            fdspec.sweep_buildings([SHORT], one, stiffness_scale=[0.5, 1.0], slip_scale=[1.0])[limit].values
            for one in frames
        ]
        np.testing.assert_allclose(cube[limit], np.concatenate(alone, axis=-1), rtol=1e-10)
    history = fdspec.simulate(building, SHORT)
    cell = cube.sel(stiffness_scale=1.0, slip_scale=1.0).squeeze()
    for name in ("peak_drift", "residual_drift", "peak_base_shear", "peak_slip"):
        np.testing.assert_allclose(cell[name], history[name], rtol=1e-12)
    assert (cube["status"] == 0).all()


def test_a_file_says_what_stands_where(tmp_path: Path) -> None:
    path = tmp_path / "pair.toml"
    text = """
floor_mass = [40e3, 30e3, 25e3]
storey_stiffness = [40e6, 25e6, 30e6]
brace_stiffness = [80e6, 50e6, 0.0]
slip_force = [60e3, 40e3, 0.0]
stands_on = [0, 1, 0]

[[links]]
upper = 2
lower = 3
stiffness = 30e6
slip_force = 20e3
"""
    path.write_text(text)
    building = read_building(path, design=True)
    assert building.stands_on.tolist() == [0, 1, 0]
    path.write_text(text.replace("[0, 1, 0]", "[0, 1, 3]"))
    with pytest.raises(InvalidInput, match=r"pair.toml, line 6: stands_on.* storey 3 stands on 3"):
        read_building(path, design=True)


def test_a_history_says_what_stands_where(histories: tuple[Any, Any, Any], tmp_path: Path) -> None:
    both, low, _ = histories
    assert both["stands_on"].values.tolist() == [0, 1, 0, 3, 4]
    assert "stands_on" not in low.coords
    fdspec.save(both, tmp_path / "both.nc")
    assert fdspec.open(tmp_path / "both.nc").identical(both)


def test_profiles_do_not_run_from_one_frame_into_the_next() -> None:
    cube = fdspec.sweep_buildings([SHORT], pair(), stiffness_scale=[1.0], slip_scale=[1.0])
    figure = fdspec.figures.plot_profiles(cube)
    for axis in figure.axes:
        for line in axis.lines:
            height = line.get_ydata()
            assert height.size == 6
            assert np.isnan(height[2])
            assert np.isfinite(np.delete(height, 2)).all()


def test_other_methods_refuse_them() -> None:
    with pytest.raises(InvalidInput, match="need the exact method"):
        fdspec.simulate(pair(), SHORT, method=fdspec.methods.Newmark())
