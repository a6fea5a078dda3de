"""Energy: what the ground puts in is kinetic, elastic, viscous or friction, each by its own formula."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fdspec.model.building import Building
from fdspec.records import load_record
from fdspec.runs.simulate import simulate
from fdspec.runs.sweep import sweep
from fdspec.validation import four_storey
from fdspec.verification.problems import shaking
from fdspec.verification.row import Row, at_most, relative

WITHIN = 1e-9


def rows(full: bool) -> Iterator[Row]:
    """Yield the rows of this family."""
    motions = [load_record(name) for name in (("FSR1", "FMR2", "FHR3") if full else ("FSR1",))]
    grid = {
        "period": np.linspace(0.05, 3.0, 60 if full else 12),
        "stiffness_ratio": [0.5, 1.0, 2.0, 4.0, 6.0, 8.0, 10.0],
        "pretension": 10e3 + 100e3 * np.arange(11),
    }
    cube = sweep(motions, **grid)  # type: ignore[arg-type]
    case = f"energy balance of {cube['energy_error'].size} histories"
    yield at_most(case, "worst error over input", float(cube["energy_error"].max()), WITHIN)
    yield at_most(case, "histories that did not end well", float((cube["status"] != 0).sum()), 0.0)
    motion = shaking(20.0)
    for kinetic in (1.0, 0.8):
        given = four_storey.building()
        building = Building(
            given.floor_mass,
            given.storey_stiffness,
            given.brace_mass,
            given.brace_stiffness,
            given.slip_force,
            kinetic * given.slip_force,
            given.damping,
        )
        history = simulate(building, motion)
        case = f"energy balance, four storeys, kinetic friction {kinetic:g} of static"
        yield at_most(case, "error over input", float(history["energy_error"]), WITHIN)
        work = float((building.kinetic_slip_force * history["slip_travel"][-1].values).sum())
        quantity = "friction, kinetic force times travel, J"
        yield relative(case, quantity, work, float(history["dissipated_energy"]), WITHIN)
