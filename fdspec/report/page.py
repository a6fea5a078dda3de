"""The report of a choice as one page that needs nothing else: no server, no network, no script."""

from __future__ import annotations

import base64
import re
from collections.abc import Sequence
from html import escape
from typing import TYPE_CHECKING, Final

from fdspec.choice.bench import Bench, without_braces
from fdspec.figures import encode, plot_before_after, plot_choice_index, plot_choice_records, plot_history
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.report.findings import (
    CASES,
    assumptions,
    index_name,
    kilonewtons,
    parameters,
    percent,
    recommendation,
    worst_record,
)
from fdspec.report.rows import record_rows
from fdspec.runs.simulate import simulate
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

STYLE: Final = """
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, sans-serif; color: #1a1a1a; background: #fff; margin: 0 auto;
  max-width: 62rem; padding: 1rem; }
h1 { font-size: 1.5rem; line-height: 1.25; } h2 { font-size: 1.2rem; margin-top: 2rem; }
dl { display: grid; grid-template-columns: 10rem 1fr; gap: .35rem 1rem; }
dt { font-weight: 600; } dd { margin: 0; }
.answer { font-size: 1.15rem; border-left: .4rem solid #0072b2; padding: .3rem 1rem; background: #f2f7fb; }
figure { margin: 1rem 0; } img { width: 100%; min-width: 36rem; max-width: 62rem; height: auto; }
figcaption { color: #444; }
.wide { overflow-x: auto; } .wide:focus { outline: 3px solid #0072b2; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: #444; padding-bottom: .4rem; }
th, td { padding: .2rem .6rem; text-align: right; border-bottom: 1px solid #ddd; white-space: nowrap; }
th:first-child { text-align: left; }
footer { margin-top: 2rem; border-top: 1px solid #ccc; color: #444; font-size: .9rem;
  overflow-wrap: anywhere; }
@media (max-width: 40rem) { dl { grid-template-columns: 1fr; gap: 0; } dd { margin-bottom: .6rem; } }
"""


def page(choice: xr.Dataset, building: Building, motions: GroundMotion | Sequence[GroundMotion]) -> str:
    """Write the page: recommendation, pictures with their text alternatives, tables, assumptions.

    Parameters
    ----------
    choice : xarray.Dataset
        What `fdspec.choose` returned for this building and these motions.
    building : Building
    motions : GroundMotion or sequence of them

    Returns
    -------
    str
        HTML, pictures and style included.
    """
    given = (motions,) if isinstance(motions, GroundMotion) else tuple(motions)
    chosen = Bench(building, given).with_slip_force(choice["slip_force"].values)
    before = [simulate(without_braces(building), motion) for motion in given]
    after = [simulate(chosen, motion) for motion in given]
    worst = worst_record(choice)
    history = next(one for one in after if str(one["record"].item()) == worst)
    many = choice.sizes["storey"] > 1
    index = index_name(choice)
    title = "Friction dampers: recommended pretension" + ("s" if many else "")
    told = recommendation(choice)
    parts = [
        f"<h1>{title}</h1>",
        f'<p class="answer"><strong>{_words(told[0][1])}</strong><br>{_words(told[2][1])}</p>',
        "<dl>",
        *(f"<dt>{escape(head)}</dt><dd>{_words(sentence)}</dd>" for head, sentence in told),
        "</dl>",
        "<h2>Index over pretension</h2>",
        _picture(
            plot_choice_index(choice),
            f"Line chart. {_index_in_words(choice, index)}",
            f"{index.capitalize()} over pretension, and each record's; less is better, 1 is the bare frame.",
        ),
        "<h2>Record by record</h2>",
        _picture(
            plot_choice_records(choice),
            "Two dot charts, a row a record: peak acceleration and peak drift of the bare frame, of the "
            "braced frame and as recommended. The table below has the numbers.",
            "Bare, with a brace that never slips, and as recommended; bars span the bounds of friction.",
        ),
        _table(choice),
        "<h2>Histories</h2>",
        _picture(
            plot_before_after(before, after),
            f"Line charts, one a record: displacement of the {'top ' if many else ''}floor over time. "
            + "; ".join(_fall(one, other) for one, other in zip(before, after, strict=True))
            + ".",
            f"Displacement of the {'top ' if many else ''}floor, without and with the damper.",
        ),
        *(
            _picture(
                plot_history(history, storey),
                f"Five charts of {worst}, storey {storey}: displacement of floor and brace, friction force, "
                "times of slip, absolute acceleration, and the hysteresis loop. Peak acceleration "
                f"{history['peak_acceleration'].values[storey - 1] / G:.3g} g, "
                f"{int(history['storey_transitions'].values[storey - 1])} changes of phase.",
                f"{worst}, the record with the largest index{f', storey {storey}' if many else ''}.",
            )
            for storey in range(1, choice.sizes["storey"] + 1)
        ),
        *(_distribution(choice) if many else ()),
        "<h2>What this assumes</h2>",
        "<ul>",
        *(f"<li>{escape(sentence)}</li>" for sentence in assumptions(choice)),
        "</ul>",
        f"<footer><p>{escape(choice.attrs['history'])}</p>",
        f"<p>{escape(choice.attrs['references'])}</p>",
        "<details><summary>All parameters</summary>",
        f"<p><code>{escape(choice.attrs['parameters'])}</code></p></details></footer>",
    ]
    body = "\n".join(parts)
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n<title>{title}</title>\n'
        f"<style>{STYLE}</style>\n</head>\n<body>\n<main>\n{body}\n</main>\n</body>\n</html>\n"
    )


