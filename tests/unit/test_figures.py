"""What the figures show: panels, labels, limits, and the data in their artists."""

import io
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.text import Text

import fdspec
from fdspec.errors import InvalidInput
from fdspec.figures import (
    acceleration_caption,
    ensemble_caption,
    plot_acceleration,
    plot_acceleration_maps,
    plot_acceleration_print,
    plot_chart,
    plot_ensemble,
    plot_history,
)
from fdspec.figures.encoding import encode
from fdspec.figures.panels import BAND, BEST, HEIGHT
from fdspec.figures.storeys import phase_spans
from fdspec.measures import hysteresis
from fdspec.units import G
from tests.cubes import synthetic_cube, synthetic_history
from tests.explored import own_motion

SHAPE = (5, 4, 6)

RATIOS = np.array([0.5, 1.0, 2.0, 4.0, 8.0])


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


BOTH = pytest.mark.parametrize("plot", [plot_acceleration_maps, plot_acceleration])


def maps(figure: Figure) -> list:
    """Return the axes of the maps, without surfaces, strips and scale."""
    return [axis for axis in figure.axes if axis.get_ylabel() == "pretension, kN" and axis.name != "3d"]


def surfaces(figure: Figure) -> list:
    return [axis for axis in figure.axes if axis.name == "3d"]


def strips(axis) -> dict:
    return {child.get_label(): child for child in axis.child_axes}


def _idle(figure: Figure) -> list[Text]:
    """Return the numbers of axes in space that lie beyond their limits, which are kept but not drawn."""
    axes = [axis for space in surfaces(figure) for axis in (space.xaxis, space.yaxis, space.zaxis)]
    return [
        label
        for axis in axes
        for tick in axis.get_major_ticks()
        if not min(axis.get_view_interval()) - 1e-9 <= tick.get_loc() <= max(axis.get_view_interval()) + 1e-9
        for label in (tick.label1, tick.label2)
    ]


