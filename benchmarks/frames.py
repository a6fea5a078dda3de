"""OpenSees, by OpenSeesPy: the frame, the brace and a damper between them, Newmark's average acceleration.

Two dampers that its users reach for: `CoulombDamper` (friction made viscous below 1e-6 m/s) and `ElasticPP`
(an elastic spring a thousand times as stiff as the brace, yielding at the slip force).
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from benchmarks.problem import Problem


def run(problem: Problem, damper: str, step: float) -> float | None:
    """Peak absolute acceleration (m/s2), or None when a step did not converge."""
    import openseespy.opensees as ops

    ground, dt = problem.motion
    s = problem.storey
    ops.logFile(os.devnull, "-noEcho")
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    for node, mass in ((1, 0.0), (2, s.floor_mass), (3, s.brace_mass)):
        ops.node(node, 0.0, "-mass", mass)
    ops.fix(1, 1)
    ops.uniaxialMaterial("Elastic", 1, s.floor_stiffness, s.floor_damping)
    ops.uniaxialMaterial("Elastic", 2, s.brace_stiffness)
    if damper == "CoulombDamper":
        ops.uniaxialMaterial("CoulombDamper", 3, 0.0, s.static_force)
    else:
        stiffness = 1e3 * s.brace_stiffness
        ops.uniaxialMaterial("ElasticPP", 3, stiffness, s.static_force / stiffness)
    for element, ends in ((1, (1, 2)), (2, (1, 3)), (3, (3, 2))):
        ops.element("zeroLength", element, *ends, "-mat", element, "-dir", 1, "-doRayleigh", 0)
    ops.timeSeries("Path", 1, "-dt", dt, "-values", *ground.tolist(), "-factor", 1.0)
    ops.pattern("UniformExcitation", 1, 1, "-accel", 1)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "peak.txt"
        ops.recorder(
            "EnvelopeNode",
            "-file",
            str(path),
            "-precision",
            16,
            "-timeSeries",
            1,
            "-node",
            2,
            "-dof",
            1,
            "accel",
        )
        ops.constraints("Plain")
        ops.numberer("Plain")
        ops.system("FullGeneral")
        ops.test("NormUnbalance", 1e-6 * s.static_force, 50, 0)
        ops.algorithm("Newton")
        ops.integrator("Newmark", 0.5, 0.25)
        ops.analysis("Transient")
        failed = ops.analyze(round((len(ground) - 1) * dt / step), step)
        ops.remove("recorders")
        ops.wipe()
        if failed:
            return None
        return float(path.read_text(encoding="utf-8").split()[-1])
