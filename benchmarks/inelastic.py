"""Inelastic spectra beside OpenSees' sdfResponse and gmspy: errors, times of a history and of a spectrum."""

from __future__ import annotations

import math
import tempfile
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import fdspec
from benchmarks import timing
from benchmarks.table import percent, seconds, show
from fdspec.engines.bilinear import Oscillator, bilinear_peaks, elastic_strength

FloatArray = NDArray[np.float64]

OSCILLATOR = Oscillator(0.05, 0.0, math.inf)
"""Elastoplastic, 5 %."""

REDUCTIONS = np.array([1.5, 2.0, 3.0, 4.0, 6.0, 8.0])
DUCTILITY = 4.0
STEPS = (1, 5)
"""Parts of the record's step that sdfResponse takes; 1 is its own default."""
FINER = (1, 5, 20)
"""The same of gmspy, which takes the record's step; finer ones by interpolation."""


def rows() -> None:
    """Print both tables."""
    motion = fdspec.load_record("FMR1")
    periods = np.geomspace(0.1, 3.0, 20)
    strengths = np.array([elastic_strength(OSCILLATOR, period, motion) for period in periods])[:, np.newaxis]
    strengths = strengths / REDUCTIONS
    exact = _exact(motion, periods, strengths)
    ours = timing.best_of(lambda: _exact(motion, periods, strengths)) / exact.size
    alone = timing.best_of(lambda: _exact(motion, periods, strengths, certify=False)) / exact.size
    table = [
        ("fdspec, certified", seconds(ours), "1", "-", "-"),
        ("fdspec, without certificate", seconds(alone), f"{alone / ours:.2g}", "-", "-"),
    ]
    for parts in STEPS:
        found = _sdf_response(motion, periods, strengths, parts)
        if found is None:
            table.append(("OpenSees sdfResponse", "not installed", "", "", ""))
            break
        peaks, spent = found
        who = f"OpenSees sdfResponse, dt {1e3 * motion.dt / parts:g} ms"
        table.append(_row(who, spent, ours, peaks / exact))
    title = f"Elastoplastic oscillator under {motion.name}, {exact.size} histories, one thread"
    show(title, ("who", "a history", "times ours", "median error", "worst error"), table)
    _constant_ductility(motion, periods)


def _row(who: str, spent: float, ours: float, over_exact: FloatArray) -> tuple[str, ...]:
    """A peer's row: its time, how often ours goes into it, and errors of what it gives over the exact."""
    errors = np.abs(over_exact - 1.0)
    worst = percent(float(errors.max()))
    return who, seconds(spent), f"{spent / ours:.2g}", percent(float(np.median(errors))), worst


def _exact(
    motion: fdspec.GroundMotion, periods: FloatArray, strengths: FloatArray, *, certify: bool = True
) -> FloatArray:
    return np.array(
        [
            bilinear_peaks(OSCILLATOR, period, of, motion, certify=certify)[:, 0]
            for period, of in zip(periods, strengths, strict=True)
        ]
    )


def _sdf_response(
    motion: fdspec.GroundMotion, periods: FloatArray, strengths: FloatArray, parts: int
) -> tuple[FloatArray, float] | None:
    """Peak displacements and seconds a history; None where OpenSees is not installed."""
    try:
        import openseespy.opensees as ops
    except ImportError:
        return None
    with tempfile.TemporaryDirectory() as folder:
        force = Path(folder, "force.txt")
        np.savetxt(force, -motion.acceleration)

        def run() -> FloatArray:
            peaks = np.empty(strengths.shape)
            for i, period in enumerate(periods):
                k = (2.0 * math.pi / period) ** 2
                for j, strength in enumerate(strengths[i]):
                    told: Any = ops.sdfResponse(
                        1.0, 0.05, k, float(strength), 1e-9, motion.dt, str(force), motion.dt / parts
                    )
                    peaks[i, j] = told[0]
            return peaks

        return run(), timing.best_of(run, 3) / strengths.size


def _constant_ductility(motion: fdspec.GroundMotion, periods: FloatArray) -> None:
    """Strengths for one ductility, ours with every root and gmspy's by iteration."""

    def ours() -> FloatArray:
        spectra = fdspec.inelastic_spectra(motion, periods, ductility=DUCTILITY, workers=1)
        return np.asarray(spectra.strength.values[0, :, 0])

    exact = ours()
    spent = timing.best_of(ours, 3) / periods.size
    table = [("fdspec, every root", seconds(spent), "1", "-", "-")]
    try:
        from gmspy import const_duct_spec
    except ImportError:
        table.append(("gmspy", "not installed", "", "", ""))
    else:

        def theirs(parts: int) -> FloatArray:
            size = (motion.n - 1) * parts + 1
            fine = np.interp(np.arange(size) / parts, np.arange(motion.n), motion.acceleration)
            found = const_duct_spec(motion.dt / parts, fine, periods, harden_ratio=1e-9, mu=DUCTILITY)
            # Its yield displacement times the stiffness is the strength.
            return np.asarray(found[:, 3]) * (2.0 * math.pi / periods) ** 2

        for parts in FINER:
            found = theirs(parts)
            times = timing.best_of(partial(theirs, parts), 1) / periods.size
            who = f"gmspy const_duct_spec, dt {1e3 * motion.dt / parts:g} ms"
            table.append(_row(who, times, spent, found / exact))
    title = f"Strength for ductility {DUCTILITY:g} under {motion.name}, {periods.size} periods, one thread"
    show(title, ("who", "a period", "times ours", "median error", "worst error"), table)
