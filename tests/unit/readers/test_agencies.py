"""The agencies' formats: what each file's own header says, and what obspy reads, is what the reader gives."""

import re

import numpy as np
import pytest

from fdspec.errors import RecordError
from fdspec.records import read_channels, read_record
from fdspec.records.formats import FORMATS
from fdspec.units import G
from tests.fixtures.records import samples
from tests.fixtures.records.samples import SAMPLES, VARIANTS

# format -> channels, time step, event, station and component of the first, what opens its history
SAID = {
    "PEER AT2": (["090"], 0.01, "Nowhere-01, 1/2/1999", "Old Mill", "090", ""),
    "COSMOS V1 or V2": (
        ["90 deg", "Up"], 0.01, "Nowhere Earthquake of Sat Jan 02, 1999 12:00 UTC", "XX Old Mill", "90 deg",
        "Record filtered below  0.10 Hz",
    ),
    "CSMIP V2": (
        ["90 Deg"], 0.01, "Sat Jan 02, 1999 12:00:00.0 UTC", "Old Mill", "90 Deg",
        "Accelerogram bandpass filtered with 3 dB pts at   .10 and 40.00 cyc/sec",
    ),
    "CSMIP V2 of 1983": (
        ["90 DEG"], 0.01, "RCRD OF SAT JAN 02, 1999 12:00:00.0 UTC", "OLD MILL", "90 DEG",
        "ACCELEROGRAM BANDPASS FILTERED WITH",
    ),
    "CSMIP V1": (["90 Deg", "Up"], 0.01, "Sat Jan 02, 1999 12:00:00.0 UTC", "Old Mill", "90 Deg", ""),
    "CSMIP V1 in pairs": (["NS"], 0.01, "01/02/1999 12:00:00", "OLD MILL", "NS", ""),
    "CSMIP V1 of CDMG": (["90 DEG", "UP"], 0.01, "", "OLD MILL", "90 DEG", ""),
    "USGS blocks": (
        ["90"], 0.01, "EARTHQUAKE OF JANUARY 2, 1999 1200 GMT", "OLD MILL, 1 MILL ROAD, GROUND", "90",
        "filtered by the agency: BUTTERWORTH AT .25 HZ",
    ),
    "AFAD": (["HNE"], 0.01, "NOWHERE 19990102", "MILL", "HNE", "by the agency: "),
    "USGS SMC": (["90"], 0.01, "1999 01 02 1200 Nowhere", "Old Mill", "90", ""),
    "ESM or ITACA ASCII": (["HNE"], 0.01, "NOWHERE 19990102", "MILL", "HNE", "by the agency: "),
    "K-NET or KiK-net": (
        ["E-W"], 0.02, "1999/01/02 12:00:00 M6.0", "MIL001", "E-W", "offset of ",
    ),
    "GeoNet V1A or V2A": (
        ["N10E", "N80W"], 0.02, "5 km south of Nowhere, 1999 January 02 12:00:00 UT", "MILL", "N10E",
        "Band-pass filter",
    ),
    "CWB": (["U", "N", "E"], 0.02, "1999/01/02-12:00:00 GMT+08", "MIL", "U", ""),
    "NSMN (Turkey)": (["N-S", "E-W", "U-D"], 0.01, "1999/01/02 12:00:00 (GMT)", "0001", "N-S", ""),
    "UNAM ASA": (["V", "N00E", "N90E"], 0.01, "1999/01/02 12:00:00 M=6.0", "MILL", "V", ""),
    "BHRC (Iran)": (["L1", "T2"], 0.01, "1999/01/02 12:00:00", "Old Mill", "L1", ""),
    "columns of fdspec": (
        ["090"], 0.01, "Nowhere 1999-01-02", "Old Mill", "090", "Accelerogram bandpass filtered",
    ),
    "columns of text": (["Accel"], 0.01, "The Nowhere earthquake", "MILL", "", ""),
}  # fmt: skip


