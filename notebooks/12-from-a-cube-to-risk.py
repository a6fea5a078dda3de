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
# # From a cube to risk
#
# A pretension that is best for one scenario is not the one that is exceeded least often in the life of a
# building: weak earthquakes are many, strong ones few. How far do the two lie apart? A cube over intensity
# holds the answer, for every frame in it.

# %%
import matplotlib.pyplot as plt
import numpy as np

import fdspec
from fdspec.figures.inelastic import plot_fragility, plot_ida
from fdspec.measures.dynamic_curves import ida_curves
from fdspec.measures.fragility import fragility_curve
from fdspec.measures.risk import hazard_curve, least_risk

NAMES = ["FSR1", "FSR2", "FSR3", "FMR1", "FMR2", "FMR3", "FHR1", "FHR2", "FHR3"]
motions = [fdspec.load_record(name) for name in NAMES]
HEIGHT, LIMIT = 3.5, 0.005  # m; drift ratio at which partitions are damaged

cube = fdspec.sweep(
    motions,
    period=0.5,
    stiffness_ratio=4,
    pretension=np.geomspace(10e3, 500e3, 40),
    intensity=[0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.25, 1.6, 2.0, 2.5, 3.2, 4.0],
    outputs=["peak_displacement"],
).squeeze(["period", "stiffness_ratio"], drop=True)

# %% [markdown]
# ## Demand over intensity
#
# Each grey line is a record, scaled up from a tenth to four times itself. For a frame whose strengths can
# all be scaled this needs no new mechanics: the response to a record twice as strong is twice that of a
# damper half as strong.

# %%
near = cube.sel(pretension=100e3, method="nearest")
plot_ida(ida_curves(near, demand="peak_displacement"), limit=LIMIT * HEIGHT)

# %% [markdown]
# ## Fragility
#
# A lognormal curve by maximum likelihood. The measure of intensity is the peak ground acceleration of each
# history. The band counts records, not histories: fifteen intensities of one record are not independent.

# %%
fit = fdspec.fragility(cube, demand="peak_displacement", limit=LIMIT * HEIGHT, measure="pga")
one = fit.sel(pretension=near.pretension)
print(f"median {one['median'].item():.2f} m/s2, dispersion {one['dispersion'].item():.2f}")
plot_fragility(one)

# %% [markdown]
# ## Annual rate
#
# The hazard here is a plain power of the peak ground acceleration; `fdspec fragility --hazard site.csv`
# takes one from a file.

# %%
levels = np.geomspace(0.2, 20.0, 25)  # m/s2
hazard = hazard_curve(levels, 2e-3 * (levels / 2.0) ** -2.3)
rates = fdspec.risk(fit, hazard)
best = least_risk(cube, fit, hazard)
print(f"least annual rate {best.least_rate.item():.2e} at {best.by_risk.item() / 1e3:.0f} kN")
print(f"least mean drift of the scenario at {best.by_scenario.item() / 1e3:.0f} kN, where the annual rate is")
print(f"{best.rate_by_scenario.item():.2e}: the two pretensions lie a factor {best.apart.item():.2f} apart")

figure, (left, right) = plt.subplots(1, 2, figsize=(9.5, 3.8), layout="constrained")
left.loglog(cube.pretension / 1e3, rates.annual_rate, color="#0072B2")
left.axvline(best.by_risk.item() / 1e3, color="#0072B2", linestyle="--", linewidth=0.9, label="least risk")
left.axvline(best.by_scenario.item() / 1e3, color="#D55E00", linestyle=":", label="least mean drift")
left.set_xlabel("pretension, kN")
left.set_ylabel("annual rate of exceedance")
left.legend(frameon=False)
share = rates.deaggregation.sel(pretension=best.by_risk)
middle = np.sqrt(share.segment_from * share.segment_to)
right.bar(middle, 100 * share, width=0.15 * middle, color="#009E73")
right.set_xscale("log")
right.set_xlabel("peak ground acceleration, m/s²")
right.set_ylabel("share of the rate, %")
plt.show()

# %% [markdown]
# The right panel says which earthquakes the rate comes from. A curve with its band at any intensity is one
# call away:

# %%
print(fragility_curve(one, [1.0, 2.0, 4.0]).to_dataframe()[["low", "probability", "high"]].round(3))
