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
# # One frame up close
#
# **What does a friction damper do during an earthquake, and why must the instants at which it sticks and
# slips be found exactly?**

# %%
import numpy as np

import fdspec
from fdspec.figures import plot_energy, plot_grazing, plot_history, plot_hysteresis, shortest_stick
from fdspec.methods import Newmark

# %% [markdown]
# A frame of 20 t and 0.5 s, a brace of 50 kg four times as stiff as the frame, and a damper that slips at
# 50 kN, under `FSR1`, a record of the Kobe earthquake. `dt_out` says how often the answer is told; no
# number depends on it.

# %%
motion = fdspec.load_record("FSR1")
frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=50e3)
history = fdspec.simulate(frame, motion, dt_out=1e-3)
plot_history(history)

# %% [markdown]
# Until 12 s the damper sticks: floor and brace move as one. Then the force in it reaches 50 kN and it
# slips, here and there for a few hundredths of a second. At 38 s the ground is still, but floor and brace
# have moved apart for good, because the damper stuck before they had come back together. Peaks are those
# of the continuous motion; the largest sample may lie a little below.
#
# ## What the slips burn
#
# Each closed loop of friction force over slip has an area, the energy turned into heat.

# %%
plot_hysteresis(history)

# %% [markdown]
# And this is where the energy of the earthquake went. Every term is computed by its own formula, so that
# the black line lying on the top of the stack is a check of the whole history, not a definition.

# %%
plot_energy(history)

# %%
burned = history.friction_energy[-1] / history.input_energy[-1]
print(f"{burned.item():.0%} of the input burned by friction")
print(f"the balance is off by {history.energy_error.item():.0e} of the input")
assert history.energy_error < 1e-9

# %% [markdown]
# ## A halt of 0.2 ms
#
# The brace is light. While the damper slips it swings on its own, here some eighty times a second, and
# once in each swing the sliding velocity comes back close to zero. It may turn just short of zero, or
# touch it; then the damper holds for a moment, and slips on. Such near misses are not the exception: half
# of the times that this damper sticks, once it has slipped, it does so for two milliseconds or less.

# %%
start, stop = shortest_stick(history)
held = np.diff(history.transition_time)[history.transition_phase[:-1] == 0]
print(f"{history.transitions.item()} changes of phase")
print(f"{held.size} halts, half of them shorter than {1e3 * np.median(held):.1f} ms")
print(f"the shortest: {1e6 * (stop - start):.0f} microseconds from {start:.4f} s")

# %% [markdown]
# The same history until shortly after that halt, told every 5 microseconds, beside the study's own scheme
# with a step of 1 ms. The scheme looks at the ends of its steps alone, and a halt that lies between two
# of them is not there for it. In this picture its brace swings some 3 ms late, for halts that it passed
# over before, and in single steps its friction exceeds the 50 kN.

# %%
until = int(np.ceil((stop + 0.03) / motion.dt)) + 2
short = fdspec.GroundMotion(motion.acceleration[:until], motion.dt, name=motion.name, source=motion.source)
fine = fdspec.simulate(frame, short, dt_out=5e-6)
stepped = fdspec.simulate(frame, short, method=Newmark(dt=1e-3), dt_out=1e-3)
plot_grazing(fine, (start, stop), before=0.02, after=0.03, stepped=stepped)

# %% [markdown]
# ## Why it matters
#
# In the halt the brace takes over the velocity of the floor: its swing starts anew. A scheme that steps
# over the halt keeps the old swing, and friction pulls the wrong way for the rest of the step; from there
# on its brace is out of time. Each halt adds an error of this kind, so that the error of the whole falls
# with the first power of the step and no faster, however good the scheme is between changes. The study
# needs a step of a microsecond for this reason.

# %%
print(f"{'step, s':>8} {'error of the peak':>18} {'changes of phase':>17}")
for dt in (1e-3, 1e-4, 1e-5):
    other = fdspec.simulate(frame, motion, method=Newmark(dt=dt))
    error = (other.peak_acceleration / history.peak_acceleration).item() - 1
    print(f"{dt:8.0e} {error:18.1e} {other.transitions.item():17d}")
print(f"{'exact':>8} {0:18} {history.transitions.item():17d}")

# %% [markdown]
# The floor, four hundred times heavier than the brace, hides most of this. The brace does not: its
# acceleration jumps at each change of phase, and so does the force that it hands on.
#
# How other methods fare: {doc}`methods compared <methods-compared>`. Next: {doc}`the study's nine records
# <03-the-study>`.
