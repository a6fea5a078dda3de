"""Elastic spectra of the nine records at 100 periods, with peers: ``python -m benchmarks.spectra``."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from benchmarks.table import show
from benchmarks.timing import best_of
from fdspec.model.motion import GroundMotion
from fdspec.records import catalogue, load_record
from fdspec.signals.spectra import elastic_spectra

PERIODS = np.linspace(0.05, 5.0, 100)
ZETA = 0.05


def fdspec_spectra(motions: Sequence[GroundMotion]) -> np.ndarray:
    """Exact peaks of the continuous motion: displacement and absolute acceleration; one thread."""
    return elastic_spectra(motions, PERIODS, ZETA).spectral_displacement.values[:, 0]


def pyrotd_spectra(motions: Sequence[GroundMotion]) -> np.ndarray:
    """Frequency domain, in this process."""
    import pyrotd

    pyrotd.processes = 1
    frequencies = 1.0 / PERIODS
    found = [pyrotd.calc_spec_accels(m.dt, m.acceleration, frequencies, ZETA).spec_accel for m in motions]
    return np.array(found) / (2.0 * np.pi / PERIODS) ** 2


def eqsig_spectra(motions: Sequence[GroundMotion]) -> np.ndarray:
    """Nigam and Jennings at the samples, in numpy."""
    from eqsig import sdof

    return np.array([sdof.pseudo_response_spectra(m.acceleration, m.dt, PERIODS, ZETA)[0] for m in motions])


def sdof_spectra(motions: Sequence[GroundMotion], threads: int) -> np.ndarray:
    """Newmark in C at the record's step, on threads of its own."""
    import sdof

    found = []
    for motion in motions:
        ground = motion.acceleration.copy()  # it takes no read-only array
        found.append(sdof.spectrum(ground, motion.dt, ZETA, periods=PERIODS, threads=threads)[0][1])
    return np.array(found)


PEERS: dict[str, Callable[[Sequence[GroundMotion]], np.ndarray]] = {
    "fdspec": fdspec_spectra,
    "pyrotd": pyrotd_spectra,
    "eqsig": eqsig_spectra,
    "sdof, 1 thread": lambda motions: sdof_spectra(motions, 1),
    "sdof, 2 threads": lambda motions: sdof_spectra(motions, 2),
}


def main() -> None:
    """Measure all in one run and show them side by side."""
    motions = [load_record(entry.name) for entry in catalogue()]
    exact = fdspec_spectra(motions)
    rows = []
    for name, run in PEERS.items():
        wall = best_of(lambda run=run: run(motions))
        error = np.abs(run(motions) / exact - 1.0)
        rows.append((name, wall, float(np.median(error)), float(error.max())))
    ours = rows[0][1]
    show(
        f"elastic spectra, {len(PERIODS)} periods x {len(motions)} records",
        ("who", "ms", "of ours", "median error", "largest error"),
        [
            (name, f"{wall * 1e3:.1f}", f"{wall / ours:.1f}", f"{middle:.1e}", f"{worst:.1e}")
            for name, wall, middle, worst in rows
        ],
    )


if __name__ == "__main__":
    main()