def test_every_format_has_a_sample():
    of = {VARIANTS.get(name, name) for name in SAMPLES}
    assert of == {known.name for known in FORMATS} | {"columns of text"}


@pytest.mark.parametrize("name", SAMPLES)
@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_sample_files(record_file, name, ending):
    text, values = SAMPLES[name]
    channels, dt, event, station, component, first_step = SAID[name]
    path = record_file(text.replace("\n", ending), "sample.xyz")
    read = read_channels(path)
    assert list(read) == channels
    motion = read["N"] if name == "CWB" else read[channels[0]]
    np.testing.assert_allclose(motion.acceleration, values, rtol=2e-16, atol=2e-17)
    assert motion.dt == dt
    first = read[channels[0]]
    assert (first.event, first.station, first.component) == (event, station, component)
    assert first.history[0].startswith(first_step) if first_step else first.history == ()
    assert VARIANTS.get(name, name) in first.source


@pytest.mark.parametrize("name", sorted(set(SAMPLES) - {"columns of text"}))
def test_a_file_cut_anywhere_in_its_values_is_refused(record_file, name):
    lines = SAMPLES[name][0].splitlines()
    first_value_line = {"GeoNet V1A or V2A": 70, "COSMOS V1 or V2": 95}.get(name, len(lines) - 2)
    # COSMOS counts its values; the line that ends them may be missing.
    for kept in range(first_value_line, len(lines) - (name == "COSMOS V1 or V2")):
        with pytest.raises(RecordError, match=r"^cut\.dat"):
            read_channels(record_file("\n".join(lines[:kept]), "cut.dat"))


COUNTS = {
    "PEER AT2": "NPTS=     23",
    "COSMOS V1 or V2": "      23 acceleration pts",
    "CSMIP V2": "    23 points of accel",
    "CSMIP V2 of 1983": "   23 POINTS OF ACCEL",
    "CSMIP V1": "    23 Accelerogram points",
    "CSMIP V1 in pairs": "NO. OF POINTS =     23",
    "CSMIP V1 of CDMG": "   23 POINTS OF ACCEL",
    "USGS blocks": "NO OF POINTS=    23",
    "AFAD": "NDATA: 23",
    "USGS SMC": "    -32768         1\n        23    -32768",
    "ESM or ITACA ASCII": "NDATA: 23",
    "K-NET or KiK-net": "Duration Time(s)  2",
    "GeoNet V1A or V2A": "Number of points     23",
    "CWB": "#RecordLength(sec): 0.46",
    "NSMN (Turkey)": "NUMBER OF DATA          : 23",
    "BHRC (Iran)": "NO. OF POINTS =     23",
    "UNAM ASA": "NUM. TOTAL DE MUESTRAS, C1-C6          : /23/23/23",
    "columns of fdspec": "Samples: 23",
}


@pytest.mark.parametrize("name", COUNTS)
@pytest.mark.parametrize("change", [-23, -22, -1, +1, +8, +1000])
def test_a_damaged_count_is_refused(record_file, name, change):
    text = SAMPLES[name][0]
    assert COUNTS[name] in text
    number = re.findall(r"[\d.]+", COUNTS[name])[-1]
    if name == "USGS SMC":
        damaged = text.replace(COUNTS[name], COUNTS[name].replace("        23", f"{23 + change:10d}"), 1)
    elif name == "UNAM ASA":
        damaged = text.replace("/23/23/23", f"/{23 + change}" * 3, 1)
    elif name == "CWB":
        damaged = text.replace(COUNTS[name], f"#RecordLength(sec): {0.46 + 0.02 * change:.2f}", 1)
    else:
        prefix, suffix = COUNTS[name].split(number)
        damaged = text.replace(COUNTS[name], f"{prefix}{int(number) + change}{suffix}", 1)
    with pytest.raises(RecordError):
        read_channels(record_file(damaged, "damaged.dat"))


