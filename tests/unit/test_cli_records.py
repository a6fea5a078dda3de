"""`fdspec records`: what a person and a program can read, and files that come out as they should."""

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

from fdspec.cli import main
from fdspec.printable import rounded
from fdspec.records import catalogue, load_record, read_record
from fdspec.signals.intensity import intensity
from fdspec.units import G


def output(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(["records", *arguments]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    return out


def test_list_has_a_line_for_each_of_the_nine(capsys: pytest.CaptureFixture[str]) -> None:
    head, *rows = output(capsys, "list").splitlines()
    assert head.split()[:3] == ["name", "event", "date"]
    assert [row.split()[0] for row in rows] == [entry.name for entry in catalogue()]
    assert "Shin-Osaka 090" in rows[0]
    assert "0.345" in rows[0]
    assert not any("\x1b" in row for row in rows)


def test_list_as_json_holds_the_whole_catalogue(capsys: pytest.CaptureFixture[str]) -> None:
    entries = json.loads(output(capsys, "list", "--json"))
    assert [entry["name"] for entry in entries] == [entry.name for entry in catalogue()]
    assert entries[0]["stand_in"]["station"] == "Shin-Osaka"
    assert entries[0]["date"] == "1995-01-16"


def test_show_tells_the_stand_in_and_its_scale(capsys: pytest.CaptureFixture[str]) -> None:
    about = json.loads(output(capsys, "show", "fsr1", "--json"))
    assert about["name"] == "FSR1"
    assert about["pga_g"] == pytest.approx(0.345)
    assert about["scale_factor"] == pytest.approx(0.345 / 0.211916, rel=1e-5)
    assert about["source"].startswith("stand-in for the study's FSR1")
    assert about["soil"] == "soft"


def test_show_raw_is_as_recorded(capsys: pytest.CaptureFixture[str]) -> None:
    about = json.loads(output(capsys, "show", "FSR1", "--raw", "--json"))
    assert about["scale_factor"] == 1.0
    assert about["pga_g"] == pytest.approx(0.211916, rel=1e-5)


def test_show_says_the_same_for_people(capsys: pytest.CaptureFixture[str]) -> None:
    lines = dict(re.split(r"  +", line) for line in output(capsys, "show", "FSR1").splitlines())
    assert lines["name"] == "FSR1"
    assert lines["PGA"] == "0.345 g"
    assert lines["significant duration"] == "11.824 s"
    assert lines["history"] == "scaled by 1.628 to a PGA of 3.38329 m/s2"


def test_show_reads_a_file_with_what_it_does_not_say(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "FSR1.txt"
    np.savetxt(path, 100 * np.sin(0.1 * np.arange(300)), fmt="%.6f")
    about = json.loads(output(capsys, "show", str(path), "--units", "cm/s2", "--dt", "0.02", "--json"))
    assert about["samples"] == 300
    assert about["dt_s"] == 0.02
    assert about["pga_g"] == pytest.approx(1.0 / 9.80665, rel=1e-3)
    assert "study_pga_g" not in about  # a file of a catalogue name is no record of the catalogue


def test_show_gives_the_intensity(capsys: pytest.CaptureFixture[str]) -> None:
    about = json.loads(output(capsys, "show", "FMR1", "--json"))
    found = intensity(load_record("FMR1"))
    assert about["pgv_m_per_s"] == found.pgv
    assert about["pgd_m"] == found.pgd
    assert about["arias_m_per_s"] == found.arias
    assert about["significant_duration_s"] == found.significant_duration
    assert about["cav_m_per_s"] == found.cav


def test_show_takes_a_motion_that_is_zero(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "still.txt").write_text("0.0\n" * 20)
    still = ("show", str(tmp_path / "still.txt"), "--units", "g", "--dt", "0.01")
    about = json.loads(output(capsys, *still, "--json"))
    assert about["pga_g"] == 0.0
    assert "arias_m_per_s" not in about
    assert main(["records", *still, "--figure", str(tmp_path / "still.png")]) == 2
    assert "zero throughout" in capsys.readouterr().err
    assert not (tmp_path / "still.png").exists()


@pytest.mark.parametrize(("kind", "head"), [("png", b"\x89PNG"), ("pdf", b"%PDF"), ("svg", b"<?xml")])
def test_show_draws(tmp_path: Path, capsys: pytest.CaptureFixture[str], kind: str, head: bytes) -> None:
    path = tmp_path / f"FMR1.{kind}"
    about = json.loads(output(capsys, "show", "FMR1", "--figure", str(path), "--json"))
    assert about["figure"] == str(path)
    assert path.read_bytes().startswith(head)


def test_show_replaces_no_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "mine.png"
    path.write_text("mine")
    assert main(["records", "show", "FMR1", "--figure", str(path)]) == 2
    assert "exists already" in capsys.readouterr().err
    assert path.read_text() == "mine"
    output(capsys, "show", "FMR1", "--figure", str(path), "--force")
    assert path.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("name", "words"),
    [("FSR9", ["FSR9", "did you mean"]), ("none.AT2", ["none.AT2"])],
)
def test_an_unknown_record_is_refused(
    capsys: pytest.CaptureFixture[str], name: str, words: list[str]
) -> None:
    assert main(["records", "show", name]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert all(word in err for word in words)


def at2(event: str, station: str, component: str, pga_g: float) -> str:
    rows = [f"{math.exp(-0.1 * k) * math.cos(k) * pga_g:.7E}" for k in range(40)]
    head = ["PEER NGA STRONG MOTION DATABASE RECORD", f"{event}, {station}, {component}"]
    return "\n".join([*head, "ACCELERATION TIME SERIES IN UNITS OF G", "NPTS= 40, DT= .01 SEC", *rows, ""])


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a folder with Kakogawa 090, five that may be FMR1, a note and a cut file; links of its own."""
    monkeypatch.setenv("FDSPEC_RECORDS", str(tmp_path / "links.toml"))
    folder = tmp_path / "own"
    (folder / "deeper").mkdir(parents=True)
    (folder / "deeper" / "kak.AT2").write_text(at2("KOBE 01/16/95 2046", "KAKOGAWA", "090", 0.3447))
    for k in range(5):
        content = at2("NORTHRIDGE 1/17/94", f"S{k}", "090", 0.364 + 0.001 * k)
        (folder / f"n{k}.AT2").write_text(content)
    (folder / "notes.txt").write_text("milk, eggs\n")
    (folder / "cut.AT2").write_text(at2("KOBE", "KAKOGAWA", "000", 0.251).replace("NPTS= 40", "NPTS= 41"))
    return folder


def test_check_reports_found_candidates_and_missing(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = output(capsys, "check", str(own)).splitlines()
    assert lines[0].split() == ["name", "event", "status", "file", "channel", "why"]
    rows = {line.split()[0]: line for line in lines[1:] if line.startswith("F")}
    assert list(rows) == [entry.name for entry in catalogue()]
    assert " ".join(rows["FSR1"].split()) == (
        "FSR1 Kobe 1995 found deeper/kak.AT2 090 event, station and component agree, "
        "PGA 0.3447 g, the study's is 0.345"
    )
    assert " ".join(rows["FSR2"].split()) == "FSR2 Kobe 1995 missing the study's PGA is 0.251 g"
    at = lines.index(rows["FMR1"])
    assert [line.split("candidate")[1].split()[0] for line in lines[at : at + 3]] == [
        "n0.AT2",
        "n1.AT2",
        "n2.AT2",
    ]
    assert lines[at + 3].strip() == "and 2 more; --json lists all"
    assert "8 files looked through: 1 found, 1 candidate, 7 missing" in lines
    unread = lines.index("not read (2):")
    assert "cut.AT2" in lines[unread + 1]
    assert "expected 41 values" in lines[unread + 1]
    assert "notes.txt" in lines[unread + 2]
    assert lines[-3] == "--link loads those found in place of the stand-ins from now on."
    assert lines[-1] == "fdspec records link NAME FILE links a candidate that you know to be the one."
    assert load_record("FSR1").source.startswith("stand-in for")


def test_check_shortens_a_long_list_of_files_not_read(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for k in range(20):
        (own / f"z{k:02}.txt").write_text("x" * 400)
    lines = output(capsys, "check", str(own)).splitlines()
    unread = lines.index("not read (22):")
    assert lines[unread + 9] == "  and 14 more; --json lists all"
    assert max(map(len, lines[unread : unread + 10])) <= 112


def test_check_as_json_lists_all(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = json.loads(output(capsys, "check", str(own), "--json"))
    assert found["files"] == 8
    records = {record["name"]: record for record in found["records"]}
    assert {name: record["status"] for name, record in records.items() if record["matches"]} == {
        "FSR1": "found",
        "FMR1": "candidate",
    }
    assert len(records["FMR1"]["matches"]) == 5
    (match,) = records["FSR1"]["matches"]
    assert match["path"] == str(own / "deeper" / "kak.AT2")
    assert match["channel"] == "090"
    assert match["pga_g"] == pytest.approx(0.3447, rel=1e-12)
    assert [Path(file["file"]).name for file in found["unread"]] == ["cut.AT2", "notes.txt"]
    assert records["FSR1"]["linked"] is None


def test_linked_records_are_loaded_until_unlinked(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = own / "deeper" / "kak.AT2"
    lines = output(capsys, "check", str(own), "--link").splitlines()
    assert lines[-4:-2] == ["Linked, and loaded in place of the stand-ins:", f"  FSR1  {path}"]
    assert load_record("FSR1").source.startswith("the user's own FSR1: kak.AT2")
    assert load_record("FMR1").source.startswith("stand-in for")  # a candidate is never linked
    about = json.loads(output(capsys, "show", "FSR1", "--json"))
    assert about["file"] == str(path)
    assert about["station"] == "KAKOGAWA"
    assert "site_class" not in about  # that of the stand-in's station
    reported = json.loads(output(capsys, "check", str(own), "--json"))["records"]
    assert {record["name"]: record["linked"] for record in reported if record["linked"]} == {
        "FSR1": str(path)
    }
    assert output(capsys, "unlink") == "unlinked: FSR1; the stand-ins are loaded\n"
    assert load_record("FSR1").source.startswith("stand-in for")
    assert json.loads(output(capsys, "unlink", "--json"))["unlinked"] == []


def test_a_candidate_is_linked_by_name_and_listed(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = output(capsys, "link", "fmr1", str(own / "n0.AT2"))
    assert out == (
        f"FMR1 is {own / 'n0.AT2'} from now on: same event, PGA 0.3640 g, the study's is 0.364; "
        "the study does not name the station\n"
    )
    output(capsys, "check", str(own), "--link")
    lines = output(capsys, "list").splitlines()
    rows = {line.split()[0]: line for line in lines[1:10]}
    assert "own: n0.AT2" in rows["FMR1"]
    assert rows["FMR1"].endswith(f"{load_record('FMR1').scale_factor:.3f}")
    assert "own: kak.AT2" in rows["FSR1"]
    assert "Shin-Osaka 000" in rows["FSR2"]
    told = ["Linked, and loaded in place of the stand-ins:", f"  FMR1  {own / 'n0.AT2'}"]
    assert lines[11:] == [*told, f"  FSR1  {own / 'deeper' / 'kak.AT2'}"]
    entries = {entry["name"]: entry["linked"] for entry in json.loads(output(capsys, "list", "--json"))}
    assert entries["FMR1"]["path"] == str(own / "n0.AT2")
    assert entries["FMR1"]["channel"] == "090"
    assert entries["FSR2"] is None
    assert output(capsys, "unlink", "FSR1", "fsr2") == "unlinked: FSR1; the stand-ins are loaded\n"
    assert load_record("FMR1").source.startswith("the user's own FMR1")


def test_list_says_which_link_is_broken(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = own / "deeper" / "kak.AT2"
    output(capsys, "link", "FSR1", str(path))
    path.write_text(path.read_text().replace("KAKOGAWA", "Kakogawa"))
    lines = output(capsys, "list").splitlines()
    assert "own: kak.AT2, refused" in lines[1]
    assert lines[-1] == (
        f"  FSR1 is linked to {path}, which was changed since: "
        "link it again or give it up with `fdspec records unlink FSR1`"
    )
    assert main(["records", "show", "FSR1"]) == 2
    assert "which was changed since" in capsys.readouterr().err
    output(capsys, "unlink", "FSR1")
    output(capsys, "show", "FSR1")


def test_unlink_clears_a_damaged_file_of_links(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    links = own.parent / "links.toml"
    links.write_text("not toml")
    assert main(["records", "check", str(own)]) == 2
    assert "correct or delete it" in capsys.readouterr().err
    assert output(capsys, "unlink") == "unlinked: nothing; the stand-ins are loaded\n"
    assert not links.exists()


def test_link_fails_when_nothing_was_found(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (own / "deeper" / "kak.AT2").unlink()
    assert main(["records", "check", str(own), "--link"]) == 1
    out, err = capsys.readouterr()
    assert "0 found, 1 candidate, 8 missing" in out
    assert err == f"fdspec: error: {own} has none of the study's records for certain: nothing was linked\n"
    assert not (own.parent / "links.toml").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["check"], "Missing argument 'DIR'"),
        (["unlink", "FSR9"], "there is no record 'FSR9' in the catalogue"),
        (["link", "FSR1"], "Missing argument 'FILE'"),
        (["link", "FSR9", "none.AT2"], "there is no record 'FSR9' in the catalogue"),
        (["link", "FSR1", "none.AT2"], "none.AT2: there is no such file"),
        (["check", "nowhere"], "nowhere: is not a folder"),
        (["convert", "FMR1"], "Missing option"),
        (["convert", "FMR1", "-o", "new.csv"], "the name should end in .at2 or .txt"),
        (["convert", "FMR1", "-o", "new.at2", "--pga", "1", "--factor", "2"], "one of --factor, --pga and"),
        (["convert", "FMR1", "-o", "new.at2", "--pga-g", "-1"], "pga must be positive"),
        (["convert", "FMR1", "-o", "new.at2", "--trim", "5", "1"], "end"),
        (["convert", "FMR1", "-o", "new.at2", "--trim-arias", "0.9", "0.1"], "0 <= start < end <= 1"),
        (["convert", "FMR1", "-o", "new.at2", "--pad", "1e300", "0"], "before must be at most 100000 s"),
        (["convert", "none.AT2", "-o", "new.at2"], "none.AT2: there is no such file"),
        (["show", "FSR1,FSR2"], "there is no record 'FSR1,FSR2' in the catalogue"),
        (["show", ""], "A record has a name or is a file: give one"),
        (["show", "fsr1", "--units", "g"], "tell about a file; the catalogue knows fsr1"),
        (["convert", "FSR1,FSR2", "-o", "new.at2"], "there is no record 'FSR1,FSR2' in the catalogue"),
        (["figures", "--record", ","], "A record has a name or is a file: give one"),
        (["figures", "--record", "FMR1", "--dt", "0.01"], "tell about a file; the catalogue knows FMR1"),
        (["figures", "--units", "g"], "tell about a file named with --record"),
        (["figures", "--record", "FMR1", "--record", "FMR1"], "names that differ"),
        (["figures", "--record", "FMR1", "--damping-ratio", "-1"], "damping_ratio must be 0 or more"),
    ],
)
def test_wrong_usage_is_told_and_leaves_nothing(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    words: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["records", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert words in err
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []


@pytest.mark.parametrize("ending", ["at2", "AT2", "txt"])
def test_convert_keeps_the_numbers(tmp_path: Path, capsys: pytest.CaptureFixture[str], ending: str) -> None:
    path = tmp_path / f"new.{ending}"
    out = output(capsys, "convert", "FMR1", "--raw", "-o", str(path))
    motion, written = load_record("FMR1", scaled=False), read_record(path)
    assert out.splitlines()[0] == f"{path}: {motion.n} samples, dt 0.01 s, PGA {motion.pga / G:.4g} g"
    assert written.dt == motion.dt
    if ending == "txt":
        assert np.array_equal(written.acceleration, motion.acceleration)
    else:  # two roundings: to g and back
        np.testing.assert_array_max_ulp(written.acceleration, motion.acceleration, maxulp=2)
    assert written.station == motion.station


def test_convert_reads_what_the_options_tell(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    samples = np.random.default_rng(11).normal(size=300)
    np.savetxt(tmp_path / "old.dat", 100.0 * samples, fmt="%.17g")
    old, new = str(tmp_path / "old.dat"), str(tmp_path / "new.txt")
    output(capsys, "convert", old, "--units", "cm/s2", "--dt", "0.02", "-o", new)
    written = read_record(new)
    np.testing.assert_allclose(written.acceleration, samples, rtol=1e-15)
    assert written.dt == 0.02


def test_convert_takes_one_channel_of_several(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = [f"{0.01 * k:.2f} {math.sin(k)!r} {math.cos(k)!r}" for k in range(50)]
    old, new = tmp_path / "old.txt", tmp_path / "new.txt"
    old.write_text("\n".join(["Time[s] East[m/s2] North[m/s2]", *rows, ""]))
    assert main(["records", "convert", str(old), "-o", str(new)]) == 2
    assert "the file has 2 channels: give channel, one of" in capsys.readouterr().err
    output(capsys, "convert", str(old), "--channel", "North", "-o", str(new))
    assert read_record(new).acceleration.tolist() == [math.cos(k) for k in range(50)]


def test_convert_takes_its_steps_in_one_order(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    steps = ["--pga-g", "0.5", "--pad", "1", "2", "--resample", "0.02", "--band-pass", "0.1", "20"]
    steps += ["--baseline", "1", "--trim-arias", "0.01", "0.99", "--trim", "2", "12"]
    path = tmp_path / "new.txt"
    head, *told = output(capsys, "convert", "FMR1", *steps, "-o", str(path)).splitlines()
    assert head.endswith("samples, dt 0.02 s, PGA 0.5 g")
    assert [step.split()[0] for step in told] == [
        "scaled",  # to the study's PGA
        "trimmed",
        "trimmed",
        "baseline",
        "band-passed",
        "resampled",
        "padded",
        "scaled",
    ]
    motion = read_record(path)
    assert [rounded(f"  {step}") for step in motion.history] == told
    assert motion.pga == pytest.approx(0.5 * G, rel=1e-15)
    assert not motion.acceleration[:50].any()
    assert motion.acceleration[51:-100].any()


@pytest.mark.parametrize(("option", "pga"), [("--pga=2.5", 2.5), ("--pga-g=0.25", 0.25 * G)])
def test_convert_scales(tmp_path: Path, capsys: pytest.CaptureFixture[str], option: str, pga: float) -> None:
    output(capsys, "convert", "FMR1", option, "-o", str(tmp_path / "new.txt"))
    assert read_record(tmp_path / "new.txt").pga == pytest.approx(pga, rel=1e-15)


def test_convert_replaces_no_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "mine.at2"
    path.write_text("mine")
    assert main(["records", "convert", "FMR1", "-o", str(path)]) == 2
    assert "exists already" in capsys.readouterr().err
    assert path.read_text() == "mine"
    output(capsys, "convert", "FMR1", "--factor", "-1", "-o", str(path), "--force")
    assert read_record(path).acceleration[100] == pytest.approx(-load_record("FMR1").acceleration[100])


def test_figures_of_a_name_and_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "mine.AT2").write_text(at2("KOBE 01/16/95", "KAKOGAWA", "090", 0.3447))
    chosen = ["--record", "FMR1", "--record", str(tmp_path / "mine.AT2"), "-o", str(tmp_path / "drawn")]
    out = output(capsys, "figures", *chosen)
    paths = [tmp_path / "drawn" / f"records-{what}.png" for what in ("histories", "spectra")]
    assert out.splitlines() == [str(path) for path in paths]
    first = [path.read_bytes() for path in paths]
    assert all(content.startswith(b"\x89PNG") for content in first)
    assert main(["records", "figures", *chosen]) == 2
    assert "exists already" in capsys.readouterr().err
    output(capsys, "figures", *chosen, "--force")
    assert [path.read_bytes() for path in paths] == first


def test_what_is_told_of_a_file_leaves_names_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "mine.txt"
    path.write_text("".join(f"{math.sin(0.1 * k):.6f}\n" for k in range(300)))
    both = ["--record", "FMR1", "--record", str(path)]
    output(capsys, "figures", *both, "--units", "m/s2", "--dt", "0.02", "-o", str(tmp_path / "drawn"))
    assert len(list((tmp_path / "drawn").iterdir())) == 2


def test_figures_draw_the_nine(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output(capsys, "figures", "-o", str(tmp_path), "--format", "svg")
    content = (tmp_path / "records-histories.svg").read_text()
    # A panel, its title in paths; the note in the head names all nine.
    assert content.count('<g id="axes_') == 9