def overlapping(figure: Figure) -> list[tuple[str, str]]:
    """Return the pairs of texts that stand on each other, and (text, "edge") for those that the page cuts."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    texts = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip()]
    texts = [text for text in texts if not any(text is idle for idle in _idle(figure))]
    drawn = [(text.get_text(), text.get_window_extent(canvas.get_renderer())) for text in texts]
    slanted = {
        text.get_text() for text in texts if text.get_rotation() % 90.0
    }  # their boxes are mostly empty
    drawn = [(text, box) for text, box in drawn if box.width > 0.0]
    page = figure.bbox
    cut = [
        (text, "edge")
        for text, box in drawn
        if box.x0 < page.x0 or box.x1 > page.x1 or box.y0 < page.y0 or box.y1 > page.y1
    ]
    shrunk = [(text, box.padded(-1.0)) for text, box in drawn if text not in slanted and box.width > 2.0]
    return cut + [
        (one, other)
        for k, (one, a) in enumerate(shrunk)
        for other, b in shrunk[k + 1 :]
        if a.x0 < b.x1 and b.x0 < a.x1 and a.y0 < b.y1 and b.y0 < a.y1
    ]


def test_maps_have_a_panel_for_each_stiffness_ratio(cube: xr.Dataset) -> None:
    ratios = [f"stiffness ratio {x:g}" for x in cube["stiffness_ratio"].values]
    assert titles(plot_acceleration_maps(cube, "FSR1")) == ratios


def test_the_title_of_maps_names_the_record_really_used(cube: xr.Dataset) -> None:
    cube["source"] = ("record", ["another", "stand-in for the study's FHR1: Loma Prieta"])
    cube["pga"].values[1] = 0.41 * G
    cube["scale_factor"].values[1] = 0.993
    lines = plot_acceleration_maps(cube, "FHR1").get_suptitle().splitlines()
    assert lines == [
        "Peak absolute acceleration of the floor, record FHR1",
        "stand-in for the study's FHR1: Loma Prieta",
        "PGA 0.41 g, the recorded motion times 0.993",
    ]


def test_the_caption_names_the_record_really_used_and_the_frame(cube: xr.Dataset) -> None:
    cube["source"] = ("record", ["another", "stand-in for the study's FHR1: Loma Prieta"])
    cube["pga"].values[1] = 0.41 * G
    cube["scale_factor"].values[1] = 0.993
    cube.attrs["parameters"] = '{"floor_mass": 20000.0, "damping_ratio": 0.05, "period": [0.1, 0.2]}'
    words = acceleration_caption(cube, "FHR1")
    used = "stand-in for the study's FHR1: Loma Prieta; PGA 0.41 g, the recorded motion times 0.993"
    assert f"ground motion FHR1 ({used}). Frame: floor 20\u00a0000\u00a0kg, damping ratio 0.05." in words
    figure = plot_acceleration(cube, "FHR1", caption=words)
    below = figure.texts[-1]
    assert below.get_text().replace("\n", " ") == words
    figure.savefig(io.BytesIO())
    assert below.get_window_extent().y1 < min(axis.get_tightbbox().y0 for axis in maps(figure))


@pytest.mark.parametrize("panels", [1, 2, 5])
def test_a_long_title_fits_the_maps(cube: xr.Dataset, panels: int) -> None:
    cube["source"] = ("record", ["rotated from 000 and 090: fault-normal is 038, " * 4] * 2)
    assert not overlapping(plot_acceleration_maps(cube.isel(stiffness_ratio=slice(0, panels)), "FSR1"))


@BOTH
def test_a_record_as_recorded_is_not_said_to_be_scaled(plot, cube: xr.Dataset) -> None:
    cube["scale_factor"].values[:] = 1.0
    assert "times" not in plot(cube, "FSR1").get_suptitle()
    assert "motion times" not in acceleration_caption(cube, "FSR1")


@BOTH
def test_colours_carry_their_unit(plot, cube: xr.Dataset) -> None:
    assert plot(cube, "FSR1").axes[-1].get_ylabel() == "peak absolute acceleration, g"


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


def smooth() -> xr.Dataset:
    """Give a cube on the study's grid whose values look like spectra, for pictures to be laid out."""
    ratio, force, period = np.meshgrid(
        [0.5, 1.0, 2.0, 4.0, 8.0, 10.0], np.linspace(10e3, 1010e3, 11), 0.05 * np.arange(1, 61), indexing="ij"
    )
    spectrum = (1.0 + np.sin(9.0 * period)) * np.exp(-period) + 0.2
    peak = G * spectrum * (1.0 + 0.1 * ratio * np.abs(force / 1e6 - 0.2))
    made = synthetic_cube(["FSR1", "FHR1"], peak.shape)
    made["peak_acceleration"].values[:] = peak
    made["elastic_acceleration"].values[:] = G * spectrum[0, 0]
    made["braced_acceleration"].values[:] = 1.2 * G * spectrum[:, 0]
    made["status"].values[:] = 0
    ratios = np.array([0.5, 1.0, 2.0, 4.0, 8.0, 10.0])
    return made.assign_coords(stiffness_ratio=ratios, pga=("record", [0.345 * G, 0.41 * G]))


@BOTH
def test_no_words_stand_on_others_or_are_cut(plot) -> None:
    study = smooth()
    more = {} if plot is plot_acceleration_maps else {"caption": acceleration_caption(study, "FSR1")}
    assert not overlapping(plot(study, "FSR1", **more))


@BOTH
def test_maps_share_one_scale_from_zero_to_above_the_largest(plot, cube: xr.Dataset) -> None:
    cube["braced_acceleration"].values[0, 0, 0] = 1.9 * G
    figure = plot(cube.assign_coords(stiffness_ratio=RATIOS), "FSR1")
    levels = [axis.collections[0].levels for axis in maps(figure)]
    levels += [strip.collections[0].levels for axis in maps(figure) for strip in axis.child_axes]
    assert levels[0][0] == 0.0
    assert levels[0][-2] < 1.9 <= levels[0][-1]
    assert all(np.array_equal(one, levels[0]) for one in levels)


