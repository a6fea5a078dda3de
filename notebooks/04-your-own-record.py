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
# # Your own record
#
# **How do I run all this on a record of my own, and what must I check before I believe the answer?**
#
# fdspec reads what agencies publish (PEER, COSMOS, CSMIP, K-NET, ESM, miniSEED and others) and plain
# columns. It tells a format by its content. What a file does not say of itself, its unit or its time
# step, has to be told.

# %%
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import fdspec
from fdspec.figures import plot_record
from fdspec.signals.spectra import elastic_spectra

known = fdspec.load_record("FMR1")
plot_record(known, elastic_spectra([known], np.linspace(0.02, 3.0, 100), [0.05]))

# %% [markdown]
# ## A file with two columns
#
# Yours lies on your disk. This one is written here, so that the page runs anywhere: a pulse of 1.2 s as
# near a fault, with some shaking on top, in cm/s².

# %%
folder = Path(tempfile.mkdtemp())
path = folder / "pulse.txt"
time = 0.005 * np.arange(4001)
random = np.random.default_rng(7)
pulse = 250.0 * np.exp(-(((time - 5.0) / 1.0) ** 2)) * np.sin(2 * np.pi * (time - 5.0) / 1.2)
shaking = np.convolve(random.normal(size=time.size), np.hanning(12), "same") * np.exp(
    -(((time - 6.0) / 3.0) ** 2)
)
samples = pulse + 25.0 * shaking
np.savetxt(path, np.column_stack([time, samples]), header="time, s   acceleration, cm/s2")
print("".join(path.read_text().splitlines(keepends=True)[1000:1004]))

# %%
motion = fdspec.read_record(path, units="cm/s2", name="pulse")
print(motion)

# %% [markdown]
# ## Look at it first
#
# Is the peak what it should be? Does the motion end at rest? Is there energy where your frame is? A wrong
# unit shows here, and a record whose peak is over 5 g draws a warning.

# %%
spectra = elastic_spectra([motion], np.linspace(0.02, 3.0, 150), [0.02, 0.05])
plot_record(motion, spectra)

# %% [markdown]
# ## A small study
#
# One frame of 30 t, three braces, pretensions up to 400 kN. The record is named by its path or handed
# over as here; a catalogue record runs beside it, to compare.

# %%
cube = fdspec.sweep(
    [motion, fdspec.load_record("FSR1")],
    floor_mass=30e3,
    period=[0.3, 0.6, 0.9, 1.2, 1.5],
    pretension=[5e3 * k for k in range(1, 81)],
    stiffness_ratio=[2, 4, 8],
)
assert (cube.status == 0).all()

# %% [markdown]
# Each line below is the response of one frame over pretension, divided by that of the frame without
# damper. Where it is below 1 the damper helps; the lowest point is the pretension to choose, and a flat
# valley means that a bolt which loses some force does little harm.

# %%
figure, panels = plt.subplots(1, 2, figsize=(10, 3.8), sharey=True, layout="constrained")
ratio = cube.peak_acceleration.sel(stiffness_ratio=4) / cube.elastic_acceleration
for panel, record in zip(panels, cube.record.values, strict=True):
    for period in cube.period.values:
        panel.plot(1e-3 * cube.pretension, ratio.sel(record=record, period=period), label=f"{period:g} s")
    panel.axhline(1.0, color="0.5", ls="--", lw=0.8)
    panel.set(title=f"{record}, stiffness ratio 4", xlabel="pretension, kN", xlim=(0, 400), ylim=(0, None))
panels[0].set_ylabel("response over free frame's")
_ = figure.legend(
    *panels[0].get_legend_handles_labels(), title="period", loc="outside right center", frameon=False
)

# %%
best = ratio.idxmin("pretension") / 1e3
best.to_pandas().rename_axis(columns="best pretension in kN at period, s")

# %% [markdown]
# The two records ask for different pretensions, and for some frames one of them for none at all. One
# record is no ground to choose a damper on: take several, and look at the worst.

# %%
worst = cube.peak_acceleration.max("record")
choice = worst.sel(period=0.6, method="nearest").sel(stiffness_ratio=4)
force = choice.idxmin("pretension").item()
print(f"0.6 s, SR 4: {force / 1e3:.0f} kN, at most {choice.min().item():.2f} m/s2 under both records")

# %% [markdown]
# ## The same as a study file
#
# ```toml
# records = ["FSR1", { path = "pulse.txt", units = "cm/s2", name = "pulse" }]
# floor_mass = 30e3
# stiffness_ratio = [2, 4, 8]
# pretension = { start = 5e3, stop = 400e3, step = 5e3 }
# period = [0.3, 0.6, 0.9, 1.2, 1.5]
# ```
#
# `fdspec sweep mine.toml -o mine.nc` makes the cube, `fdspec figures mine.nc` draws it. Such a file is
# checked as a whole, and reads the very same motion:

# %%
text = """
records = [{ path = "pulse.txt", units = "cm/s2", name = "pulse" }]
floor_mass = 30e3
stiffness_ratio = [4]
pretension = { start = 5e3, stop = 400e3, step = 5e3 }
period = [0.6]
"""
study = fdspec.Study.parse(text, folder=folder)
(again,) = study.motions()
assert again.checksum == motion.checksum

# %% [markdown]
# Next: {doc}`four storeys <05-four-storeys>`.
