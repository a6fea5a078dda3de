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
# # Four storeys
#
# **What do friction dampers do to a building of several storeys, and what would they do if their bolts
# were tightened more, or not the same in all storeys?**
#
# The building is the study's second validation problem (its Figures 5 and 6): a moment-resisting frame of
# four storeys, each with a brace and a friction damper.
#
# - **printed**: floors 41 610, 41 610, 41 610, 40 820 kg; bracing 23 kg a storey; first period 1.006 s
#   bare and 0.612 s braced; friction coefficient 0.15; damping 2 %; NS component of Kalamata, 13
#   September 1986, dt 0.00976 s, PGA 0.240 g
# - **not printed**: the normal forces; storey and brace stiffnesses
# - **assumed here**: 500 kN of normal force in each damper; all storeys of one stiffness and all braces
#   of another, which the two periods then fix; 2 % in every mode of the bare frame, undamped braces;
#   static and kinetic friction equal
# - **excitation here**: a stand-in, since the record cannot be shipped: Corralitos (Loma Prieta 1989),
#   scaled to 0.240 g
#
# The curves are therefore like the study's, not the study's. With the record at hand, put its path here.

# %%
import matplotlib.pyplot as plt
import numpy as np

import fdspec
from fdspec.figures import plot_bare_and_damped, plot_energy, plot_history, plot_hysteresis, plot_sketch
from fdspec.validation import four_storey, kalamata

PATH = None  # "kalamata_ns.txt"
motion = kalamata.stand_in() if PATH is None else kalamata.read_kalamata(PATH, units="m/s2", dt=kalamata.DT)
building = four_storey.building()
print(building)
stiffness, brace = 1e-6 * building.storey_stiffness[0], 1e-6 * building.brace_stiffness[0]
print(f"storeys {stiffness:.2f} MN/m, braces {brace:.2f} MN/m")
plot_sketch(building)

# %% [markdown]
# ## Bare frame and damped frame

# %%
bare, damped = four_storey.solve(motion)
plot_bare_and_damped(bare, damped, title="Displacement of the floors, the study's Figure 6", end=25)

# %%
table = {
    "bare, mm": 1e3 * bare.peak_displacement,
    "damped, mm": 1e3 * damped.peak_displacement,
    "bare, m/s2": bare.peak_acceleration,
    "damped, m/s2": damped.peak_acceleration,
    "slip travel, mm": 1e3 * damped.slip_travel[-1],
    "transitions": damped.storey_transitions,
}
print("storey         " + "".join(f"{storey:9d}" for storey in damped.storey.values))
for name, values in table.items():
    print(f"{name:15s}" + "".join(f"{value:9.2f}" for value in values.values))
print(f"energy error {damped.energy_error.item():.1e} of the input")

# %% [markdown]
# ## The dampers at work
#
# Force over slip in each damper; the area of the loops is what it burns, written above each.

# %%
plot_hysteresis(damped)

# %%
plot_energy(damped)

# %% [markdown]
# Storeys decide by themselves when to stick and when to slip. The first one up close:

# %%
plot_history(damped, storey=1)

# %% [markdown]
# ## The normal forces that are not printed
#
# From dampers that slide freely, the bare frame but for 23 kg a storey, to dampers that never slip.

# %%
forces = np.concatenate([np.linspace(0.0, 1.5e6, 16), [4e6]])
runs = [four_storey.solve(motion, force).damped for force in forces]
figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
roof = [1e3 * run.peak_displacement[-1].item() for run in runs]
axes.plot(1e-3 * forces[:-1], roof[:-1], "o-", ms=3, label="roof")
axes.axhline(roof[0], color="0.6", ls="--", lw=0.8, label="free")
axes.axhline(roof[-1], color="0.6", ls=":", lw=0.8, label="stuck")
axes.set(xlabel="normal force in each damper, kN", ylabel="peak displacement, mm", ylim=(0, None))
_ = axes.legend()

# %% [markdown]
# ## Not the same in all storeys
#
# Storey shear falls towards the roof, so that equal dampers serve the lower storeys and hardly slip in
# the top one. `sweep_buildings` takes several buildings at once, here three distributions over the height
# with the same sum of slip forces, each scaled from nothing to three times.

# %%
shapes = {
    "equal": np.array([1.0, 1.0, 1.0, 1.0]),
    "falling": np.array([1.6, 1.2, 0.8, 0.4]),
    "as shear": np.array([1.0, 0.9, 0.7, 0.4]) / 0.75,
}
buildings = {name: four_storey.building(shape * four_storey.NORMAL_FORCE) for name, shape in shapes.items()}
cube = fdspec.sweep_buildings(motion, buildings, slip_scale=np.linspace(0.0, 3.0, 31), stiffness_scale=[1.0])
assert (cube.status == 0).all()
drift = 1e3 * cube.peak_drift.max("storey").sel(stiffness_scale=1.0).squeeze("record")
roof = cube.peak_acceleration.sel(storey=4, stiffness_scale=1.0).squeeze("record")

figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.6), layout="constrained")
for name in shapes:
    left.plot(cube.slip_scale, drift.sel(building=name), label=name)
    right.plot(cube.slip_scale, roof.sel(building=name))
left.set(ylabel="largest storey drift, mm", ylim=(0, None))
right.set(ylabel="peak acceleration of the roof, m/s²", ylim=(0, None))
for panel in (left, right):
    panel.set(xlabel="factor on the slip forces", xlim=(0, 3))
_ = figure.legend(*left.get_legend_handles_labels(), loc="outside right center", frameon=False)

# %%
best = drift.idxmin("slip_scale")
for name in shapes:
    least = drift.sel(building=name).min().item()
    force = (
        best.sel(building=name).item() * cube.slip_force.sel(building=name, slip_scale=1.0).sum().item() / 1e3
    )
    print(f"{name:9} least drift {least:5.2f} mm with slip forces of {force:5.0f} kN in all")

# %% [markdown]
# Drift and acceleration do not ask for the same dampers. What one gains on either hand: {doc}`choosing a
# pretension <06-choosing-a-pretension>`; how to search the distribution instead of guessing it:
# {doc}`slip forces of four storeys <07-slip-forces-of-four-storeys>`.
