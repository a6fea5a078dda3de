"""Run the comparison, all of its parts unless some are named: ``python -m benchmarks [PART ...]``."""

from __future__ import annotations

import argparse
import os
import platform
from collections.abc import Callable, Sequence
from importlib.metadata import PackageNotFoundError, version
from statistics import median

import numpy as np

import fdspec
from benchmarks import (
    elastic,
    fixed_step,
    frames,
    general,
    inelastic,
    page,
    side_by_side,
    start,
    study,
    timing,
)
from benchmarks.problem import SLIPPING_ELEVEN, STUDY_ELEVEN, Problem, answer, slipping_cells
from benchmarks.table import percent, seconds, show

PEERS = ("numba", "numpy", "scipy", "dask", "openseespy", "pyrotd", "eqsig", "sdof", "gmspy")
WITHIN = 1e-3
CALLS = 5
"""Sweeps of ours in each turn beside a peer's one history, so that what a turn begins with does not count."""
OPENSEES = {"CoulombDamper": (5e-3, 1e-3, 1e-4), "ElasticPP": (1e-3, 1e-4)}
"""Dampers and steps, s."""


def print_versions() -> None:
    """Say what was measured where."""
    python = f"Python {platform.python_version()} on {os.cpu_count()} cores"
    found = [python, f"load {os.getloadavg()[0]:.1f}", f"fdspec {fdspec.__version__}"]
    for name in PEERS:
        try:
            found.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            found.append(f"{name} (not installed)")
    print(", ".join(found))


def many(problem: Problem, forces: Sequence[float] = STUDY_ELEVEN) -> tuple[Callable[[], object], int]:
    """A sweep of the problem's neighbourhood on one thread, these slip forces at once, and its histories."""
    periods = problem.period * np.linspace(0.99, 1.01, 91)
    motion = problem.ground_motion

    def run() -> object:
        return fdspec.sweep(
            motion,
            period=periods,
            stiffness_ratio=[problem.stiffness_ratio],
            pretension=forces,
            friction_coefficient=1.0,
            certify=False,
            workers=1,
        )

    return run, len(periods) * len(forces)


def one_history() -> None:
    """One slipping history by everybody."""
    problem = Problem()
    exact = answer(problem)
    run, count = many(problem)
    building, motion = problem.building, problem.ground_motion
    peak = float(fdspec.simulate(building, motion).peak_acceleration[0])
    rows = []

    def add(name: str, time: float, ratio: float | None, error: float | None, count: int | None) -> None:
        rows.append(
            (
                name,
                seconds(time),
                "1" if ratio is None else f"{ratio:,.3g}" if ratio < 100.0 else f"{ratio:,.0f}",
                "failed" if error is None else percent(error),
                "" if count is None else str(count),
            )
        )

    each = timing.best_of(run) / count
    error = peak / exact.peak_acceleration - 1.0
    add("fdspec sweep, the study's eleven slip forces at once", each, None, error, len(exact.transitions))
    slipping, slips = many(problem, SLIPPING_ELEVEN)
    _, theirs, ratio = timing.pairs(run, slipping)
    add("fdspec sweep, eleven that all slip", theirs / slips, ratio * count / slips, error, None)
    single = timing.best_of(lambda: fdspec.simulate(building, motion))
    add("fdspec simulate, with its time series", single, single / each, error, len(exact.transitions))
    for step in (1e-4, 1e-5, 1e-6):
        a, _, changes = fixed_step.run(problem, step)
        _, theirs, ratio = timing.pairs(run, lambda step=step: fixed_step.run(problem, step), calls=CALLS)
        add(
            f"fixed step {step:g} s (the study's scheme)",
            theirs,
            ratio * count,
            a / exact.peak_acceleration - 1.0,
            changes,
        )
    for damper, steps in OPENSEES.items():
        reached = False
        for step in steps:
            found = frames.run(problem, damper, step)
            wrong = None if found is None else found / exact.peak_acceleration - 1.0
            _, theirs, ratio = timing.pairs(run, lambda d=damper, h=step: frames.run(problem, d, h), 3, CALLS)
            within = wrong is not None and abs(wrong) <= WITHIN
            mark = " <- 0.1 %" if within and not reached else ""
            reached |= within
            add(f"OpenSees {damper}, step {step:g} s{mark}", theirs, ratio * count, wrong, None)
    a, changes = general.run(problem)
    _, theirs, ratio = timing.pairs(run, lambda: general.run(problem), 3, CALLS)
    add(
        "scipy solve_ivp DOP853 with events, rtol 1e-8",
        theirs,
        ratio * count,
        a / exact.peak_acceleration - 1.0,
        changes,
    )
    show(
        "One history (T 0.5 s, SR 4, slip force 100 kN, 2001 samples), one core",
        ("who", "time", "times ours", "peak acceleration off by", "transitions"),
        rows,
    )


def failures() -> None:
    """Twelve slipping histories: who leaves some of them, and how wrong the others are."""
    problems = slipping_cells()
    exact = [answer(problem).peak_acceleration for problem in problems]
    rows = []

    def add(name: str, run: Callable[[Problem], float | None]) -> None:
        times: list[float] = []
        errors: list[float] = []
        for problem, peak in zip(problems, exact, strict=True):
            found: list[float | None] = []
            times.append(timing.once(lambda p=problem, found=found: found.append(run(p))))
            if found[0] is not None:
                errors.append(abs(found[0] / peak - 1.0))
        failed = f"{len(problems) - len(errors)} of {len(problems)}"
        rows.append(
            (
                name,
                seconds(median(times)),
                failed,
                percent(max(errors, default=np.nan)),
            )
        )

    add("fdspec simulate", lambda p: float(fdspec.simulate(p.building, p.ground_motion).peak_acceleration[0]))
    add("fixed step 1e-5 s", lambda p: fixed_step.run(p, 1e-5)[0])
    for damper, steps in OPENSEES.items():
        for step in steps:
            add(f"OpenSees {damper}, step {step:g} s", lambda p, d=damper, h=step: frames.run(p, d, h))
    show("Twelve histories that slip", ("who", "median time", "failed", "worst peak acceleration"), rows)


