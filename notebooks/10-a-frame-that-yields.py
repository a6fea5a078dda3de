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
# # A frame that yields
#
# How strong must a damper be beside columns that yield? The study's reference [16] calls the ratio of the
# damper's slip force to the storey's yield force decisive. Here it is computed: one frame whose columns
# yield, and slip forces from next to nothing to more than the columns carry.

# %%
import matplotlib.pyplot as plt
import numpy as np

import fdspec

frame = {"period": 0.6, "stiffness_ratio": 4.0, "floor_mass": 20e3, "damping_ratio": 0.03}
columns = {"yield_shear": 30e3, "hardening_ratio": 0.02, "storey_height": 3.2, "gravity_load": 250e3}
motions = [fdspec.load_record(name) for name in ("FSR1", "FMR1", "FHR1")]
motions = [fdspec.GroundMotion(m.acceleration[: int(20 / m.dt)], m.dt, name=m.name) for m in motions]

# %% [markdown]
# One history first. The columns' shear over the drift has two straight lines; the damper takes its share from
# its own slip force on.

# %%
building = fdspec.Building.single_storey(**frame, slip_force=15e3, **columns)
history = fdspec.simulate(building, motions[0], dt_out=0.002)
print(f"ductility {history.ductility.item():.2f}, plastic drift {history.plastic_drift.item() * 1e3:.1f} mm")
yielding, friction = history.column_energy.item(), history.dissipated_energy.item()
print(f"energy: columns {yielding / 1e3:.1f} kJ, damper {friction / 1e3:.1f} kJ")
assert history.energy_error < 1e-9

figure, axis = plt.subplots(figsize=(6, 4), layout="constrained")
axis.plot(1e3 * history.drift[:, 0], 1e-3 * history.column_shear[:, 0], lw=0.8, label="columns")
axis.plot(1e3 * history.drift[:, 0], 1e-3 * history.friction_force[:, 0], lw=0.8, label="damper")
axis.set(xlabel="drift, mm", ylabel="force, kN")
axis.legend()
plt.show()

# %% [markdown]
# Now all slip forces at once. A weak damper leaves the work to the columns, a strong one never slips and only
# stiffens the frame.

# %%
ratio = np.array([0.02, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0, 5.0])
cube = fdspec.sweep(
    motions,
    period=[frame["period"]],
    stiffness_ratio=[frame["stiffness_ratio"]],
    pretension=ratio * columns["yield_shear"],
    friction_coefficient=1.0,
    floor_mass=frame["floor_mass"],
    damping_ratio=frame["damping_ratio"],
    **columns,
)
assert (cube.status == 0).all()
best = ratio[cube.ductility.squeeze().mean("record").values.argmin()]
print(f"least mean ductility at a slip force of {best:g} times the yield shear")

figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
for record in cube.record.values:
    one = cube.sel(record=record).squeeze()
    left.semilogx(ratio, one.ductility, "o-", label=record)
    right.semilogx(ratio, one.column_energy / (one.column_energy + one.dissipated_energy), "o-", label=record)
left.set(xlabel="slip force over yield shear", ylabel="ductility of the columns")
right.set(xlabel="slip force over yield shear", ylabel="share of the columns in the energy dissipated")
left.legend()
plt.show()