@BOTH
def test_maps_span_the_axes_in_seconds_and_kilonewtons(plot, cube: xr.Dataset) -> None:
    drawn = maps(plot(cube.assign_coords(stiffness_ratio=RATIOS), "FSR1"))
    assert len(drawn) == 5
    for axis in drawn:
        assert axis.get_xlim() == (cube["period"].values[0], cube["period"].values[-1])
        assert axis.get_ylim() == (cube["pretension"].values[0] / 1e3, cube["pretension"].values[-1] / 1e3)
        assert [text.get_text() for text in axis.texts if "period" in text.get_text()] == [
            "period without brace, s"
        ]


@BOTH
def test_maps_are_filled_with_the_cube_in_g(plot, cube: xr.Dataset) -> None:
    """A cube that is flat but for one panel fills each map with the one field its value lies in."""
    for k, value in enumerate((0.35, 0.55, 0.75, 0.95, 1.15)):
        cube["peak_acceleration"].values[0, k] = value * G
    for name in ("elastic_acceleration", "braced_acceleration"):
        cube[name].values[:] = 1.3 * G
    figure = plot(cube.assign_coords(stiffness_ratio=RATIOS), "FSR1")
    for axis, value in zip(maps(figure), (0.35, 0.55, 0.75, 0.95, 1.15), strict=True):
        filled = axis.collections[0]
        fields = [k for k, path in enumerate(filled.get_paths()) if len(path.vertices)]
        (field,) = fields
        assert filled.levels[field] <= value < filled.levels[field + 1]


@BOTH
def test_strips_carry_the_limits_of_the_free_and_the_braced_frame(plot, cube: xr.Dataset) -> None:
    cube["elastic_acceleration"].values[:] = 0.25 * G
    cube["braced_acceleration"].values[:] = np.array([0.45, 0.65, 0.85, 1.05, 1.15])[:, None] * G
    figure = plot(cube.assign_coords(stiffness_ratio=RATIOS), "FSR1")
    for axis, braced in zip(maps(figure), (0.45, 0.65, 0.85, 1.05, 1.15), strict=True):
        found = strips(axis)
        assert set(found) == {"free", "braced"}
        assert found["free"].get_position().y1 <= axis.get_position().y0
        assert found["braced"].get_position().y0 >= axis.get_position().y1
        for name, value in (("free", 0.25), ("braced", braced)):
            strip = found[name]
            (field,) = [k for k, path in enumerate(strip.collections[0].get_paths()) if len(path.vertices)]
            low, high = strip.collections[0].levels[field : field + 2]
            assert low <= value < high
            assert strip.get_xlim() == axis.get_xlim()
            assert [label.get_text() for label in strip.get_yticklabels()] == [name]


@BOTH
def test_a_cube_without_limits_has_no_strips(plot, cube: xr.Dataset) -> None:
    bare = cube.drop_vars(["elastic_acceleration", "braced_acceleration"])
    assert all(not axis.child_axes for axis in maps(plot(bare, "FSR1")))


@BOTH
def test_a_line_marks_the_pretension_of_the_smallest_acceleration(plot, cube: xr.Dataset) -> None:
    cube = cube.assign_coords(stiffness_ratio=RATIOS)
    peak = cube["peak_acceleration"].sel(record="FSR1")
    cube["status"].loc[{"record": "FSR1"}].values[0, :, 2] = 1
    for index, axis in enumerate(maps(plot(cube, "FSR1"))):
        (line,) = axis.get_lines()
        best = cube["pretension"].values[peak[index].argmin("pretension").values] / 1e3
        known = np.arange(SHAPE[2]) != 2 if index == 0 else np.full(SHAPE[2], True)
        assert np.array_equal(line.get_xdata(), cube["period"].values[known])
        assert np.array_equal(line.get_ydata(), best[known])
        assert line.get_label() == BEST


