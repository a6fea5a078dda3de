"""The reference numbers and the motion they were made with, read from the files beside this one."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

HERE = Path(__file__).parent
FILES = ("sdof_peaks.json", "mdof_peaks.json")


def read(name: str) -> dict[str, Any]:
    return dict(json.loads((HERE / name).read_text(encoding="utf-8")))


@dataclass(frozen=True)
class SingleStorey:
    """One history of sdof_peaks.json; floor 20 000 kg, brace 50 kg, damping ratio 0.05."""

    period: float
    stiffness_ratio: float
    slip_force: float
    peak_acceleration: float
    peak_displacement: float
    transitions: int

    def __str__(self) -> str:
        return f"T={self.period:g} SR={self.stiffness_ratio:g} F={self.slip_force / 1e3:g}kN"


@cache
def motion(name: str = "sdof_peaks.json") -> tuple[NDArray[np.float64], float]:
    """Ground acceleration (m/s2) and its time step (s)."""
    given = read(name)["motion"]
    t = np.arange(given["n"]) * given["dt"]
    x = np.zeros(given["n"])
    for f, a, phi in zip(given["f"], given["a"], given["phi"], strict=True):
        x += a * np.sin(2.0 * np.pi * f * t + phi)
    x *= np.where(t < 3.0, (t / 3.0) ** 2, np.where(t < 10.0, 1.0, np.exp(-0.35 * (t - 10.0))))
    x *= given["pga_g"] * given["g"] / np.max(np.abs(x))
    x.flags.writeable = False
    return x, float(given["dt"])


@cache
def single_storeys() -> tuple[SingleStorey, ...]:
    return tuple(
        SingleStorey(
            c["period_s"],
            c["stiffness_ratio"],
            c["slip_force_n"],
            c["peak_acceleration_m_s2"],
            c["peak_displacement_m"],
            c["n_transitions"],
        )
        for c in read("sdof_peaks.json")["cells"]
    )
