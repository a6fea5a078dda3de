"""What a choice says, sentence by sentence: the same in text and on the page."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fdspec.choice.targets import target_of
from fdspec.measures.ensemble import statistic_of
from fdspec.measures.indices import name_of
from fdspec.report.numbers import kilonewtons, listed, percent, rounded
from fdspec.report.targets import SHOWN, has_limits, limit_sentence, met, missed, stretches
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


def index_name(choice: xr.Dataset) -> str:
    """The index as a person reads it: mean acceleration index."""
    asked = parameters(choice)
    return f"{STATISTIC[asked['statistic']]} {name_of(asked['index'])} index".replace("_", " ")


def recommendation(choice: xr.Dataset) -> list[tuple[str, str]]:
    """(Head, sentence) of the answer."""
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
        *([("Limits", limit_sentence(choice))] if has_limits(choice) else []),
        ("Band", _band(choice, start, end)),
        (
            "Gain",
            (
                f"{index_name(choice)} {index['chosen']:.3g}: {_against(index['chosen'], 1.0)} the bare "
                f"frame's 1, {_against(index['chosen'], index['braced'])} that of a brace that never slips, "
                f"{index['braced']:.3g}"
            ),
        ),
        ("Brace", f"{stiffness} MN/m; must carry {kilonewtons(carried)} kN{_where(carried)}"),
        ("Slot", slots(choice)),
        ("Other braces", _other_braces(choice)),
        ("Worst record", _worst(choice)),
        ("What limits it", limits(choice)),
        ("Bounds", _bounds(choice)),
        ("Left at the end", _residual(choice)),
    ]


def plainly(choice: xr.Dataset) -> str:
    """Say the answer as one would say it to a client."""
    index = {case: float(choice["index"].sel(case=case)) for case in CASES}
    pretension, carried = choice["pretension"].values, choice["brace_force"].values
    start, end = (choice["band_pretension"].sel(bound=bound).values for bound in ("start", "end"))
    which = "each friction damper" if pretension.size > 1 else "the friction damper"
    over = _over(choice)
    if has_limits(choice) and not met(choice):
        return (
            f"No slip force meets all limits: {missed(target_of(choice))}. What comes closest is a total "
            f"pretension of {kilonewtons(pretension)} kN{_where(pretension)}, with which the dampers slip at "
            f"{kilonewtons(choice['slip_force'].values)} kN."
        )
    if float(pretension.max()) == 0.0 and not has_limits(choice):
        return (
            f"Friction does not help here: {over} {_response(choice)} is least when the brace slides freely. "
            "Leave the dampers out."
        )
    return (
        f"Clamp {which} with a total pretension of {kilonewtons(pretension)} kN{_where(pretension)}, so that "
        f"it slips at {kilonewtons(choice['slip_force'].values)} kN. {over[0].upper()}{over[1:]} "
        f"{_response(choice)} is then {_against(index['chosen'], index['bare'])} that of the frame without "
        f"dampers and {_against(index['chosen'], index['braced'])} that of a frame with braces which cannot "
        f"slip. {_others(choice, start, end)} The "
        f"brace and its joints must carry {kilonewtons(carried)} kN{_where(carried)}."
    )


def _band(choice: xr.Dataset, start: Any, end: Any) -> str:
    """Say which pretensions are as good: nearly the least index, or within all limits."""
    if not has_limits(choice):
        near = percent(parameters(choice)["band"])
        return f"{_range(start, end)}: {index_name(choice)} within {near} of its least"
    if not met(choice):
        return "none: no slip force meets all limits"
    return f"{_range(start, end)}: the lowest pretensions that meet all limits, as slip forces {_met(choice)}"


def _others(choice: xr.Dataset, start: Any, end: Any) -> str:
    if has_limits(choice):
        return f"It is the least that meets all limits; so do all pretensions {_span(start, end)}."
    near = percent(parameters(choice)["band"])
    return f"Any pretension {_span(start, end)} does nearly as well, within {near}."


def _met(choice: xr.Dataset) -> str:
    return stretches(target_of(choice))


def slots(choice: xr.Dataset) -> str:
    """Say how far the dampers slip to either side: the statistic as recommended, the largest of any bound."""
    slip = 1e3 * choice["storey_slip"]
    usual = statistic(choice)(slip.sel(case="chosen").values, axis=0)
    largest = slip.sel(case=["chosen", "lower", "upper"]).max(("case", "record")).values
    which = STATISTIC[parameters(choice)["statistic"]]
    level = choice["storey_level"].item()
    which += "" if level == 1.0 else f", records times {level:g}"
    return (
        f"slips {listed(usual, rounded)} mm to either side{_where(usual)} ({which}); at most "
        f"{listed(largest, rounded)} mm under any record, with friction at its bounds"
    )


def statistic(choice: xr.Dataset) -> Any:
    """Return the statistic over records that the choice was made by, a function of values and axis."""
    return statistic_of(parameters(choice)["statistic"])


OVER: Final = {
    "mean": "on average over",
    "median": "in the median of",
    "p84": "at the 84th percentile of",
    "worst": "in the worst of",
}

RESPONSE: Final = {
    "acceleration": "the peak acceleration of the floors",
    "displacement": "the peak drift",
    "base_shear": "the peak base shear",
    "rpi": "the relative performance index of strain energy",
    "dissipated_energy": "the share of the input energy that friction leaves",
}


def _over(choice: xr.Dataset) -> str:
    """Over which ground motions an index is told, as the start of a sentence."""
    records = choice.sizes["record"]
    if records == 1:
        return f"under {choice['record'].values[0]}"
    return f"{OVER[parameters(choice)['statistic']]} the {records} ground motions"


def _response(choice: xr.Dataset) -> str:
    """What an index is of, in words; a weighted one by its weights."""
    weights = parameters(choice)["index"]
    name = next(iter(weights)) if len(weights) == 1 else ""
    return RESPONSE.get(name, f"the index {name_of(weights)}").replace("_", " ")


def _span(start: Any, end: Any) -> str:
    told = _range(start, end)
    return f"of {told}" if "more" in told or told.startswith("from") else f"from {told}"


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
        f"{at['peak_acceleration'].item() / G:.3g} g, drift {rounded(at['peak_drift'].item() * 1e3)} mm, "
        f"base shear {rounded(at['peak_base_shear'].item() / 1e3)} kN"
    )


def limits(choice: xr.Dataset) -> str:
    """Why it is no better: which records pull the pretension down, and which up."""
    sizes = choice["trial_pretension"].sum("storey").values
    chosen = float(choice["pretension"].sum())
    if has_limits(choice):
        one = target_of(choice).worst
        return (
            f"{SHOWN[one.name].words} at level {one.level:g}, {percent(one.value / one.limit)} of its limit"
        )
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
        f"{float(peak.sel(case=case)):.3g} g, drift up to {rounded(float(drift.sel(case=case)))} mm"
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
