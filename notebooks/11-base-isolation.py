# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Base isolation by friction pendulum
#
# How much friction should a friction pendulum have? Little lets the building glide far, much lets the ground
# through. A pendulum is a slider with a spring across it, W/R, under the weight W; its friction is mu W.
# Below the building it is a link between the ground and the base slab.

# %%
import matplotlib.pyplot as plt
import numpy as np

import fdspec

G = 9.80665
slab, floors = 30e3, [25e3, 25e3, 25e3]
weight = (slab + sum(floors)) * G
radius = 1.5
print(f"period on the pendulum {2 * np.pi * np.sqrt(radius / G):.2f} s, whatever the weight")


def isolated(friction: float) -> fdspec.Building:
    """Give three storeys on a slab on a friction pendulum of this coefficient."""
    pendulum = fdspec.Link(
        1,
        0,
        stiffness=friction * weight / 1e-3,  # slips after a millimetre
        slip_force=friction * weight,
        recentring_stiffness=weight / radius,
        name="pendulum",
    )
    # The slab has no columns: the least of springs stands for them.
    return fdspec.Building(
        [slab, *floors],
        [1e3, 40e6, 40e6, 40e6],
        0.0,
        0.0,
        0.0,
        damping=fdspec.RayleighDamping(0.02, 0.4, 0.1),
        links=[pendulum],
    )


# %%
motion = fdspec.load_record("FMR1")
motion = fdspec.GroundMotion(motion.acceleration[: int(25 / motion.dt)], motion.dt, name=motion.name)
friction = np.array([0.01, 0.02, 0.04, 0.06, 0.08, 0.12, 0.16])
histories = [fdspec.simulate(isolated(mu), motion, free_vibration=5.0) for mu in friction]
top = [history.peak_acceleration[-1].item() / G for history in histories]
glide = [history.peak_link_slip.item() * 1e3 for history in histories]
rest = [abs(history.residual_link_slip.item()) * 1e3 for history in histories]
for mu, a, s, r in zip(friction, top, glide, rest, strict=True):
    print(f"mu {mu:.2f}: top floor {a:.3f} g, slip {s:6.1f} mm, left over {r:5.1f} mm")
assert all(history.energy_error < 1e-9 for history in histories)

# %% [markdown]
# The loop of one of them: vertical sides of friction, and the slope W/R.

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
left.plot(friction, top, "o-")
left.set(xlabel="friction coefficient", ylabel="peak acceleration of the top floor, g")
twin = left.twinx()
twin.plot(friction, glide, "s--", color="C1")
twin.set_ylabel("slip of the pendulum, mm")
one = fdspec.simulate(isolated(0.06), motion, dt_out=0.002)
right.plot(1e3 * one.displacement[:, 0], one.link_force[:, 0] / weight, lw=0.8)
right.set(xlabel="displacement of the slab, mm", ylabel="force over weight")
plt.show()
