"""Axes and scalars of a sweep: what is taken, what is refused, and in which words."""

import dataclasses

import numpy as np
import pytest

from fdspec.errors import InvalidInput
from fdspec.model.grid import GRID_FIELDS, Grid

AXES = {"stiffness_ratio": [1.0, 4.0], "pretension": [0.0, 100e3, np.inf], "period": [0.1, 0.2, 0.5, 1.0]}


def grid(**changes: object) -> Grid:
    return Grid(**{**AXES, **changes})


def test_shape_and_size_follow_the_order_of_the_cube() -> None:
    assert grid().shape == (2, 3, 4)
    assert grid().size == 24


def test_axes_are_own_read_only_doubles() -> None:
    period = np.array([1, 2, 3])
    made = grid(period=period)
    period[0] = 9
    assert made.period.dtype == np.float64
    assert made.period.tolist() == [1.0, 2.0, 3.0]
    with pytest.raises(ValueError, match="read-only"):
        made.period[0] = 2.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        made.floor_mass = 1.0  # type: ignore[misc]


def test_a_single_number_is_an_axis_of_one() -> None:
    assert grid(period=0.5).shape == (2, 3, 1)


def test_the_study_s_grid() -> None:
    study = Grid.study()
    assert study.shape == (7, 11, 60)
    assert study.size * 9 == 41_580
    assert study.stiffness_ratio.tolist() == [0.5, 1, 2, 4, 6, 8, 10]
    assert study.pretension.tolist() == [10e3 + 100e3 * k for k in range(11)]
    assert study.period.tolist() == [float(f"{0.05 * k:.2f}") for k in range(1, 61)]
    assert (study.floor_mass, study.brace_mass, study.damping_ratio) == (20e3, 50.0, 0.05)


def test_slip_force_is_coefficient_times_factor_times_pretension() -> None:
    made = grid(friction_coefficient=0.4, kinetic_friction_coefficient=0.3, normal_force_factor=4)
    assert made.slip_force.tolist() == [0.0, 0.4 * 4 * 100e3, np.inf]
    assert made.kinetic_slip_force.tolist() == [0.0, 0.3 * 4 * 100e3, np.inf]


def test_without_a_kinetic_coefficient_both_forces_are_the_static_one() -> None:
    assert grid().kinetic_slip_force.tolist() == grid().slip_force.tolist()


def test_an_infinite_pretension_never_slides_also_with_no_kinetic_friction() -> None:
    assert grid(kinetic_friction_coefficient=0).kinetic_slip_force.tolist() == [0.0, 0.0, np.inf]


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("period", [], "period: must hold at least one value, is empty"),
        ("period", [0.5, -0.5], "period: values must be positive, got -0.5 at index 1"),
        ("period", [0.0, 0.5], "period: values must be positive, got 0 at index 0"),
        ("period", [0.5, np.nan], "period: values must be numbers, got nan at index 1"),
        ("period", [0.5, np.inf], "period: values must be finite, got inf at index 1"),
        ("period", [0.1, 0.5, 0.5], "period: values must differ, 0.5 stands at index 1 and 2"),
        ("period", [0.1, 0.5, 0.3], "period: values must increase, got 0.3 at index 2 after 0.5"),
        ("period", "fast", "period: must be a list of numbers, got 'fast'"),
        ("period", [True, False], "period: must be a list of numbers, got [True, False]"),
        ("period", [[0.1, 0.2]], "period: must be a list of numbers, got an array of shape (1, 2)"),
        ("period", [[0.1], [0.2, 0.3]], "period: must be a list of numbers, all at one level"),
        ("pretension", [-1.0, 2.0], "pretension: values must be zero or positive, got -1 at index 0"),
        ("stiffness_ratio", [0.0], "stiffness_ratio: values must be positive, got 0 at index 0"),
        ("floor_mass", 0.0, "floor_mass: must be positive, got 0"),
        ("floor_mass", "heavy", "floor_mass: must be a number, got 'heavy'"),
        ("floor_mass", None, "floor_mass: must be a number, got None"),
        ("floor_mass", np.inf, "floor_mass: must be finite, got inf"),
        ("brace_mass", -1, "brace_mass: must be zero or positive, got -1"),
        ("damping_ratio", 1.0, "damping_ratio: must be less than 1, got 1"),
        ("brace_damping_ratio", -0.1, "brace_damping_ratio: must be zero or positive, got -0.1"),
        ("normal_force_factor", 0, "normal_force_factor: must be positive, got 0"),
        (
            "kinetic_friction_coefficient",
            0.6,
            "kinetic_friction_coefficient: must be at most friction_coefficient, 0.5, got 0.6",
        ),
        (
            "friction_coefficient",
            0,
            "friction_coefficient: must be positive where pretension is infinite, got 0",
        ),
    ],
)
def test_a_mistake_is_named_with_its_value(name: str, value: object, message: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        grid(**{name: value})
    assert str(caught.value) == message


def test_all_mistakes_come_at_once() -> None:
    with pytest.raises(InvalidInput) as caught:
        grid(period=[-1.0], floor_mass=-2.0, damping_ratio=3.0)
    assert [part.split(":")[0] for part in str(caught.value).split("; ")] == [
        "period",
        "floor_mass",
        "damping_ratio",
    ]


@pytest.mark.parametrize(
    "name", ["brace_mass", "damping_ratio", "friction_coefficient", "brace_damping_ratio"]
)
def test_zero_is_allowed_where_it_means_something(name: str) -> None:
    assert getattr(grid(pretension=[1.0], **{name: 0}), name) == 0.0


def test_every_field_has_a_rule() -> None:
    for name in GRID_FIELDS:
        with pytest.raises(InvalidInput, match=f"^{name}: "):
            grid(**{name: "nonsense"})
