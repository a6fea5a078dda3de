"""What the figures of records show: panels, labels, and the data in their artists."""

import io

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from fdspec.errors import InvalidInput
from fdspec.figures import plot_histories, plot_record, plot_spectra
from fdspec.model.motion import GroundMotion
from fdspec.signals.intensity import arias_time, husid, intensity
from fdspec.signals.spectra import elastic_spectra
from fdspec.units import G

PERIODS = np.linspace(0.02, 2.0, 25)


def noise(seed: int, count: int = 200, dt: float = 0.01, name: str = "") -> GroundMotion:
    random = np.random.default_rng(seed)
    samples = random.normal(size=count) * np.hanning(count)
    about = {"event": "Somewhere 2001", "station": f"S{seed}", "component": "090", "source": "a file"}
    return GroundMotion(samples, dt, name or f"R{seed}", **about)


@pytest.fixture
def motions() -> list[GroundMotion]:
    return [noise(seed, count=150 + 40 * seed) for seed in range(5)]


@pytest.fixture
def spectra(motions: list[GroundMotion]) -> xr.Dataset:
    return elastic_spectra(motions, PERIODS, [0.02, 0.05])


def png(figure: Figure) -> bytes:
    file = io.BytesIO()
    figure.savefig(file, format="png")
    return file.getvalue()


def line(axis, label: str):
    (found,) = [one for one in axis.lines if one.get_label() == label]
    return found


def test_record_draws_the_history_and_its_peak(motions, spectra) -> None:
    motion = motions[2]
    history = plot_record(motion, spectra).axes[0]
    drawn, peak = history.lines[:2]
    assert np.array_equal(drawn.get_xdata(), motion.time)
    np.testing.assert_allclose(drawn.get_ydata(), motion.acceleration / G, rtol=1e-15)
    assert abs(peak.get_ydata()[0]) == pytest.approx(motion.pga / G, rel=1e-15)
    low, high = history.get_ylim()
    assert low == -high
    assert high > motion.pga / G
    assert history.get_ylabel() == "ground acceleration, g"


def test_record_draws_how_the_arias_intensity_arrives(motions, spectra) -> None:
    motion = motions[1]
    arrival = plot_record(motion, spectra).axes[2]
    curve, first, last = arrival.lines
    np.testing.assert_allclose(curve.get_ydata(), 100.0 * husid(motion) / husid(motion)[-1], rtol=1e-12)
    bounds = [arias_time(motion, 0.05), arias_time(motion, 0.95)]
    assert [first.get_xdata()[0], last.get_xdata()[0]] == bounds
    assert [first.get_ydata()[0], last.get_ydata()[0]] == [5.0, 95.0]
    (shaded,) = arrival.patches
    assert shaded.get_x() == pytest.approx(bounds[0])
    assert shaded.get_width() == pytest.approx(bounds[1] - bounds[0])
    told = [text.get_text() for text in arrival.texts]
    assert f"{intensity(motion).significant_duration:.3g} s (5 % to 95 %)" in told
    assert (arrival.get_xlabel(), arrival.get_ylabel()) == ("time, s", "share of Arias intensity, %")


def test_record_draws_its_own_spectra(motions, spectra) -> None:
    _, acceleration, _, displacement = plot_record(motions[3], spectra).axes
    one = spectra.sel(record="R3")
    for ratio, label in ((0.02, "0.02"), (0.05, "0.05")):
        drawn = line(acceleration, label)
        assert np.array_equal(drawn.get_xdata(), PERIODS)
        np.testing.assert_allclose(
            drawn.get_ydata(), one.absolute_acceleration.sel(damping_ratio=ratio) / G, rtol=1e-14
        )
        np.testing.assert_allclose(
            line(displacement, label).get_ydata(),
            one.spectral_displacement.sel(damping_ratio=ratio) * 1e3,
            rtol=1e-14,
        )
    pga = line(acceleration, "PGA")
    assert (pga.get_xdata()[0], pga.get_ydata()[0]) == (0.0, motions[3].pga / G)
    assert acceleration.get_ylabel() == "peak absolute acceleration, g"
    assert (displacement.get_xlabel(), displacement.get_ylabel()) == ("period, s", "peak displacement, mm")


def test_record_says_which_it_is_and_its_numbers(motions, spectra) -> None:
    head, source, numbers = plot_record(motions[0], spectra).get_suptitle().splitlines()
    assert head == "R0: Somewhere 2001, S0, 090"
    assert source == "a file"
    found = intensity(motions[0])
    assert numbers.split("   ") == [
        f"PGA {found.pga / G:.3g} g",
        f"PGV {found.pgv:.3g} m/s",
        f"PGD {found.pgd:.3g} m",
        f"Arias intensity {found.arias:.3g} m/s",
        f"CAV {found.cav:.3g} m/s",
        "dt 0.01 s",
        "150 samples",
    ]


def test_record_of_unknown_origin_has_a_short_title() -> None:
    motion = GroundMotion([0.0, 1.0, -1.0, 0.0], 0.01, "bare")
    head, numbers = plot_record(motion, elastic_spectra(motion, PERIODS)).get_suptitle().splitlines()
    assert head == "bare"
    assert numbers.startswith("PGA")


def test_record_without_its_spectra_is_refused(motions, spectra) -> None:
    with pytest.raises(InvalidInput, match="spectra must hold the record 'R9'; they hold R0, R1, R2, R3, R4"):
        plot_record(noise(9), spectra)