def _words(sentence: str) -> str:
    """A sentence in which no number is parted from its unit."""
    escaped = escape(sentence)
    for unit in ("%", "kN", "mm", "g", "MN/m"):
        escaped = re.sub(rf"(?<=\d) (?={re.escape(unit)}(?![\w/]))", "&nbsp;", escaped)
    return escaped


def _picture(figure: Figure, alternative: str, caption: str) -> str:
    data = base64.b64encode(encode(figure, "png")).decode("ascii")
    return (
        f'<figure><div class="wide" role="region" aria-label="{escape(caption)}" tabindex="0">'
        f'<img alt="{escape(alternative)}" src="data:image/png;base64,{data}"></div>'
        f"<figcaption>{escape(caption)}</figcaption></figure>"
    )


def _index_in_words(choice: xr.Dataset, index: str) -> str:
    trial = choice["trial_index"].values
    sizes = choice["trial_pretension"].max("storey").values
    best = float(choice["index"].sel(case="chosen"))
    at, never = kilonewtons(choice["pretension"].max().item()), kilonewtons(sizes[-1])
    return (
        f"The {index} is {trial[0]:.3g} with no friction, {best:.3g} at {at} kN, where it is least, and "
        f"{trial[-1]:.3g} from {never} kN on, where the damper never slips. Below it the band of all within "
        f"{percent(parameters(choice)['band'])} of the least, and both bounds of friction."
    )


def _fall(bare: xr.Dataset, damped: xr.Dataset) -> str:
    before, after = (float(one["peak_displacement"].values[-1]) * 1e3 for one in (bare, damped))
    return f"{bare['record'].item()} from {before:.3g} to {after:.3g} mm"


def _table(choice: xr.Dataset) -> str:
    head, rows = record_rows(choice)
    cells = "".join(f'<th scope="col">{escape(name)}</th>' for name in head)
    lines = "\n".join(_row(row) for row in rows)
    explained = (
        "PGA and peak accelerations in g, drifts in mm. "
        f"lower, upper: {CASES['lower']}, {CASES['upper']}. Regret: how far the index lies above the least "
        "that the record has at any pretension."
    )
    return (
        '<div class="wide" role="region" aria-label="Results by record" tabindex="0"><table>'
        f"<caption>{escape(explained)}</caption><thead><tr>{cells}</tr></thead><tbody>\n{lines}\n</tbody></table></div>"
    )


def _row(cells: Sequence[str]) -> str:
    rest = "".join(f"<td>{escape(cell)}</td>" for cell in cells[1:])
    return f'<tr><th scope="row">{escape(cells[0])}</th>{rest}</tr>'


def _distribution(choice: xr.Dataset) -> list[str]:
    head = ("storey", "slip force, kN", "pretension, kN", "band, kN", "brace, MN/m", "brace must carry, kN")
    rows = []
    for storey in choice["storey"].values:
        at = choice.sel(storey=storey)
        start, end = at["band_pretension"].values
        numbers = (
            kilonewtons(at["slip_force"].item()),
            kilonewtons(at["pretension"].item()),
            f"{kilonewtons(start)} to {kilonewtons(end)}",
            f"{at['brace_stiffness'].item() / 1e6:.3g}",
            kilonewtons(at["brace_force"].item()),
        )
        rows.append(_row([str(storey), *numbers]))
    return [
        "<h2>Storey by storey</h2>",
        '<div class="wide" role="region" aria-label="Results by storey" tabindex="0"><table><thead><tr>',
        *(f'<th scope="col">{name}</th>' for name in head),
        "</tr></thead><tbody>",
        *rows,
        "</tbody></table></div>",
    ]
