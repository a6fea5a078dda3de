"""The report of a choice as one page that needs nothing else: no server, no network, no script."""

from __future__ import annotations

import re
from collections.abc import Sequence
from html import escape
from typing import TYPE_CHECKING, Final
from urllib.parse import quote

from fdspec.choice.bench import Bench, without_braces
from fdspec.choice.targets import target_of
from fdspec.figures import (
    encode,
    plot_before_after,
    plot_choice_index,
    plot_choice_records,
    plot_history,
    plot_sketch,
    sketch_caption,
)
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.report.compact_svg import compact
from fdspec.report.findings import (
    CASES,
    assumptions,
    index_name,
    parameters,
    plainly,
    recommendation,
    worst_record,
)
from fdspec.report.inputs import MOTION_HEAD, input_rows, motion_rows
from fdspec.report.numbers import kilonewtons, percent, rounded
from fdspec.report.rows import record_rows
from fdspec.report.storeys import storey_caption, storey_rows
from fdspec.report.style import STYLE
from fdspec.report.targets import HEAD, has_limits, limit_rows, stretches
from fdspec.runs.simulate import simulate
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr

    from fdspec.figures.page import Figure

FINER: Final = 4
"""Outputs of the detailed history for each sample of its record."""

HEADLINE: Final = ("Pretension", "Gain")
"""Heads of findings that the answer on top says already."""


def page(
    choice: xr.Dataset,
    building: Building,
    motions: GroundMotion | Sequence[GroundMotion],
    *,
    title: str = "",
    project: str = "",
    author: str = "",
) -> str:
    """Write the report: the answer, inputs, pictures with their text alternatives, tables, assumptions.

    Parameters
    ----------
    choice : xarray.Dataset
        What `fdspec.choose` returned for this building and these motions.
    building : Building
    motions : GroundMotion or sequence of them
    title : str
        In place of "Friction dampers: recommended pretension".
    project, author : str
        Named below the title and, the project, at the foot of each printed page.

    Returns
    -------
    str
        HTML; style and pictures, which are vectors, are in it. Printed it fills A4 pages with numbers.
    """
    given = (motions,) if isinstance(motions, GroundMotion) else tuple(motions)
    chosen = Bench(building, given).with_slip_force(choice["slip_force"].values)
    before = [simulate(without_braces(building), motion) for motion in given]
    after = [simulate(chosen, motion) for motion in given]
    worst = worst_record(choice)
    motion = next(one for one in given if one.name == worst)
    history = simulate(chosen, motion, dt_out=motion.dt / FINER)
    many = choice.sizes["storey"] > 1
    index = index_name(choice)
    title = title or "Friction dampers: recommended pretension" + ("s" if many else "")
    told = [(head, sentence) for head, sentence in recommendation(choice) if head not in HEADLINE]
    top = "top " if many else ""
    parts = [
        f"<header><h1>{escape(title)}</h1>",
        f"<p>{_byline(choice, project, author)}</p></header>",
        f'<p class="answer">{_words(plainly(choice))}</p>',
        "<h2>The structure</h2>",
        _picture(
            plot_sketch(building),
            f"Drawing. {sketch_caption()}",
            "Frame, brace and friction damper. Left the frame with its symbols, right one damper close up.",
        ),
        '<dl class="inputs">',
        *(
            f"<div><dt>{escape(name)}</dt><dd>{_words(value)}</dd></div>"
            for name, value in input_rows(choice)
        ),
        "</dl>",
        *(_limits(choice) if has_limits(choice) else ()),
        *_distribution(choice),
        "<h2>The ground motions</h2>",
        _table(
            MOTION_HEAD,
            motion_rows(choice),
            "PGA and factor as applied: the recorded motion times the factor has this peak.",
            "Ground motions",
            words=("event", "station"),
        ),
        *(f"<p>{escape(sentence)}</p>" for sentence in _comment(choice)),
        "<h2>What was found</h2>",
        "<dl>",
        *(f"<dt>{escape(head)}</dt><dd>{_words(sentence)}</dd>" for head, sentence in told),
        "</dl>",
        "<h2>Response over pretension</h2>",
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
        _table(
            *record_rows(choice),
            "PGA and peak accelerations in g, drifts in mm. "
            f"lower, upper: {CASES['lower']}, {CASES['upper']}. Regret: how far the index lies above the "
            "least that the record has at any pretension.",
            "Results by record",
        ),
        "<h2>Histories</h2>",
        _picture(
            plot_before_after(before, after),
            f"Line charts, one a record: displacement of the {top}floor over time. "
            + "; ".join(_fall(one, other) for one, other in zip(before, after, strict=True))
            + ".",
            f"Displacement of the {top}floor, without and with the damper.",
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
        "<h2>What this assumes</h2>",
        "<ul>",
        *(
            f"<li>{escape(sentence)}</li>"
            for sentence in assumptions(choice)
            if sentence not in _comment(choice)
        ),
        "</ul>",
        f"<footer><p>{escape(choice.attrs['history'])}. {escape(choice.attrs['references'])}.</p>",
        "<details><summary>All parameters</summary>",
        f"<p><code>{escape(choice.attrs['parameters'])}</code></p></details></footer>",
    ]
    body = "\n".join(parts)
    named = f'<meta name="author" content="{escape(author)}">\n' if author else ""
    foot = _quoted(" - ".join(filter(None, (project, title))))
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"{named}<title>{escape(title)}</title>\n<style>{STYLE.replace('@foot@', foot)}</style>\n"
        f"</head>\n<body>\n<main>\n{body}\n</main>\n</body>\n</html>\n"
    )


