"""`fdspec summary`: statistics of a cube over its records."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from fdspec.cli.as_json import echo_json, json_option, of_dataset
from fdspec.cli.echo import echo
from fdspec.cli.output import force_option, free
from fdspec.cli.table import table
from fdspec.errors import InvalidInput
from fdspec.printable import in_words

if TYPE_CHECKING:
    import xarray as xr


@click.command()
@click.argument("cube", metavar="CUBE")
@click.option(
    "--variable",
    "variables",
    multiple=True,
    metavar="NAME",
    help="A result, such as 'peak acceleration'; repeat it.  [default: all]",
)
@click.option(
    "--percentile",
    "percentiles",
    multiple=True,
    type=float,
    metavar="P",
    help="From 0 to 100; repeat it.  [default: 16 and 84]",
)
@click.option(
    "--at",
    "places",
    multiple=True,
    metavar="AXIS=VALUE",
    help="Take one point of an axis, such as period=0.5 or building=office; repeat it for several axes.",
)
@click.option("-o", "--output", metavar="FILE", help="Write them: .nc or .csv.")
@json_option
@force_option
def summary(
    cube: str,
    variables: tuple[str, ...],
    percentiles: tuple[float, ...],
    places: tuple[str, ...],
    output: str | None,
    as_json: bool,
    force: bool,
) -> None:
    """Sum up a cube over its records: median, mean, percentiles and worst of every result.

    Histories that did not end well do not count. Where more than one cell is left beside the storeys, the
    table shows the least and the most of each statistic over the cells; the file and --json hold every cell.
    """
    from fdspec import store
    from fdspec.measures.summary import PERCENTILES
    from fdspec.measures.summary import summary as compute
    from fdspec.store.suitable import require_sound

    path = None if output is None else free(output, force=force, suffixes=(".nc", ".csv"))
    opened = store.open(cube)
    require_sound(opened, cube)
    if "record" not in opened.dims or "status" not in opened:
        raise InvalidInput(f"{cube} is no cube; a summary needs what fdspec sweep writes")
    for place in places:
        opened = _at(opened, place)
    wanted = [name.strip().replace(" ", "_") for name in variables]
    told = compute(opened, wanted or None, percentiles=percentiles or PERCENTILES)
    if path is not None:
        if path.suffix.lower() == ".csv":
            store.export(told, path)
        else:
            store.save(told, path, overwrite=force)
    if as_json:
        echo_json({"files": [str(path)] if path else [], **of_dataset(told)})
        return
    echo(_table(told))
    if path is not None:
        echo(str(path))


def _at(cube: xr.Dataset, place: str) -> xr.Dataset:
    """Take one point of an axis."""
    import numpy as np

    axis, equals, text = place.partition("=")
    axis = axis.strip()
    if not equals:
        raise click.UsageError(f"--at: {place!r} should be AXIS=VALUE, such as period=0.5.")
    known = [str(dim) for dim in cube.dims if dim != "record"]
    if axis not in known:
        raise InvalidInput(f"--at: {axis!r} is no axis of the cube; it has {', '.join(known)}")
    values = cube[axis].values
    if values.dtype.kind in "UTO":
        held = [str(value) for value in values]
        if text not in held:
            raise InvalidInput(f"--at: {axis} has no {text!r}; it has {', '.join(held)}")
        return cube.isel({axis: held.index(text)})
    try:
        wanted = float(text)
    except ValueError:
        raise InvalidInput(f"--at: {axis} is a number, got {text!r}") from None
    numbers = values.astype(np.float64)
    same = np.isclose(numbers, wanted, rtol=1e-9, atol=0.0)
    if not same.any():
        near = numbers[np.argsort(np.abs(numbers - wanted))[:2]]
        raise InvalidInput(
            f"--at: {axis} has no {wanted:g}; nearest are {' and '.join(f'{v:g}' for v in near)}"
        )
    return cube.isel({axis: int(np.argmax(same))})


def _table(told: xr.Dataset) -> str:
    statistics = [str(name) for name in told["statistic"].values]
    by_storey = "storey" in told.dims
    head = ["result", "unit", *(["storey"] if by_storey else []), *statistics]
    rows = []
    for name, array in told.data_vars.items():
        if name == "records":
            continue
        unit = str(array.attrs.get("units", ""))
        if by_storey and "storey" in array.dims:
            for k in reversed(range(array.sizes["storey"])):
                one = array.isel(storey=k)
                rows.append(
                    [in_words(str(name)), unit, str(int(told["storey"].values[k])), *_cells(one, statistics)]
                )
        else:
            rows.append([in_words(str(name)), unit, *([""] if by_storey else []), *_cells(array, statistics)])
    return table(head, rows, left=("result", "unit"))


def _cells(array: Any, statistics: list[str]) -> list[str]:
    import numpy as np

    cells = []
    for k, _ in enumerate(statistics):
        values = array.isel(statistic=k).values
        known = values[np.isfinite(values)]
        if not known.size:
            cells.append("-")
        elif known.min() == known.max():
            cells.append(f"{known.min():.4g}")
        else:
            cells.append(f"{known.min():.4g} to {known.max():.4g}")
    return cells
