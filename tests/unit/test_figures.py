"""What the figures show: panels, labels, limits, and the data in their artists."""

import io
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from fdspec.errors import InvalidInput
from fdspec.figures import plot_acceleration_maps, plot_acceleration_surfaces, plot_history
from fdspec.figures.history import phase_spans
from fdspec.units import G
from tests.cubes import synthetic_cube, synthetic_history

SHAPE = (5, 4, 6)


@pytest.fixture
def cube() -> xr.Dataset:
    """Give a cube whose accelerations are 0 to 1.2 g and whose statuses are all ok."""
    made = synthetic_cube(["FSR1", "FHR1"], SHAPE, seed=3)
    random = np.random.default_rng(4)
    made["peak_acceleration"].values[:] = random.uniform(0.0, 1.2 * G, made["peak_acceleration"].shape)
    made["status"].values[:] = 0
    return made


@pytest.fixture
def history() -> xr.Dataset:
    made = synthetic_history(samples=50, storeys=2, transitions=4, seed=5)
    made["transition_time"].values[:] = [0.05, 0.1, 0.2, 0.3]
    made["transition_storey"].values[:] = [1, 2, 1, 1]
    made["transition_phase"].values[:] = [1, -1, -1, 0]
    made["phase"].values[:] = 0
    return made


def titles(figure: Figure) -> list[str]:
    return [axis.get_title() for axis in figure.axes if axis.get_title()]


def png(figure: Figure) -> bytes:
    file = io.BytesIO()
    figure.savefig(file, format="png")
    return file.getvalue()


BOTH = pytest.mark.parametrize("plot", [plot_acceleration_maps, plot_acceleration_surfaces])


@BOTH
def test_a_panel_for_each_stiffness_ratio(plot, cube: xr.Dataset) -> None:
    assert titles(plot(cube, "FSR1")) == [f"stiffness ratio {x:g}" for x in cube["stiffness_ratio"].values]


@BOTH
def test_the_title_names_the_record_really_used(plot, cube: xr.Dataset) -> None:
    cube["source"] = ("record", ["another", "stand-in for the study's FHR1: Loma Prieta"])
    cube["pga"].values[1] = 0.41 * G
    cube["scale_factor"].values[1] = 0.993
    lines = plot(cube, "FHR1").get_suptitle().splitlines()
    assert lines == [
        "Peak absolute acceleration of the floor, record FHR1",
        "stand-in for the study's FHR1: Loma Prieta",
        "PGA 0.41 g, the recorded motion times 0.993",
    ]


@BOTH
@pytest.mark.parametrize("panels", [1, 2, 5])
def test_a_long_title_fits_the_picture(plot, cube: xr.Dataset, panels: int) -> None:
    cube["source"] = ("record", ["rotated from 000 and 090: fault-normal is 038, " * 4] * 2)
    figure = plot(cube.isel(stiffness_ratio=slice(0, panels)), "FSR1")
    png(figure)  # lays it out
    box = figure.texts[0].get_window_extent()
    assert box.x0 >= 0.0
    assert box.x1 <= figure.bbox.x1
    assert max(axis.get_tightbbox().y1 for axis in figure.axes[:panels]) <= box.y0


@BOTH
def test_a_record_as_recorded_is_not_said_to_be_scaled(plot, cube: xr.Dataset) -> None:
    cube["scale_factor"].values[:] = 1.0
    assert "times" not in plot(cube, "FSR1").get_suptitle()


@BOTH
def test_colours_carry_their_unit(plot, cube: xr.Dataset) -> None:
    assert plot(cube, "FSR1").axes[-1].get_ylabel().endswith("peak absolute acceleration, g")


