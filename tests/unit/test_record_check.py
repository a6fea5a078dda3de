"""The user's own files: recognised, reported, linked, and loaded under the study's names from then on."""

import math
import os
from pathlib import Path

import pytest

from fdspec.errors import RecordError
from fdspec.records import catalogue, load_record
from fdspec.records.check import check_folder, link_file, link_found, link_matches
from fdspec.records.links import Link, linked, links, links_file, remove_links, save_links
from fdspec.units import G


@pytest.fixture(autouse=True)
def own_links(monkeypatch, tmp_path):
    file = tmp_path / "configuration" / "records.toml"
    monkeypatch.setenv("FDSPEC_RECORDS", str(file))
    return file


def at2(event, station, component, pga_g, count=40):
    peak = [math.exp(-0.1 * k) * math.cos(k) * pga_g for k in range(count)]
    lines = [
        "PEER NGA STRONG MOTION DATABASE RECORD",
        f"{event}, {station}, {component}",
        "ACCELERATION TIME SERIES IN UNITS OF G",
        f"NPTS= {count}, DT= .01 SEC",
        *[f"{value:.7E}" for value in peak],
    ]
    return "\n".join(lines) + "\n"


# What the files of PEER's database say of themselves, in the old and the new way.
FOUND = {
    "FSR1": ("KOBE 01/16/95 2046", "KAKOGAWA", "090 (CUE)", 0.3447),
    "FSR2": ("Kobe Japan, 1/16/1995", "Kakogawa", "0", 0.2512),
    "FSR3": ("IMPERIAL VALLEY 10/15/79 2316", "EL CENTRO ARRAY #3", "230 (USGS STATION 5057)", 0.2213),
    "FMR2": ("Imperial Valley-06, 10/15/1979", "Calexico Fire Station", "225", 0.2770),
    "FHR1": ("Loma Prieta, 10/18/1989", "Gilroy Array #1", "000", 0.4110),
    "FHR3": ("KOCAELI 08/17/99", "GEBZE", "000 (ERD)", 0.2440),
}


@pytest.fixture
def folder(tmp_path):
    own = tmp_path / "own" / "deeper"
    own.mkdir(parents=True)
    for name, (event, station, component, pga_g) in FOUND.items():
        (own / f"{name.lower()}_file.AT2").write_text(at2(event, station, component, pga_g))
    return own.parent


def test_records_with_a_known_station_are_found(folder):
    check = check_folder(folder)
    assert {entry.name: check.status(entry.name) for entry in catalogue()} == {
        **dict.fromkeys(("FSR1", "FSR2", "FSR3", "FMR2", "FHR1", "FHR3"), "found"),
        **dict.fromkeys(("FMR1", "FMR3"), "missing"),
        "FHR2": "candidate",  # Gilroy #1 has nearly its PGA, and the study does not name its station
    }
    (match,) = check.of("FMR2")
    assert match.path == (folder / "deeper" / "fmr2_file.AT2").resolve()
    assert match.channel == "225"
    assert match.pga_g == pytest.approx(0.277, rel=1e-12)
    assert match.reason == "event, station and component agree, PGA 0.2770 g, the study's is 0.275"
    assert (check.files, check.unread) == (6, ())


@pytest.mark.parametrize(
    ("event", "station", "component", "pga_g", "name", "status"),
    [
        ("NORTHRIDGE EQ 1/17/94", "SOMEWHERE", "090", 0.3645, "FMR1", "candidate"),
        ("CHI-CHI 09/20/99", "CHY035", "N", 0.2462, "FMR3", "candidate"),
        ("Chi-Chi Taiwan, 9/20/1999", "CHY035", "N", 0.30, "FMR3", "missing"),
        ("KOBE 01/16/95", "KAKOGAWA", "090", 0.25, "FSR1", "candidate"),  # the right one, scaled
        ("KOBE 01/16/95", "KAKOGAWA", "000", 0.345, "FSR1", "candidate"),  # another component
        ("KOBE 01/16/95", "NISHI-AKASHI", "000", 0.345, "FSR1", "candidate"),
        ("KOBE 01/16/95", "NISHI-AKASHI", "000", 0.50, "FSR1", "missing"),
        ("Imperial Valley-06, 10/15/1979", "El Centro Array #13", "230", 0.30, "FSR3", "missing"),
        ("LOMA PRIETA 10/18/89", "GILROY ARRAY #1", "090", 0.473, "FHR1", "missing"),
        ("Duzce Turkey, 11/12/1999", "Gebze", "000", 0.244, "FHR3", "missing"),
    ],
)
def test_near_misses(tmp_path, event, station, component, pga_g, name, status):
    (tmp_path / "x.AT2").write_text(at2(event, station, component, pga_g))
    assert check_folder(tmp_path).status(name) == status


