"""Hysteresis, energy, halts and validation: what the figures of histories show."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from fdspec.errors import InvalidInput
from fdspec.figures import (
    plot_bare_and_damped,
    plot_brace_displacements,
    plot_contact_sheet,
    plot_energy,
    plot_grazing,
    plot_hysteresis,
    shortest_stick,
)
from fdspec.figures.encoding import encode
from fdspec.measures import hysteresis
from fdspec.units import G
from tests.cubes import synthetic_history


@pytest.fixture
def history() -> xr.Dataset:
    """Give 1 s of two storeys; the first slips back, halts for 20 ms, goes on, and later slips forward."""
    made = synthetic_history(samples=1001, storeys=2, transitions=6, seed=6).assign_coords(
        time=1e-3 * np.arange(1001)
    )
    made["phase"].values[0] = 0
    made["transition_time"].values[:] = [0.1, 0.3, 0.32, 0.5, 0.6, 0.9]
    made["transition_storey"].values[:] = 1
    made["transition_phase"].values[:] = [-1, 0, -1, 0, 1, 0]
    return made


def legend_of(figure: Figure) -> list[str]:
    (legend,) = figure.legends
    return [text.get_text() for text in legend.get_texts()]


def test_hysteresis_has_a_loop_a_storey_with_the_energy_it_burned(history: xr.Dataset) -> None:
    history["storey_friction_energy"].values[-1] = [2500.0, 12.5]
    history["slip_force"].values[:] = [50e3, np.inf]
    figure = plot_hysteresis(history)
    assert [axis.get_title() for axis in figure.axes] == ["storey 1: 2.5 kJ", "storey 2: 0.0125 kJ"]
    for axis, storey in zip(figure.axes, (1, 2), strict=True):
        corners = hysteresis(history, storey)
        loop = axis.lines[0]
        np.testing.assert_allclose(loop.get_xdata(), 1e3 * corners["slip"].values, rtol=1e-14)
        np.testing.assert_allclose(loop.get_ydata(), corners["force"].values / 1e3, rtol=1e-14)
        assert axis.get_xlabel() == "slip, floor less brace, mm"
    assert figure.axes[0].get_ylabel() == "friction force, kN"
    assert [line.get_ydata()[0] for line in figure.axes[0].lines[1:]] == [-50.0, 50.0]
    assert len(figure.axes[1].lines) == 1
    assert len({axis.get_xlim() for axis in figure.axes}) == 1


def test_hysteresis_of_six_storeys_stands_in_two_rows() -> None:
    figure = plot_hysteresis(synthetic_history(storeys=6, transitions=0))
    assert len(figure.axes) == 6
    assert [bool(axis.get_xlabel()) for axis in figure.axes] == [False, False, True, True, True, True]
    assert [bool(axis.get_ylabel()) for axis in figure.axes] == [True, False, False, False, True, False]


def balanced(history: xr.Dataset) -> xr.Dataset:
    """Give the history energies that close: 0 until 0.2 s, then friction 6, viscous 2, others 1 kJ."""
    on = history["time"].values > 0.2
    terms = {"friction": 6e3, "viscous": 2e3, "strain": 1e3, "kinetic": 1e3, "input": 10e3}
    for name, value in terms.items():
        history[f"{name}_energy"].values[:] = np.where(on, value, 0.0)
    history["energy_error"].values[...] = 2e-13
    return history


def heights(collection) -> tuple[float, float]:
    """Return bottom and top of a field at the last instant."""
    vertices = collection.get_paths()[0].vertices
    last = vertices[np.isclose(vertices[:, 0], vertices[:, 0].max())]
    return last[:, 1].min(), last[:, 1].max()


def test_energy_stacks_the_terms_below_the_input(history: xr.Dataset) -> None:
    figure = plot_energy(balanced(history))
    energy, share = figure.axes
    assert [heights(field) for field in energy.collections] == [(0, 6), (6, 8), (8, 9), (9, 10)]
    (given,) = energy.lines
    np.testing.assert_allclose(given.get_ydata(), history["input_energy"].values / 1e3)
    np.testing.assert_allclose(
        [heights(field) for field in share.collections], [(0, 60), (60, 80), (80, 90), (90, 100)], atol=1e-12
    )
    assert share.get_ylim() == (0.0, 100.0)
    assert legend_of(figure) == ["input", "motion", "strain", "viscous damping", "friction"]
    assert (energy.get_ylabel(), share.get_ylabel()) == ("energy, kJ", "share, %")
    assert share.get_xlabel() == "time, s"
    assert figure.get_suptitle().endswith("differ by 2e-13 of the input")


def test_shares_of_next_to_nothing_are_not_drawn(history: xr.Dataset) -> None:
    share = plot_energy(balanced(history)).axes[1]
    vertices = share.collections[0].get_paths()[0].vertices
    assert vertices[vertices[:, 0] <= 0.2][:, 1].max() == 0.0
    assert vertices[vertices[:, 0] > 0.205][:, 1].max() == pytest.approx(60.0)


def test_the_shortest_stick_lies_between_slips_of_one_direction(history: xr.Dataset) -> None:
    assert shortest_stick(history) == (0.3, 0.32)
    history["transition_phase"].values[:] = [-1, 0, 1, 0, 1, 0]
    assert shortest_stick(history) == (0.5, 0.6)
    history["transition_phase"].values[:] = [-1, 0, 1, 0, -1, 0]
    with pytest.raises(InvalidInput, match="no stick between two slips of one direction in storey 1"):
        shortest_stick(history)
    with pytest.raises(InvalidInput, match="storey must be from 1 to 2, got 3"):
        shortest_stick(history, 3)


def test_a_halt_is_drawn_around_and_at_its_own_scale(history: xr.Dataset) -> None:
    history["slip_force"].values[0] = 50e3
    history["friction_force"].values[:, 0] = -49e3
    stepped = history.isel(time=slice(None, None, 50))
    figure = plot_grazing(history, (0.3, 0.32), before=0.05, after=0.08, stepped=stepped)
    left, right = figure.axes[0::2], figure.axes[1::2]
    np.testing.assert_allclose([axis.get_xlim() for axis in left], 3 * [(-50.0, 80.0)], rtol=1e-12)
    np.testing.assert_allclose([axis.get_xlim() for axis in right], 3 * [(-40.0, 60.0)], rtol=1e-12)
    labels = ["sliding velocity, mm/s", "friction force, kN", "acceleration, g"]
    assert [axis.get_ylabel() for axis in left] == labels
    one = history.sel(storey=1)
    window = (one["time"].values >= 0.25) & (one["time"].values <= 0.38)
    for axis, values in zip(
        left,
        (
            1e3 * (one["velocity"] - one["brace_velocity"]).values,
            one["friction_force"].values / 1e3,
            one["acceleration"].values / G,
        ),
        strict=True,
    ):
        exact, dots = axis.lines[:2]
        np.testing.assert_allclose(exact.get_ydata(), values[window], rtol=1e-13)
        np.testing.assert_allclose(dots.get_xdata(), [-50.0, 0.0, 50.0], atol=1e-9)
        np.testing.assert_allclose(dots.get_ydata(), values[[250, 300, 350]], rtol=1e-13)
        spans = [(patch.get_x(), patch.get_x() + patch.get_width()) for patch in axis.patches]
        assert spans == [pytest.approx((-200.0, 0.0)), pytest.approx((20.0, 200.0))]
    assert [line.get_ydata()[0] for line in left[1].lines if line.get_linestyle() == "--"] == [-50.0]
    inside = (one["time"].values >= 0.26) & (one["time"].values <= 0.36)
    most = np.abs((one["acceleration"].values / G)[inside]).max()
    assert right[2].get_ylim()[1] < 1.2 * most
    assert right[0].get_title() == "the stick, 20000 µs"
    assert legend_of(figure) == ["exact", "fixed step", "slips backward"]


def test_a_halt_between_samples_is_refused(history: xr.Dataset) -> None:
    coarse = history.isel(time=slice(None, None, 5))
    with pytest.raises(
        InvalidInput, match=r"has 5 outputs, and 10 are needed; simulate with a dt_out of 0.001 s"
    ):
        plot_grazing(coarse, (0.3, 0.32), before=0.1, after=0.1)


def test_bare_and_damped_floors_from_the_top(history: xr.Dataset) -> None:
    bare = synthetic_history(samples=1001, storeys=2, seed=8)
    history["peak_displacement"].values[:] = [0.0123, 0.0456]
    figure = plot_bare_and_damped(bare, history, title="Figure 6", caption="Where from.", end=0.7)
    assert [axis.get_ylabel() for axis in figure.axes] == ["floor 2, mm", "floor 1, mm"]
    for axis, storey in zip(figure.axes, (2, 1), strict=True):
        for line, data in zip(axis.lines, (bare, history), strict=True):
            np.testing.assert_allclose(line.get_ydata(), 1e3 * data["displacement"].sel(storey=storey).values)
    (told,) = [
        text.get_text() for text in figure.axes[0].get_legend().get_texts() if "damper" in text.get_text()
    ]
    assert told == "with friction dampers, peak 45.6 mm"
    assert figure.axes[1].get_xlim() == (0.0, 0.7)
    assert figure.get_suptitle() == "Figure 6"
    assert figure.get_supxlabel() == "Where from."


def test_bare_and_damped_must_be_of_one_height(history: xr.Dataset) -> None:
    with pytest.raises(InvalidInput, match="bare has 3 storeys, damped 2"):
        plot_bare_and_damped(synthetic_history(storeys=3), history)


def test_each_method_is_drawn_over_the_first(history: xr.Dataset) -> None:
    other = history.isel(time=slice(None, None, 10)).copy(deep=True)
    other["brace_displacement"].values[3, 0] += 7.0  # m
    figure = plot_brace_displacements({"exact": history, "band": other}, end=0.5, caption="Words.")
    exact, band, error = figure.axes
    np.testing.assert_allclose(exact.lines[0].get_ydata(), 1e3 * history["brace_displacement"].sel(storey=1))
    behind, before = band.lines
    assert np.array_equal(behind.get_ydata(), exact.lines[0].get_ydata())
    np.testing.assert_allclose(before.get_ydata(), 1e3 * other["brace_displacement"].sel(storey=1))
    assert band.get_title(loc="left").endswith("off by up to 7000 mm")
    most = np.abs(1e3 * history["brace_displacement"].sel(storey=1).values[:501]).max()
    assert exact.get_ylim() == band.get_ylim() == (pytest.approx(-1.25 * most), pytest.approx(1.25 * most))
    assert figure.get_supylabel() == "displacement of the brace, mm"
    assert error.get_yscale() == "log"
    apart = np.abs(before.get_ydata() - behind.get_ydata()[::10])
    drawn = error.lines[0].get_ydata()
    assert (np.diff(drawn) >= 0.0).all()
    assert drawn[-1] == pytest.approx(apart.max())
    assert len(plot_brace_displacements({"exact": history}).axes) == 1
    with pytest.raises(InvalidInput, match="histories must name one or more"):
        plot_brace_displacements({})


def test_a_contact_sheet_holds_every_picture_by_name(history: xr.Dataset) -> None:
    png = encode(plot_hysteresis(history), "png")
    names = [f"Figure {k}" for k in range(4, 10)]
    figure = plot_contact_sheet(dict.fromkeys(names, png), title="All of them")
    assert [axis.get_title() for axis in figure.axes] == names
    assert all(axis.images[0].get_array().shape[2] in {3, 4} for axis in figure.axes)
    places = {(round(axis.get_position().x0, 3), round(axis.get_position().y0, 3)) for axis in figure.axes}
    assert len(places) == 6
    with pytest.raises(InvalidInput, match="pictures must name one or more"):
        plot_contact_sheet({})
