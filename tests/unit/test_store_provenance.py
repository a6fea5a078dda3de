"""Provenance: what made a dataset, from what, when; and that it fits into a file."""

import json
from datetime import UTC, datetime, timedelta, timezone

import numpy as np
import pytest

import fdspec
from fdspec import store
from fdspec.errors import InvalidInput
from fdspec.model.motion import GroundMotion
from fdspec.store.provenance import provenance
from tests.cubes import synthetic_cube

MOTION = GroundMotion([0.0, 1.0, -2.0], 0.01, name="mine", source="mine.AT2").scaled(2.0)
NOON = datetime(2026, 3, 4, 12, 0, 5, 999, tzinfo=UTC)


def test_attributes():
    attributes = provenance("A cube", {"floor_mass": 20e3}, [MOTION], command="fdspec.sweep", now=NOON)
    version = fdspec.__version__
    assert list(attributes) == [
        "Conventions", "title", "source", "history", "references", "fdspec_version", "parameters",
    ]  # fmt: skip
    assert attributes["Conventions"] == "CF-1.11"
    assert attributes["title"] == "A cube"
    assert attributes["history"] == f"2026-03-04T12:00:05Z fdspec.sweep (fdspec {version})"
    assert attributes["fdspec_version"] == version
    assert attributes["source"].startswith(f"fdspec {version}, ")
    assert attributes["references"].startswith("Numerical methodology for dynamic analysis of buildings")
    assert json.loads(attributes["parameters"]) == {
        "floor_mass": 20e3,
        "records": [
            {
                "name": "mine",
                "checksum": MOTION.checksum,
                "source": "mine.AT2",
                "history": list(MOTION.history),
            }
        ],
    }


def test_parameters_of_every_kind_become_one_json_text():
    parameters = {
        "period": np.array([0.1, 0.2]),
        "count": np.int64(3),
        "certify": True,
        "slip_force": [np.inf, -np.inf, 1.5],
        "outputs": None,
        "damping": {"kind": "modal", "ratio": np.float64(0.02)},
    }
    content = json.loads(provenance("x", parameters, [])["parameters"])
    assert content == {
        "period": [0.1, 0.2],
        "count": 3,
        "certify": True,
        "slip_force": ["inf", "-inf", 1.5],
        "outputs": None,
        "damping": {"kind": "modal", "ratio": 0.02},
        "records": [],
    }


def test_every_bit_of_a_parameter_survives():
    periods = np.random.default_rng(7).random(50)
    content = json.loads(provenance("x", {"period": periods}, [])["parameters"])
    assert np.array(content["period"]).tobytes() == periods.tobytes()


def test_a_parameter_that_json_cannot_hold():
    with pytest.raises(
        InvalidInput, match=r"parameter damping\.kind is <object .* it should be numbers, text"
    ):
        provenance("x", {"damping": {"kind": object()}}, [])


def test_stand_ins_are_told():
    attributes = provenance("x", {}, [fdspec.load_record("FSR1"), MOTION], comment="Trial.")
    assert attributes["comment"] == (
        "Stand-ins: FSR1. Each is another real record of the same earthquake; "
        "the study's own files cannot be shipped. Trial."
    )


def test_the_user_s_own_files_are_told_from_stand_ins():
    own = [
        GroundMotion([0.0, 1.0], 0.01, name=name, source=f"the user's own {name}: x.AT2 (PEER AT2)")
        for name in ("FSR1", "FMR2")
    ]
    motions = [own[0], fdspec.load_record("FSR2"), own[1], MOTION]
    assert provenance("x", {}, motions)["comment"] == (
        "From the user's own files: FSR1, FMR2. "
        "Stand-ins: FSR2. Each is another real record of the same earthquake; "
        "the study's own files cannot be shipped."
    )
    assert provenance("x", {}, own)["comment"] == ("From the user's own files: FSR1, FMR2.")


def test_comment_alone():
    assert provenance("x", {}, [MOTION], comment="Trial.")["comment"] == "Trial."


def test_time_is_universal():
    east = NOON.astimezone(timezone(timedelta(hours=5)))
    assert provenance("x", {}, [], now=east) == provenance("x", {}, [], now=NOON)
    with pytest.raises(InvalidInput, match="it should carry its time zone"):
        provenance("x", {}, [], now=datetime(2026, 3, 4))  # noqa: DTZ001


def test_time_from_source_date_epoch(monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    assert provenance("x", {}, [])["history"].startswith("1970-01-02T00:00:00Z ")


@pytest.mark.parametrize("epoch", ["", "soon", "1e9", "99999999999999999999"])
def test_unusable_source_date_epoch(monkeypatch, epoch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", epoch)
    with pytest.raises(InvalidInput, match="SOURCE_DATE_EPOCH is .*; it should be whole seconds since 1970"):
        provenance("x", {}, [])


def test_time_from_the_clock(monkeypatch):
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    before = datetime.now(UTC).replace(microsecond=0)
    stamp = provenance("x", {}, [])["history"].split()[0]
    assert before <= datetime.strptime(stamp, "%Y-%m-%dT%H:%M:%S%z") <= datetime.now(UTC)


def test_a_file_holds_it(tmp_path):
    attributes = provenance("A cube", {"period": [0.1]}, [fdspec.load_record("FSR1")], now=NOON)
    store.save(synthetic_cube().assign_attrs(attributes), tmp_path / "cube.nc")
    opened = store.open(tmp_path / "cube.nc")
    assert {name: opened.attrs[name] for name in attributes} == attributes
