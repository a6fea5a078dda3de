"""A building as the script that SimCenter's workflows call for a custom analysis in Python."""

from __future__ import annotations

from typing import Final

from fdspec.model.building_file import building_of
from fdspec.model.toml_lines import parsed
from fdspec.version import __version__


def simcenter_script(building: str, *, name: str = "building") -> str:
    """Write the script with `custom_analysis` that SimCenter's customPySimulation calls.

    Parameters
    ----------
    building : str
        A building file's text, which stands in the script.
    name : str
        What the script calls it.

    Returns
    -------
    str
        Python. It needs fdspec where it runs, and gives the demands by SimCenter's names: ``1-PFA-1-1``
        the peak floor acceleration, location 0 the ground; ``1-PFD-1-1`` the peak floor displacement; with
        heights known ``1-PID-1-1`` the peak and ``1-RID-1-1`` the residual drift ratio, ``1-PRD-1-1`` the
        peak roof drift ratio. Accelerations and lengths are in the units of the event's file.

    Raises
    ------
    InvalidInput
        For text that is no building file.
    """
    building_of(parsed(building), design=True)
    about = " ".join(name.replace("\\", "/").replace('"', "'").split())
    return (
        SCRIPT.replace("@about@", about)
        .replace("@version@", __version__)
        .replace("@building@", repr(building))
    )


SCRIPT: Final = '''"""@about@ for SimCenter, written by fdspec @version@; needs fdspec where it runs.

Name this file as the main script of a custom analysis in Python.
"""

import tomllib

import numpy as np

import fdspec
from fdspec.model.building_file import building_of

BUILDING = @building@

METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048, "inch": 0.0254}
DIRECTION = 1


def length_unit(about):
    """Metres in the unit of length that the workflow's file names; m where it names none."""
    units = (about or {}).get("GeneralInformation", {}).get("units", {})
    return METRES[units.get("length", "m")]


def ground_motion(event, metres):
    """The event's acceleration along DIRECTION, from rest: its first sample is preceded by 0."""
    wanted = [one["timeSeries"] for one in event["pattern"] if one.get("dof", DIRECTION) == DIRECTION]
    series = next(one for one in event["timeSeries"] if one["name"] in wanted)
    samples = np.array([0.0, *series["data"]]) * series.get("factor", 1.0) * metres
    return fdspec.GroundMotion(samples, series["dT"], name=str(event.get("name", "event")))


def custom_analysis(AIM=None, EVENT=None, SAM=None, EDP=None, BIM=None):
    """Peak demands of the building under the event, by SimCenter's names."""
    metres = length_unit(AIM or BIM)
    building = building_of(tomllib.loads(BUILDING), design=True)
    motion = ground_motion(EVENT, metres)
    history = fdspec.simulate(building, motion)
    found = {f"1-PFA-0-{DIRECTION}": motion.pga / metres}
    drift = building.drifts(history["residual_displacement"].values)
    for k, height in enumerate(building.storey_height):
        floor = f"{k + 1}-{DIRECTION}"
        found[f"1-PFA-{floor}"] = float(history["peak_acceleration"][k]) / metres
        found[f"1-PFD-{floor}"] = float(history["peak_displacement"][k]) / metres
        if np.isfinite(height):
            found[f"1-PID-{floor}"] = float(history["peak_drift"][k] / height)
            found[f"1-RID-{floor}"] = float(abs(drift[k]) / height)
    heights = building.floor_height
    if np.isfinite(heights).all():
        roof = int(np.argmax(heights))
        found[f"1-PRD-1-{DIRECTION}"] = float(history["peak_displacement"][roof] / heights[roof])
    return found
'''
