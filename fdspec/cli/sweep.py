"""`fdspec sweep`: the cube of a study."""

from __future__ import annotations

import dataclasses
import math
import time
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import click

from fdspec.cli.output import force_option, free
from fdspec.cli.record_options import file_options, named_records
from fdspec.cli.table import grouped, seconds, size

if TYPE_CHECKING:
    import xarray as xr

    from fdspec.study import Study


@click.command()
@click.argument("study_file", metavar="[STUDY.toml]", required=False)
@click.option(
    "-o",
    "--output",
    metavar="FILE",
    help="The cube, netCDF.  [default: study.nc, or STUDY.nc for STUDY.toml]",
)
@click.option(
    "--record",
    "--records",
    "records",
    multiple=True,
    metavar="NAME|FILE",
    help="A record of the catalogue or a file, in place of the study's; repeat it for several.",
)
@file_options
@click.option(
    "--raw", is_flag=True, help="Leave the catalogue's records as recorded, not scaled to the study's PGA."
)
@click.option("--no-certify", is_flag=True, help="Leave out the energy balance of each history; faster.")
@click.option("--workers", type=click.IntRange(min=1), metavar="N", help="Threads.  [default: one a core]")
@click.option(
    "--dry-run", is_flag=True, help="Say how many histories, the expected time and size; compute nothing."
)
@click.option(
    "--print-study", is_flag=True, help="Print the study as a study file, to be edited; compute nothing."
)
@force_option
def sweep(
    study_file: str | None,
    output: str | None,
    records: tuple[str, ...],
    units: str | None,
    dt: float | None,
    channel: str | None,
    raw: bool,
    no_certify: bool,
    workers: int | None,
    dry_run: bool,
    print_study: bool,
    force: bool,
) -> None:
    """Compute the cube of a study: peaks over record, stiffness ratio, pretension and period.

    Without STUDY.toml it is the study of the nine records: 41 580 histories. To make a study of your own,
    edit what this prints:

    \b
        fdspec sweep --print-study > mine.toml
    """
    from fdspec.study import Study

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
    if print_study:
        click.echo(study.to_toml(), nl=False)
        return
    path = free(output or ("study.nc" if study_file is None else f"{Path(study_file).stem}.nc"), force=force)
    if dry_run:
        click.echo(_plan(study, path))
        return
    cube = _computed(study, workers)
    _finish(cube, path, force, started)


def _finish(cube: xr.Dataset, path: Path, force: bool, started: float) -> None:
    """Write the cube and say what it holds."""
    from fdspec.cli.summary import summary
    from fdspec.store import save

    save(cube, path, overwrite=force)
    click.echo(summary(cube, path, time.perf_counter() - started))
    failed = int((cube["status"] != 0).sum())
    if failed:
        warnings.warn(f"{failed} histories did not end well; see the cube's variable status", stacklevel=1)


def _plan(study: Study, path: Path) -> str:
    """Say what a run would do."""
    import numpy as np

    from fdspec.sweep import OUTPUTS, estimate
    from fdspec.variables import CUBE

    motions = study.motions()
    n_sr, n_f, n_t = study.grid.shape
    samples = sum(motion.n for motion in motions)
    lengths = {"record": len(motions), "stiffness_ratio": n_sr, "pretension": n_f, "period": n_t}
    bytes_of = {
        name: math.prod(lengths[dim] for dim in CUBE[name].dims) * np.dtype(CUBE[name].dtype).itemsize
        for name in study.outputs or OUTPUTS
    }
    return "\n".join(
        (
            f"records           {', '.join(motion.name for motion in motions)} ({grouped(samples)} samples)",
            f"stiffness ratios  {n_sr}",
            f"pretensions       {n_f}",
            f"periods           {n_t}",
            f"histories         {grouped(len(motions) * study.grid.size)}",
            f"expected time     {seconds(estimate(motions, study.grid, certify=study.certify))}",
            f"expected size     at most {size(sum(bytes_of.values()))}",
            f"would write       {path}",
        )
    )


def _computed(study: Study, workers: int | None) -> xr.Dataset:
    """Run the sweep that a study describes."""
    from fdspec.grid import GRID_FIELDS
    from fdspec.sweep import sweep as compute

    axes_and_scalars = {name: getattr(study.grid, name) for name in GRID_FIELDS}
    return compute(
        study.motions(),
        **axes_and_scalars,
        outputs=study.outputs,
        certify=study.certify,
        workers=workers,
        progress=True,
    )
