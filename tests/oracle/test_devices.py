"""One storey with devices: the engine of N storeys against matrix exponentials on random cells."""

import json

import numpy as np
import pytest

import fdspec
from tests.oracle.device_events import Storey, integrate
from tests.reference import numbers


def _ground(rng):
    n = int(rng.integers(40, 110))
    dt = float(rng.choice([0.01, 0.02]))
    ground = np.cumsum(rng.normal(size=n))
    ground *= rng.uniform(1.0, 6.0) / np.abs(ground).max()
    ground[0] = 0.0
    return ground, dt


def _cell(rng):
    """Arguments of both programs: floor, brace, forces, and each device in half of the cells."""
    mass = float(rng.uniform(1e4, 4e4))
    period = float(rng.uniform(0.2, 1.0))
    stiffness = mass * (2.0 * np.pi / period) ** 2
    brace = float(rng.uniform(0.5, 8.0)) * stiffness
    slip = float(rng.uniform(0.02, 0.3)) * mass * 9.81
    has = rng.random(5) < 0.5
    return {
        "mass": mass,
        "stiffness": stiffness,
        "damping_ratio": float(rng.choice([0.0, 0.02, 0.05])),
        "brace_mass": float(10.0 ** rng.uniform(1.5, 3.0)),
        "brace": brace,
        "slip": slip,
        "kinetic": slip * float(rng.choice([1.0, 1.0, 0.8])),
        "brace_damping": 0.02 * np.sqrt(brace * 300.0) if has[0] else 0.0,
        "yield_shear": float(rng.uniform(0.05, 0.3)) * mass * 9.81 if has[1] else None,
        "hardening_ratio": float(rng.choice([0.0, 0.05, 0.2])) if has[1] else 0.0,
        "gravity": float(rng.uniform(0.01, 0.15)) * stiffness if has[2] else 0.0,
        "slot_length": float(10.0 ** rng.uniform(-3.0, -1.3)) if has[3] else None,
        "slot_stiffness": float(rng.uniform(0.5, 5.0)) * brace if has[3] else None,
        "recentring": float(rng.uniform(0.05, 0.5)) * brace if has[4] else None,
    }


def _ours(cell, ground, dt):
    height = 3.0
    building = fdspec.Building(
        [cell["mass"]],
        [cell["stiffness"]],
        [cell["brace_mass"]],
        [cell["brace"]],
        [cell["slip"]],
        [cell["kinetic"]],
        damping=fdspec.ModalDamping(cell["damping_ratio"]),
        brace_damping=[cell["brace_damping"]],
        storey_height=[height],
        collapse_drift=[1e6],  # beyond what the motions reach: both go on alike where gravity pulls them over
        yield_shear=None if cell["yield_shear"] is None else [cell["yield_shear"]],
        hardening_ratio=cell["hardening_ratio"],
        gravity_load=[cell["gravity"] * height] if cell["gravity"] else None,
        slot_length=None if cell["slot_length"] is None else [cell["slot_length"]],
        slot_stiffness=None if cell["slot_stiffness"] is None else [cell["slot_stiffness"]],
        recentring_stiffness=None if cell["recentring"] is None else [cell["recentring"]],
    )
    return fdspec.simulate(building, fdspec.GroundMotion(ground, dt, name="random"), dt_out=dt)


def _theirs(cell, ground, dt):
    storey = Storey(
        cell["mass"],
        cell["stiffness"],
        2.0 * cell["damping_ratio"] * np.sqrt(cell["mass"] * cell["stiffness"]),
        cell["brace_mass"],
        cell["brace"],
        cell["slip"],
        cell["kinetic"],
        brace_damping=cell["brace_damping"],
        yield_shear=cell["yield_shear"] or np.inf,
        hardening_ratio=cell["hardening_ratio"],
        gravity=cell["gravity"],
        slot_length=cell["slot_length"] or np.inf,
        slot_stiffness=cell["slot_stiffness"] or 0.0,
        recentring=cell["recentring"] or 0.0,
    )
    return integrate(storey, ground, dt)


def compare(seed):
    rng = np.random.default_rng(seed)
    cell, (ground, dt) = _cell(rng), _ground(rng)
    ours, theirs = _ours(cell, ground, dt), _theirs(cell, ground, dt)
    assert ours.peak_displacement.item() == pytest.approx(theirs.displacement, rel=1e-9), cell
    assert ours.peak_acceleration.item() == pytest.approx(theirs.acceleration, rel=1e-9), cell
    assert ours.transitions.item() == theirs.counts["damper"], cell
    if "peak_slip" in ours:
        assert ours.peak_slip.item() == pytest.approx(theirs.slip, rel=1e-9), cell
    for kind in ("column", "slot"):  # a frame without such devices has no count of their events
        events = int(ours[f"{kind}_events"].sum()) if f"{kind}_events" in ours else 0
        assert events == theirs.counts[kind], cell


@pytest.mark.parametrize("seed", [5, 7, 8, 12])
def test_random_cells(seed):
    compare(seed)


@pytest.mark.slow
@pytest.mark.parametrize("tens", range(4))
def test_forty_random_cells(tens):
    for seed in range(100 + 10 * tens, 110 + 10 * tens):
        compare(seed)


@pytest.mark.slow
def test_the_oracle_gives_the_numbers_made_outside(shared):
    """Two of the single storeys of the reference, one with yielding columns and one with a slot as well."""
    given = json.loads((shared / "reference" / "yielding_peaks.json").read_text(encoding="utf-8"))
    plain, dt = numbers.motion()
    plain = plain * given["motion"]["pga_g"] * given["motion"]["g"] / np.abs(plain).max()
    singles = [case for case in given["cases"] if len(case["frame"]["floor_mass"]) == 1]
    for case in (singles[0], singles[3]):
        frame, answer = case["frame"], case["answer"]
        first = {name: values[0] for name, values in frame.items() if isinstance(values, list)}
        mass, stiffness = first["floor_mass"], first["storey_stiffness"]
        theirs = integrate(
            Storey(
                mass,
                stiffness,
                2.0 * frame["damping_ratio"] * np.sqrt(mass * stiffness),
                first["brace_mass"],
                first["brace_stiffness"],
                first["slip_force"],
                first["kinetic_slip_force"],
                yield_shear=first.get("yield_shear", np.inf),
                hardening_ratio=frame["hardening_ratio"],
                gravity=first.get("gravity_load", 0.0) / first["storey_height"],
                slot_length=first.get("slot_length", np.inf),
                slot_stiffness=first.get("slot_stiffness", 0.0),
            ),
            plain,
            dt,
        )
        assert theirs.counts == answer["events"]
        assert theirs.acceleration == pytest.approx(answer["peak_acceleration"][0], rel=1e-10)
        assert theirs.slip == pytest.approx(answer["peak_slip"][0], rel=1e-10)
