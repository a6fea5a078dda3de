"""The state of a history, ``STATE``: motion and peaks are taken from it and put back."""

from __future__ import annotations

from fdspec.compiler.options import inlined
from fdspec.kernels.types import STATE, Motion, Peaks


@inlined
def motion_of(s):
    """Motion of floor and brace."""
    return Motion(s[STATE.u], s[STATE.v], s[STATE.d], s[STATE.e])


@inlined
def put_motion(s, motion):
    """Put a motion in its place."""
    s[STATE.u] = motion.u
    s[STATE.v] = motion.v
    s[STATE.d] = motion.d
    s[STATE.e] = motion.e


@inlined
def peaks_of(s):
    """Peaks of the floor and of base shear so far."""
    return Peaks(
        s[STATE.peak_acceleration], s[STATE.peak_displacement], s[STATE.peak_velocity], s[STATE.peak_shear]
    )


@inlined
def put_peaks(s, peaks):
    """Put peaks in their place."""
    s[STATE.peak_acceleration] = peaks.acceleration
    s[STATE.peak_displacement] = peaks.displacement
    s[STATE.peak_velocity] = peaks.velocity
    s[STATE.peak_shear] = peaks.shear
