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
# # A first cube
#
# **How do I compute the peak response of a frame for many dampers at once, and read the answer?**
#
# The answer is a cube: one number for every record, stiffness ratio, pretension and period. This page
# makes a small one, reads a best pretension off it, and keeps it in a file.

# %%
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import xarray as xr

import fdspec
from fdspec.figures import plot_sketch

_ = xr.set_options(display_expand_data=False)  # what is in a cube, not its numbers
plot_sketch()

# %% [markdown]
# ## One record, three braces, three frames
#
# `FSR1` is a record of the Kobe earthquake. The study's own file cannot be shipped, so this is another
# real record of the same earthquake, scaled to the study's peak ground acceleration; the motion says so.

# %%
motion = fdspec.load_record("FSR1")
print(motion.source)
print(f"{motion.n} samples, {motion.dt} s apart, peak {motion.pga:.2f} m/s2, times {motion.scale_factor:.3g}")

# %% [markdown]
# Units are SI: pretension in newtons, period in seconds. The period is that of the frame without its
# brace, the stiffness ratio that of brace over frame, and the damper slips at half its pretension
# (friction coefficient 0.5).

# %%
cube = fdspec.sweep(
    [motion],
    period=[0.3, 0.5, 1.0],
    pretension=[10e3 * k for k in range(1, 61)],
    stiffness_ratio=[1, 4, 10],
)
cube.peak_acceleration

# %% [markdown]
# `cube` is an xarray Dataset: select by name and value, reduce, plot. 540 histories took less than a
# second. Each ended well, and the energy of each closes to rounding:

# %%
assert (cube.status == 0).all()
print(
    f"largest energy error of {cube.status.size} histories: {cube.energy_error.max().item():.0e} of the input"
)

# %% [markdown]
# ## The best pretension
#
# At the left the damper slides almost freely, at the right it hardly ever does and the frame is a braced
# one. In between lies the pretension one wants; for a weak brace there is little to gain, for a stiff one
# much.

# %%
figure, panels = plt.subplots(1, 3, figsize=(11, 3.5), sharey=True, layout="constrained")
for panel, period in zip(panels, cube.period.values, strict=True):
    one = cube.sel(record="FSR1", period=period)
    for ratio in cube.stiffness_ratio.values:
        line = one.peak_acceleration.sel(stiffness_ratio=ratio)
        panel.plot(1e-3 * cube.pretension, line, label=f"SR {ratio:g}")
    panel.axhline(one.elastic_acceleration, color="0.5", ls="--", lw=0.8, label="free frame")
    panel.set(title=f"period {period} s", xlabel="pretension, kN", xlim=(0, 600), ylim=(0, None))
panels[0].set_ylabel("peak acceleration, m/s²")
_ = figure.legend(*panels[0].get_legend_handles_labels(), loc="outside right center", frameon=False)

# %%
best = cube.peak_acceleration.idxmin("pretension") / 1e3
best.attrs = {"long_name": "best pretension", "units": "kN"}
best.sel(record="FSR1").to_pandas()

# %% [markdown]
# ## What else is in it
#
# Each history leaves more than one number. Outputs that are not wanted can be left out: `outputs=[...]`.

# %%
for name, variable in cube.data_vars.items():
    print(f"{name:22} {variable.attrs.get('units', ''):6} {variable.attrs['long_name']}")

# %% [markdown]
# ## Keep it
#
# The file is netCDF, readable far beyond Python, and the same bits come back. It carries its own
# provenance.

# %%
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "first.nc"
    fdspec.save(cube, path)
    again = fdspec.open(path).load()
    print(f"{path.stat().st_size / 1e3:.0f} kB")
assert again.identical(cube)
print(again.attrs["history"])
print(again.attrs["comment"])

# %% [markdown]
# On the command line the same is a study file and `fdspec sweep`. Next: {doc}`what a damper does during
# an earthquake <02-one-frame-up-close>`.
