"""Units in every spelling, and what is none."""

import numpy as np
import pytest

from fdspec.errors import InvalidInput
from fdspec.records.units import acceleration_unit, to_si, unit_named, unit_of
from fdspec.units import G

SPELLINGS = {
    "g": ["g", "G", " g ", "g's", "gs", "g0", "gn", "gravity", "(g)", "[g]"],
    "m/s2": [
        "m/s2", "m/s^2", "m/s**2", "m/s/s", "m/s²", "M/S2", "m/sec2", "m/sec/sec", "m/sec^2", "m s-2",
        "m s^-2",
        "m·s⁻²", "m.s-2", "m*s^-2", "ms-2", "ms^-2", "ms⁻²", "m/(s*s)", "m/(s^2)", "m/s^{2}", "$m/s^2$",
        "meters per second squared", "metres/second/second", "m/sn2", "m/seg2", "м/с2", "м/с²", "m/sec.sec",
    ],
    "cm/s2": [
        "cm/s2", "CM/SEC**2", "cm/sec/sec", "CM/SEC/SEC", "cm/sec2.", "cm/s*s", "cm s-2", "cms-2", "gal",
        "Gal",
        "GALS", "cm/sq.sec", "cm/seg/seg", "см/с2", "ガル",
    ],
    "mm/s2": ["mm/s2", "mm/s/s", "mm/sec/sec", "mm s^-2"],
    "mgal": ["mgal", "mGal", "milligal"],
    "mg": ["mg", "MG"],
    "%g": ["%g", "% g", "percent g", "%G"],
    "g/10": ["g/10", "G/10"],
    "ft/s2": ["ft/s2", "ft/sec^2", "feet per second squared", "FT/SEC/SEC"],
    "in/s2": ["in/s2", "in/sec/sec", "inches/s^2", "in/s²"],
    "nm/s2": ["nm/s2", "nm/sec/sec"],
}  # fmt: skip
FACTORS = {
    "g": G, "m/s2": 1.0, "cm/s2": 0.01, "mm/s2": 0.001, "mgal": 1e-5, "mg": G / 1e3, "%g": G / 100.0,
    "g/10": G / 10.0,
    "ft/s2": 0.3048, "in/s2": 0.0254, "nm/s2": 1e-9,
}  # fmt: skip


@pytest.mark.parametrize(("name", "spelling"), [(n, s) for n, all_ in SPELLINGS.items() for s in all_])
def test_spellings_of_acceleration(name, spelling):
    assert acceleration_unit(spelling) == name
    assert unit_named(spelling) == name
    np.testing.assert_allclose(
        to_si(np.array([2.0, -3.0]), name), np.array([2.0, -3.0]) * FACTORS[name], rtol=3e-16
    )


@pytest.mark.parametrize(
    ("spelling", "quantity"),
    [
        ("s", "time"), ("sec", "time"), ("ms", "time"), ("min", "time"), ("秒", "time"), ("Hz", "frequency"),
        ("cm/s", "velocity"), ("m s-1", "velocity"), ("kine", "velocity"), ("g*s", "velocity"),
        ("cm", "displacement"), ("in", "displacement"), ("мм", "displacement"),
    ],
)  # fmt: skip
def test_units_of_other_quantities(spelling, quantity):
    assert unit_of(spelling).quantity == quantity
    assert acceleration_unit(spelling) is None
    with pytest.raises(InvalidInput, match=r"units must be g, m/s2, .* not "):
        unit_named(spelling)


@pytest.mark.parametrize(
    "text",
    [
        "", " ", "counts", "rad/s2", "g/100", "m/s2/10", "1e-3 g", "2 g", "g m", "m s2", "cm/s/s/s", "N",
        "NS", "m/s^-2", "t", "E", "furlong", "/s", "^2", "g g", "m/s2 g", "x" * 100, "/" * 60, "(" * 60,
        "s" * 60,
        "v", "m/s2, g",
    ],
)  # fmt: skip
def test_what_is_no_unit(text):
    assert unit_of(text) is None or unit_of(text).quantity != "acceleration"
    assert acceleration_unit(text) is None
