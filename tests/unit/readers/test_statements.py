"""What headers state in words: count, step, unit; and notes that state nothing about the values."""

import pytest

from fdspec.records.statements import statements
from tests.fixtures.records.layouts import COUNTS, NOTES, STEPS_IN_WORDS, UNITS_IN_WORDS


def stated(line):
    return statements([(1, line)])


@pytest.mark.parametrize("words", COUNTS)
def test_counts(words):
    assert [count for _, count, _ in stated(words.format(n=1559)).counts] == [1559]


@pytest.mark.parametrize("words", STEPS_IN_WORDS)
def test_steps(words):
    line = words.format(dt=0.005, rate="200", ms="5")
    assert [step for _, step, _ in stated(line).steps] == pytest.approx([0.005])
    assert stated(line).counts == []


@pytest.mark.parametrize("words", UNITS_IN_WORDS)
@pytest.mark.parametrize("spelling", ["cm/s2", "CM/SEC**2", "gal"])
def test_units(words, spelling):
    assert [unit.name for _, unit, _ in stated(words.format(u=spelling)).units] == ["cm/s2"]


@pytest.mark.parametrize(
    "note",
    [
        *NOTES, "Points are listed in the format of 8F10.5, i.e., 8 points across in", "Skipped samples: 0",
        "3 dB pts at 0.1 and 40 Hz", "Number of Displacement Ductility Factors: 2", "acc_range = 4 g",
        "UMBRAL DE DISPARO, C1-C6 (Gal)         : /2/2/2", "RAW PGA VALUES (gal)    : (N-S) 37.0",
        "5 values per line",
        "Natural frequency: 25 Hz", "FULL_SCALE_G: 2", "filter = 488 Hz", "Scale Factor 1g", "8 values a row",
    ],
)  # fmt: skip
def test_notes_state_nothing(note):
    found = stated(note)
    assert (found.counts, found.steps, found.units) == ([], [], [])


@pytest.mark.parametrize(
    ("line", "count", "step"),
    [
        ("1000 0.0050 NPTS, DT", 1000, 0.005),
        ("0.0050 1000 DT, NPTS", 1000, 0.005),
        ("NO. OF POINTS:   2400  EQUALLY SPACED INTERVALS OF:  0.005  SEC", 2400, 0.005),
        ("1559 points at equal spacing of 0.02 sec", 1559, 0.02),
        ("NPTS=  1559, DT= .02000 SEC", 1559, 0.02),
        ("dt=0.01,npts=300", 300, 0.01),
        ("Num. samples: 400, data_rate = 2000.0 Hz", 400, 0.0005),
    ],
)
def test_both_in_one_line(line, count, step):
    found = stated(line)
    assert [n for _, n, _ in found.counts] == [count]
    assert [s for _, s, _ in found.steps] == pytest.approx([step])


def test_a_step_of_seconds_is_doubted_unless_its_unit_is_told():
    assert stated("DT = 5").steps[0][1] is None
    assert stated("DT = 5 ms").steps[0][1] == 0.005
    assert statements([(1, "Zeitschritt: 0,01 s")], decimal_comma=True).steps[0][1] == 0.01


def test_instruments_are_no_accelerations():
    assert "acceleration" not in stated("INSTRUMENT: ACCELEROMETER ES-T").mentioned
    assert "acceleration" in stated("type of record: accelerogram").mentioned