def _byline(choice: xr.Dataset, project: str, author: str) -> str:
    """Project, author, date and version, as far as they are known."""
    made = str(choice.attrs.get("history", ""))[:10]
    version = choice.attrs.get("fdspec_version", "")
    told = (project, author, made, f"fdspec {version}" if version else "")
    return " &middot; ".join(escape(one) for one in told if one)


def _quoted(text: str) -> str:
    """A CSS string, with whatever might end it or its style element written as code points."""
    return (
        '"' + "".join(one if one.isalnum() or one in " -,.:" else f"\\{ord(one):06x}" for one in text) + '"'
    )


def _comment(choice: xr.Dataset) -> list[str]:
    comment = str(choice.attrs.get("comment", ""))
    return [comment] if comment else []


def _words(sentence: str) -> str:
    """A sentence in which no number is parted from its unit, or from its own thousands."""
    escaped = re.sub(r"(?<=\d) (?=\d{3}(?!\d))", "&nbsp;", escape(sentence))
    for unit in ("%", "kN", "mm", "g", "kg", "t", "s", "MN/m"):
        escaped = re.sub(rf"(?<=\d) (?={re.escape(unit)}(?![\w/]))", "&nbsp;", escaped)
    return escaped


def _picture(figure: Figure, alternative: str, caption: str) -> str:
    data = quote(compact(encode(figure, "svg").decode("utf-8")))
    return (
        f'<figure><div class="wide" role="region" aria-label="{escape(caption)}" tabindex="0">'
        f'<img alt="{escape(alternative)}" src="data:image/svg+xml,{data}"></div>'
        f"<figcaption>{escape(caption)}</figcaption></figure>"
    )


def _index_in_words(choice: xr.Dataset, index: str) -> str:
    trial = choice["trial_index"].values
    sizes = choice["trial_pretension"].max("storey").values
    best = float(choice["index"].sel(case="chosen"))
    at, never = kilonewtons(choice["pretension"].max().item()), kilonewtons(sizes[-1])
    where = "where it is least"
    band = f"within {percent(parameters(choice)['band'])} of the least"
    if has_limits(choice):
        where, band = "as recommended", "that meet all limits"
    return (
        f"The {index} is {trial[0]:.3g} with no friction, {best:.3g} at {at} kN, {where}, and "
        f"{trial[-1]:.3g} from {never} kN on, where the damper never slips. Below it the band of all "
        f"{band}, and both bounds of friction."
    )


def _fall(bare: xr.Dataset, damped: xr.Dataset) -> str:
    before, after = (rounded(float(one["peak_displacement"].values[-1]) * 1e3) for one in (bare, damped))
    return f"{bare['record'].item()} from {before} to {after} mm"


def _table(
    head: Sequence[str],
    rows: Sequence[Sequence[str]],
    caption: str,
    label: str,
    words: Sequence[str] = (),
) -> str:
    kinds = ["words" if name in words else "" for name in head]
    cells = "".join(
        f'<th scope="col"{_class(kind)}>{escape(name)}</th>' for name, kind in zip(head, kinds, strict=True)
    )
    lines = "\n".join(_row(row, kinds) for row in rows)
    return (
        f'<div class="wide" role="region" aria-label="{escape(label)}" tabindex="0"><table>'
        f"<caption>{escape(caption)}</caption><thead><tr>{cells}</tr></thead><tbody>\n{lines}\n"
        "</tbody></table></div>"
    )


def _row(cells: Sequence[str], kinds: Sequence[str]) -> str:
    rest = "".join(
        f"<td{_class(kind)}>{escape(cell)}</td>" for cell, kind in zip(cells[1:], kinds[1:], strict=True)
    )
    return f'<tr><th scope="row">{escape(cells[0])}</th>{rest}</tr>'


def _class(kind: str) -> str:
    return f' class="{kind}"' if kind else ""


def _distribution(choice: xr.Dataset) -> list[str]:
    head = "Storey by storey" if choice.sizes["storey"] > 1 else "Damper, slot and brace"
    table = _table(*storey_rows(choice), storey_caption(choice), "Results by storey")
    return [f"<h2>{head}</h2>", table]


def _limits(choice: xr.Dataset) -> list[str]:
    target = target_of(choice)
    told = "Each the statistic over the records, the largest over the bounds of friction. "
    told += (
        f"All are met at slip forces of {stretches(target)}." if target.met else "No slip force meets all."
    )
    table = _table(HEAD, limit_rows(target), told, "Limits", words=("demand",))
    return ["<h2>The limits</h2>", table]
