"""Picture files: fonts that journals take, a title and an author, nothing of the clock."""

import re
import zlib

import pytest
from matplotlib.figure import Figure

from fdspec.figures import encode
from fdspec.version import __version__


@pytest.fixture
def figure() -> Figure:
    made = Figure(figsize=(3.0, 2.0), dpi=100)
    axis = made.subplots()
    axis.plot([0.0, 1.0], [0.0, 1.0])
    axis.set_xlabel(r"period, s, $\zeta$")
    made.suptitle("Figure 10: spectra\nof a record")
    return made


def test_pdf_embeds_truetype_and_says_title_and_author(figure: Figure) -> None:
    pdf = encode(figure, "pdf")
    assert b"/Subtype /Type3" not in pdf
    assert b"/FontType 42" in pdf or b"/Subtype /Type0" in pdf or b"/Subtype /CIDFontType2" in pdf
    assert b"/Title (Figure 10: spectra)" in pdf
    assert f"/Author (fdspec {__version__})".encode() in pdf
    assert b"CreationDate" not in pdf
    assert b"/Author (A. Engineer)" in encode(figure, "pdf", author="A. Engineer")


def test_a_figure_without_a_heading_is_titled_by_its_label(figure: Figure) -> None:
    figure.suptitle("")
    figure.set_label("Figure 11: another")
    assert b"/Title (Figure 11: another)" in encode(figure, "pdf")
    assert b"/Title (mine)" in encode(figure, "pdf", title="mine")


def test_png_and_svg_carry_them_too(figure: Figure) -> None:
    png = encode(figure, "png")
    assert b"Title\x00Figure 10: spectra" in png
    assert re.search(rb"pHYs", png)
    svg = encode(figure, "svg").decode()
    assert "<dc:title>Figure 10: spectra</dc:title>" in svg
    assert "<dc:date>" not in svg


def test_dots_per_inch_are_those_asked_for(figure: Figure) -> None:
    for dpi in (100, 300):
        png = encode(figure, "png", dpi=dpi)
        assert (int.from_bytes(png[16:20], "big"), int.from_bytes(png[20:24], "big")) == (3 * dpi, 2 * dpi)
    assert zlib.crc32(encode(figure, "png")) == zlib.crc32(encode(figure, "png", dpi=100))
