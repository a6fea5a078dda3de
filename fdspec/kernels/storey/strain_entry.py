"""Entry point for the strain energy of single-storey histories; compiled where an index asks for it."""

from __future__ import annotations

import numpy as np
from numba import types

from fdspec.compiler.options import entry, float1d, float2d, given1d, int1d
from fdspec.compiler.records import read
from fdspec.kernels.mathematics.oscillator import TERMS
from fdspec.kernels.storey.energy import N_FORMS
from fdspec.kernels.storey.strain import N_SQUARES, strain_of_history
from fdspec.kernels.types import N_STATE, Storey


@entry(types.int64(float2d, given1d, types.float64, types.float64, int1d, float1d, float2d))
def integrate_strain(storeys, ground, dt, radians, phases, times, results):
    """Integrate the strain energy of storeys (m, 8), rows of `Storey`, each from rest.

    times, phases: room for the changes of phase on one step, of equal size.  Filled: results
    (m, len(STRAIN_RESULTS)).  Returns how many changes the busiest step has: where that is more than
    there is room for, it stopped there and wants to be called again with more.
    """
    no_traces, no_forms = np.empty((0, 0)), np.zeros(N_FORMS)
    squares = np.empty(N_SQUARES)
    start, s = np.empty(N_STATE), np.empty(N_STATE)
    floor, brace, out = np.empty(TERMS), np.empty(TERMS), np.empty(TERMS)
    busiest = 0
    for i in range(storeys.shape[0]):
        found = strain_of_history(
            read(Storey, storeys, i),
            ground,
            dt,
            radians,
            times,
            phases,
            no_traces,
            no_forms,
            squares,
            start,
            s,
            floor,
            brace,
            out,
            results[i],
        )
        busiest = max(busiest, found)
        if busiest > times.size:
            break
    return busiest
