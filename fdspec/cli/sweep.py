"""`fdspec sweep`: the cube of a study."""

from __future__ import annotations

import dataclasses
import json
import time
import warnings
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from fdspec.cli.as_json import echo_json, json_option
from fdspec.cli.echo import echo
from fdspec.cli.held import holds
from fdspec.cli.numbers_option import Numbers
from fdspec.cli.output import force_option, free, is_there
from fdspec.cli.record_options import RecordsOption, file_options, named_records
from fdspec.cli.run_options import STORE_SUFFIX, client_of, kept, logged, run_options, store_of
from fdspec.cli.table import grouped, seconds, size
from fdspec.errors import BusyError
from fdspec.locks import locked

if TYPE_CHECKING:
    import xarray as xr

    from fdspec.runs.studies import AnyStudy


@click.command()
@click.argument("study_file", metavar="[STUDY.toml]", required=False)
@click.option(
    "-o",
    "--output",
    metavar="FILE",
    help="The cube: netCDF, or a Zarr store where the name ends in .zarr.  [default: study.nc, or STUDY.nc "
    "for STUDY.toml]",
)
@click.option(
    "--record",
    "--records",
    "records",
    cls=RecordsOption,
    multiple=True,
    metavar="NAME|FILE",
    help="A record of the catalogue or a file, in place of the study's; repeat it for several.",
)
@click.option(
    "--record-suite",
    type=click.Choice(["far-field", "near-field-pulse", "near-field-no-pulse"]),
    help="All records of a set of FEMA P695, as recorded; needs fdspec[records].",
)
@file_options
@click.option(
    "--intensity",
    type=Numbers(),
    metavar="X",
    help="Factors on all records, a further axis: numbers with commas, LOW:HIGH:COUNT on a logarithmic "
    "scale, or both.",
)
@click.option(
    "--raw", is_flag=True, help="Leave the catalogue's records as recorded, not scaled to the study's PGA."
)
@click.option(
    "--free-vibration",
    type=click.FloatRange(min=0.0),
    metavar="S",
    help="Go on after each record, the ground at rest, s.",
)
@click.option(
    "--at-rest",
    is_flag=True,
    help="Go on until no damper can slip any more: residuals where the building comes to rest.",
)
@click.option("--no-certify", is_flag=True, help="Leave out the energy balance of each history; faster.")
@click.option(
    "--dry-run",
    is_flag=True,
    help="Say how many histories, the time by a measured sample, and the size; write nothing.",
)
@click.option(
    "--print-study", is_flag=True, help="Print the study as a study file, to be edited; compute nothing."
)
@run_options
@json_option
@force_option
def sweep(
    study_file: str | None,
    output: str | None,
    records: tuple[str, ...],
    record_suite: str | None,
    units: str | None,
    dt: float | None,
    channel: str | None,
    intensity: list[float] | None,
    raw: bool,
    free_vibration: float | None,
    at_rest: bool,
    no_certify: bool,
    dry_run: bool,
    print_study: bool,
    threads: int | None,
    workers: int | None,
    scheduler: str | None,
    resumable: bool | None,
    restart: bool,
    log: str | None,
    as_json: bool,
    force: bool,
) -> None:
    """Compute the cube of a study: peaks over record, stiffness ratio, pretension and period.

    A study that names buildings, or a building file by itself, gives the cube of buildings: peaks of every
    storey over record, building, and factors on the stiffness of braces and on slip forces.

    Without STUDY.toml it is the study of the nine records: 41 580 histories. To make a study of your own,
    edit what this prints:

    \b
        fdspec sweep --print-study > mine.toml
    """
    from fdspec.records.suites import suite_names
    from fdspec.runs.studies import with_intensity
    from fdspec.runs.study import Study
    from fdspec.store import check_writable

    started = time.perf_counter()
    study: AnyStudy = Study()
    if study_file is not None:
        from fdspec.runs.building_study import read_study

        study = read_study(study_file)
    if records or record_suite:
        chosen = named_records(records, units, dt, channel) if records else ()
        if record_suite:
            chosen = (*chosen, *suite_names(record_suite))
        study = dataclasses.replace(study, records=chosen, folder=Path())
    elif units or dt or channel:
        raise click.UsageError("--units, --dt and --channel tell about a file named with --record")
    study = dataclasses.replace(
        study, scaled=study.scaled and not raw, certify=study.certify and not no_certify
    )
    if free_vibration is not None:
        study = dataclasses.replace(
            study, after=dataclasses.replace(study.after, free_vibration=free_vibration)
        )
    if at_rest:
        study = dataclasses.replace(study, after=dataclasses.replace(study.after, at_rest=True))
    if intensity is not None:
        study = with_intensity(study, intensity)
    if print_study:
        echo(study.to_toml(), nl=False)
        return
    if sum(one is not None for one in (threads, workers, scheduler)) > 1:
        raise click.UsageError("--threads, --workers and --scheduler exclude each other")
    path = Path(output or ("study.nc" if study_file is None else f"{Path(study_file).stem}.nc"))
    if is_there(path) and not force and holds(path, study, study.motions()):
        echo(f"{path} holds this study already: nothing to compute; --force computes it again")
        return
    if path.suffix != STORE_SUFFIX:
        free(path, force=force)
    elif not path.is_dir():
        check_writable(path, suffixes=(STORE_SUFFIX,))
    if dry_run:
        echo(_plan(study, path, as_json))
        return
    with locked(path):
        if is_there(path) and not force and holds(path, study, study.motions()):
            echo(f"{path} holds this study already: another run has just written it")
            return
        if path.suffix != STORE_SUFFIX:
            free(path, force=force)
        _run(study, path, started, threads, workers, scheduler, resumable, restart, log, force, as_json)