def test_candidates_come_nearest_first(tmp_path):
    for k, pga_g in enumerate((0.3660, 0.3641, 0.3620)):
        (tmp_path / f"{k}.AT2").write_text(at2("NORTHRIDGE 1/17/94", f"S{k}", "090", pga_g))
    assert [match.path.stem for match in check_folder(tmp_path).of("FMR1")] == ["1", "0", "2"]


def test_other_files_are_listed_and_not_raised(tmp_path):
    (tmp_path / "notes.txt").write_text("milk, eggs\n")
    (tmp_path / "broken.AT2").write_text(
        at2("KOBE", "KAKOGAWA", "090", 0.345).replace("NPTS= 40", "NPTS= 41")
    )
    seen = []
    check = check_folder(tmp_path, on_file=seen.append)
    assert [path.name for path, _ in check.unread] == ["broken.AT2", "notes.txt"]
    assert "expected 41 values" in check.unread[0][1]
    assert len(seen) == check.files == 2
    assert {check.status(entry.name) for entry in catalogue()} == {"missing"}


def test_what_may_not_be_opened_is_listed(tmp_path, monkeypatch):
    """Permissions mean nothing to the superuser, who may run the tests: they are refused by hand."""
    (tmp_path / "open" / "closed").mkdir(parents=True)
    for place in ("open", "open/closed"):
        (tmp_path / place / "secret.AT2").write_text(at2("KOBE", "KAKOGAWA", "090", 0.345))
    scandir, stat = os.scandir, Path.stat

    def refuse(path):
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr("os.scandir", lambda path: refuse(path) if path.endswith("closed") else scandir(path))
    monkeypatch.setattr(
        Path, "stat", lambda path, **how: refuse(path) if path.suffix == ".AT2" else stat(path, **how)
    )
    check = check_folder(tmp_path)
    reasons = {path.name: reason for path, reason in check.unread}
    assert set(reasons) == {"closed", "secret.AT2"}
    assert reasons["closed"].endswith("closed: cannot be read (Permission denied)")
    assert "secret.AT2: cannot be read" in reasons["secret.AT2"]
    assert check.matches == ()


def test_a_folder_that_is_none(tmp_path):
    with pytest.raises(RecordError, match="nowhere: is not a folder"):
        check_folder(tmp_path / "nowhere")


def test_linked_records_are_loaded_in_place_of_the_stand_ins(folder, own_links):
    stand_in = load_record("FSR1")
    assert set(link_found(check_folder(folder))) == set(FOUND)
    assert links_file() == own_links
    assert set(links()) == set(FOUND)
    motion = load_record("FSR1", scaled=False)
    assert motion.pga == pytest.approx(0.3447 * G, rel=1e-12)
    assert motion.name == "FSR1"
    assert motion.source.startswith(
        "the user's own FSR1: fsr1_file.AT2 (PEER AT2), KOBE 01/16/95 2046, KAKOGAWA 090; SHA-256 "
    )
    scaled = load_record("FSR1")
    assert scaled.pga == pytest.approx(0.345 * G, rel=1e-15)
    assert scaled.history == (f"scaled by {scaled.scale_factor!r} to a PGA of {0.345 * G!r} m/s2",)
    assert load_record("FMR1").source.startswith("stand-in for the study's FMR1")
    remove_links(("FSR1",))
    assert load_record("FSR1") == stand_in
    assert "FSR2" in links()
    remove_links()
    assert not own_links.exists()


def test_a_candidate_is_linked_only_by_hand(tmp_path):
    own = tmp_path / "own"
    own.mkdir()
    (own / "x.AT2").write_text(at2("NORTHRIDGE EQ 1/17/94", "SOMEWHERE", "090", 0.3645))
    check = check_folder(own)
    assert link_found(check) == {}
    assert links() == {}
    link_matches(check.of("FMR1"))
    assert "SOMEWHERE" in load_record("FMR1").source


@pytest.mark.parametrize(
    ("content", "arguments", "reason"),
    [
        (
            at2("CHI-CHI 09/20/99", "CHY035", "N", 0.2462),
            {},
            "same event, PGA 0.2462 g, the study's is 0.246; ",
        ),
        ("t[s] NS[g] EW[g]\n0 0.1 0.246\n1 0 0\n2 0 0\n", {"channel": "ew"}, "PGA 0.2460 g, the study's is"),
        ("0.1\n-2.46\n0\n", {"units": "m/s2", "dt": 0.01}, "PGA 0.2509 g, the study's is"),
    ],
)
@pytest.mark.filterwarnings("ignore:.*does not look like FMR3")
def test_one_file_is_linked_by_hand(tmp_path, content, arguments, reason):
    path = tmp_path / "mine.dat"
    path.write_text(content)
    match = link_file("fmr3", path, **arguments)
    assert (match.name, match.status, match.path) == ("FMR3", "candidate", path)
    assert match.reason.startswith(reason)
    assert load_record("FMR3", scaled=False).pga == pytest.approx(match.pga_g * G, rel=1e-15)
    assert load_record("FMR3").source.startswith("the user's own FMR3: mine.dat (")
    assert set(links()) == {"FMR3"}


