"""`fdspec claims`: what the study concludes, put to a cube."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Final

import click

from fdspec.cli.echo import echo
from fdspec.cli.table import BAD, FAIR, GOOD, filled, table

if TYPE_CHECKING:
    import xarray as xr

MARKS: Final = {"holds": "+", "holds in part": "~", "does not hold": "-", "not tested": " "}

COLOURS: Final = {"holds": GOOD, "holds in part": FAIR, "does not hold": BAD}

BOLT_FACTOR: Final = 2.0
"""Normal force over the force of a bolt: one bolt, two faces."""


@click.command()
@click.argument("cube", metavar="CUBE.nc")
@click.option(
    "--normal-force-factor",
    "factor",
    type=float,
    default=1.0,
    show_default=True,
    metavar="X",
    help="The cube's pretension over what the study calls so: 2 n_b for the force of one of n_b bolts.",
)
@click.option("--markdown", "form", flag_value="markdown", help="Tables for a Markdown page.")
@click.option("--json", "form", flag_value="json", help="Shares and verdicts as JSON.")
def claims(cube: str, factor: float, form: str | None) -> None:
    """Check the study's conclusions against a cube: each with the number that decides it, per record.

    A claim falls into parts, sentences about cells of the cube. The number is the share of cells, in percent,
    that do what the sentence says: from 90 on it holds (+), from 50 on in part (~), else it does not (-).
    """
    from fdspec import store
    from fdspec.measures.claims import study_claims
    from fdspec.store.suitable import require_cube

    dataset = store.open(cube)
    require_cube(dataset, cube, "the study's claims")
    found = study_claims(dataset, normal_force_factor=factor)
    if form == "json":
        echo(_as_json(found))
        return
    bolt = study_claims(dataset, normal_force_factor=BOLT_FACTOR * factor)
    markdown = form == "markdown"
    blocks = [_shares(found, markdown=markdown), _sentences(found), _verdicts(found, bolt, markdown=markdown)]
    if comment := dataset.attrs.get("comment"):
        blocks.append(filled(str(comment)))
    echo("\n\n".join(blocks))


def _shares(found: xr.Dataset, *, markdown: bool) -> str:
    records = [str(name) for name in found["record"].values]
    rows = [
        [str(part), *(_cell(*pair) for pair in zip(shares, verdicts, strict=True)), str(together)]
        for part, shares, verdicts, together in zip(
            found["part"].values,
            found["share"].values,
            found["verdict"].values,
            found["verdict_of_part"].values,
            strict=True,
        )
    ]
    return _table(["part", *records, "verdict"], rows, left=("part", "verdict"), markdown=markdown)


def _cell(share: float, verdict: str) -> str:
    """Write a share in percent, cut rather than rounded, so that what falls short of all never reads 100."""
    return "" if math.isnan(share) else f"{math.floor(100.0 * share + 1e-9)} {MARKS[str(verdict)]}"


def _sentences(found: xr.Dataset) -> str:
    names, sentences = found["part"].values, found["sentence"].values
    return "\n".join(
        filled(str(sentence), first=f"{name:3} ", rest="    ")
        for name, sentence in zip(names, sentences, strict=True)
    )


def _verdicts(found: xr.Dataset, bolt: xr.Dataset, *, markdown: bool) -> str:
    from fdspec.measures.claims import CLAIMS, verdict_of_claim

    rows = [
        [
            f"({letter})",
            verdict_of_claim(found, letter),
            "differ" if _records_differ(found, letter) else "agree",
            verdict_of_claim(bolt, letter),
            claim,
        ]
        for letter, claim in CLAIMS.items()
    ]
    head = ["claim", "verdict", "records", "if of one bolt", "the study says"]
    told = (
        "Where records differ, the stand-ins may decide; where they agree, that is unlikely. If of one bolt: "
        f"the verdict when the study's pretension is 1/{BOLT_FACTOR:g} of what it is taken for here."
    )
    return f"{_table(head, rows, left=head, markdown=markdown)}\n\n{filled(told)}"


def _records_differ(found: xr.Dataset, letter: str) -> bool:
    rows = found["verdict"].values[found["claim"].values == letter]
    return any(len(set(row.tolist())) > 1 for row in rows)


def _table(
    head: list[str], rows: list[list[str]], *, left: list[str] | tuple[str, ...], markdown: bool
) -> str:
    if not markdown:
        return table(head, rows, left=tuple(left), colours=COLOURS)
    rule = [":--" if name in left else "--:" for name in head]
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, rule, *rows])


def _as_json(found: xr.Dataset) -> str:
    from fdspec.measures.claims import CLAIMS, verdict_of_claim

    parts = [
        {
            "part": str(part),
            "claim": str(one["claim"].item()),
            "sentence": str(one["sentence"].item()),
            "verdict": str(one["verdict_of_part"].item()),
            "records": {
                str(record): {
                    "share": None if math.isnan(share) else float(share),
                    "cells": int(cells),
                    "verdict": str(verdict),
                }
                for record, share, cells, verdict in zip(
                    found["record"].values,
                    one["share"].values,
                    one["cells"].values,
                    one["verdict"].values,
                    strict=True,
                )
            },
        }
        for part in found["part"].values
        for one in [found.sel(part=part)]
    ]
    told = [
        {"claim": letter, "verdict": verdict_of_claim(found, letter), "the study says": said}
        for letter, said in CLAIMS.items()
    ]
    return json.dumps({"claims": told, "parts": parts}, indent=2)
