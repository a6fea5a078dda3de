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
# # Inelastic spectra, and why a step is not enough
#
# How strong must an oscillator be so that an earthquake stretches it to no more than four times its yield
# displacement? The answer over period is an inelastic spectrum. Most programs get it by stepping through
# the record; here the yields and unloadings are located instead, and the peaks are those of the continuous
# motion.

# %%
import matplotlib.pyplot as plt
import numpy as np

import fdspec
from fdspec.engines.bilinear import Oscillator, bilinear_peaks
from fdspec.figures.inelastic import plot_inelastic_spectra
from fdspec.runs.inelastic_spectra import inelastic_spectra

NAMES = ["FSR1", "FSR2", "FSR3", "FMR1", "FMR2", "FMR3", "FHR1", "FHR2", "FHR3"]
motions = [fdspec.load_record(name) for name in NAMES]
spectra = inelastic_spectra(motions, np.geomspace(0.1, 3.0, 30), ductility=[2, 4, 8])
plot_inelastic_spectra(spectra)

# %% [markdown]
# ## More than one strength
#
# Ductility does not fall steadily as strength rises: a stronger oscillator yields later, at another moment
# of the record, and may end up further out. So a ductility can belong to several strengths. The spectrum
# takes the largest of them, above which the ductility is never exceeded; `root_strength` has them all.

# %%
many = int((spectra.roots > 1).sum())
print(f"{many} of {spectra.roots.size} cells have more than one strength, at most {int(spectra.roots.max())}")

record, period, target = (
    str(spectra.record[i].item()) if dim == "record" else spectra[dim][i].item()
    for dim, i in zip(
        ("record", "period", "ductility_target"),
        np.unravel_index(int(spectra.roots.values.argmax()), spectra.roots.shape),
        strict=True,
    )
)
motion = fdspec.load_record(record)
oscillator = Oscillator(damping_ratio=0.05, hardening_ratio=0.0, collapse_ductility=np.inf)
cell = spectra.sel(record=record, period=period, ductility_target=target)
elastic = cell.elastic_strength.item()
strength = elastic * np.geomspace(0.5 * cell.root_strength.min().item() / elastic, 1.0, 600)
ductility = bilinear_peaks(oscillator, period, strength, motion)[:, 0] * (2 * np.pi / period) ** 2 / strength

figure, axis = plt.subplots(figsize=(7, 3.6), layout="constrained")
axis.semilogx(strength / 9.80665, ductility, color="#0072B2")
axis.set_xticks([0.03, 0.05, 0.1, 0.2], ["0.03", "0.05", "0.1", "0.2"])
axis.set_xticks([], minor=True)
axis.axhline(target, color="0.4", linewidth=0.8, linestyle="--")
roots = cell.root_strength.values[np.isfinite(cell.root_strength.values)]
axis.plot(roots / 9.80665, np.full(roots.size, target), "o", color="#D55E00")
axis.set_xlabel("strength over weight")
axis.set_ylabel("ductility")
axis.set_title(
    f"{record}, period {period:.2f} s: ductility {target:g} at {roots.size} strengths", fontsize="medium"
)
plt.show()

# %% [markdown]
# ## What a step costs
#
# A stepped program, here Newmark's average acceleration with one step a sample and the spring's force
# brought back to its limit at the end of each step, overshoots every yield and sees each peak at samples
# only. Its error does not fall with care, but with the step.


# %%
def stepped(motion, periods, strength, parts=1):
    """Peak displacement by Newmark's average acceleration, all periods at once, elastoplastic, 5 %."""
    ground = np.interp(
        np.arange((motion.n - 1) * parts + 1) / parts, np.arange(motion.n), motion.acceleration
    )
    h = motion.dt / parts
    omega = 2.0 * np.pi / periods
    k, c = omega**2, 0.1 * omega
    u, v, force = np.zeros_like(k), np.zeros_like(k), np.zeros_like(k)
    a = -ground[0] - np.zeros_like(k)
    peak = np.zeros_like(k)
    for g in ground[1:]:
        tangent = np.where(np.abs(force) < strength, k, 0.0)
        for _ in range(20):  # the step again with the stiffness of the mode it ends in
            rate = 4.0 / h**2 + 2.0 * c / h
            push = -g - force + 4.0 / h * v + a + c * v
            step = push / (rate + tangent)
            trial = np.clip(force + k * step, -strength, strength)
            secant = np.where(step != 0.0, (trial - force) / np.where(step == 0.0, 1.0, step), k)
            if np.allclose(secant, tangent, rtol=1e-12):
                break
            tangent = secant
        new_v = 2.0 * step / h - v
        a = 4.0 * step / h**2 - 4.0 * v / h - a
        u, v, force = u + step, new_v, trial
        peak = np.maximum(peak, np.abs(u))
    return peak


# %%
motion = fdspec.load_record("FSR1")
periods = np.geomspace(0.1, 3.0, 60)
exact = inelastic_spectra(motion, periods, reduction_factor=4)
strength = exact.strength.values[0, :, 0]
truth = np.array(
    [
        bilinear_peaks(oscillator, T, np.array([f]), motion)[0, 0]
        for T, f in zip(periods, strength, strict=True)
    ]
)

figure, axis = plt.subplots(figsize=(7, 3.6), layout="constrained")
for parts, colour in ((1, "#D55E00"), (4, "#E69F00"), (16, "#0072B2")):
    error = np.abs(stepped(motion, periods, strength, parts) / truth - 1.0)
    label = f"dt {1e3 * motion.dt / parts:.3g} ms: worst {100 * error.max():.2g} %"
    axis.loglog(periods, 100 * np.maximum(error, 1e-6), color=colour, label=label)
axis.set_xlabel("period, s")
axis.set_ylabel("error of the peak displacement, %")
axis.legend(frameon=False)
axis.set_title(
    f"{motion.name}, elastic strength over 4: a stepped program against the exact motion", fontsize="medium"
)
plt.show()

# %% [markdown]
# ## The spring that loses force
#
# A negative hardening ratio is gravity's pull, or a spring that softens. Beyond the displacement at which
# its force is used up nothing holds the oscillator; such a history has the status `collapsed`.

# %%
for hardening in (0.05, 0.0, -0.02, -0.05):
    one = inelastic_spectra(motions, [0.5], reduction_factor=[2, 4, 6], hardening_ratio=hardening)
    collapsed = (one.status == 1).sum("record").values.ravel().tolist()
    median = one.ductility.where(one.status == 0).median("record").values.ravel()
    print(f"hardening {hardening:5.2f}: median ductility {np.round(median, 1)}, collapsed {collapsed} of 9")
