"""`fdspec sweep`: the cube of a study."""

from __future__ import annotations

import dataclasses
import time
import warnings
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

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

    from fdspec.runs.study import Study


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
@force_option
def sweep(
    study_file: str | None,
    output: str | None,
    records: tuple[str, ...],
    units: str | None,
    dt: float | None,
    channel: str | None,
    intensity: list[float] | None,
    raw: bool,
    no_certify: bool,
    dry_run: bool,
    print_study: bool,
    threads: int | None,
    workers: int | None,
    scheduler: str | None,
    resumable: bool | None,
    restart: bool,
    log: str | None,
    force: bool,
) -> None:
    """Compute the cube of a study: peaks over record, stiffness ratio, pretension and period.

    Without STUDY.toml it is the study of the nine records: 41 580 histories. To make a study of your own,
    edit what this prints:

    \b
        fdspec sweep --print-study > mine.toml
    """
    from fdspec.runs.study import Study
    from fdspec.store import check_writable

    started = time.perf_counter()
    study = Study() if study_file is None else Study.read(study_file)
    if records:
        chosen = named_records(records, units, dt, channel)
        study = dataclasses.replace(study, records=chosen, folder=Path())
    elif units or dt or channel:
        raise click.UsageError("--units, --dt and --channel tell about a file named with --record")
    study = dataclasses.replace(
        study, scaled=study.scaled and not raw, certify=study.certify and not no_certify
    )
    if intensity is not None:
        grid = dataclasses.replace(study.grid, intensity=intensity)  # type: ignore[arg-type]
        study = dataclasses.replace(study, grid=grid)
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
        echo(_plan(study, path))
        return
    with locked(path):
        if is_there(path) and not force and holds(path, study, study.motions()):
            echo(f"{path} holds this study already: another run has just written it")
            return
        if path.suffix != STORE_SUFFIX:
            free(path, force=force)
        _run(study, path, started, threads, workers, scheduler, resumable, restart, log, force)


def _run(
    study: Study,
    path: Path,
    started: float,
    threads: int | None,
    workers: int | None,
    scheduler: str | None,
    resumable: bool | None,
    restart: bool,
    log: str | None,
    force: bool,
) -> None:
    """Compute and write; nobody else writes there meanwhile."""
    from fdspec.model.grid import GRID_FIELDS
    from fdspec.runs.pilot import wall_seconds
    from fdspec.runs.sweep import sweep as compute

    motions = study.motions()
    expected = partial(wall_seconds, motions, study.grid, study.certify)
    store = store_of(path, resumable=resumable, expected=expected)
    with (
        logged(log),
        kept(store),
        nullcontext() if store is None else locked(store),
        client_of(workers, scheduler) as client,
    ):
        cube = compute(
            motions,
            **{name: getattr(study.grid, name) for name in GRID_FIELDS},
            outputs=study.outputs,
            certify=study.certify,
            workers=threads,
            client=client,
            store=store,
            restart=restart,
            progress=True,
        )
        _finish(cube, path, store, force, started)


def _finish(cube: xr.Dataset, path: Path, store: Path | None, force: bool, started: float) -> None:
    """Write the cube and say what it holds."""
    from fdspec.cli.summary import statuses, summary
    from fdspec.store import remove, save, to_netcdf

    if store is None:
        save(cube, path, overwrite=force)
    elif store != path:
        to_netcdf(store, path, overwrite=force)
    with cube:
        told, failed = statuses(cube)
        echo(summary(cube, path, time.perf_counter() - started))
        echo(told)
    if failed:
        warnings.warn(f"{failed} histories did not end well; their cells are listed above", stacklevel=1)
    if store is not None and store != path:
        try:
            remove(store)
        except BusyError:
            warnings.warn(f"{store} is being read and was kept; remove it when it is not", stacklevel=1)


def _plan(study: Study, path: Path) -> str:
    """Say what a run would do."""
    from fdspec.runs.cost import seconds_of_sweep
    from fdspec.runs.pilot import measured
    from fdspec.runs.sweep import bytes_of, refuse_endless, usual_outputs
    from fdspec.scheduling.task import cores

    motions = study.motions()
    outputs = study.outputs or usual_outputs(study.grid)
    rough = sum(seconds_of_sweep(study.grid, motions, study.certify))
    store = store_of(path, resumable=None, expected=lambda: rough / cores())
    refuse_endless(motions, study.grid, outputs, rough, store)
    histories = len(motions) * study.grid.size
    cost = measured(study.grid, motions, study.certify)
    total, count = cost.of_sweep(study.grid, motions), cores()
    n_sr, n_f, n_t = study.grid.shape
    samples = sum(motion.n for motion in motions)
    return "\n".join(
        (
            f"records           {', '.join(motion.name for motion in motions)} ({grouped(samples)} samples)",
            *([] if study.grid.intensity is None else [f"intensities       {study.grid.intensity.size}"]),
            f"stiffness ratios  {n_sr}",
            f"pretensions       {n_f}",
            f"periods           {n_t}",
            f"histories         {grouped(histories)}",
            f"measured cost     {1e6 * total / histories:.3g} us of core time a history",
            f"transitions       {cost.transitions_per_sample * samples / len(motions):.0f} a history",
            f"expected time     {seconds(total)} of core time, {seconds(total / count)} on {count} cores",
            f"expected size     at most {size(sum(bytes_of(motions, study.grid, outputs).values()))}",
            f"would write       {path}",
        )
    )
