"""Frames of N storeys, many side by side, beside one at a time, OpenSees and the study's scheme.

``python -m benchmarks storeys``; one core.  Times are those of the thread and of the same run, in turns.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

import numpy as np

import fdspec
from benchmarks.mdof_scaling import Array, reference_buildings, reference_motion, tower
from benchmarks.table import percent, seconds, show
from fdspec.engines.frames import peaks_of_frames
from fdspec.engines.many_storeys import peaks_of
from fdspec.kernels.frame.model import KINETIC_SLIP_FORCE, SLIP_FORCE
from fdspec.model.building import Building, Frame

HISTORIES = 64
ROUNDS = 5
WITHIN = 2e-3
OPENSEES_STEPS = (2e-3, 1e-3, 5e-4, 2e-4, 1e-4)
STUDY_STEPS = (1e-4, 1e-5)


def spent(run: Callable[[], object]) -> float:
    """Seconds of this thread."""
    start = time.thread_time()
    run()
    return time.thread_time() - start


def scaled(building: Building) -> list[Frame]:
    """The building under as many factors on its slip forces, from a half to one and a half."""
    frames = []
    for scale in np.linspace(0.5, 1.5, HISTORIES):
        properties = building.frame.properties.copy()
        properties[[SLIP_FORCE, KINETIC_SLIP_FORCE]] *= scale
        frames.append(building.frame._replace(properties=properties))
    return frames


def modal_tower(storeys: int) -> Building:
    """The tower of `mdof_scaling` with modal damping: its matrix is full."""
    b = tower(storeys)
    return Building(
        b.floor_mass,
        b.storey_stiffness,
        b.brace_mass,
        b.brace_stiffness,
        b.slip_force,
        damping=fdspec.ModalDamping(0.03),
    )


def sweeps() -> None:
    """A history among many, and the same one at a time."""
    motion = fdspec.GroundMotion(reference_motion(), 0.01, name="reference")
    four, _, two, *_, eight = reference_buildings()
    rows = []
    for name, building in (
        ("2 storeys, reference", two),
        ("4 storeys, reference", four),
        ("8 storeys, reference", eight),
        ("20 storeys, modal damping", modal_tower(20)),
        ("20 storeys, banded damping", tower(20)),
    ):
        frames = scaled(building)
        _, totals = peaks_of_frames(frames, motion, certify=True)
        some = frames[:: HISTORIES // 4]
        certified, plain, alone = [], [], []
        for _ in range(ROUNDS):
            certified.append(spent(lambda f=frames: peaks_of_frames(f, motion, certify=True)) / HISTORIES)
            plain.append(spent(lambda f=frames: peaks_of_frames(f, motion, certify=False)) / HISTORIES)
            alone.append(spent(lambda f=some: [peaks_of(one, motion, certify=True) for one in f]) / len(some))
        changes = totals[:, 0].mean()
        rows.append(
            (
                name,
                f"{changes:.0f}",
                seconds(median(certified)),
                seconds(min(certified)),
                seconds(median(plain)),
                seconds(median(certified) / changes),
                seconds(median(alone)),
                f"{median(a / c for a, c in zip(alone, certified, strict=True)):.1f}",
            )
        )
    header = (
        f"{HISTORIES} histories, certified",
        "changes",
        "a history",
        "best",
        "plain",
        "a change",
        "one at a time",
        "ratio",
    )
    show("N storeys side by side, one core", header, rows)


def stiffness_damped() -> Building:
    """The reference frame of four storeys with damping in its columns, which OpenSees can have as well."""
    b = reference_buildings()[0]
    omega = 2.0 * np.pi / b.bare_periods[0]
    return Building(
        b.floor_mass,
        b.storey_stiffness,
        b.brace_mass,
        b.brace_stiffness,
        b.slip_force,
        damping=fdspec.DampingMatrix(2.0 * 0.02 / omega * b.stiffness_matrix),
    )


def opensees(building: Building, ground: Array, dt: float, step: float) -> float | None:
    """Peak absolute acceleration of the top floor (m/s2), or None where a step did not converge.

    Dampers are ElasticPP, a thousand times as stiff as the braces.
    """
    import openseespy.opensees as ops

    size = building.n_storeys
    ops.logFile(os.devnull, "-noEcho")
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    ops.node(0, 0.0)
    ops.fix(0, 1)
    damping = building.damping_matrix[0, 0] / building.stiffness_matrix[0, 0]
    for i in range(size):
        floor, brace, below = i + 1, 100 + i, i
        ops.node(floor, 0.0, "-mass", float(building.floor_mass[i]))
        ops.node(brace, 0.0, "-mass", float(building.brace_mass[i]))
        k, k_d = float(building.storey_stiffness[i]), float(building.brace_stiffness[i])
        ops.uniaxialMaterial("Elastic", 10 * i + 1, k, damping * k)
        ops.uniaxialMaterial("Elastic", 10 * i + 2, k_d)
        ops.uniaxialMaterial("ElasticPP", 10 * i + 3, 1e3 * k_d, float(building.slip_force[i]) / (1e3 * k_d))
        for material, ends in ((1, (below, floor)), (2, (below, brace)), (3, (brace, floor))):
            ops.element(
                "zeroLength", 10 * i + material, *ends, "-mat", 10 * i + material, "-dir", 1, "-doRayleigh", 0
            )
    ops.timeSeries("Path", 1, "-dt", dt, "-values", *ground.tolist(), "-factor", 1.0)
    ops.pattern("UniformExcitation", 1, 1, "-accel", 1)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "peak.txt"
        what = ("-precision", 16, "-timeSeries", 1, "-node", size, "-dof", 1, "accel")
        ops.recorder("EnvelopeNode", "-file", str(path), *what)
        ops.constraints("Plain")
        ops.numberer("RCM")
        ops.system("BandGeneral")
        ops.test("NormUnbalance", 1e-6 * float(building.slip_force.max()), 50, 0)
        ops.algorithm("Newton")
        ops.integrator("Newmark", 0.5, 0.25)
        ops.analysis("Transient")
        failed = ops.analyze(round((len(ground) - 1) * dt / step), step)
        ops.remove("recorders")
        ops.wipe()
        return None if failed else float(path.read_text(encoding="utf-8").split()[-1])


def peers() -> None:
    """The frame of four storeys by everybody."""
    building = stiffness_damped()
    ground = reference_motion()
    motion = fdspec.GroundMotion(ground, 0.01, name="reference")
    frames = scaled(building)
    by_storey, totals = peaks_of_frames([building.frame], motion, certify=True)
    exact = by_storey[0, 0, -1]
    peaks_of_frames(frames, motion, certify=True)
    ours = median(
        spent(lambda: peaks_of_frames(frames, motion, certify=True)) / HISTORIES for _ in range(ROUNDS)
    )
    rows = [("fdspec, 64 slip forces side by side, certified", seconds(ours), "1", "rounding")]

    def add(name: str, took: float, peak: float | None) -> None:
        wrong = "failed" if peak is None else percent(peak / exact - 1.0)
        rows.append((name, seconds(took), f"{took / ours:,.0f}", wrong))

    peaks_of(building.frame, motion, certify=True)
    alone = median(spent(lambda: peaks_of(building.frame, motion, certify=True)) for _ in range(ROUNDS))
    add("fdspec, one at a time, certified", alone, exact)
    for step in OPENSEES_STEPS:
        found: list[float | None] = []
        took = spent(lambda h=step, f=found: f.append(opensees(building, ground, 0.01, h)))
        close = found[0] is not None and abs(found[0] / exact - 1.0) <= WITHIN
        add(f"OpenSees ElasticPP, step {step:g} s{' <- 0.2 %' if close else ''}", took, found[0])
    for step in STUDY_STEPS:
        told: list[float] = []
        method = fdspec.methods.Newmark(dt=step)

        def scheme(method: fdspec.methods.Newmark = method, told: list[float] = told) -> None:
            history = fdspec.simulate(building, motion, method=method)
            told.append(float(history.peak_acceleration[-1]))

        add(f"the study's scheme, step {step:g} s", spent(scheme), told[0])
    title = f"Four storeys, {totals[0, 0]:.0f} changes of phase, peak acceleration of the top floor"
    show(title, ("who", "time a history", "times ours", "off by"), rows)