def ordinate() -> None:
    """The price of an elastic ordinate beside a stick-slip one."""
    problem = Problem()
    ground, dt = problem.motion
    run, count = many(problem)
    exact = elastic.sampled_ordinates(problem)
    each = timing.best_of(run) / count
    rows = [("fdspec, stick-slip, the study's eleven slip forces", seconds(each), "1", "")]
    for name, peer in elastic.PEERS.items():
        wrong = float(np.max(np.abs(peer(ground, dt) / exact - 1.0)))
        _, theirs, ratio = timing.pairs(run, lambda peer=peer: peer(ground, dt))
        size = len(elastic.PERIODS)
        rows.append(
            (f"{name}, elastic", seconds(theirs / size), f"{ratio * count / size:.2f}", percent(wrong))
        )
    size = elastic.recurrence(problem)
    _, bare, ratio = timing.pairs(run, lambda: elastic.recurrence(problem))
    rows.append(
        ("bare recurrence, elastic, 64 lanes", seconds(bare / size), f"{ratio * count / size:.3f}", "")
    )
    show(
        "One ordinate, 2001 samples, one core; elastic ones over periods 0.05 to 3 s",
        ("who", "time", "times ours", "worst error"),
        rows,
    )


def whole_study() -> None:
    """41 580 histories."""
    motions = study.records()
    histories = len(motions) * int(np.prod([len(axis) for axis in study.AXES.values()]))
    rows = []
    ones: dict[bool, float] = {}
    for certify in (False, True):
        one, two, ratio = timing.pairs(
            lambda c=certify: study.sweep(motions, workers=1, certify=c),
            lambda c=certify: study.sweep(motions, workers=2, certify=c),
            rounds=3,
        )
        ones[certify] = one
        name = "with the energy certificate" if certify else "without certificate"
        rows.append((f"sweep {name}, one thread", seconds(one), seconds(one / histories), ""))
        rows.append((f"sweep {name}, two threads", seconds(two), "", f"efficiency {0.5 / ratio:.2f}"))
    total, sampled = study.fixed_step_core_seconds(motions)
    note = f"{total / ones[False]:,.0f} times ours (extrapolated from {sampled} histories)"
    rows.append(("fixed step 1e-6 s, one core", f"{total / 3600:.1f} h", seconds(total / histories), note))
    show(f"The study: {histories} histories on nine records", ("what", "wall time", "a history", ""), rows)


def scaling() -> None:
    """Time against what there is more of."""
    motions = study.records()
    rows = []
    for count in (10, 30, 100, 300):
        periods = np.linspace(0.05, 3.0, count)
        wall = timing.best_of(
            lambda p=periods: study.sweep(motions[:1], workers=1, certify=False, period=p), 3
        )
        rows.append((f"{count} periods", seconds(wall), f"{seconds(wall / count / 77)} a history"))
    for count in (1, 3, 9):
        wall = timing.best_of(lambda n=count: study.sweep(motions[:n], workers=1, certify=False), 3)
        samples = sum(motion.n for motion in motions[:count])
        rows.append(
            (f"{count} records", seconds(wall), f"{seconds(wall / samples / 4620)} a sample and history")
        )
    for count in (1, 2):
        wall = timing.best_of(lambda n=count: study.sweep(motions, workers=n, certify=False), 3)
        rows.append((f"{count} threads", seconds(wall), ""))
    problem = Problem(strength=1.0)
    times = {}
    for storeys in (2, 5, 10, 20, 40):
        building = fdspec.Building.from_periods(
            [40e3] * storeys, 0.1 * storeys, 0.06 * storeys, slip_force=50e3, brace_mass=50.0
        )
        history = fdspec.simulate(building, problem.ground_motion)
        changes = int(history.transitions)
        times[storeys] = timing.best_of(lambda b=building: fdspec.simulate(b, problem.ground_motion), 3)
        rows.append((f"{storeys} storeys", seconds(times[storeys]), f"{changes} transitions"))
    power = np.log(times[40] / times[2]) / np.log(20.0)
    rows.append(("2 to 40 storeys", "", f"time grows as N^{power:.2f}"))
    show("Scaling (one thread unless said)", ("what", "wall time", ""), rows)


def starting() -> None:
    """Processes of their own."""
    rows = [(what, seconds(time), f"{rounds} runs") for what, rounds, time in start.rows()]
    show("From the shell", ("what", "wall time", "median of"), rows)


def browsing() -> None:
    """The page of fdspec explore in Chromium."""
    rows = [(what, seconds(time), f"{rounds} runs") for what, rounds, time in page.rows()]
    show("In the browser, 41 580 cells", ("what", "wall time", "median of"), rows)


PARTS: dict[str, tuple[Callable[[], None], ...]] = {
    "history": (one_history, failures),
    "ordinate": (ordinate,),
    "study": (whole_study,),
    "storeys": (side_by_side.sweeps, side_by_side.peers),
    "inelastic": (inelastic.rows,),
    "scaling": (scaling,),
    "start": (starting,),
    "page": (browsing,),
}


def main() -> None:
    """Print the tables asked for."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument(
        "parts", nargs="*", choices=[*PARTS, []], default=[], metavar="PART", help=", ".join(PARTS)
    )
    chosen = parser.parse_args().parts or list(PARTS)
    print_versions()
    for part in chosen:
        for run in PARTS[part]:
            run()


if __name__ == "__main__":
    main()