@pytest.mark.parametrize("name", sorted(SAMPLES))
def test_text_in_a_number_s_place_is_refused_with_its_line(record_file, name):
    lines = SAMPLES[name][0].splitlines()
    at = len(lines) - 2
    lines[at] = lines[at][:2] + "__import__('os')" + lines[at][18:]
    with pytest.raises(RecordError, match=rf"^damaged\.dat, line {at + 1}: "):
        read_channels(record_file("\n".join(lines), "damaged.dat"))


def test_raw_counts_are_refused(record_file):
    text = SAMPLES["COSMOS V1 or V2"][0].replace("units=cm/sec2(04)", "units=counts (50)")
    with pytest.raises(RecordError, match=r"line 45: .*raw counts are no acceleration"):
        read_record(record_file(text))


def test_other_quantities_are_refused(record_file):
    with pytest.raises(RecordError, match="expected an accelerogram"):
        read_record(record_file(SAMPLES["USGS SMC"][0].replace("2 CORRECTED ACCEL", "3 VELOCITY    ACCEL")))
    with pytest.raises(RecordError, match="expected DATA_TYPE: ACCELERATION, found 'VELOCITY'"):
        read_record(record_file(SAMPLES["ESM or ITACA ASCII"][0].replace(": ACCELERATION", ": VELOCITY")))


def test_the_header_s_time_step_is_checked_against_its_length(record_file):
    text = SAMPLES["COSMOS V1 or V2"][0].replace("    10.000000", "    20.000000")
    with pytest.raises(RecordError, match=r"23 points of 0.02 s do not make 0.23 s"):
        read_record(record_file(text), channel="Up")


def test_channels_without_a_name_of_their_own_are_numbered(record_file):
    text = SAMPLES["COSMOS V1 or V2"][0].replace("Sta Chan  2: Up", "Sta Chan  2: 90 deg")
    assert list(read_channels(record_file(text))) == ["90 deg (1)", "90 deg (2)"]


# What each real file's own header says of its channels: name, count, dt in s, peak, and its unit in m/s2.
GAL, MM = 0.01, 0.001
REAL = {
    "cesmd_v1c__CE23837.V1C": [
        ("360 deg", 13400, 0.005, 0.105, G),
        ("Up", 13400, 0.005, 0.049, G),
        ("90 deg", 13400, 0.005, 0.059, G),
    ],
    "cosmos_v1__Cosmos12TimeSeriesTest.v1": [("340 deg", 7000, 0.01, 161.962, GAL)],
    "cosmos_v2c__AKBMR.BNZ.acc.V2c": [("Other", 42000, 0.005, 6.852, GAL)],
    "csmip_dmg_v2__CE58667.V2": [
        ("H1", 7500, 0.01, 27.114, GAL),
        ("Up", 7500, 0.01, 11.244, GAL),
        ("H2", 7500, 0.01, 26.411, GAL),
    ],
    "csmip_dmg_v2__CE89146.V2": [
        ("360 Deg", 12000, 0.005, 77.280, GAL),
        ("Up", 12000, 0.005, 20.529, GAL),
        ("90 Deg", 12000, 0.005, 44.200, GAL),
    ],
    "csmip_dmg_v2__CIWLT.V2": [
        ("90 Deg", 15050, 0.02, 82.584, GAL),
        ("360 Deg", 15029, 0.02, 115.845, GAL),
        ("Up", 15050, 0.02, 69.662, GAL),
    ],
    "renadic_chile__arica0911131.v1": [
        ("NS", 26600, 0.005, 0.052, G),
        ("V", 26600, 0.005, 0.029, G),
        ("EW", 26600, 0.005, 0.057, G),
    ],
    "smc__0111a.smc": [("360", 6001, 0.005, 104.41, GAL)],
    "esm_itaca__HI.ARS1.HNE.ACC.ASC": [("HNE", 19128, 0.005, 0.300022, GAL)],
    "knet__AOM0011801241951.EW": [("E-W", 10200, 0.01, 4.078, GAL)],
    "kiknet__AICH040010061330.EW2": [("EW (surface)", 28600, 0.005, 3.896, GAL)],
    "geonet_v1a__HSES_20.V1A": [
        ("N10E", 65536, 0.005, 2394.8, MM),
        ("N80W", 65536, 0.005, 2584.4, MM),
        ("Up", 65536, 0.005, 1589.9, MM),
    ],
    "geonet_v2a__WPWS_20.V2A": [
        ("S16W", 5800, 0.02, 41.6, MM),
        ("S74E", 5800, 0.02, 194.0, MM),
        ("Up", 5800, 0.02, 27.3, MM),
    ],
    "nsmn_turkey__20170720223109_0921.txt": [
        ("N-S", 28683, 0.01, 13.200332, GAL),
        ("E-W", 28683, 0.01, 12.163827, GAL),
        ("U-D", 28683, 0.01, 9.840572, GAL),
    ],
    "unam_mexico__ACAC1709.191": [
        ("V", 35600, 0.005, 25.6114, GAL),
        ("N00E", 35600, 0.005, 58.7394, GAL),
        ("N90E", 35600, 0.005, 42.3377, GAL),
    ],
    "bhrc_iran__5520-1.V1": [],  # its header gives no peak
    "cwb_taiwan__1-EAS.dat": [
        ("U", 6000, 0.02, 0.837, GAL),
        ("N", 6000, 0.02, 2.273, GAL),
        ("E", 6000, 0.02, 1.017, GAL),
    ],
}


