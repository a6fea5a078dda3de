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
# # First steps
#
# One frame under one record, then the choice of its damper.

# %%
import matplotlib.pyplot as plt

import fdspec

# %% [markdown]
# ## One history
#
# A frame of 20 t and 0.5 s with a brace four times as stiff as its columns, and a damper that slips at
# 50 kN. `FSR1` is a record of the Kobe earthquake that stands in for the study's, scaled to its peak ground
# acceleration.

# %%
motion = fdspec.load_record("FSR1")
frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=50e3)
history = fdspec.simulate(frame, motion, dt_out=1e-3).squeeze("storey")
print(f"peak ground acceleration    {motion.pga:5.2f} m/s2")
print(f"peak absolute acceleration  {history.peak_acceleration.item():5.2f} m/s2")
print(f"changes of phase            {history.transitions.item():5d}")

# %% [markdown]
# The damper sticks until the force in it reaches 50 kN; the area of the loops is the energy it burns.

# %%
slip = history.displacement - history.brace_displacement
figure, (over_time, loop) = plt.subplots(1, 2, figsize=(10, 3.5), width_ratios=(2, 1), layout="constrained")
over_time.plot(history.time, 1e3 * history.displacement, lw=0.8)
over_time.set(xlabel="time, s", ylabel="floor, mm", xlim=(0, 25))
loop.plot(1e3 * slip, 1e-3 * history.friction_force, lw=0.5)
_ = loop.set(xlabel="slip, mm", ylabel="friction force, kN")

# %% [markdown]
# Where the energy of the earthquake went, and how well the terms, each computed on its own, add up.

# %%
figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
terms = ("friction_energy", "viscous_energy", "strain_energy", "kinetic_energy")
axes.stackplot(history.time, [1e-3 * history[term] for term in terms], labels=terms)
axes.plot(history.time, 1e-3 * history.input_energy, "k", lw=1, label="input_energy")
axes.set(xlabel="time, s", ylabel="kJ", xlim=(0, 25))
_ = axes.legend(loc="upper left")
print(f"energy error {history.energy_error.item():.1e} of the input")

# %% [markdown]
# ## The choice of the damper
#
# Peak acceleration over the pretension, for three braces. At the left the damper slides almost freely, at
# the right it hardly ever does; in between lies the pretension one wants.

# %%
cube = fdspec.sweep(
    [motion],
    period=[0.3, 0.5, 1.0],
    pretension=[10e3 * k for k in range(1, 61)],
    stiffness_ratio=[1, 4, 10],
)
panels = cube.peak_acceleration.sel(record="FSR1").assign_coords(pretension=1e-3 * cube.pretension)
panels.pretension.attrs = {"long_name": "pretension", "units": "kN"}
_ = panels.plot.line(x="pretension", hue="stiffness_ratio", col="period", figsize=(11, 3.5))

# %%
cube.peak_acceleration.idxmin("pretension").squeeze("record").to_pandas()