def test_maps_say_what_line_and_hatching_are(cube: xr.Dataset) -> None:
    (legend,) = plot_acceleration_maps(cube, "FSR1").legends
    assert [text.get_text() for text in legend.get_texts()] == [BEST, BAND]


@BOTH
def test_the_band_about_the_best_is_within_five_per_cent(plot, cube: xr.Dataset) -> None:
    """A straight valley about 0.8 g: 5 % above it lie where the sides reach 0.84 g."""
    cube = cube.isel(pretension=slice(0, 3)).assign_coords(
        pretension=[10e3, 100e3, 1000e3], stiffness_ratio=RATIOS
    )
    cube["peak_acceleration"].values[:] = G * np.array([0.88, 0.80, 1.20])[:, None]
    for axis in maps(plot(cube, "FSR1")):
        (band,) = [one for one in axis.collections if one.get_label() == BAND]
        heights = band.get_paths()[0].vertices[:, 1]
        assert (heights.min(), heights.max()) == pytest.approx((55.0, 190.0))


def test_a_wide_range_of_pretension_has_a_logarithmic_axis_with_the_surface_s_ticks(cube: xr.Dataset) -> None:
    wide = cube.assign_coords(stiffness_ratio=RATIOS, pretension=[2e3, 20e3, 200e3, 1000e3])
    for chosen, scale in ((wide, "log"), (wide.isel(pretension=slice(2, 4)), "linear")):
        figure = plot_acceleration(chosen, "FSR1")
        for chart, space in zip(maps(figure), surfaces(figure), strict=True):
            assert chart.get_yscale() == scale
            numbers = [text.get_text() for text in space.get_yticklabels()]
            assert set(numbers) <= {f"{tick:g}" for tick in chart.get_yticks()}
            assert set(space.get_xticks()) <= set(strips(chart)["free"].get_xticks())
    figure = plot_acceleration(wide, "FSR1")
    assert [text.get_text() for text in surfaces(figure)[0].get_yticklabels()] == [
        "3",
        "10",
        "30",
        "100",
        "300",
        "1000",
    ]
    assert list(maps(figure)[0].get_yticks()) == [3.0, 10.0, 30.0, 100.0, 300.0, 1000.0]


def test_values_keep_off_the_line_of_the_best() -> None:
    for axis in maps(plot_acceleration(smooth(), "FSR1")):
        to_axes = axis.transData + axis.transAxes.inverted()
        line = to_axes.transform(axis.get_lines()[0].get_xydata())
        for text in axis.texts:
            if "period" not in text.get_text():
                apart = np.abs(line - to_axes.transform(text.get_position()))
                assert not (apart < 0.05).all(axis=1).any()


@pytest.mark.parametrize(("kind", "width"), [("maps", 180.0), ("surfaces", 180.0), ("maps", 88.0)])
def test_print_has_its_width_and_letters_that_can_be_read(kind: str, width: float) -> None:
    figure = plot_acceleration_print(smooth(), "FSR1", width=width, kind=kind)
    assert figure.get_figwidth() * 25.4 == pytest.approx(width)
    assert figure.get_suptitle() == ""
    assert figure.dpi >= 300
    assert len(surfaces(figure)) == (6 if kind == "surfaces" else 0)
    assert len(maps(figure)) == (6 if kind == "maps" else 0)
    told = [text.get_text() for text in figure.texts]
    assert told == [
        f"({letter}) SR = {ratio}"
        for letter, ratio in zip("abcdef", ("0.5", "1", "2", "4", "8", "10"), strict=True)
    ]
    words = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip()]
    lines = {f"{level:g}" for level in (maps(figure)[0].collections[0].levels if kind == "maps" else [])}
    assert all(text.get_fontsize() >= 7.0 for text in words if text.get_text() not in lines)
    figure.set_dpi(150)
    assert not overlapping(figure)


