"""The study's figures by number: which a cube gives, which records they find, what their captions say."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.text import Text

from fdspec.errors import InvalidInput
from fdspec.model.motion import GroundMotion
from fdspec.records import catalogue, load_record
from fdspec.report import study_figures
from fdspec.report.finer import FRAME, Finer
from fdspec.report.study_figures import (
    RECORD_FIGURES,
    applied_motions,
    chosen,
    methods_compared,
    study_pictures,
)
from fdspec.runs import sweep as sweeping
from fdspec.runs.simulate import simulate
from fdspec.units import G
from fdspec.validation import single_storey_k_braced
from tests.cubes import synthetic_cube


def cube_of(motions: list[GroundMotion]) -> xr.Dataset:
    cube = synthetic_cube([motion.name for motion in motions], (2, 3, 4))
    cube["peak_acceleration"].values[:] = np.abs(cube["peak_acceleration"].values)
    cube["status"].values[:] = 0
    told = {
        "checksum": [motion.checksum for motion in motions],
        "source": [motion.source for motion in motions],
        "pga": [motion.pga for motion in motions],
        "scale_factor": [motion.scale_factor for motion in motions],
    }
    return cube.assign_coords({name: ("record", values) for name, values in told.items()})


def test_every_record_of_the_study_has_its_figure() -> None:
    assert list(RECORD_FIGURES) == [entry.name for entry in catalogue()]
    assert list(RECORD_FIGURES.values()) == list(range(10, 19))


def test_figures_come_in_the_study_s_order_and_others_after_them() -> None:
    motions = [load_record("FHR1"), GroundMotion([0.0, 1.0, 0.0], 0.01, "zebra"), load_record("FSR2")]
    numbers = [picture.number for picture in study_pictures(cube_of(motions))]
    assert numbers == ["4", "6", "7", "8", "9", "11", "16", "zebra"]


def test_without_records_there_are_no_figures_of_records() -> None:
    lost = cube_of([GroundMotion([0.0, 1.0, 0.0], 0.01, "zebra")])
    assert [picture.number for picture in study_pictures(lost)] == ["4", "6", "7", "zebra"]


def test_records_are_found_by_name_as_scaled_or_not_and_by_checksum_alone() -> None:
    raw, scaled = load_record("FSR1", scaled=False), load_record("FMR1")
    found, lost = applied_motions(cube_of([raw, scaled]))
    assert [motion.checksum for motion in found] == [raw.checksum, scaled.checksum]
    assert lost == []
    other = cube_of([raw, scaled])
    other["checksum"].values[1] = "another"
    assert applied_motions(other)[1] == ["FMR1"]


def test_own_records_are_found_among_those_given() -> None:
    mine, other = (GroundMotion([0.0, peak, 0.0], 0.01, "mine") for peak in (1.0, 2.0))
    cube = cube_of([mine, load_record("FSR1")])
    assert applied_motions(cube)[1] == ["mine"]
    assert applied_motions(cube, [other])[1] == ["mine"]  # of the same name, with other numbers
    found, lost = applied_motions(cube, [other, mine])
    assert [motion.checksum for motion in found] == [mine.checksum, load_record("FSR1").checksum]
    assert lost == []
    assert "mine, unknown" in next(one.caption for one in study_pictures(cube, [mine]) if one.number == "8")


def test_captions_name_the_records_really_used() -> None:
    motion = load_record("FHR3")
    pictures = {picture.number: picture for picture in study_pictures(cube_of([motion]))}
    origin = motion.source.removeprefix("stand-in for the study's FHR3: ")
    assert f"FHR3 (stand-in) {origin}, times {motion.scale_factor:.3g}." in pictures["8"].caption
    assert f"FHR3 (stand-in) {origin}" in pictures["9"].caption
    assert f"{motion.source}; PGA {motion.pga / G:.3g} g" in pictures["18"].caption
    for number in ("4", "6"):
        assert "scaled to 0.24 g in place of Kalamata 1986, NS." in pictures[number].caption
        assert "normal force assumed" in pictures[number].caption
    assert all(one.caption.startswith(f"Figure {number}. ") for number, one in pictures.items())
    assert all(one.heading.startswith(f"Figure {number}: ") for number, one in pictures.items())


def test_a_drawn_picture_carries_its_heading_and_its_caption() -> None:
    pictures = {picture.number: picture for picture in study_pictures(cube_of([load_record("FSR1")]))}
    for number, below in (("6", "get_supxlabel"), ("9", "get_supxlabel")):
        figure = pictures[number].draw()
        assert figure.get_suptitle() == pictures[number].heading
        assert getattr(figure, below)().replace("\n", " ") == pictures[number].caption


def test_spectra_are_of_the_cube_s_damping_ratio() -> None:
    cube = cube_of([load_record("FMR1")])
    cube.attrs["parameters"] = '{"damping_ratio": 0.02}'
    (ninth,) = [picture for picture in study_pictures(cube) if picture.number == "9"]
    assert "damping ratio 0.02." in ninth.caption
    assert ninth.draw().axes[0].get_title() == "damping ratio 0.02"


def test_chosen_figures() -> None:
    pictures = study_pictures(cube_of([load_record("FSR1")]))
    assert [picture.number for picture in chosen(pictures, ["10", "4"])] == ["4", "10"]
    assert chosen(pictures, []) == pictures
    with pytest.raises(InvalidInput, match="there is no figure '11'; this cube gives 4, 6, 7, 8, 9, 10"):
        chosen(pictures, ["11"])


@pytest.mark.slow
def test_every_method_follows_the_exact_displacement_as_far_as_its_model_goes() -> None:
    """The study's scheme and the state space solve the same equations; Dimova's error grows with the band."""
    histories = methods_compared()
    assert next(iter(histories)) == "exact"
    exact = histories["exact"]["brace_displacement"].values
    off = {
        name: np.abs(one["brace_displacement"].values - exact).max() / np.abs(exact).max()
        for name, one in histories.items()
    }
    assert max(error for name, error in off.items() if "Newmark" in name or "state space" in name) < 1e-3
    bands = [off[f"Dimova, linear within {band:g} m/s"] for band in (0.001, 0.005, 0.01)]
    assert bands == sorted(bands)
    assert off["rigid-plastic"] == pytest.approx(1.0)


@pytest.mark.parametrize("number", ["8", "9"])
def test_in_print_no_letter_is_smaller_than_seven_points_and_no_title_is_drawn(number: str) -> None:
    motions = [load_record(name) for name in RECORD_FIGURES]
    (picture,) = [one for one in study_pictures(cube_of(motions)) if one.number == number]
    figure = picture.draw_print(180.0)
    figure.draw_without_rendering()
    sizes = {text.get_text(): text.get_fontsize() for text in figure.findobj(Text) if text.get_text()}
    assert min(sizes.values()) > 6.99, sizes
    assert figure.get_suptitle() == ""


@pytest.mark.parametrize("small", [False, True])
def test_the_names_of_records_and_of_stations_stand_apart(small: bool) -> None:
    motions = [load_record(name) for name in RECORD_FIGURES]
    (picture,) = [one for one in study_pictures(cube_of(motions)) if one.number == "8"]
    figure = picture.draw_small() if small else picture.draw_print(180.0)
    figure.draw_without_rendering()
    for axis in figure.axes:
        name, station = (
            next(text for text in axis.findobj(Text) if text.get_text() == axis.get_title(loc))
            for loc in ("left", "right")
        )
        assert not name.get_window_extent().overlaps(station.get_window_extent()), name.get_text()


def test_nothing_is_computed_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    """The contact sheet draws every picture again."""
    calls = []
    histories = {"exact": simulate(single_storey_k_braced.building(), load_record("FSR1"), dt_out=0.1)}
    monkeypatch.setattr(study_figures, "methods_compared", lambda: calls.append("methods") or histories)
    motions = [load_record("FSR1"), load_record("FMR1")]
    monkeypatch.setattr(sweeping, "sweep", lambda *_, **__: calls.append("sweep") or cube_of(motions))
    (fourth,) = [one for one in study_pictures(cube_of(motions)) if one.number == "4"]
    fourth.draw()
    fourth.draw_small()
    assert calls == ["methods"]
    finer = Finer(cube_of(motions), motions)
    finer.frame = dict.fromkeys(FRAME, 1.0)
    for _ in range(2):
        finer.for_chart()
        finer.together()
    assert calls == ["methods", "sweep", "sweep", "sweep"]
