"""The sketch of frame, brace and damper: its parts are named, its words are apart, its bytes repeat."""

import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text

from fdspec.figures import encode, plot_sketch
from fdspec.figures.sketch import MOST
from fdspec.model.building import Building
from tests.unit.test_figures import overlapping


def words(figure: Figure) -> str:
    return " ".join(text.get_text() for text in figure.findobj(Text)).replace("\n", " ")


def building_of(storeys: int) -> Building:
    return Building.from_periods([20e3] * storeys, 0.6, 0.35, 1e3, brace_mass=25.0)


@pytest.mark.parametrize(
    "part", ["floor", "columns", "brace", "friction damper", "slotted", "clamping", "F_N"]
)
def test_every_part_has_its_name(part: str) -> None:
    assert part in words(plot_sketch())


def test_symbols_are_those_of_the_equations() -> None:
    said = words(plot_sketch())
    for symbol in ("$u_f$", "$u_d$", "$a_g(t)$", "$m_f$", "$k_f$", "$k_d$, $m_d$"):
        assert symbol in said


def test_a_single_storey_stands_with_its_numbers() -> None:
    said = words(plot_sketch(Building.single_storey(0.5, 4.0, 50e3)))
    for number in ("20 t", "3.16 MN/m", "12.6 MN/m", "50 kg"):
        assert number in said


@pytest.mark.parametrize("building", [None, *(building_of(n) for n in (1, 2, 4, MOST + 2))])
def test_words_stand_apart(building: Building | None) -> None:
    assert not overlapping(plot_sketch(building))


def test_a_high_building_says_what_is_left_out() -> None:
    assert f"the lowest {MOST} of {MOST + 2} storeys" in words(plot_sketch(building_of(MOST + 2)))
    assert "the lowest" not in words(plot_sketch(building_of(MOST)))


@pytest.mark.parametrize("kind", ["png", "svg", "pdf"])
def test_two_sketches_are_the_same_bytes(kind: str) -> None:
    assert encode(plot_sketch(), kind) == encode(plot_sketch(), kind)
