"""A building and a ground motion as an OpenSeesPy script that runs by itself."""

from __future__ import annotations

from typing import Final

import numpy as np

from fdspec.errors import InvalidInput
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.version import __version__

ONE_LINE: Final = 8
"""Numbers in a line of the script."""


def opensees_script(building: Building, motion: GroundMotion, *, name: str = "building") -> str:
    """Write a script of OpenSeesPy that computes the same history.

    Parameters
    ----------
    building : Building
        Without devices beside its friction dampers, kinetic friction as large as static.
    motion : GroundMotion
        Its samples stand in the script.
    name : str
        What the script calls the building.

    Returns
    -------
    str
        Python. Run, it prints peaks of the floors as JSON, SI units; ``--step S`` sets its time step.

    Raises
    ------
    InvalidInput
        For a building that these elements of OpenSees do not describe.

    Notes
    -----
    Time goes on by TR-BDF2 (Bank and others 1985): average acceleration leaves the stiff sliders ringing.
    OpenSees has no rigid plastic slider: a stuck damper is a spring, `LOCK` times as stiff as its brace, so
    that results go to fdspec's with the step and with 1 / LOCK.
    """
    if building.has_devices:
        raise InvalidInput(
            "the script holds frame, braces and friction; this building has columns that yield, gravity, "
            "slots, springs or links beside them, or several frames"
        )
    braced = building.brace_stiffness > 0.0
    if (building.kinetic_slip_force != building.slip_force)[braced].any():
        raise InvalidInput("OpenSees' sliders have one friction: kinetic_slip_force must equal slip_force")
    if ((building.brace_damping > 0.0) & (building.brace_mass == 0.0) & braced).any():
        raise InvalidInput("a dashpot beside a massless brace has no like in the script: give brace_mass")
    told = {
        "FLOOR_MASS": building.floor_mass,
        "FRAME_STIFFNESS": building.stiffness_matrix,
        "FRAME_DAMPING": building.damping_matrix,
        "BRACE_MASS": np.where(braced, building.brace_mass, 0.0),
        "BRACE_STIFFNESS": building.brace_stiffness,
        "BRACE_DAMPING": building.brace_damping,
        "SLIP_FORCE": building.slip_force,
    }
    lines = [f"{key} = {_text(values)}" for key, values in told.items()]
    about = f"{name} under {motion.name or 'a ground motion'}".replace("\\", "/").replace('"', "'")
    about = " ".join(about.split())
    return (
        SCRIPT.replace("@about@", about)
        .replace("@version@", __version__)
        .replace("@building@", "\n".join(lines))
        .replace("@dt@", repr(motion.dt))
        .replace("@ground@", _lines(motion.acceleration))
    )


def _text(values: np.ndarray) -> str:
    if values.ndim == 2:
        return "[\n" + "".join(f"    {_text(row)},\n" for row in values) + "]"
    return "[" + ", ".join(_number(value) for value in values.tolist()) + "]"


def _number(value: float) -> str:
    return "INFINITE" if value == float("inf") else repr(value)


def _lines(values: np.ndarray) -> str:
    numbers = [repr(value) for value in values.tolist()]
    rows = [", ".join(numbers[k : k + ONE_LINE]) for k in range(0, len(numbers), ONE_LINE)]
    return "[\n" + "".join(f"    {row},\n" for row in rows) + "]"


