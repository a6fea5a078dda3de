"""The N-storey engine alone (``python -m benchmarks.mdof_scaling``): reference buildings, time against N.

One core, after compilation, 20 s at dt 0.01. Times are those of the thread, so that what else the machine
does costs no more than it must; the smallest of several is shown beside the median.
"""

from __future__ import annotations

import json
import math
import time
from pathlib import Path
from statistics import median

import numpy as np
from numpy.typing import NDArray

from benchmarks.table import seconds, show
from fdspec.kernels.frame.entry import integrate
from fdspec.kernels.frame.output import STOREY_TRACES, TOTAL_TRACES
from fdspec.kernels.frame.results import RADIANS, STOREY_RESULTS, TOTALS
from fdspec.model.building import Building, ModalDamping, RayleighDamping

REFERENCE = Path(__file__).parents[1] / "tests" / "reference" / "mdof_peaks.json"
STOREYS = (2, 4, 8, 16, 24, 40)
ROUNDS = 15

Array = NDArray[np.float64]


def reference_motion() -> Array:
    """The motion of the reference numbers, m/s2, 0.01 s apart."""
    given = json.loads(REFERENCE.read_text(encoding="utf-8"))["motion"]
    t = np.arange(given["n"]) * given["dt"]
    terms = zip(given["f"], given["a"], given["phi"], strict=True)
    x = sum(a * np.sin(2.0 * np.pi * f * t + phi) for f, a, phi in terms)
    x = x * np.where(t < 3.0, (t / 3.0) ** 2, np.where(t < 10.0, 1.0, np.exp(-0.35 * (t - 10.0))))
    return np.asarray(x * given["pga_g"] * given["g"] / np.abs(x).max())


def reference_buildings() -> list[Building]:
    """The five buildings of the reference numbers."""
    return [
        Building(
            given["floor_mass_kg"],
            given["storey_stiffness_n_m"],
            given["brace_mass_kg"],
            given["brace_stiffness_n_m"],
            given["slip_force_n"],
            damping=ModalDamping(given["modal_damping_ratio"]),
        )
        for given in json.loads(REFERENCE.read_text(encoding="utf-8"))["buildings"]
    ]


def tower(storeys: int) -> Building:
    """A uniform building of banded damping, 0.1 s a storey, that slips in every storey."""
    return Building.from_periods(
        [40e3] * storeys,
        bare_period=0.1 * storeys,
        braced_period=0.06 * storeys,
        slip_force=60e3 * np.sqrt(storeys) * np.linspace(1.0, 0.3, storeys),
        brace_mass=50.0,
        damping=RayleighDamping(0.03, 0.1 * storeys, 0.03 * storeys),
    )


def measure(
    building: Building, ground: Array, certify: bool, radians: float = RADIANS
) -> tuple[float, float, int]:
    """Smallest and median thread seconds of a history, and its changes of phase."""
    size = building.n_storeys
    frame = building.frame
    by_storey, totals = np.empty((len(STOREY_RESULTS), size)), np.empty(len(TOTALS))
    none = np.empty(0), np.empty(0, np.int64), np.empty(0, np.int64)
    traces, energies = np.empty((0, len(STOREY_TRACES), size)), np.empty((0, len(TOTAL_TRACES)))
    start = np.zeros((4, size))
    times = []
    for _ in range(ROUNDS):
        begin = time.thread_time()
        integrate(
            *frame,
            ground,
            0.01,
            0,
            certify,
            start,
            radians,
            0,
            *none,
            1.0,
            traces,
            energies,
            by_storey,
            totals,
        )
        times.append(time.thread_time() - begin)
    if totals[TOTALS.index("status")] != 0.0:
        raise RuntimeError(f"{building!r} ended with status {totals[TOTALS.index('status')]:g}")
    return min(times), median(times), int(totals[0])


def main() -> None:
    """Print both tables."""
    ground = reference_motion()
    rows = []
    for building in reference_buildings():
        best, middle, changes = measure(building, ground, certify=False)
        certified, *_ = measure(building, ground, certify=True)
        rows.append(
            (str(building.n_storeys), str(changes), seconds(best), seconds(middle), seconds(certified))
        )
    header = ("storeys", "transitions", "best", "median", "best with energies")
    show("Reference buildings, modal damping", header, rows)
    rows = []
    spent = {}
    for storeys in STOREYS:
        best, middle, changes = measure(tower(storeys), ground, certify=False)
        spent[storeys] = best
        rows.append(
            (str(storeys), str(changes), seconds(best), seconds(middle), f"{1e6 * best / changes:.2f} us")
        )
    show("Towers, banded damping", ("storeys", "transitions", "best", "median", "a transition"), rows)
    power = math.log(spent[40] / spent[2]) / math.log(20.0)
    print(f"\n  from 2 to 40 storeys time grows as N^{power:.2f}")


if __name__ == "__main__":
    main()
