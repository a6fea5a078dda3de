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
# # Validation: single-storey frame with K bracing
#
# **What of the study's first validation problem is known, what has to be assumed, and what comes out?**
#
# The problem (the study's Figure 4) is a frame with an additional, K-braced frame inside,
# joined by a friction joint. It plots the displacement of the additional frame.
#
# - **printed**: frame 20 000 kg and 0.4 s; additional frame 27 kg and 0.0684 s; friction coefficient
#   0.15; damping 2 %; NS component of Kalamata, 13 September 1986, dt 0.00976 s, PGA 0.240 g
# - **not printed**: the normal force in the joint; which masses the periods belong to; whether the 2 %
#   hold for the additional frame
# - **assumed here**: a normal force of 10 kN; each period is that of its frame standing by itself; the
#   additional frame is undamped; static and kinetic friction are equal
# - **excitation here**: a stand-in, since the record cannot be shipped: Corralitos (Loma Prieta 1989),
#   scaled to 0.240 g
#
# The curves are therefore like the study's, not the study's. With the record at hand, put its path here.

# %%
import matplotlib.pyplot as plt
import numpy as np

from fdspec.validation import kalamata, single_storey_k_braced

PATH = None  # "kalamata_ns.txt"
motion = kalamata.stand_in() if PATH is None else kalamata.read_kalamata(PATH, units="m/s2", dt=kalamata.DT)
print(motion, *motion.history, sep="\n  ")

# %% [markdown]
# ## Bare frame and damped frame

# %%
pair = single_storey_k_braced.solve(motion)
bare, damped = (history.squeeze("storey") for history in pair)
end = min(float(damped.time[-1]), 15.0)

figure, (floor, brace) = plt.subplots(2, 1, figsize=(9, 5.5), sharex=True, layout="constrained")
floor.plot(bare.time, 1e3 * bare.displacement, color="0.6", lw=0.9, label="bare frame")
floor.plot(damped.time, 1e3 * damped.displacement, color="C0", lw=0.9, label="with friction joint")
floor.set(ylabel="frame, mm")
floor.legend(loc="upper right")
brace.plot(damped.time, 1e3 * damped.brace_displacement, color="C3", lw=0.7)
_ = brace.set(xlabel="time, s", ylabel="additional frame, mm", xlim=(0, end))

# %%
print(f"peak displacement of the frame            {1e3 * bare.peak_displacement.item():6.2f} mm bare")
print(f"                                          {1e3 * damped.peak_displacement.item():6.2f} mm damped")
print(
    f"peak displacement of the additional frame {1e3 * abs(damped.brace_displacement).max().item():6.2f} mm"
)
print(f"changes of phase                          {damped.transitions.item():6d}")
print(f"energy error                              {damped.energy_error.item():.1e} of the input")

# %% [markdown]
# While the joint slips, the additional frame rings about the displacement at which its spring carries the
# friction force, 1.5 kN over 228 kN/m, 6.6 mm; while it sticks, it goes with the frame.
#
# ## The normal force that is not printed
#
# Between a joint that slides freely and one that never does, the additional frame goes from rest to the
# frame's own motion. The frame itself hardly cares: the brace has 5 % of its stiffness.

# %%
forces = np.linspace(0.0, 40e3, 21)
runs = [single_storey_k_braced.solve(motion, force).damped for force in forces]
figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
peaks = [[1e3 * run.peak_displacement.item(), 1e3 * abs(run.brace_displacement).max().item()] for run in runs]
axes.plot(1e-3 * forces, peaks, label=["frame", "additional frame"])
axes.set(xlabel="normal force, kN", ylabel="peak displacement, mm", ylim=(0, None))
_ = axes.legend()