@pytest.mark.parametrize(
    ("how", "said"),
    [({"width": 20.0}, "width must be from 60 to 400 mm, got 20"), ({"kind": "pairs"}, "kind must be")],
)
def test_print_that_cannot_be(how, said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        plot_acceleration_print(smooth(), "FSR1", **how)


def test_the_ensemble_draws_the_median_with_zero_marked_and_one_best() -> None:
    study = smooth()
    study["peak_acceleration"].values[1] *= 1.4
    figure = plot_ensemble(study, caption=ensemble_caption(study))
    charts = [axis for axis in figure.axes if axis.get_label() != "<colorbar>" and axis.texts]
    assert len(charts) == 12
    shares = [
        study["peak_acceleration"].values[k] / study["elastic_acceleration"].values[k][None, None]
        for k in range(2)
    ]
    mean = np.mean(shares, axis=0)
    for k, axis in enumerate(charts[::2]):
        line = axis.get_lines()[0]
        best = study["pretension"].values[mean[k].argmin(axis=0)] / 1e3
        assert line.get_ydata() == pytest.approx(best)
        filled = axis.collections[0]
        assert filled.levels[0] == -filled.levels[-1] == -100.0
    with pytest.raises(InvalidInput, match="needs 2 records or more, the cube has 1"):
        plot_ensemble(study.isel(record=[0]))
    assert plot_ensemble(study, width=180.0).get_figwidth() * 25.4 == pytest.approx(180.0)


def test_the_chart_is_the_same_for_any_mass_and_loudness() -> None:
    """F / (m PGA) is what the equations know: a heavier floor under a louder ground draws the same lines."""
    motion = own_motion()
    lines = []
    for mass, pga in ((20e3, 2.0), (50e3, 5.0)):
        cube = fdspec.sweep(
            motion.scaled_to_pga(pga),
            period=[0.3, 0.8],
            stiffness_ratio=[1.0, 4.0],
            pretension=np.geomspace(0.02, 2.0, 5) * mass * pga / 0.5,
            floor_mass=mass,
            brace_mass=0.0025 * mass,
        )
        lines.append([line.get_xydata() for axis in plot_chart(cube).axes for line in axis.lines])
    for one, other in zip(*lines, strict=True):
        assert one == pytest.approx(other, rel=1e-9)
    quiet = fdspec.sweep(
        [motion, replace(motion.scaled(2.0), name="loud")],
        period=0.3,
        stiffness_ratio=1.0,
        pretension=[1e4, 1e5],
    )
    with pytest.raises(InvalidInput, match="needs records of one PGA"):
        plot_chart(quiet)


def test_values_at_lines_keep_apart_and_off_the_edges() -> None:
    for axis in maps(plot_acceleration(smooth(), "FSR1")):
        values = [text for text in axis.texts if "period" not in text.get_text()]
        at = [axis.transAxes.inverted().transform(axis.transData.transform(t.get_position())) for t in values]
        assert all(0.05 < x < 0.95 and 0.05 < y < 0.95 for x, y in at)
        assert all(
            abs(a - c) >= 0.12 or abs(b - d) >= 0.12 for k, (a, b) in enumerate(at) for c, d in at[k + 1 :]
        )


def test_surfaces_are_the_study_s_panels(cube: xr.Dataset) -> None:
    more = cube.isel(stiffness_ratio=[0, 1, 2, 3, 4, 0, 1]).assign_coords(
        stiffness_ratio=[0.5, 1.0, 2.0, 4.0, 6.0, 8.0, 10.0]
    )
    figure = plot_acceleration(more, "FSR1")
    told = [text.get_text() for text in figure.texts if text.get_text().startswith("SR")]
    assert told == [f"SR = {ratio}" for ratio in ("0.5", "1", "2", "4", "8", "10")]
    assert len(surfaces(figure)) == len(maps(figure)) == 6
    some = plot_acceleration(more, "FSR1", stiffness_ratios=[6.0])
    assert [text.get_text() for text in some.texts if text.get_text().startswith("SR")] == ["SR = 6"]


def test_stiffness_ratios_that_are_not_there(cube: xr.Dataset) -> None:
    with pytest.raises(InvalidInput, match="the cube has no stiffness_ratio 3; it has 0.5, "):
        plot_acceleration(cube, "FSR1", stiffness_ratios=[0.5, 3.0])
    with pytest.raises(InvalidInput, match="must name one or more"):
        plot_acceleration(cube, "FSR1", stiffness_ratios=[])


def test_a_surface_stands_left_of_its_map(cube: xr.Dataset) -> None:
    figure = plot_acceleration(cube.assign_coords(stiffness_ratio=RATIOS), "FSR1")
    for space, chart in zip(surfaces(figure), maps(figure), strict=True):
        assert space.get_position().x1 <= chart.get_position().x0
        assert abs(space.get_position().y0 - chart.get_position().y0) < 0.08


def test_surfaces_share_height_and_say_their_units(cube: xr.Dataset) -> None:
    figure = plot_acceleration(cube.assign_coords(stiffness_ratio=RATIOS), "FSR1")
    panels = surfaces(figure)
    assert len({axis.get_zlim() for axis in panels}) == 1
    assert panels[0].get_zlim() == (0.0, maps(figure)[0].collections[0].levels[-1])
    assert {axis.get_xlabel() for axis in panels} == {"period, s"}
    assert {axis.get_ylabel() for axis in panels} == {"pretension, kN"}
    assert [text.get_text() for text in figure.texts].count(HEIGHT) == len(panels)
    assert HEIGHT.endswith(", g")


def test_surfaces_are_coloured_by_their_height_on_one_scale(cube: xr.Dataset) -> None:
    figure = plot_acceleration(cube.assign_coords(stiffness_ratio=RATIOS), "FSR1")
    peak = cube["peak_acceleration"].sel(record="FSR1").values / G
    for axis, values in zip(surfaces(figure), peak, strict=True):
        (surface,) = [one for one in axis.collections if isinstance(one, PolyCollection)]
        assert (surface.norm.vmin, surface.norm.vmax) == axis.get_zlim()
        cells = 0.25 * (values[1:, 1:] + values[1:, :-1] + values[:-1, 1:] + values[:-1, :-1])
        np.testing.assert_allclose(np.sort(surface.get_array()), np.sort(cells.ravel()), rtol=1e-12)


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
    corners = hysteresis(history, 2)
    assert np.allclose(loop.lines[0].get_xdata(), corners["slip"].values * 1e3)
    assert np.allclose(loop.lines[0].get_ydata(), corners["force"].values / 1e3)
    assert [axis.get_ylabel() for axis in (displaced, held, accelerated)] == [
        "displacement, mm",
        "friction force, kN",
        "absolute acceleration, g",
    ]
    assert accelerated.get_xlabel() == "time, s"
    assert figure.get_suptitle().splitlines()[0] == "Response to FSR1, storey 2 of 2"


def test_history_draws_the_slip_force_where_it_is_finite(history: xr.Dataset) -> None:
    history["slip_force"].values[:] = [50e3, np.inf]
    limits = [line.get_ydata()[0] for line in plot_history(history, 1).axes[1].lines[1:3]]
    assert limits == [-50.0, 50.0]
    assert [line.get_label() for line in plot_history(history, 2).axes[1].lines][1:] == ["change of phase"]


def test_history_marks_each_change_of_phase_at_its_instant(history: xr.Dataset) -> None:
    history["friction_force"].values[:, 0] = 1e3 * history["time"].values  # N, so that kN are seconds
    dots = plot_history(history, 1).axes[1].lines[-1]
    assert dots.get_xdata().tolist() == [0.05, 0.2, 0.3]
    assert dots.get_ydata() == pytest.approx([0.05, 0.2, 0.3])


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


def test_a_notebook_shows_a_figure_without_pyplot(cube: xr.Dataset) -> None:
    figure = plot_acceleration_maps(cube, "FSR1")
    assert figure._repr_png_() == encode(figure, "png")
