"""The report's pictures in fewer bytes: every corner, mark and bar stays where it was."""

import re

import numpy as np
import pytest

from fdspec.figures.encoding import encode
from fdspec.figures.page import Figure
from fdspec.report.compact_svg import compact

NUMBER = r"-?(?:\d+\.?\d*|\.\d+)(?:e-?\d+)?"

HALF_A_STEP = 0.005 + 1e-9
"""pt."""


def corners(path: str) -> np.ndarray:
    """Return the ends of all steps of a path, of absolute or of relative ones, a row each."""
    found, at, start = [], np.zeros(2), np.zeros(2)
    for kind, told in re.findall(r"([a-zA-Z])([^a-zA-Z]*)", path):
        numbers = [float(one) for one in re.findall(NUMBER, told)]
        if kind == "z":
            at = start
            continue
        if kind in "hv":
            at = at + ([numbers[0], 0.0] if kind == "h" else [0.0, numbers[0]])
        else:
            at = np.array(numbers[-2:]) + (at if kind.islower() else 0.0)
        start = at if kind in "mM" else start
        found.append(at)
    return np.array(found)


def written(figure: Figure) -> tuple[str, str]:
    svg = encode(figure, "svg").decode()
    return svg, compact(svg)


def paths(svg: str) -> list[str]:
    """Return what paths draw, without those of nothing but marks."""
    return re.findall(r'<path d="([^"]*)"(?![^>]*marker:)', svg)


@pytest.fixture
def noise() -> np.ndarray:
    return np.random.default_rng(7).normal(size=3000)


def test_every_corner_of_a_line_stays_to_a_hundredth_of_a_point(noise: np.ndarray) -> None:
    figure = Figure(figsize=(11.0, 6.5))
    figure.subplots().plot(noise, linewidth=0.8)
    svg, less = written(figure)
    before, after = (max(map(corners, paths(one)), key=len) for one in (svg, less))
    assert len(before) > 2500
    # Corners that fall onto the one before are not repeated.
    gone = np.append(False, (np.abs(np.diff(np.round(before, 2), axis=0)) < 1e-9).all(axis=1))
    assert np.abs(after - before[~gone]).max() < HALF_A_STEP
    assert len(less) < 0.5 * len(svg)


def test_every_mark_stays_as_one_of_a_path_s(noise: np.ndarray) -> None:
    figure = Figure(figsize=(11.0, 6.5))
    figure.subplots().plot(noise, "o", markersize=2.0)
    svg, less = written(figure)
    marks = re.findall(rf'<use xlink:href="#\w+" x="({NUMBER})" y="({NUMBER})" style="[^"]*#1f77b4', svg)
    wanted = np.array(marks, dtype=float)
    (name,) = re.findall(r'<marker id="([^"]*)" overflow="visible" markerUnits="userSpaceOnUse">', less)
    (marked,) = re.findall(
        rf'<path d="([^"]*)" style="fill: none; stroke: none; marker: url\(#{name}\)"', less
    )
    assert len(wanted) == 3000
    at = corners(marked)
    off = [np.hypot(*(at - place).T).min() for place in wanted]
    assert max(off) < np.sqrt(2.0) * HALF_A_STEP
    assert len(less) < 0.2 * len(svg)


def test_marks_and_bars_of_two_looks_are_kept_apart() -> None:
    figure = Figure(figsize=(6.0, 4.0))
    axis = figure.subplots()
    axis.plot(np.arange(20), "o", color="#123456")
    axis.plot(np.arange(20) + 1.0, "s", color="#654321")
    axis.broken_barh([(2.0 * k, 1.0) for k in range(15)], (0.0, 1.0), color="#abcdef")
    axis.broken_barh([(2.0 * k, 1.0) for k in range(15)], (2.0, 1.0), color="#fedcba")
    svg, less = written(figure)
    assert less.count("<marker ") == 2
    for colour in ("#abcdef", "#fedcba"):
        before = [corners(path) for path in re.findall(rf'<path d="([^"]*)"[^>]*fill: {colour}', svg)]
        (after,) = re.findall(rf'<path d="([^"]*)"[^>]*fill: {colour}', less)
        assert len(before) == 15
        assert after.count("z") == 15
        assert np.abs(corners(after) - np.concatenate(before)).max() < HALF_A_STEP


@pytest.mark.parametrize(
    "look", [{"color": "#abcdef", "alpha": 0.5}, {"facecolor": "#abcdef", "edgecolor": "black"}]
)
def test_where_an_overlap_shows_bars_are_left_in_their_parts(look: dict[str, str]) -> None:
    figure = Figure(figsize=(6.0, 4.0))
    figure.subplots().broken_barh([(0.5 * k, 1.0) for k in range(15)], (0.0, 1.0), **look)
    svg, less = written(figure)
    assert less.count("fill: #abcdef") == svg.count("fill: #abcdef") == 15


def test_marks_that_shine_through_add_up_where_they_overlap() -> None:
    figure = Figure(figsize=(6.0, 4.0))
    figure.subplots().plot(np.zeros(15), "o", color="#abcdef", alpha=0.5)
    svg, less = written(figure)
    assert less.count("<use ") == svg.count("<use ")


def test_curves_are_kept() -> None:
    figure = Figure(figsize=(6.0, 4.0))
    figure.text(0.5, 0.5, "words and curves")
    svg, less = written(figure)
    letters = [re.findall(r'<path id="[^"]*" d="([^"]*)"', one) for one in (svg, less)]
    assert len(letters[0]) == len(letters[1]) > 5
    for before, after in zip(*letters, strict=True):
        assert before.count("Q") == after.count("q")
        np.testing.assert_allclose(corners(after)[-1], corners(before)[-1], atol=HALF_A_STEP)
