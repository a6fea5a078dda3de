"""One building under one ground motion -> its history over time, as a Dataset."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from fdspec.engines.step_count import refuse_endless
from fdspec.engines.trajectory import FloatArray, Rest, Span, TrajectoryWithDevices
from fdspec.errors import IntegrationError, InvalidInput
from fdspec.methods import EXACT, Method, chosen_method
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.runs.bounds import HISTORY_HOURS, refuse_large, refuse_long
from fdspec.runs.cost import seconds_of_history
from fdspec.runs.history import ROUNDING, history_of
from fdspec.runs.plausible import warn_of_units
from fdspec.store import provenance
from fdspec.variables import STATUSES

MAX_OUTPUTS = 50_000_000
"""Output instants; a dt_out with a slipped decimal is refused before it fills the memory."""


def simulate(
    building: Building,
    motion: GroundMotion,
    *,
    method: str | Method = EXACT,
    dt_out: float | None = None,
    free_vibration: float = 0.0,
    initial_displacement: ArrayLike | None = None,
    initial_velocity: ArrayLike | None = None,
    start_from: xr.Dataset | None = None,
    at_rest: bool = False,
    max_steps: float | None = None,
) -> xr.Dataset:
    """Integrate one history exactly, event by event, or by another method; return its time series.

    Parameters
    ----------
    building : Building
        The frame or building, at rest unless said otherwise.
    motion : GroundMotion
        Ground acceleration, linear between its samples.
    method : str or Method
        "exact", or one of the methods that the study compares, by name (`fdspec.methods.METHODS`) or with
        parameters of its own, as ``Newmark(dt=1e-5)``.
    dt_out : float, s, optional
        Time between outputs, the motion's own unless given.  It is not a step size: no peak and no
        instant of change depends on it.
    free_vibration : float, s
        How long to go on after the motion's end, the ground at rest; rounded up to whole steps of
        the motion.
    at_rest : bool
        Go on from there until the energy left can make no damper slip, and give ``residual_displacement``,
        ``residual_drift`` and ``residual_slip`` where the building comes to rest.
    initial_displacement, initial_velocity : array_like, m and m/s, optional
        Relative to the ground: shape (N,) for the floors, each brace moving with its floor as if no
        damper had ever slipped; shape (2, N) for floors and braces apart.
    max_steps : float, optional
        Most steps that the exact method may take, 1e9 (minutes) unless given or set by the environment
        variable ``FDSPEC_MAX_STEPS``: a slip of a decimal in a mass or in dt would otherwise take days.
    start_from : xarray.Dataset, optional
        A history of the same building, from `simulate` or a file, at whose end this one begins: an aftershock
        after a mainshock.  To the bit as if both motions were one, where the second begins with the sample
        that the first ends with and no free vibration lies between; peaks, travels and energies are those of
        the second motion alone.

    Returns
    -------
    xarray.Dataset
        Dims time, storey and transition; variables, units and meanings are those of
        `fdspec.variables.HISTORY`.

    Raises
    ------
    InvalidInput
        For an argument that cannot be used, by name and value.
    IntegrationError
        When the history could not be completed; the text names the status.

    Notes
    -----
    The equations of motion are the study's (2) to (7) for one storey and (19) to (25) for many.

    Examples
    --------
    >>> import fdspec
    >>> frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=50e3)
    >>> history = fdspec.simulate(frame, fdspec.load_record("FSR1"))
    >>> bool(history.peak_acceleration[0] < 9.81)
    True
    """
    if not isinstance(building, Building):
        raise InvalidInput(f"building must be a Building, got {type(building).__name__}")
    if not isinstance(motion, GroundMotion):
        raise InvalidInput(f"motion must be a GroundMotion, got {type(motion).__name__}")
    span = _span(motion, dt_out, free_vibration)
    samples = float(motion.n + span.free_steps)
    traces = (16.0 * building.n_storeys + 6.0) * span.outputs
    refuse_large(8.0 * (samples + 2.0 * traces), f"a history of {samples:.4g} samples")
    if method == EXACT:
        seconds = seconds_of_history(building, motion.dt, samples)
        refuse_long(seconds, HISTORY_HOURS, f"the history of {samples:.4g} samples")
    warn_of_units(
        [motion], period=building.bare_periods, slip_force=building.slip_force, floor_mass=building.floor_mass
    )
    start = np.stack(
        [
            _initial("initial_displacement", initial_displacement, building),
            _initial("initial_velocity", initial_velocity, building),
        ]
    )
    other = chosen_method(method)
    resume = None if start_from is None else _end_of(start_from, building)
    if resume is not None:
        if initial_displacement is not None or initial_velocity is not None:
            raise InvalidInput(
                "start_from gives the start: leave initial_displacement and initial_velocity out"
            )
        if other is not None:
            raise InvalidInput(f"start_from needs method 'exact', got {other.name!r}")
    if other is None:
        refuse_endless(building, motion.dt, motion.n - 1 + span.free_steps, max_steps)
    rest = None
    if at_rest:
        rest = _rest(building, motion, span, start, resume, other)
        span = _span(motion, dt_out, free_vibration, rest.steps)
    if other is not None:
        if building.has_devices:
            raise InvalidInput(
                f"method {other.name!r} knows frames, braces and friction alone; yielding columns, slots, "
                "gravity and links need the exact method"
            )
        trajectory = other.integrate(building, motion, span, start)
    elif building.has_devices:
        from fdspec.engines.devices import integrate_devices

        trajectory = integrate_devices(building, motion, span, start, resume)
    elif building.n_storeys == 1:
        from fdspec.engines.single_storey import integrate_single_storey

        trajectory = integrate_single_storey(building, motion, span, start, resume)
    else:
        from fdspec.engines.many_storeys import integrate_many_storeys

        trajectory = integrate_many_storeys(building, motion, span, start, resume)
    if isinstance(trajectory, TrajectoryWithDevices) and trajectory.devices.collapse_storey > 0:
        raise IntegrationError(
            f"the history of {building!r} under {motion.name or 'the motion'} ended with status collapsed: "
            f"the drift of storey {trajectory.devices.collapse_storey} reached its limit of "
            f"{trajectory.devices.collapse_drift:g} m at {trajectory.devices.collapse_time:.4f} s "
            "(collapse_drift of the building sets the limit)"
        )
    if trajectory.status != 0:
        raise IntegrationError(
            f"the history of {building!r} under {motion.name or 'the motion'} ended with status "
            f"{STATUSES[trajectory.status]} after {trajectory.transition_time.size} changes of phase"
        )
    if rest is not None:
        trajectory = replace(trajectory, residual_displacement=rest.displacement, residual_slip=rest.slip)
    solved = building if other is None else other.model(building)
    return history_of(solved, motion, span, start, trajectory, {} if other is None else other.parameters)


def _end_of(history: object, building: Building) -> FloatArray:
    """The state in which a history of this very building ended."""
    if not isinstance(history, xr.Dataset) or "end_state" not in history:
        raise InvalidInput(
            "start_from must be a history that fdspec.simulate has computed by the exact method"
        )
    told = json.loads(history.attrs.get("parameters", "{}"))
    ours = json.loads(provenance("", building.parameters, ())["parameters"])
    for name, value in ours.items():
        if name in building.parameters and told.get(name) != value:
            raise InvalidInput(f"start_from must be a history of the same building, but its {name} differs")
    return np.array(history["end_state"].values, dtype=np.float64)


def _rest(
    building: Building,
    motion: GroundMotion,
    span: Span,
    start: FloatArray,
    resume: FloatArray | None,
    other: Method | None,
) -> Rest:
    """Find when and where the building comes to rest."""
    if other is not None or building.has_devices:
        what = f"method {other.name!r}" if other is not None else "buildings with devices"
        raise InvalidInput(f"at_rest is for the exact method and dampers alone, not for {what}")
    if building.n_storeys == 1:
        from fdspec.engines.single_storey import rest_of_single_storey

        rest = rest_of_single_storey(building, motion, span, start, resume)
    else:
        from fdspec.engines.rest import rest_of_building

        rest = rest_of_building(building, motion, span, start, resume)
    if rest.status != 0:
        raise IntegrationError(
            f"{building!r} has not come to rest {rest.steps * motion.dt:g} s after the motion; "
            f"status {STATUSES[rest.status]}"
        )
    return rest


def _span(motion: GroundMotion, dt_out: object, free_vibration: object, more_steps: int = 0) -> Span:
    if not (isinstance(free_vibration, int | float) and 0.0 <= free_vibration < math.inf):
        raise InvalidInput(f"free_vibration must be zero or a positive time in s, got {free_vibration!r}")
    every = motion.dt if dt_out is None else dt_out
    if not (isinstance(every, int | float) and 0.0 < every < math.inf):
        raise InvalidInput(f"dt_out must be a positive time in s, got {dt_out!r}")
    free_steps = math.ceil(free_vibration / motion.dt - 1e-9) + more_steps
    total = (motion.n - 1 + free_steps) * motion.dt
    outputs = math.floor(total / every + ROUNDING) + 1
    if outputs > MAX_OUTPUTS:
        raise InvalidInput(
            f"dt_out {every:g} s gives {outputs:g} outputs over {total:g} s; at most {MAX_OUTPUTS} are kept, "
            f"so it must be at least {total / (MAX_OUTPUTS - 1):.3g} s"
        )
    return Span(free_steps, float(every), outputs)


def _initial(name: str, given: ArrayLike | None, building: Building) -> FloatArray:
    """Floors and braces (2, N) of an initial displacement or velocity."""
    size = building.n_storeys
    if given is None:
        return np.zeros((2, size))
    try:
        values = np.array(given, dtype=np.float64)
    except (TypeError, ValueError):
        raise InvalidInput(f"{name} must be numbers, got {given!r:.60}") from None
    if values.ndim == 0 and size == 1:
        values = values[np.newaxis]
    if values.shape not in ((size,), (2, size)):
        raise InvalidInput(f"{name} must have shape ({size},) or (2, {size}), got {values.shape}")
    if not np.isfinite(values).all():
        raise InvalidInput(f"{name} must be finite, got {given!r:.60}")
    return np.broadcast_to(values, (2, size)).copy()
