"""`fdspec check`: is a cube on disk whole and right?"""

from __future__ import annotations

import click

from fdspec.cli.as_json import echo_json, json_option
from fdspec.cli.echo import echo
from fdspec.cli.table import BAD, GOOD, grouped, styled
from fdspec.errors import FdspecError
from fdspec.printable import in_words

WORDS = {True: "ok", False: "FAILED", None: "-"}

COLOURS = {True: GOOD, False: BAD, None: None}


@click.command("check")
@click.argument("cube")
@json_option
@click.option("--all", "everything", is_flag=True, help="List every history that did not end well.")
def check_cube(cube: str, as_json: bool, everything: bool) -> None:
    """Verify a cube, a netCDF file or a Zarr store: schema, CF, records, checksums, statuses, energy.

    Exit code 1 when something is wrong with it.
    """
    from fdspec.cli.outcome import LISTED
    from fdspec.measures.statuses import failed_cells
    from fdspec.store import open as open_cube
    from fdspec.store.check import check

    if as_json:
        findings = list(check(cube))
        echo_json({"cube": cube, "findings": [finding._asdict() for finding in findings]})
        _fail(cube, [finding.what for finding in findings if finding.passed is False])
        return
    failed = []
    for finding in check(cube):
        told = in_words(finding.told) if finding.what == "statuses" else finding.told
        word = styled(f"{WORDS[finding.passed]:6s}", COLOURS[finding.passed])
        echo(f"{word}  {finding.what:9s}  {told}")
        if finding.passed is False:
            failed.append(finding.what)
        if finding.what == "statuses" and not finding.passed:
            with open_cube(cube, lazily=True) as opened:
                number = 0
                for number, cell in enumerate(failed_cells(opened), 1):
                    if everything or number <= LISTED:
                        echo(f"        {cell}")
            if not everything and number > LISTED:
                echo(f"        and {grouped(number - LISTED)} more; --all lists them")
    _fail(cube, failed)


def _fail(cube: str, failed: list[str]) -> None:
    if failed:
        raise FdspecError(f"{cube}: {', '.join(failed)} failed")
