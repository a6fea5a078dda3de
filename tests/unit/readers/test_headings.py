"""What a heading is taken for: words, symbols and units, and neighbours that settle what is open."""

import pytest

from fdspec.records.headings import heading_of, is_unit_row, row_of
from fdspec.records.vocabulary import quantity_of

HEADINGS = [
    ("Time", "time", None), ("Time (s)", "time", "s"), ("Time [sec]", "time", "s"), ("t", "time", None),
    ("time_ms", "time", "0.001 s"), ("Zeit t / s", "time", "s"), ("时间(秒)", "time", "s"), ("Tempo, s",
    "time", "s"),
    ("Acc (g)", "acceleration", "g"), ("Accel[cm/s2]", "acceleration", "cm/s2"), ("a / m/s²",
    "acceleration", "m/s2"),
    ("Beschleunigung a / m/s²", "acceleration", "m/s2"), ("acc_g", "acceleration", "g"), ("acc g",
    "acceleration", "g"),
    ("acceleration in m/s/s", "acceleration", "m/s2"), ("Acceleration, CM/SEC**2", "acceleration", "cm/s2"),
    ("a(t) [g]", "acceleration", "g"), ("üg (m/s²)", "acceleration", "m/s2"), ("ẍ", "acceleration", None),
    ("x''", "acceleration", None), ("ug_ddot", "acceleration", None), ("a_x", "acceleration", None),
    ("AccX", "acceleration", None), ("Accélération", "acceleration", None), ("İvme", "acceleration", None),
    ("加速度(gal)", "acceleration", "cm/s2"), ("Ускорение, см/с2", "acceleration", "cm/s2"),
    ("accelaration", "acceleration", None), ("NS (gal)", "acceleration", "cm/s2"),
    ("Acceleration time history", "acceleration", None), ("Linear Acceleration x (m/s^2)",
    "acceleration", "m/s2"),
    ("Velocity [cm/sec]", "velocity", "0.01 m/s"), ("v (m/s)", "velocity", "m/s"), ("速度", "velocity", None),
    ("Hız", "velocity", None), ("NS (cm/s)", "velocity", "0.01 m/s"), ("u'", "velocity", None),
    ("Displacement, cm", "displacement", "0.01 m"), ("位移", "displacement", None), ("Weg [mm]",
    "displacement", "0.001 m"),
    ("Period [sec]", "period", "s"), ("周期", "period", None), ("Tn", "period", None), ("Periyot (s)",
    "period", "s"),
    ("Frequency [Hz]", "frequency", "Hz"), ("f", "frequency", None), ("频率", "frequency", None),
    ("Sa (g)", "spectral amplitude", "g"), ("PSA [g]", "spectral amplitude", "g"),
    ("Spectral acceleration", "spectral amplitude", None), ("Fourier Amplitude", "spectral amplitude", None),
    ("Acc./Elastic", "spectral amplitude", None), ("Acc (5% damping)", "spectral amplitude", None),
    ("Sample", "sample number", None), ("No.", "sample number", None), ("#", "unknown", None),
    ("count", "sample number", None), ("序号", "sample number", None), ("time step", "sample number", None),
    ("g_x", "another quantity", None), ("Temperature (C)", "another quantity", None),
    ("Peak acceleration (g)", "another quantity", "g"), ("角速度", "another quantity", None),
    ("angular velocity", "another quantity", None), ("NS", "direction", None), ("N00E", "direction", None),
    ("Chan 1", "direction", None), ("HNE", "direction", None), ("foo", "unknown", None), ("dt",
    "unknown", None),
]  # fmt: skip


@pytest.mark.parametrize(("text", "quantity", "unit"), HEADINGS)
def test_one_heading(text, quantity, unit):
    heading = heading_of(text)
    assert heading.quantity == quantity
    assert (heading.unit.name if heading.unit else None) == unit
    assert not heading.contradiction


@pytest.mark.parametrize(
    "text", ["Acc (cm/s)", "Velocity (g)", "Displacement [m/s2]", "Acceleration [s]", "Period (g)"]
)
def test_words_and_unit_that_contradict_each_other(text):
    assert heading_of(text).contradiction


@pytest.mark.parametrize("text", ["Acc (counts)", "acc [mV]", "a (raw)"])
def test_numbers_that_are_not_measured_have_no_unit(text):
    assert heading_of(text).unit is None
    assert heading_of(text).unit_text


@pytest.mark.parametrize(
    ("cells", "quantities"),
    [
        (["t", "a", "v", "d"], ["time", "acceleration", "velocity", "displacement"]),
        (["t", "N", "E", "V"], ["time", "direction", "direction", "direction"]),
        (["L", "T", "V"], ["direction", "direction", "direction"]),
        (["X", "Y", "Z"], ["direction", "direction", "direction"]),
        (["t", "v"], ["time", "velocity"]),
        (["t", "x"], ["time", "displacement"]),
        (["n", "a"], ["sample number", "acceleration"]),
        (["N", "E", "U"], ["direction", "direction", "direction"]),
        (["count", "a_x", "g_x"], ["sample number", "acceleration", "another quantity"]),
        (["N-S", "E-W", "U-D"], ["direction", "direction", "direction"]),
    ],
)
def test_neighbours_settle_what_is_open(cells, quantities):
    assert [heading.quantity for heading in row_of(cells)] == quantities


def test_an_underscore_before_a_symbol_may_be_a_subscript():
    assert row_of(["t", "a_g"])[1].unit is None
    assert row_of(["t_s", "a_g"])[1].unit.name == "g"
    assert row_of(["time_s", "acc_g"])[1].unit.name == "g"


def test_units_in_a_row_of_their_own():
    assert is_unit_row(["(s)", "(g)"])
    assert is_unit_row(["sec", "cm/s2", "-"])
    assert not is_unit_row(["Time", "Acc"])


def test_accents_and_case_do_not_matter():
    assert quantity_of("ACCÉLÉRATION") == quantity_of("acceleration") == quantity_of("aceleração")