@pytest.mark.parametrize("name", REAL)
def test_real_files_say_what_their_headers_say(shared_records, name):
    read = read_channels(shared_records / "formats" / name)
    assert not REAL[name] or set(read) == {told[0] for told in REAL[name]}
    for channel, count, dt, peak, unit in REAL[name]:
        digits = len(f"{peak}".split(".")[1])
        assert (len(read[channel]), read[channel].dt) == (count, dt)
        # As exact as the header prints it; RENADIC's own maximum is of a 3-digit sample.
        assert abs(read[channel].pga / unit - peak) <= 0.5000001 * 10.0**-digits


REFUSED = {
    "cosmos_v0c__NP1795.v0c": "line 51: .*raw counts are no acceleration",
    "miniseed__CI.MIKB.HNE.mseed": "miniSEED does not say the unit",
}


def test_every_file_of_formats_is_accounted_for(shared_records):
    found = {path.name for path in (shared_records / "formats").iterdir() if path.is_file()}
    others = {name for name in found if name.startswith(("peer_", "twocol_"))}  # in test_at2.py, test_text.py
    assert found == set(REAL) | set(REFUSED) | others


@pytest.mark.parametrize("name", REFUSED)
def test_files_that_are_refused_say_why(shared_records, name):
    with pytest.raises(RecordError, match=REFUSED[name]):
        read_channels(shared_records / "formats" / name)


def test_bhrc_s_real_file(shared_records):
    """Its header says count and duration; the first value stands alone to be seen."""
    read = read_channels(shared_records / "formats" / "bhrc_iran__5520-1.V1")
    assert [(name, len(motion), motion.dt) for name, motion in read.items()] == [
        ("L1", 15616, 0.005),
        ("V2", 15616, 0.005),
        ("T3", 15616, 0.005),
    ]
    assert read["L1"].acceleration[0] == 0.854257e-3 / 10.0 * G


def obspy_stream(path):
    obspy = pytest.importorskip("obspy", reason="obspy is in the extra miniseed")
    return obspy.read(str(path))