@BOTH
@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda cube: cube.drop_vars("peak_acceleration"), "has no peak_acceleration"),
        (lambda cube: cube.isel(period=[0]), "over period needs at least 2 finite values, the cube has 1"),
        (lambda cube: cube.isel(pretension=[0]), "over pretension needs at least 2 finite values"),
        (lambda cube: cube.sel(record=["FHR1"]), "has no record 'FSR1'; it has FHR1"),
        (lambda cube: cube.assign(status=cube["status"] + 1), "no history of record 'FSR1' ended well"),
    ],
)
def test_what_cannot_be_drawn_is_refused(plot, cube: xr.Dataset, change, message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        plot(change(cube), "FSR1")


@BOTH
def test_the_same_data_give_the_same_bytes_and_the_cube_stays(plot, cube: xr.Dataset) -> None:
    before = cube.copy(deep=True)
    assert png(plot(cube, "FSR1")) == png(plot(cube, "FSR1"))
    assert cube.identical(before)


@BOTH
def test_an_infinite_pretension_is_left_out(plot, cube: xr.Dataset) -> None:
    pretension = cube["pretension"].values.copy()
    pretension[-1] = np.inf
    limit = plot(cube.assign_coords(pretension=pretension), "FSR1")
    assert png(limit) == png(plot(cube.isel(pretension=slice(0, -1)), "FSR1"))


def test_maps_share_one_scale_from_zero_to_above_the_largest(cube: xr.Dataset) -> None:
    figure = plot_acceleration_maps(cube, "FSR1")
    levels = [axis.collections[0].levels for axis in figure.axes[: SHAPE[0]]]
    largest = cube["peak_acceleration"].sel(record="FSR1").max().item() / G
    assert levels[0][0] == 0.0
    assert levels[0][-2] < largest <= levels[0][-1]
    assert all(np.array_equal(one, levels[0]) for one in levels)


def test_maps_span_the_axes_in_seconds_and_kilonewtons(cube: xr.Dataset) -> None:
    figure = plot_acceleration_maps(cube, "FSR1")
    first, *_, last = figure.axes[: SHAPE[0]]
    assert first.get_xlim() == (cube["period"].values[0], cube["period"].values[-1])
    assert first.get_ylim() == (cube["pretension"].values[0] / 1e3, cube["pretension"].values[-1] / 1e3)
    assert first.get_ylabel() == "pretension, kN"
    assert last.get_xlabel() == "period without brace, s"


def test_every_column_of_maps_has_its_periods_below(cube: xr.Dataset) -> None:
    """Five panels stand in rows of three and two: the last column ends in the first row."""
    figure = plot_acceleration_maps(cube, "FSR1")
    png(figure)  # lays it out
    below = [bool(axis.get_xlabel()) for axis in figure.axes[:5]]
    assert below == [False, False, True, True, True]
    ticked = [any(label.get_visible() for label in axis.get_xticklabels()) for axis in figure.axes[:5]]
    assert ticked == below


def test_dots_mark_the_pretension_of_the_smallest_acceleration(cube: xr.Dataset) -> None:
    peak = cube["peak_acceleration"].sel(record="FSR1")
    cube["status"].loc[{"record": "FSR1"}].values[0, :, 2] = 1
    figure = plot_acceleration_maps(cube, "FSR1")
    for index, axis in enumerate(figure.axes[: SHAPE[0]]):
        (dots,) = axis.get_lines()
        best = cube["pretension"].values[peak[index].argmin("pretension").values] / 1e3
        known = np.arange(SHAPE[2]) != 2 if index == 0 else np.full(SHAPE[2], True)
        assert np.array_equal(dots.get_xdata(), cube["period"].values[known])
        assert np.array_equal(dots.get_ydata(), best[known])
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [
        "pretension of the smallest acceleration at each period"
    ]


def test_surfaces_share_height_and_say_their_units(cube: xr.Dataset) -> None:
    figure = plot_acceleration_surfaces(cube, "FSR1")
    panels = figure.axes[: SHAPE[0]]
    assert len({axis.get_zlim() for axis in panels}) == 1
    assert panels[0].get_zlim()[0] == 0.0
    assert {axis.get_xlabel() for axis in panels} == {"period, s"}
    assert {axis.get_ylabel() for axis in panels} == {"pretension, kN"}


def test_surfaces_are_coloured_on_one_scale(cube: xr.Dataset) -> None:
    figure = plot_acceleration_surfaces(cube, "FSR1")
    surfaces = [axis.collections[0] for axis in figure.axes[: SHAPE[0]]]
    assert all(isinstance(surface, PolyCollection) for surface in surfaces)
    assert len({(surface.norm.vmin, surface.norm.vmax) for surface in surfaces}) == 1
    assert surfaces[0].norm.vmin == 0.0
    assert surfaces[0].norm.vmax == pytest.approx(1.2)


def test_phase_spans_are_the_exact_instants_of_one_storey(history: xr.Dataset) -> None:
    assert list(phase_spans(history, 1)) == [(0.0, 0.05, 0), (0.05, 0.2, 1), (0.2, 0.3, -1), (0.3, 0.49, 0)]
    assert list(phase_spans(history, 2)) == [(0.0, 0.1, 0), (0.1, 0.49, -1)]


def test_history_draws_one_storey_in_readable_units(history: xr.Dataset) -> None:
    figure = plot_history(history, storey=2)
    displaced, held, _, accelerated, loop, _ = figure.axes
    one = history.sel(storey=2)
    lines = {
        line.get_label(): line.get_ydata() for axis in (displaced, accelerated) for line in axis.lines[:1]
    }
    assert np.allclose(lines["floor"], one["acceleration"].values / G)
    assert np.allclose(displaced.lines[0].get_ydata(), one["displacement"].values * 1e3)
    assert np.allclose(displaced.lines[1].get_ydata(), one["brace_displacement"].values * 1e3)
    assert np.allclose(held.lines[0].get_ydata(), one["friction_force"].values / 1e3)
    slip = (one["displacement"] - one["brace_displacement"]).values * 1e3
    assert np.allclose(loop.lines[0].get_xdata(), slip)
    assert [axis.get_ylabel() for axis in (displaced, held, accelerated)] == [
        "displacement, mm",
        "friction force, kN",
        "absolute acceleration, g",
    ]
    assert accelerated.get_xlabel() == "time, s"
    assert figure.get_suptitle().splitlines()[0] == "Response to FSR1, storey 2 of 2"


def test_history_draws_the_slip_force_where_it_is_finite(history: xr.Dataset) -> None:
    history["slip_force"].values[:] = [50e3, np.inf]
    limits = [line.get_ydata()[0] for line in plot_history(history, 1).axes[1].lines[1:]]
    assert limits == [-50.0, 50.0]
    assert len(plot_history(history, 2).axes[1].lines) == 1


def test_history_colours_slip_by_its_direction(history: xr.Dataset) -> None:
    strip = plot_history(history, 1).axes[2]
    forward, backward = strip.collections
    assert [path.get_extents().intervalx.tolist() for path in forward.get_paths()] == [[0.05, 0.2]]
    assert [path.get_extents().intervalx.tolist() for path in backward.get_paths()] == [[0.2, 0.3]]
    assert [forward.get_label(), backward.get_label()] == ["slips forward", "slips backward"]


def test_history_of_a_storey_that_is_not_there(history: xr.Dataset) -> None:
    with pytest.raises(InvalidInput, match="storey must be from 1 to 2, got 3"):
        plot_history(history, 3)


def test_figures_keep_no_state_of_pyplot() -> None:
    code = "import sys, fdspec.figures; print('matplotlib.pyplot' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert done.stdout.strip() == "False"
