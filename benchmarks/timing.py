"""Medians of interleaved runs: what else the machine does meets both sides alike."""

from __future__ import annotations

import time
from collections.abc import Callable
from statistics import median
from typing import Any


def once(run: Callable[[], Any]) -> float:
    """Wall seconds of one call."""
    start = time.perf_counter()
    run()
    return time.perf_counter() - start


def best_of(run: Callable[[], Any], rounds: int = 5) -> float:
    """Median wall seconds of ``rounds`` calls after one that is thrown away."""
    run()
    return median(once(run) for _ in range(rounds))


def pairs(
    one: Callable[[], Any], other: Callable[[], Any], rounds: int = 5, calls: int = 1
) -> tuple[float, float, float]:
    """Median seconds of a call of each and median ratio other/one, run in turns.

    ``calls``: calls of ``one`` in each turn, where it is much the faster.
    """
    one()
    firsts, seconds = [], []
    for _ in range(rounds):
        firsts.append(once(lambda: [one() for _ in range(calls)]) / calls)
        seconds.append(once(other))
    ratios = [b / a for a, b in zip(firsts, seconds, strict=True)]
    return median(firsts), median(seconds), median(ratios)
