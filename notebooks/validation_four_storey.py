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
# # Validation: four-storey steel frame
#
# The study's second validation problem (its Figures 5 and 6): a moment-resisting frame of four storeys,
# each with a brace and a friction damper; bare frame beside damped frame.
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

from fdspec.validation import four_storey, kalamata

PATH = None  # "kalamata_ns.txt"
motion = kalamata.stand_in() if PATH is None else kalamata.read_kalamata(PATH, units="m/s2", dt=kalamata.DT)
building = four_storey.building()
print(building)
stiffness, brace = 1e-6 * building.storey_stiffness[0], 1e-6 * building.brace_stiffness[0]
print(f"storeys {stiffness:.2f} MN/m, braces {brace:.2f} MN/m")

# %% [markdown]
# ## Bare frame and damped frame

# %%
bare, damped = four_storey.solve(motion)
figure, panels = plt.subplots(4, 1, figsize=(9, 8), sharex=True, sharey=True, layout="constrained")
for panel, storey in zip(panels, (4, 3, 2, 1), strict=True):
    panel.plot(bare.time, 1e3 * bare.displacement.sel(storey=storey), color="0.6", lw=0.9, label="bare frame")
    panel.plot(
        damped.time, 1e3 * damped.displacement.sel(storey=storey), color="C0", lw=0.9, label="with dampers"
    )
    panel.set(ylabel=f"floor {storey}, mm")
panels[0].legend(loc="upper right")
_ = panels[-1].set(xlabel="time, s", xlim=(0, 25))

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
# Force over slip in each damper; the area of the loops is what it burns.

# %%
figure, panels = plt.subplots(1, 4, figsize=(11, 3), sharey=True, layout="constrained")
for panel, storey in zip(panels, damped.storey.values, strict=True):
    one = damped.sel(storey=storey)
    panel.plot(1e3 * (one.displacement - one.brace_displacement), 1e-3 * one.friction_force, lw=0.5)
    panel.set(title=f"storey {storey}", xlabel="slip, mm")
_ = panels[0].set(ylabel="friction force, kN")

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
