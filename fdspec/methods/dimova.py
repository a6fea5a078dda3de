"""Friction made linear within a band of sliding velocity."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fdspec.engines.trajectory import FloatArray, Span, Trajectory
from fdspec.methods.matrices import braced, drifts
from fdspec.methods.method import Method, intervals, parts_of, positive
from fdspec.methods.samples import Samples, count_steps, stepwise, trajectory_of
from fdspec.methods.smooth import integrate_smooth
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion


@dataclass(frozen=True, kw_only=True)
class Dimova(Method):
    """Make friction linear in the sliding velocity within a band about zero.

    Dimova, Meskouris and Kraetzig (1995), the study's reference [22] and its Figure 4.  In place of (1), with
    the sliding velocity w = u_f' - u_d' and the tolerance e::

        R = F w / e   for |w| <= e,   F sgn w   beyond.

    The damper never sticks: it creeps at up to e, a dashpot F / e while a real one would hold.

    Parameters
    ----------
    velocity_band : float, m/s
        The tolerance e; Figure 4 compares 0.001, 0.005 and 0.01 m/s.
    rtol : float
        Relative tolerance of the integrator, LSODA, which is meant for stiff systems such as this.
    dt : float, s
        Longest time between the instants at which peaks are read.

    Notes
    -----
    The phases told are those of the approximation: 0 within the band, else the direction of sliding.  Kinetic
    friction is used.  A damper that never slips is locked.  A massless brace creeps as its spring has it:
    R = k_d stretch decides w within the band, and at R = F the brace stands still.
    """

    name: ClassVar[str] = "dimova"

    velocity_band: float = 0.001
    rtol: float = 1e-6
    dt: float = 1e-4

    def __post_init__(self) -> None:
        for name, unit in (("velocity_band", "m/s"), ("rtol", ""), ("dt", "s")):
            positive(self, name, unit)

    def integrate(
        self, building: Building, motion: GroundMotion, span: Span, start: FloatArray
    ) -> Trajectory:
        """Integrate one history."""
        ground, parts = intervals(motion, span), parts_of(motion, self.dt)
        count_steps(self, ground.shape[0], parts)
        law = _Law(building, self.velocity_band)
        size = building.n_storeys
        begin = np.concatenate([start[0, 0], start[0, 1], start[1, 0], start[1, 1]])
        speed = max(motion.pga * float(building.bare_periods[0]), float(np.max(np.abs(start[1]))), 1e-9)
        length = max(speed * float(building.bare_periods[0]), float(np.max(np.abs(start[0]))))
        atol = self.rtol * 1e-2 * np.repeat([length, speed], 2 * size)
        states, status = integrate_smooth(law.quick_rates(), begin, ground, motion, parts, self.rtol, atol)
        u, d, v = states[:, :size], states[:, size : 2 * size], states[:, 2 * size : 3 * size]
        e, force, rest, spring = law.parts_of(u, d, v, states[:, 3 * size :])
        m_d = building.brace_mass
        with np.errstate(invalid="ignore"):
            sliding = np.where(np.abs(v - e) >= self.velocity_band, np.sign(v - e), 0.0)
        phase = np.where(law.free, sliding, 0.0).astype(np.int64)
        return trajectory_of(
            building,
            Samples(
                step=motion.dt / parts,
                ground=stepwise(ground, parts),
                displacement=u,
                velocity=v,
                acceleration=(rest - force) / building.floor_mass,
                brace_displacement=d,
                brace_velocity=e,
                brace_acceleration=np.divide(force - spring, m_d, out=np.zeros_like(force), where=m_d > 0.0),
                friction_force=force,
                phase=np.nan_to_num(phase).astype(np.int64),
                status=status,
            ),
            span,
        )


class _Law:
    """Forces and rates of change of y = [u_f, u_d, v_f, v_d], (4N,)."""

    def __init__(self, building: Building, band: float) -> None:
        self.n = building.n_storeys
        self.band = band
        self.m_f, self.m_d = building.floor_mass, building.brace_mass
        self.K, self.C = building.stiffness_matrix, building.damping_matrix
        self.k_d, self.c_d = building.brace_stiffness, building.brace_damping
        self.D = drifts(self.n)
        has = np.zeros(self.n, bool)
        has[braced(building)] = True
        self.free = has & np.isfinite(building.slip_force)
        """Dampers that may creep; the others are locked, and storeys without a brace have none."""
        self.light = self.free & (self.m_d == 0.0)
        self.any_light = bool(self.light.any())
        self.all_free = bool(self.free.all())
        self.F = np.where(self.free, building.kinetic_slip_force, 0.0)
        self.share = self.m_d / (self.m_f + self.m_d)

    def parts_of(
        self, u: FloatArray, d: FloatArray, v: FloatArray, e: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Brace velocity, friction, force on the floor but for it, force of the brace's spring."""
        below, below_velocity = u - u @ self.D.T, v - v @ self.D.T
        if not self.all_free:
            e = np.where(self.free, e, v)
        if self.any_light:
            e = np.where(self.light, self._creep(d - below, v, below_velocity), e)
        spring = self.k_d * (d - below) + self.c_d * (e - below_velocity)
        rest = -(u @ self.K + v @ self.C)
        rest[..., :-1] += spring[..., 1:]
        force = self.F * np.clip((v - e) / self.band, -1.0, 1.0)
        if self.any_light:
            force = np.where(self.light, spring, force)
        if not self.all_free:
            force = np.where(self.free, force, self.share * rest + (1.0 - self.share) * spring)
        return e, force, rest, spring

    def _creep(self, stretch: FloatArray, v: FloatArray, below: FloatArray) -> FloatArray:
        """Velocity of a massless brace whose spring (and dashpot) carries what the damper does."""
        k, c, F, band = self.k_d, self.c_d, self.F, self.band
        # k stretch + c (e - below) = F (v - e) / band inside the band, +-F beyond.
        with np.errstate(divide="ignore", invalid="ignore"):
            inside = (F * v / band + c * below - k * stretch) / (c + F / band)
            over = np.sign(v - inside)
            beyond = np.where(c > 0.0, below + (over * F - k * stretch) / c, below)
            # Without a dashpot the spring stands at F once it is there, while the storey goes on.
            goes_on = (c > 0.0) | ((np.abs(k * stretch) >= F) & (over * (v - below) >= band))
            held = np.where(goes_on & (np.abs(v - inside) >= band), beyond, inside)
        return np.where(F > 0.0, held, below)

    def rates(self, y: FloatArray, ground: float, out: FloatArray) -> None:
        """Fill y'."""
        n = self.n
        v = y[2 * n : 3 * n]
        e, force, rest, spring = self.parts_of(y[:n], y[n : 2 * n], v, y[3 * n :])
        a = (rest - force) / self.m_f - ground
        moves = self.free & ~self.light
        brace = np.divide(force - spring, self.m_d, out=np.zeros(n), where=moves)
        out[:n] = v
        out[n : 2 * n] = e
        out[2 * n : 3 * n] = a
        out[3 * n :] = np.where(moves, brace - ground, a)

    def quick_rates(self) -> Callable[[FloatArray, float, FloatArray], None]:
        """Return `rates` as y' = L y + P clip(W y) + g a_g where no brace is massless: quicker."""
        if self.any_light:
            return self.rates
        n, columns = self.n, np.eye(4 * self.n)
        frictionless = copy(self)
        frictionless.F = np.zeros(n)
        L, out = np.empty((4 * n, 4 * n)), np.empty(4 * n)
        for k in range(4 * n):
            frictionless.rates(columns[k], 0.0, out)
            L[:, k] = out
        g = np.empty(4 * n)
        frictionless.rates(np.zeros(4 * n), 1.0, g)
        reciprocal = np.divide(1.0, self.m_d, out=np.zeros(n), where=self.free)
        P = np.vstack([np.zeros((2 * n, n)), np.diag(-self.F / self.m_f), np.diag(self.F * reciprocal)])
        W = np.hstack([np.zeros((n, 2 * n)), np.eye(n), -np.eye(n)]) / self.band

        def rates(y: FloatArray, ground: float, out: FloatArray) -> None:
            np.dot(L, y, out=out)
            out += P @ np.maximum(np.minimum(W @ y, 1.0), -1.0)
            out += g * ground

        return rates