def test_record_that_is_zero_is_refused() -> None:
    still = GroundMotion(np.zeros(10), 0.01, "still")
    with pytest.raises(InvalidInput, match="zero throughout"):
        plot_record(still, elastic_spectra(still, PERIODS))


def test_a_panel_a_history_on_one_scale(motions) -> None:
    figure = plot_histories(motions)
    assert len(figure.axes) == 5
    assert [axis.get_title(loc="left") for axis in figure.axes] == ["R0", "R1", "R2", "R3", "R4"]
    assert len({axis.get_ylim() for axis in figure.axes}) == 1
    assert figure.axes[0].get_ylim()[1] > max(motion.pga for motion in motions) / G
    for axis, motion in zip(figure.axes, motions, strict=True):
        assert np.array_equal(axis.lines[0].get_xdata(), motion.time)
        np.testing.assert_allclose(axis.lines[0].get_ydata(), motion.acceleration / G, rtol=1e-15)
        assert abs(axis.lines[1].get_ydata()[0]) == pytest.approx(motion.pga / G, rel=1e-15)
        assert [text.get_text() for text in axis.texts] == [f"{motion.pga / G:.3f} g"]
        assert axis.get_title(loc="right") == f"Somewhere 2001,\n{motion.station}"


def test_axes_of_histories_are_named_at_the_edge(motions) -> None:
    axes = plot_histories(motions).axes
    assert [axis.get_ylabel() for axis in axes] == ["acceleration, g", "", "", "acceleration, g", ""]
    # Five stand in rows of three and two: the third has nothing below it.
    assert [axis.get_xlabel() for axis in axes] == ["", "", *["time, s"] * 3]


def test_three_histories_a_colour(motions) -> None:
    colours = [axis.lines[0].get_color() for axis in plot_histories(motions).axes]
    assert colours[0] == colours[1] == colours[2] != colours[3] == colours[4]


def test_histories_of_nothing_and_of_zeros() -> None:
    with pytest.raises(InvalidInput, match="motions must be one or more"):
        plot_histories([])
    assert png(plot_histories([GroundMotion(np.zeros(10), 0.01, "still")]))


def test_a_spectrum_a_record_and_their_mean(spectra) -> None:
    figure = plot_spectra(spectra)
    assert [axis.get_title() for axis in figure.axes] == ["damping ratio 0.02", "damping ratio 0.05"]
    for axis, ratio in zip(figure.axes, (0.02, 0.05), strict=True):
        values = spectra.absolute_acceleration.sel(damping_ratio=ratio) / G
        for name in spectra.record.values:
            np.testing.assert_allclose(line(axis, name).get_ydata(), values.sel(record=name), rtol=1e-14)
        np.testing.assert_allclose(line(axis, "mean").get_ydata(), values.mean("record"), rtol=1e-14)
        assert axis.get_xlabel() == "period, s"
    assert figure.axes[0].get_ylabel() == "peak absolute acceleration, g"
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["R0", "R1", "R2", "R3", "R4", "mean"]


def test_every_record_of_the_study_has_a_line_of_its_own() -> None:
    nine = elastic_spectra([noise(seed, 60) for seed in range(9)], PERIODS)
    lines = plot_spectra(nine).axes[0].lines[:9]
    assert len({(one.get_color(), one.get_linestyle()) for one in lines}) == 9


def test_pseudo_acceleration_and_one_record(spectra) -> None:
    one = spectra.sel(record=["R1"], damping_ratio=[0.05])
    (axis,) = plot_spectra(one, quantity="pseudo_acceleration").axes
    (drawn,) = axis.lines  # one record is its own mean
    np.testing.assert_allclose(drawn.get_ydata(), one.pseudo_acceleration.squeeze() / G, rtol=1e-14)
    assert axis.get_ylabel() == "peak pseudo acceleration, g"


@pytest.mark.parametrize(
    ("change", "arguments", "message"),
    [
        (lambda spectra: spectra.isel(period=[0]), {}, "a spectrum needs at least 2 periods, not 1"),
        (lambda spectra: spectra, {"quantity": "spectral_displacement"}, "quantity must be one of absolute_"),
    ],
)
def test_spectra_that_cannot_be_drawn(spectra, change, arguments, message) -> None:
    with pytest.raises(InvalidInput, match=message):
        plot_spectra(change(spectra), **arguments)


def test_a_long_note_fits_the_picture(motions, spectra) -> None:
    note = "Stand-ins: " + ", ".join(f"FSR{k}" for k in range(60)) + "."
    for figure in (plot_histories(motions, note=note), plot_spectra(spectra, note=note)):
        png(figure)  # lays it out
        title = figure.texts[0]
        assert title.get_text().replace("\n", " ").endswith(note)
        box = title.get_window_extent()
        assert box.x0 >= 0.0
        assert box.x1 <= figure.bbox.x1
        assert max(axis.get_tightbbox().y1 for axis in figure.axes) <= box.y0


def test_the_same_data_give_the_same_bytes(motions, spectra) -> None:
    before = spectra.copy(deep=True)
    assert png(plot_record(motions[0], spectra)) == png(plot_record(motions[0], spectra))
    assert png(plot_histories(motions)) == png(plot_histories(motions))
    assert png(plot_spectra(spectra)) == png(plot_spectra(spectra))
    assert spectra.identical(before)
