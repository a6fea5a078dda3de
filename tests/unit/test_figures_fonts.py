"""Names in Chinese and Japanese are drawn with a font that has the glyphs, else in ASCII."""

import io

import numpy as np
import pytest

from fdspec.figures import fonts, plot_record
from fdspec.figures.page import Figure
from fdspec.model.motion import GroundMotion
from fdspec.signals.spectra import elastic_spectra

NAMES = "汶川 卧龙", "益城町 平成28年"


def picture(name):
    motion = GroundMotion(np.sin(np.arange(200) * 0.3), 0.01, name, event="熊本地震")
    return plot_record(motion, elastic_spectra([motion], np.array([0.1, 0.5]), [0.05]))


@pytest.mark.parametrize("name", NAMES)
def test_a_name_beyond_latin_is_drawn_without_a_missing_glyph(name):
    figure = picture(name)
    figure.savefig(io.BytesIO(), format="png")  # a missing glyph is warned of, and warnings are errors here
    title = figure.get_suptitle()
    missing = fonts.missing_glyphs(title, figure._suptitle.get_fontproperties())
    assert missing == ""


def test_without_such_a_font_the_name_is_in_ascii(monkeypatch):
    monkeypatch.setattr(fonts, "family_with", lambda characters: None)
    figure = picture("汶川")
    assert "\\u6c76\\u5ddd" in figure.get_suptitle()
    figure.savefig(io.BytesIO(), format="png")


def test_what_the_usual_font_has_stays_as_it_is():
    figure = Figure()
    figure.text(0.0, 0.0, "İzmit, Kalamáta, m/s²")
    fonts.give_glyphs(figure)
    assert figure.texts[0].get_text() == "İzmit, Kalamáta, m/s²"
    assert len(figure.texts[0].get_family()) == 1