@pytest.mark.filterwarnings("ignore")  # obspy's own
def test_knet_as_obspy_reads_it(shared_records):
    for name in ("knet__AOM0011801241951.EW", "kiknet__AICH040010061330.EW2"):
        path = shared_records / "formats" / name
        trace = obspy_stream(path)[0]
        expected = (trace.data - trace.data.mean()) * trace.stats.calib
        motion = read_record(path)
        assert motion.dt == pytest.approx(trace.stats.delta, rel=1e-15)
        np.testing.assert_allclose(motion.acceleration, expected, rtol=1e-12, atol=1e-15)


@pytest.mark.filterwarnings("ignore")
def test_miniseed_as_obspy_reads_it(shared_records):
    path = shared_records / "formats" / "miniseed__CI.MIKB.HNE.mseed"
    trace = obspy_stream(path)[0]
    motion = read_record(path, units="mm/s2")
    assert motion.acceleration.tolist() == (trace.data / 1000.0).tolist()
    assert (motion.dt, motion.station, motion.component) == (trace.stats.delta, "MIKB", "HNE")


@pytest.mark.filterwarnings("ignore")
def test_miniseed_of_our_own(record_file):
    pytest.importorskip("obspy", reason="obspy is in the extra miniseed")
    path = record_file(samples.miniseed(), "own.mseed")
    motion = read_record(path, units="gal")
    assert motion.acceleration.tolist() == [value / 100.0 for value in samples.VALUES]
    with pytest.raises(RecordError, match=r"own\.mseed: miniSEED does not say the unit"):
        read_record(path)


def test_miniseed_without_obspy_says_what_to_install(record_file, monkeypatch):
    def absent(name):
        raise ImportError(name)

    monkeypatch.setattr("fdspec.records.miniseed.import_module", absent)
    with pytest.raises(RecordError, match=r"miniSEED needs obspy: pip install 'fdspec\[miniseed\]'"):
        read_record(record_file(b"000001D " + bytes(504), "a.mseed"), units="gal")


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("order", ["<", ">"])
def test_sac_of_our_own(record_file, order):
    pytest.importorskip("obspy", reason="obspy is in the extra miniseed")
    path = record_file(samples.sac(order), "own.sac")
    motion = read_record(path, units="cm/s2")
    single = np.array(samples.VALUES, dtype=np.float32).astype(float)
    assert motion.acceleration.tolist() == (single / 100.0).tolist()
    assert (motion.dt, motion.station, motion.component) == (0.01, "MILL", "HNE")
    with pytest.raises(RecordError, match=r"own\.sac: SAC does not say the unit .*: give units"):
        read_record(path)
    with pytest.raises(
        RecordError, match="expected 23 samples, as the header says, but the file ends before"
    ):
        read_record(record_file(samples.sac(order)[:-3], "cut.sac"), units="gal")


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(("code", "quantity"), [(6, "displacement"), (7, "velocity")])
def test_sac_of_another_quantity_is_refused(record_file, code, quantity):
    pytest.importorskip("obspy", reason="obspy is in the extra miniseed")
    with pytest.raises(RecordError, match=f"SAC says that this is {quantity}"):
        read_record(record_file(samples.sac(idep=code), "v.sac"), units="gal")


def test_a_binary_format_is_a_module_and_an_entry(record_file, monkeypatch):
    """Nothing else knows of miniSEED or SAC; a third one needs no more."""
    from fdspec.records import reading
    from fdspec.records.channel import Channel
    from fdspec.records.formats import BINARY_FORMATS, BinaryFormat

    def read(content, name, given):
        return (Channel("Z", np.frombuffer(content[4:], "<f8"), 0.02, "m/s2"),)

    known = BinaryFormat("new", lambda content: content.startswith(b"NEW\0"), read)
    monkeypatch.setattr(reading, "BINARY_FORMATS", (*BINARY_FORMATS, known))
    motion = read_record(record_file(b"NEW\0" + np.array([0.0, 1.0, -3.0]).tobytes(), "a.new"))
    assert (motion.pga, motion.dt, motion.source) == (3.0, 0.02, "a.new (new)")