def _run(
    study: AnyStudy,
    path: Path,
    started: float,
    threads: int | None,
    workers: int | None,
    scheduler: str | None,
    resumable: bool | None,
    restart: bool,
    log: str | None,
    force: bool,
    as_json: bool,
) -> None:
    """Compute and write; nobody else writes there meanwhile."""
    from fdspec.runs.studies import compute, expected

    motions = study.motions()
    store = store_of(path, resumable=resumable, expected=partial(expected, study, motions))
    with (
        logged(log),
        kept(store),
        nullcontext() if store is None else locked(store),
        client_of(workers, scheduler) as client,
    ):
        cube = compute(
            study,
            motions,
            workers=threads,
            client=client,
            store=store,
            restart=restart,
            progress=True,
        )
        _finish(cube, path, store, force, started, as_json)


def _finish(
    cube: xr.Dataset, path: Path, store: Path | None, force: bool, started: float, as_json: bool
) -> None:
    """Write the cube and say what it holds."""
    from fdspec.cli.outcome import as_data, statuses, summary
    from fdspec.store import remove, save, to_netcdf

    if store is None:
        save(cube, path, overwrite=force)
    elif store != path:
        to_netcdf(store, path, overwrite=force)
    with cube:
        told, failed = statuses(cube)
        elapsed = time.perf_counter() - started
        if as_json:
            echo_json(as_data(cube, path, elapsed))
        else:
            echo(summary(cube, path, elapsed))
            echo(told)
    if failed:
        warnings.warn(f"{failed} histories did not end well; their cells are listed above", stacklevel=1)
    if store is not None and store != path:
        try:
            remove(store)
        except BusyError:
            warnings.warn(f"{store} is being read and was kept; remove it when it is not", stacklevel=1)


def _plan(study: AnyStudy, path: Path, as_json: bool) -> str:
    """Say what a run would do."""
    from fdspec.runs.studies import planned, refuse_endless, rough_seconds
    from fdspec.scheduling.task import cores

    motions = study.motions()
    count = cores()
    store = store_of(path, resumable=None, expected=lambda: rough_seconds(study, motions) / count)
    refuse_endless(study, motions, store)
    plan = planned(study, motions)
    samples = sum(motion.n for motion in motions)
    if as_json:
        return json.dumps(
            {
                "records": [motion.name for motion in motions],
                "samples": samples,
                **{name.replace(" ", "_"): number for name, number in plan.axes},
                "histories": plan.histories,
                "core_seconds": plan.seconds,
                "cores": count,
                "bytes": plan.n_bytes,
                "output": str(path),
            }
        )
    rows = {
        "records": f"{', '.join(motion.name for motion in motions)} ({grouped(samples)} samples)",
        **{name: grouped(number) for name, number in plan.axes},
        "histories": grouped(plan.histories),
        "measured cost": f"{1e6 * plan.seconds / plan.histories:.3g} us of core time a history",
    }
    if plan.transitions is not None:
        rows["transitions"] = f"{plan.transitions:.0f} a history"
    rows["expected time"] = (
        f"{seconds(plan.seconds)} of core time, {seconds(plan.seconds / count)} on {count} cores"
    )
    rows["expected size"] = f"at most {size(plan.n_bytes)}"
    rows["would write"] = str(path)
    return "\n".join(f"{name:<18}{told}" for name, told in rows.items())
