"""What a choice says, sentence by sentence: the same in text and on the page."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fdspec.measures.indices import name_of
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr

STATISTIC: Final = {"mean": "mean", "median": "median", "p84": "84th percentile", "worst": "largest"}

CASES: Final = {
    "bare": "bare frame",
    "braced": "braced, never slips",
    "chosen": "recommended",
    "lower": "lower bound of friction",
    "upper": "upper bound of friction",
}


def parameters(choice: xr.Dataset) -> dict[str, Any]:
    """What the choice was asked for."""
    told: dict[str, Any] = json.loads(choice.attrs["parameters"])
    return told


def kilonewtons(forces: Any) -> str:
    """Write forces (N) of one or of many storeys in kN, the lowest first; one number where all are equal."""
    values = np.atleast_1d(forces) / 1e3
    return listed(values, lambda value: "no limit" if np.isinf(value) else rounded(value))


def rounded(value: float) -> str:
    """Write a number with three digits, and all of those before the point."""
    return f"{value:.3g}" if abs(value) < 999.5 else f"{value:.0f}"


def listed(values: Any, write: Callable[[float], str]) -> str:
    """Write one number or many, and many that are equal once."""
    given = values[:1] if (values == values[0]).all() else values
    return ", ".join(write(float(value)) for value in given)


def percent(share: float) -> str:
    """Write a share as whole per cents, with the sign that a reduction has."""
    return f"{100.0 * share:.0f} %"


def index_name(choice: xr.Dataset) -> str:
    """The index as a person reads it: mean acceleration index."""
    asked = parameters(choice)
    return f"{STATISTIC[asked['statistic']]} {name_of(asked['index'])} index".replace("_", " ")


def recommendation(choice: xr.Dataset) -> list[tuple[str, str]]:
    """(Head, sentence) of the answer."""
    asked = parameters(choice)
    start, end = (choice["band_pretension"].sel(bound=bound).values for bound in ("start", "end"))
    index = {case: float(choice["index"].sel(case=case)) for case in CASES}
    stiffness = listed(choice["brace_stiffness"].values / 1e6, rounded)
    pretension, carried = choice["pretension"].values, choice["brace_force"].values
    return [
        (
            "Pretension",
            (
                f"{kilonewtons(pretension)} kN{_where(pretension)} (slip force "
                f"{kilonewtons(choice['slip_force'].values)} kN)"
            ),
        ),
        ("Band", f"{_range(start, end)}: {index_name(choice)} within {percent(asked['band'])} of its least"),
        (
            "Gain",
            (
                f"{index_name(choice)} {index['chosen']:.3g}: {_against(index['chosen'], 1.0)} the bare "
                f"frame's 1, {_against(index['chosen'], index['braced'])} that of a brace that never slips, "
                f"{index['braced']:.3g}"
            ),
        ),
        ("Brace", f"{stiffness} MN/m; must carry {kilonewtons(carried)} kN{_where(carried)}"),
        ("Other braces", _other_braces(choice)),
        ("Worst record", _worst(choice)),
        ("What limits it", limits(choice)),
        ("Bounds", _bounds(choice)),
        ("Left at the end", _residual(choice)),
    ]


def _where(forces: Any) -> str:
    if forces.size == 1:
        return ""
    return " in each storey" if (forces == forces[0]).all() else " in the storeys from the ground up"


def _range(start: Any, end: Any) -> str:
    if np.isinf(end).all():
        return f"{kilonewtons(start)} kN and more"
    if start.size == 1 or (start == start[0]).all():
        return f"{kilonewtons(start)} to {kilonewtons(end)} kN"
    return f"from ({kilonewtons(start)}) to ({kilonewtons(end)}) kN"


def _against(index: float, other: float) -> str:
    share = 1.0 - index / other
    return f"{percent(abs(share))} {'below' if share >= 0.0 else 'above'}"


def _other_braces(choice: xr.Dataset) -> str:
    others = choice.sel(stiffness_scale=choice["stiffness_scale"] != 1.0)
    told = [
        f"{scale:.3g} times as stiff: index {index:.3g} at {kilonewtons(pretension)} kN"
        for scale, index, pretension in zip(
            others["stiffness_scale"].values,
            others["scaled_index"].values,
            others["scaled_pretension"].values,
            strict=True,
        )
    ]
    return "; ".join(told) or "none compared"


def worst_record(choice: xr.Dataset) -> str:
    """The record with the largest index at the recommendation."""
    index = choice["index_of_record"].sel(case="chosen").values
    return str(choice["record"].values[int(index.argmax())])


def _worst(choice: xr.Dataset) -> str:
    at = choice.sel(case="chosen", record=worst_record(choice))
    return (
        f"{worst_record(choice)}: index {at['index_of_record'].item():.3g}, acceleration "
        f"{at['peak_acceleration'].item() / G:.3g} g, drift {at['peak_drift'].item() * 1e3:.3g} mm, "
        f"base shear {at['peak_base_shear'].item() / 1e3:.3g} kN"
    )


def limits(choice: xr.Dataset) -> str:
    """Why it is no better: which records pull the pretension down, and which up."""
    sizes = choice["trial_pretension"].sum("storey").values
    chosen = float(choice["pretension"].sum())
    if chosen == 0.0:
        return "no friction is best: every pretension tried makes it worse than a brace that slides freely"
    if float(choice["index"].sel(case="braced")) <= float(choice["index"].sel(case="chosen")):
        return "the damper adds nothing: a brace that never slips is as good"
    own = sizes[choice["trial_index_of_record"].values.argmin(axis=0)]
    near = float(parameters(choice)["band"])
    names = choice["record"].values
    regret = choice["regret"].values
    less = [
        str(name) for name, at, lost in zip(names, own, regret, strict=True) if at < chosen and lost > near
    ]
    more = [
        str(name) for name, at, lost in zip(names, own, regret, strict=True) if at > chosen and lost > near
    ]
    said = []
    if less:
        said.append(f"less would serve {', '.join(less)}, for which the damper sticks too much")
    if more:
        said.append(f"more would serve {', '.join(more)}, for which friction takes too little")
    if not said:
        return (
            f"every record is within {percent(near)} of its own best: the brace does, not how records differ"
        )
    lost = choice["record"].values[int(regret.argmax())]
    most = percent(float(regret.max()))
    return f"the records differ: {'; '.join(said)}; {lost} loses most, {most} of its best"


def _bounds(choice: xr.Dataset) -> str:
    asked = parameters(choice)
    index = {case: float(choice["index"].sel(case=case)) for case in CASES}
    peak = choice["peak_acceleration"].max("record") / G
    drift = choice["peak_drift"].max("record") * 1e3
    told = [
        f"friction {asked[case]:.3g} times: index {index[case]:.3g}, acceleration up to "
        f"{float(peak.sel(case=case)):.3g} g, drift up to {float(drift.sel(case=case)):.3g} mm"
        for case in ("lower", "upper")
    ]
    return "; ".join(told)


def _residual(choice: xr.Dataset) -> str:
    left = choice["residual_drift"].sel(case="chosen")
    record = choice["record"].values[int(left.values.argmax())]
    return f"at most {float(left.max()) * 1e3:.2g} mm ({record}), at the last sample of the record"


def assumptions(choice: xr.Dataset) -> list[str]:
    """What the answer takes for granted."""
    asked = parameters(choice)
    masses = listed(np.array(asked["floor_mass"]) / 1e3, lambda mass: f"{mass:.4g}")
    braces = listed(np.array(asked["brace_mass"]), lambda mass: f"{mass:.4g}")
    kinetic = asked["kinetic_ratio"]
    friction = "equal static and kinetic friction"
    if min(kinetic) < 1.0:
        friction = f"kinetic friction {listed(np.array(kinetic), rounded)} times the static"
    distribution = {
        "uniform": "one slip force for all storeys",
        "shear": "slip forces in proportion to the storey shears of the braced building",
        "free": f"a slip force of its own in each storey (differential evolution, seed {asked['seed']})",
    }[asked["distribution"]]
    coefficient, factor = asked["friction_coefficient"], asked["normal_force_factor"]
    return [
        f"Floors of {masses} t, braces of {braces} kg; the frame stays elastic, the brace does not buckle.",
        f"Coulomb friction: {friction}, the same at every speed and after every cycle.",
        f"Pretension is slip force / ({coefficient:.3g} x {factor:.3g}), friction and normal force factor.",
        *([f"The dampers have {distribution}."] if choice.sizes["storey"] > 1 else []),
        (
            f"The ground moves in one direction; {choice.sizes['record']} records, as recorded or scaled, "
            "stand for what may come, and each weighs the same."
        ),
        f"{choice.sizes['trial']} pretensions were tried; each history is exact, none is interpolated.",
        (
            "Bounds: the slip force as a whole times the lower and the upper property modification factor, "
            "as ASCE/SEI 7 chapter 18 asks of damping systems; the factors are the user's."
        ),
        *stand_ins(choice),
    ]


def stand_ins(choice: xr.Dataset) -> list[str]:
    """What the comment of the Dataset says of its records."""
    comment = choice.attrs.get("comment", "")
    return [comment] if comment else []