def asa(rows=23, length="0.23", peak=None):
    """Return the ASA sample with the keys of a network that counts the steps, and perhaps a row more."""
    text, values = SAMPLES["UNAM ASA"]
    lines = text.splitlines()
    last = lines[-1]
    lines += [last] * (rows - 23)
    place = max(range(23), key=lambda k: abs(values[k]))
    top = -values[place] * 100.0 if peak is None else peak
    at = next(k for k, line in enumerate(lines) if line.startswith("NUM. TOTAL"))
    lines[at + 1 : at + 1] = [
        f"DURACION DEL REGISTRO (s), C1-C6       : /{length}/{length}/{length}",
        f"ACEL. MAX.(Gal), C1-C6                 : /{-top:.4f}/{top:.4f}/{0.5 * top:.4f}".replace("--", ""),
        f"ACEL. MAX., C1-C6, EN LA MUESTRA       : /{place + 1}/{place + 1}/{place + 1}",
    ]
    return "\n".join(lines)


def test_a_network_that_counts_steps_has_a_sample_more(record_file):
    motion = read_record(record_file(asa(24), "one_more.101"), channel="N00E")
    assert len(motion) == 24
    assert motion.history == ("on reading, 24 samples were found where the header counts 23: all were taken",)


@pytest.mark.parametrize(
    "text", [asa(25), asa(24, length="0.24"), asa(24, peak=12.3), asa(22 + 2).replace("EN LA", "A LA")]
)
def test_a_row_more_is_refused_when_the_header_does_not_explain_it(record_file, text):
    with pytest.raises(RecordError, match="expected 23 rows, as NUM. TOTAL DE MUESTRAS says"):
        read_channels(record_file(text, "more.101"))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("C1-C6 (s)       :", "C1-C6, (s)      :"),
        ("3F10.4", "3E10.4"),
        ("ARCHIVO ESTANDAR DE ACELERACION", "Archivo Est\u00e1ndar de Aceleraci\u00f3n"),
        ("         V      N00E      N90E", "       V;+     N00E;     N90E;"),
    ],
)
def test_asa_as_other_networks_spell_it(record_file, old, new):
    text, values = SAMPLES["UNAM ASA"]
    assert old in text
    motion = read_record(record_file(text.replace(old, new), "other.dat"), channel="V")
    np.testing.assert_allclose(motion.acceleration, values, rtol=2e-16)


def test_csmip_s_sentence_is_believed_before_a_slot_that_film_leaves_empty(record_file):
    text, values = SAMPLES["CSMIP V2"]
    film = text.replace("  0.010000  0.230000", "  0.000000  0.230000")
    assert film != text
    with pytest.raises(RecordError, match="expected the step of real-header value 53"):
        read_record(record_file(film))
    lines = film.splitlines()
    lines[16] = "At equally-spaced intervals of    .010  sec."
    motion = read_record(record_file("\n".join(lines)))
    assert motion.dt == 0.01
    np.testing.assert_allclose(motion.acceleration, values, rtol=2e-16)


def test_film_at_unequal_steps_is_refused_or_interpolated(record_file):
    text = SAMPLES["CSMIP V1 in pairs"][0].replace("  0.020  0", "  0.027  0")
    path = record_file(text, "film.raw")
    with pytest.raises(
        RecordError, match="expected equal time steps .* to interpolate between them, resample_to"
    ):
        read_record(path)
    plain = read_record(record_file(SAMPLES["CSMIP V1 in pairs"][0], "even.raw"))
    motion = read_record(path, resample_to=0.01)
    assert (motion.n, motion.dt) == (plain.n, 0.01)
    a = plain.acceleration
    assert motion.acceleration[2] == pytest.approx(a[1] + (a[2] - a[1]) * 10.0 / 17.0)
    assert motion.acceleration[3:].tolist() == pytest.approx(a[3:].tolist())
    assert "interpolated from unequal steps" in motion.history[-1]
    with pytest.raises(RecordError, match="resample_to is for unequal steps, and these are equal, 0.01 s"):
        read_record(record_file(SAMPLES["CSMIP V1 in pairs"][0]), resample_to=0.005)
    with pytest.raises(RecordError, match="resample_to must leave 2 to 50000000 samples"):
        read_record(path, resample_to=1e-12)


