"""Devices made of straight lines, each against a formula of its own."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from fdspec.model.building import Building, ModalDamping
from fdspec.model.link import Link, TensionBrace
from fdspec.model.motion import GroundMotion
from fdspec.model.side_by_side import side_by_side
from fdspec.runs.simulate import simulate
from fdspec.verification.problems import still
from fdspec.verification.row import Row, relative, same_count

NO_DAMPING = ModalDamping(0.0)
NEXT_TO_NOTHING = 1e-9
"""Stiffness, N/m, of a frame that is there for its mass only."""


def rows(full: bool) -> Iterator[Row]:  # noqa: ARG001
    """Yield the rows of this family."""
    yield from step_load()
    yield from rigid_plastic_pulse()
    yield from oscillator_with_a_stop()
    yield from gravity_overturns()
    yield from flag_loop()
    yield from tension_only()
    yield from columns_and_massless_brace()
    yield from frames_joined_by_a_damper()


def step_load() -> Iterator[Row]:
    """Load an elastoplastic oscillator of strength R suddenly with F: its ductility is 0.5 / (1 - F/R)."""
    mass, omega, strength = 1000.0, 7.0, 4000.0
    frame = Building(mass, mass * omega**2, 0.0, 0.0, 0.0, damping=NO_DAMPING, yield_shear=strength)
    for share in (0.6, 0.8, 0.9, 0.95):
        load = GroundMotion(np.full(400, -share * strength / mass), 0.01)
        computed = float(simulate(frame, load)["ductility"][0])
        yield relative("step load", f"ductility at F/R {share:g}", 0.5 / (1.0 - share), computed, 1e-12)


def rigid_plastic_pulse() -> Iterator[Row]:
    """Push a block that friction holds by a stiff brace with a pulse that ends in a ramp.

    While the brace stretches the block swings; then it slides under A - N, and on until friction has used
    its velocity up.
    """
    mass, pulse, friction, t0, omega = 2000.0, 3.0, 1.2, 0.4, 300.0
    gives_way = math.acos(1.0 - friction / pulse) / omega
    velocity = pulse / omega * math.sin(gives_way * omega)
    left = t0 - gives_way
    slid = velocity * left + 0.5 * (pulse - friction) * left**2
    velocity += (pulse - friction) * left
    slid += velocity * t0 + pulse * t0**2 * (1.0 / 2.0 - 1.0 / 6.0) - 0.5 * friction * t0**2
    velocity += 0.5 * pulse * t0 - friction * t0
    slid += 0.5 * velocity**2 / friction
    damper = Link(1, 0, mass * omega**2, friction * mass)
    block = Building(mass, NEXT_TO_NOTHING, 0.0, 0.0, 0.0, damping=NO_DAMPING, links=[damper])
    push = GroundMotion([-pulse, -pulse, 0.0], t0)
    history = simulate(block, push, dt_out=0.1, free_vibration=1.0)
    yield relative("rigid-plastic pulse", "slip, m", slid, float(history["peak_link_slip"][0]), 1e-11)
    work = mass * friction * slid
    yield relative(
        "rigid-plastic pulse", "work of friction, J", work, float(history["links_energy"][-1]), 1e-11
    )


def oscillator_with_a_stop() -> Iterator[Row]:
    """Let an oscillator swing into the ends of a slot: two arcs of circles in the phase plane."""
    mass, k, brace, bearing, gap, velocity = 1500.0, 6.0e4, 5.0e5, 8.0e5, 0.01, 0.2
    stop = brace * bearing / (brace + bearing)
    frame = Building(mass, k, 0.0, brace, 0.0, damping=NO_DAMPING, slot_length=gap, slot_stiffness=bearing)
    # m v^2 / 2 = k u^2 / 2 + stop (u - gap)^2 / 2 at the peak
    total = k + stop
    square = (stop * gap) ** 2 - total * (stop * gap**2 - mass * velocity**2)
    peak = (stop * gap + math.sqrt(square)) / total
    slow, fast = math.sqrt(k / mass), math.sqrt(total / mass)
    at_stop = math.sqrt(velocity**2 - slow**2 * gap**2)
    centre = stop * gap / total
    free = math.asin(gap * slow / velocity) / slow
    beyond = math.pi / 2.0 - math.atan2((gap - centre) * fast, at_stop)
    half = 2.0 * (free + beyond / fast)
    history = simulate(
        frame, still(2e-3, 1e-3), dt_out=half, free_vibration=4.5 * half, initial_velocity=[velocity]
    )
    case = "oscillator with stops"
    yield relative(case, "peak displacement, m", peak, float(history["peak_displacement"][0]), 1e-12)
    yield relative(case, "velocity after four halves, m/s", velocity, float(history["velocity"][4, 0]), 1e-11)
    yield same_count(case, "contacts and releases in 4.5 halves", 9, int(history["slot_events"][0]))


def gravity_overturns() -> Iterator[Row]:
    """Push a frame with P-delta beyond its yield drift: from there its motion is a cosh."""
    mass, k, strength, height, weight, velocity = 1000.0, 5.0e4, 1500.0, 3.0, 3.0e4, 0.5
    frame = Building(
        mass,
        k,
        0.0,
        0.0,
        0.0,
        damping=NO_DAMPING,
        storey_height=height,
        yield_shear=strength,
        gravity_load=weight,
        collapse_drift=math.inf,
    )
    pull = weight / height
    omega = math.sqrt((k - pull) / mass)
    yields = strength / k
    reached = math.asin(yields * omega / velocity) / omega
    speed = velocity * math.cos(omega * reached)
    growth = math.sqrt(pull / mass)
    balance = strength / pull
    at = 1.1
    tau = growth * (at - reached)
    expected = balance + (yields - balance) * math.cosh(tau) + speed / growth * math.sinh(tau)
    history = simulate(frame, still(1e-2, 1e-2), dt_out=at, free_vibration=at, initial_velocity=[velocity])
    case = "gravity overturns a frame"
    yield relative(case, "displacement at 1.1 s, m", expected, float(history["displacement"][1, 0]), 1e-12)


def flag_loop() -> Iterator[Row]:
    """Let a mass swing on a flag-shaped joint: the energy on each of its lines gives slip and loss."""
    mass, brace, preload, friction, spring, growth = 1000.0, 2.0e6, 4000.0, 2500.0, 1.5e5, 5.0e4
    velocity = 0.6
    joint = Link(
        1,
        0,
        brace,
        friction,
        recentring_stiffness=spring,
        recentring_preload=preload,
        friction_stiffness=growth,
        name="joint",
    )
    frame = Building(mass, NEXT_TO_NOTHING, 0.0, 0.0, 0.0, damping=NO_DAMPING, links=[joint])
    # At the turn: m v^2 / 2 = f^2 / (2 brace) + (preload + friction) o + (spring + growth) o^2 / 2,
    # with the force f = preload + friction + (spring + growth) o.
    force, slope = preload + friction, spring + growth
    a = slope**2 / (2.0 * brace) + 0.5 * slope
    b = force * slope / brace + force
    c = force**2 / (2.0 * brace) - 0.5 * mass * velocity**2
    slip = (-b + math.sqrt(b * b - 4.0 * a * c)) / (2.0 * a)
    history = simulate(frame, still(1e-3, 1e-3), free_vibration=0.5, initial_velocity=[velocity])
    case = "flag-shaped joint"
    yield relative(case, "largest slip, m", slip, float(history["peak_link_slip"][0]), 1e-12)
    peak = slip + (force + slope * slip) / brace
    yield relative(case, "peak displacement, m", peak, float(history["peak_displacement"][0]), 1e-12)
    offset = history["link_slip"].values[:, 0]
    home = int(np.flatnonzero(offset[int(np.argmax(offset)) :] == 0.0)[0]) + int(np.argmax(offset))
    loss = 2.0 * friction * slip + growth * slip**2
    yield relative(case, "energy of one loop, J", loss, float(history["links_energy"][home]), 1e-12)


def tension_only() -> Iterator[Row]:
    """Let a mass swing with a brace that pulls one way only: two half periods of two oscillators."""
    mass, k, brace, velocity = 1200.0, 4.0e4, 9.0e4, 0.3
    frame = Building(mass, k, 0.0, 0.0, 0.0, damping=NO_DAMPING, links=[TensionBrace(1, 0, brace)])
    with_brace, without = math.sqrt((k + brace) / mass), math.sqrt(k / mass)
    whole = math.pi / with_brace + math.pi / without
    history = simulate(
        frame, still(1e-3, 1e-3), dt_out=whole, free_vibration=3.5 * whole, initial_velocity=[velocity]
    )
    case = "tension-only brace"
    slack = float(history["peak_displacement"][0])
    yield relative(case, "peak with the brace slack, m", velocity / without, slack, 1e-12)
    pull = float(history["peak_link_force"][0])
    yield relative(case, "peak force, N", brace * velocity / with_brace, pull, 1e-12)
    after = float(history["velocity"][3, 0])
    yield relative(case, "velocity after three cycles, m/s", velocity, after, 1e-11)


def columns_and_massless_brace() -> Iterator[Row]:
    """Make one bilinear oscillator from columns that yield and from a massless brace that slips."""
    mass, k, share, strength = 20e3, 8.0e6, 0.1, 30e3
    t = np.arange(1000) * 0.01
    motion = GroundMotion(6.0 * np.sin(9.0 * t) * np.sin(0.7 * t) + 2.0 * np.sin(31.0 * t), 0.01)
    damping = ModalDamping(0.05)
    columns = Building(mass, k, 0.0, 0.0, 0.0, damping=damping, yield_shear=strength, hardening_ratio=share)
    brace = Building(
        mass,
        share * k,
        0.0,
        (1.0 - share) * k,
        (1.0 - share) * strength,
        damping=ModalDamping(0.05 / math.sqrt(share)),
    )
    one, other = simulate(columns, motion), simulate(brace, motion)
    case = "columns against massless brace"
    for name in ("peak_displacement", "peak_acceleration", "peak_velocity", "residual_displacement"):
        yield relative(case, f"{name.replace('_', ' ')}", float(other[name][0]), float(one[name][0]), 1e-12)
    count = int(other["transitions"])
    yield same_count(case, "yields and unloadings", count, int(one["column_events"][0]))


def frames_joined_by_a_damper() -> Iterator[Row]:
    """Let two equal frames swing against each other: their damper sticks, then slips to the peak."""
    mass, k, brace, friction, velocity = 1800.0, 9.0e4, 3.0e5, 1500.0, 0.3
    frame = Building(mass, k, 0.0, 0.0, 0.0, damping=NO_DAMPING)
    pair = side_by_side(frame, frame, links=[Link(1, 2, brace, friction)])
    gives_way = 0.5 * friction / brace
    speed = math.sqrt(velocity**2 - (k + 2.0 * brace) / mass * gives_way**2)
    centre = friction / k
    peak = math.hypot(gives_way + centre, speed * math.sqrt(mass / k)) - centre
    history = simulate(pair, still(0.3, 0.01), initial_velocity=[velocity, -velocity])
    case = "frames joined by a damper"
    for frame_number in (0, 1):
        found = float(history["peak_displacement"][frame_number])
        yield relative(case, f"peak displacement of frame {frame_number + 1}, m", peak, found, 1e-12)
    slip = 2.0 * peak - friction / brace
    yield relative(case, "slip, m", slip, float(history["peak_link_slip"][0]), 1e-12)