def test_a_file_that_speaks_against_its_name_is_linked_with_a_warning(tmp_path):
    path = tmp_path / "x.AT2"
    path.write_text(at2("KOBE 01/16/95", "KAKOGAWA", "090", 0.345))
    with pytest.warns(
        UserWarning, match=r"does not look like FMR3, of Chi-Chi 1999: it says KOBE 01/16/95 KAK"
    ):
        link_file("FMR3", path)
    assert "KOBE 01/16/95" in load_record("FMR3").source


def test_what_cannot_be_read_is_not_linked(tmp_path):
    path = tmp_path / "two.txt"
    path.write_text("0 0.1 0.2\n0.01 0.3 0.4\n0.02 0.5 0.6\n")
    for arguments, problem in (
        ({}, "does not say the unit"),
        ({"units": "g"}, "has 2 channels: give channel"),
        ({"units": "g", "channel": "3"}, "there is no channel '3'"),
    ):
        with pytest.raises(RecordError, match=problem):
            link_file("FMR3", path, **arguments)
    (tmp_path / "still.txt").write_text("0\n0\n0\n")
    with pytest.raises(RecordError, match="zero throughout: no factor gives it the PGA of FMR3"):
        link_file("FMR3", tmp_path / "still.txt", units="g", dt=0.01)
    with pytest.raises(RecordError, match="there is no record 'FMR9' in the catalogue"):
        link_file("FMR9", path)
    assert links() == {}


def test_a_linked_file_that_went_or_changed_is_refused(folder):
    link_found(check_folder(folder))
    path = folder / "deeper" / "fsr1_file.AT2"
    path.write_text(path.read_text().replace("KAKOGAWA", "Kakogawa"))
    with pytest.raises(RecordError, match=r"FSR1 is linked to .*fsr1_file\.AT2, which was changed since"):
        load_record("FSR1")
    path.unlink()
    with pytest.raises(RecordError, match=r"which is not there: link it again or give it up with"):
        load_record("FSR1")


def test_odd_paths_survive_the_file_of_links(own_links):
    odd = own_links.parent / 'a "quoted" \\ name = [x].AT2'
    told = {"FSR1": Link(odd, 'ch "1"', "0" * 64), "FSR2": Link(odd, "", "1" * 64, "cm/s2", 0.005)}
    save_links(told)
    assert links() == told


@pytest.mark.parametrize(
    "content", ["not toml", "[FSR1]\npath = 1\n", "FSR1 = 3\n", "[FSR1]\nchannel = 'a'\n"]
)
def test_a_damaged_file_of_links_is_refused(own_links, content):
    own_links.parent.mkdir()
    own_links.write_text(content)
    with pytest.raises(RecordError, match="the file of links cannot be read .* correct or delete it"):
        linked("FSR1")


def test_links_that_cannot_be_written(monkeypatch, tmp_path):
    (tmp_path / "file").touch()
    monkeypatch.setenv("FDSPEC_RECORDS", str(tmp_path / "file" / "records.toml"))
    with pytest.raises(RecordError, match="cannot be"):
        save_links({"FSR1": Link(tmp_path, "", "")})


def test_links_that_cannot_be_deleted(own_links):
    own_links.mkdir(parents=True)
    with pytest.raises(RecordError, match="the file of links cannot be deleted"):
        remove_links()


def test_links_that_cannot_be_rewritten_stay(folder, own_links, monkeypatch):
    link_found(check_folder(folder))
    before = own_links.read_bytes()

    def full(*_, **__):
        raise OSError("disk full")

    monkeypatch.setattr("tempfile.NamedTemporaryFile", full)
    with pytest.raises(RecordError, match="links cannot be written .disk full"):
        remove_links(("FSR1",))
    assert own_links.read_bytes() == before


def test_links_stand_in_the_user_s_configuration(monkeypatch, tmp_path):
    monkeypatch.delenv("FDSPEC_RECORDS")
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    assert links_file() == tmp_path / "fdspec" / "records.toml"


@pytest.mark.parametrize("name", ["FSR1", "FMR2"])
def test_the_true_records_are_found(name):
    """Kakogawa 090 and Calexico 225 are among the real files."""
    real = Path(__file__).resolve().parents[3] / "shared" / "records" / "real"
    if not real.is_dir():
        pytest.skip("needs real record files in ../shared/records, which this machine does not have")
    check = check_folder(real)
    assert check.status(name) == "found"
    link_found(check)
    own = {"FSR1": "Kobe_KAKOGAWA_CUE90.dat", "FMR2": "RSN162_IMPVALL.H_H-CXO225.AT2"}[name]
    assert own in load_record(name).source