def test_smc_without_a_title_says_what_it_is_in_a_comment(record_file):
    text, values = SAMPLES["USGS SMC"]
    unknown = text.replace("2 CORRECTED ACCELEROGRAM", "0 UNKNOWN")
    with pytest.raises(
        RecordError, match="the title says UNKNOWN, and no comment that this is an acceleration"
    ):
        read_record(record_file(unknown))
    told = unknown.replace("| made up", "|ACCELERATION TIME HISTORY IN UNITS OF G")
    np.testing.assert_allclose(read_record(record_file(told)).acceleration, values, rtol=2e-16)


def test_names_have_no_runs_of_blanks(record_file):
    text = SAMPLES["CSMIP V1"][0].replace(
        "Chan  1:  90 Deg", "Chan  1:  90 Deg   (Sta Chn: 11)    Location: Roof:   South End        "
    )
    path = record_file(text)
    assert list(read_channels(path)) == ["90 Deg, Roof: South End", "Up"]
    assert read_record(path, channel="90  deg,  ROOF: South End").component == "90 Deg, Roof: South End"


DAMAGED_HEADERS = [
    ("COSMOS V1 or V2", "acceleration pts,", "velocity pts,", "there is no acceleration channel"),
    ("COSMOS V1 or V2", "acceleration pts,", "things,", "expected 'n acceleration pts"),
    ("COSMOS V1 or V2", "      23 acceleration", "       1 acceleration", "expected at least 2 points"),
    ("COSMOS V1 or V2", "on  17 lines", "on  18 lines", "100 values in rows of 6 do not fill 18 lines"),
    (
        "COSMOS V1 or V2",
        "Format= (6F13.6)",
        "Format= none",
        "expected the number of lines and a Fortran format",
    ),
    ("COSMOS V1 or V2", "    10.000000     ", "     0.000000     ", "expected the time step in ms"),
    ("COSMOS V1 or V2", "End-of-data for Chan  1", "Something", "expected the end of data"),
    ("CSMIP V2", "of accel data", "of veloc data", "expected 'n points of accel data equally spaced"),
    ("CSMIP V2", "    23 points of accel", "     1 points of accel", "expected at least 2 points"),
    ("CSMIP V2", "in cm/sec2.", "in furlongs.", "expected acceleration in cm/sec2 or g, found 'furlongs'"),
    (
        "CSMIP V2",
        "at  .010 sec, in cm/sec2",
        "at  .0.1 sec, in cm/sec2",
        "expected the step of real-header value 53",
    ),
    ("CSMIP V2 of 1983", "UNITS: CM/SEC/SEC", "UNITS: FURLONGS", "in cm/sec2 or g, found 'FURLONGS'"),
    ("CSMIP V2", "End of data", "Nothing", "expected the end of data"),
    (
        "CSMIP V1",
        "No. of Points =     23",
        "No. of Points =     22",
        "expected 22 points, as the header says",
    ),
    ("CSMIP V1", "No. of Points =     23", "No. of Points =      1", "expected at least 2 points, found 1"),
    (
        "CSMIP V1",
        "in units of g.",
        "in units of furlongs.",
        "expected units of g or cm/sec2, found 'furlongs'",
    ),
    ("CSMIP V1", "at 100 pts/sec", "at 0 pts/sec", "expected a positive rate and a Fortran format"),
    ("CSMIP V1", "at 100 pts/sec", "at 20 pts/sec", "23 points at 20 a second do not make 0.23 s"),
    ("CSMIP V1", "End of Data", "Nothing", "expected the end of data"),
    ("CSMIP V1 in pairs", "SEC AND G/10", "SEC AND CM", "expected 'UNITS OF UNCOR ACCEL ARE SEC AND G/10'"),
    ("CSMIP V1 in pairs", "  0.020  0", "  0.027  0", "expected equal time steps"),
    (
        "USGS SMC",
        "  1.0000000E+02",
        "  1.7000000E+38",
        "found none: digitised from film, at unequal time steps",
    ),
    ("USGS SMC", "  1.0000000E+02", "  0.0000000E+00", "expected samples a second as real 2, found 0"),
    ("ESM or ITACA ASCII", "UNITS: cm/s^2", "UNITS: cm", "expected UNITS: cm/s.2, found 'cm'"),
    (
        "ESM or ITACA ASCII",
        "NDATA: 23",
        "NDATA: 23.5",
        "expected a whole number of at least 2 behind 'NDATA'",
    ),
    ("K-NET or KiK-net", "2000(gal)/2000000", "2000/2000000", "expected a Scale Factor like"),
    ("GeoNet V1A or V2A", "  0.0200", "  0.0000", "expected the time step as real 26"),
    ("CWB", "AmplitudeUnit:  gal", "AmplitudeUnit:  cm", "expected AmplitudeUnit: gal"),
    ("CWB", "     0.040", "     0.050", "expected the time 0.040 s, found 0.050"),
    ("CWB", "Data: 4F10.3", "Data: 5F10.3", "expected DataSequence"),
    ("NSMN (Turkey)", "VALUES (gal)", "VALUES", "expected RAW PGA VALUES .gal. above"),
    ("NSMN (Turkey)", "       N-S ", "       S-N ", "expected the heading N-S  E-W  U-D"),
    ("UNAM ASA", ": Gal (cm/s/s)", ": cuentas", "expected UNIDADES DE LOS DATOS: Gal, found 'cuentas'"),
    ("UNAM ASA", "/0.01/0.01/0.01", "/0.01/0.02/0.01", "expected one time step and one number of samples"),
    ("UNAM ASA", "3F10.4", "6F10.4", "expected FORMATO DATOS: 3F10.4"),
    ("BHRC (Iran)", "AND G/10", "AND G", "expected 'UNITS ARE SECONDS AND G/10'"),
    ("BHRC (Iran)", "\n/&", "\nand", "expected the end of data"),
    ("columns of fdspec", "Time step: 0.01", "Time step: 0", "expected a positive number behind 'Time step'"),
    ("columns of fdspec", "Time step: 0.01", "Time step: 0.02", "expected equal time steps of about 0.02 s"),
    (
        "columns of fdspec",
        "Scale factor: 0.5",
        "Scale factor: half",
        "expected a number behind 'Scale factor'",
    ),
    (
        "columns of fdspec",
        "Done: scaled",
        "scaled",
        "expected 'Key: value' or 'time, s; acceleration, m/s2', found",
    ),
    ("columns of fdspec", "time, s; accel", "time: accel", "expected 'Key: value' or"),
    ("columns of fdspec", "0.01\t", "0.01 0 ", "expected a time and an acceleration, found '0.01 0 "),
]


@pytest.mark.parametrize(("name", "old", "new", "problem"), DAMAGED_HEADERS)
def test_a_damaged_header_is_refused_with_what_was_expected(record_file, name, old, new, problem):
    text = SAMPLES[name][0]
    assert old in text
    with pytest.raises(RecordError, match=problem):
        read_channels(record_file(text.replace(old, new), "damaged.dat"))


@pytest.mark.filterwarnings("ignore")
def test_miniseed_with_a_gap_is_refused(record_file):
    """Two traces of one channel are no motion."""
    pytest.importorskip("obspy", reason="obspy is in the extra miniseed")
    content = samples.miniseed()
    with pytest.raises(RecordError, match=r"channel XX\.MILL\.\.HNE has a gap or an overlap"):
        read_record(record_file(content + content, "gap.mseed"), units="gal")