SCRIPT: Final = '''"""@about@, written by fdspec @version@.  SI units.

    python THIS_FILE.py [--step S]        needs openseespy

Prints the peaks of each floor, from the ground up, as JSON.
"""

import argparse
import json

import openseespy.opensees as ops

INFINITE = float("inf")
@building@

DT = @dt@  # s, between samples of the ground acceleration, m/s2, which is linear between them
GROUND = @ground@

LOCK = 1e3
"""Stiffness of a stuck damper over that of its brace."""

STORIES = range(1, len(FLOOR_MASS) + 1)
GROUND_NODE = 0
tags = iter(range(1, 10**9))


def spring(lower, upper, stiffness, damping=0.0):
    """Join two nodes by a spring and a dashpot."""
    tag = next(tags)
    ops.uniaxialMaterial("Elastic", tag, stiffness, damping)
    ops.element("zeroLength", tag, lower, upper, "-mat", tag, "-dir", 1)


def slider(lower, upper, stiffness, force):
    """Join two nodes by a spring that slips at a force."""
    if force == INFINITE:
        spring(lower, upper, stiffness)
    elif force > 0.0:
        tag = next(tags)
        ops.uniaxialMaterial("ElasticPP", tag, stiffness, force / stiffness)
        ops.element("zeroLength", tag, lower, upper, "-mat", tag, "-dir", 1)


def frame(stiffness, damping):
    """Join floors, and floors to the ground, so that these matrices come out."""
    n = len(stiffness)
    for i in range(n):
        to_ground = sum(stiffness[i]), sum(damping[i])
        if max(abs(to_ground[0]) / stiffness[i][i], abs(to_ground[1]) / (damping[i][i] or 1.0)) > 1e-12:
            spring(GROUND_NODE, i + 1, *to_ground)
        for j in range(i):
            if stiffness[i][j] or damping[i][j]:
                spring(j + 1, i + 1, -stiffness[i][j], -damping[i][j])


def brace_node(storey):
    """The node of a brace that has mass."""
    return len(FLOOR_MASS) + storey


def build():
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    ops.node(GROUND_NODE, 0.0)
    ops.fix(GROUND_NODE, 1)
    for storey, mass in zip(STORIES, FLOOR_MASS):
        ops.node(storey, 0.0)
        ops.mass(storey, mass)
    frame(FRAME_STIFFNESS, FRAME_DAMPING)
    for storey in STORIES:
        mass, stiffness = BRACE_MASS[storey - 1], BRACE_STIFFNESS[storey - 1]
        force = SLIP_FORCE[storey - 1]
        if stiffness == 0.0:
            continue
        if mass == 0.0:
            slider(storey - 1, storey, stiffness, force)
            continue
        ops.node(brace_node(storey), 0.0)
        ops.mass(brace_node(storey), mass)
        spring(storey - 1, brace_node(storey), stiffness, BRACE_DAMPING[storey - 1])
        slider(brace_node(storey), storey, LOCK * stiffness, force)
    ops.timeSeries("Path", 1, "-dt", DT, "-values", *GROUND)
    ops.pattern("UniformExcitation", 1, 1, "-accel", 1)
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.test("NormUnbalance", 1e-8 * sum(FLOOR_MASS), 100)
    ops.algorithm("Newton")
    ops.integrator("TRBDF2")
    ops.analysis("Transient")


def advance(step, halvings=20):
    """Take one step; in halves where sliders change so often that Newton's method goes round in circles."""
    if ops.analyze(1, step) == 0:
        return
    if not halvings:
        raise SystemExit(f"OpenSees did not converge at {ops.getTime():g} s")
    advance(step / 2, halvings - 1)
    advance(step / 2, halvings - 1)


def run(step):
    """Return the peaks, a list for each, one number a floor."""
    build()
    parts = max(1, round(DT / step))
    names = ("peak_acceleration", "peak_displacement", "peak_drift")
    peak = {name: [0.0] * len(FLOOR_MASS) for name in names}
    peak["peak_acceleration"] = [abs(GROUND[0])] * len(FLOOR_MASS)
    for k in range(len(GROUND) - 1):
        for part in range(1, parts + 1):
            advance(DT / parts)
            ground = GROUND[k] + (GROUND[k + 1] - GROUND[k]) * part / parts
            below = 0.0
            for i, storey in enumerate(STORIES):
                u = ops.nodeDisp(storey, 1)
                now = ops.nodeAccel(storey, 1) + ground, u, u - below
                for name, value in zip(names, now):
                    peak[name][i] = max(peak[name][i], abs(value))
                below = u
    return peak


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--step", type=float, default=DT / 100, help="s")
    print(json.dumps(run(parser.parse_args().step)))
'''
