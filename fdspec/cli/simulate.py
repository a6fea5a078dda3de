"""`fdspec simulate`: the history of one frame, or of a building from its file, under one record."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import click

from fdspec.cli.as_json import echo_json, json_option, of_dataset
from fdspec.cli.device_options import DEVICES, device_options, given
from fdspec.cli.echo import echo
from fdspec.cli.output import PICTURES, force_option, free, save_picture
from fdspec.cli.record_options import file_options, named_record
from fdspec.cli.storey_columns import LINK_COLUMNS, STOREY_COLUMNS
from fdspec.cli.table import table

if TYPE_CHECKING:
    import xarray as xr


FRAME: Final = (
    "period",
    "stiffness_ratio",
    "slip_force",
    "pretension",
    "friction_coefficient",
    "kinetic_slip_force",
    "floor_mass",
    "brace_mass",
    "damping_ratio",
    "brace_damping_ratio",
)
"""Parameters of the options that tell a single-storey frame."""


OF_ALL_STOREYS: Final = (
    "peak_acceleration",
    "peak_displacement",
    "peak_velocity",
    "peak_slip",
    "peak_brace_force",
    "ductility",
    "plastic_drift",
    "column_energy",
)
"""Of which the largest over the storeys is told."""


@click.command()
@click.option("--record", required=True, metavar="NAME|FILE", help="A record of the catalogue, or a file.")
@file_options
@click.option(
    "--raw", is_flag=True, help="Leave a catalogue's record as recorded, not scaled to the study's PGA."
)
@click.option(
    "--building",
    metavar="B.toml",
    help="A building file with its slip forces, in place of the single-storey frame of the options below.",
)
@click.option("--period", type=float, metavar="S", help="Of the frame without its brace, s.")
@click.option("--stiffness-ratio", type=float, metavar="X", help="Brace over frame stiffness.")
@click.option(
    "--slip-force", type=float, metavar="N", help="Force at which the damper slips, N; inf never slips."
)
@click.option(
    "--pretension", type=float, metavar="N", help="In place of the slip force, the normal force, N."
)
@click.option(
    "--friction-coefficient", type=float, metavar="X", help="Slip force over pretension.  [default: 0.5]"
)
@click.option(
    "--kinetic-slip-force", type=float, metavar="N", help="While sliding, N.  [default: the slip force]"
)
@click.option("--floor-mass", type=float, default=20e3, show_default=True, metavar="KG")
@click.option(
    "--brace-mass", type=float, default=50.0, show_default=True, metavar="KG", help="0 is massless."
)
@click.option(
    "--damping-ratio", type=float, default=0.05, show_default=True, metavar="X", help="Of the frame."
)
@click.option(
    "--brace-damping-ratio", type=float, default=0.0, show_default=True, metavar="X", help="Of the brace."
)
@device_options
@click.option(
    "--free-vibration",
    type=float,
    default=0.0,
    show_default=True,
    metavar="S",
    help="Go on after the record, s.",
)
@click.option("--at-rest", is_flag=True, help="Go on until no damper can slip any more.")
@click.option(
    "--dt-out", type=float, metavar="S", help="Time between outputs, s.  [default: the record's step]"
)
@click.option(
    "-o", "--output", default="history.nc", show_default=True, metavar="FILE", help="The history, netCDF."
)
@click.option("--figure", metavar="FILE", help="A picture of it too: .png, .pdf or .svg.")
@click.option(
    "--storey", type=int, default=1, show_default=True, metavar="N", help="The storey in the picture."
)
@json_option
@force_option
def simulate(
    record: str,
    units: str | None,
    dt: float | None,
    channel: str | None,
    raw: bool,
    building: str | None,
    period: float | None,
    stiffness_ratio: float | None,
    slip_force: float | None,
    pretension: float | None,
    friction_coefficient: float | None,
    kinetic_slip_force: float | None,
    floor_mass: float,
    brace_mass: float,
    damping_ratio: float,
    brace_damping_ratio: float,
    free_vibration: float,
    at_rest: bool,
    dt_out: float | None,
    output: str,
    figure: str | None,
    storey: int,
    as_json: bool,
    force: bool,
    **devices: float | None,
) -> None:
    """Compute the history of one frame or building under one record: motion, friction, phases, energies.

    \b
    Examples:
        fdspec simulate --record FSR1 --period 0.5 --stiffness-ratio 4 --slip-force 50e3 --figure history.png
        fdspec simulate --record FSR1 --building six.toml
    """
    if building is not None:
        _refuse_frame_options(building)
    elif period is None or stiffness_ratio is None:
        raise click.UsageError("Give --period and --stiffness-ratio of a frame, or --building B.toml.")
    elif (slip_force is None) == (pretension is None):
        raise click.UsageError("Give either --slip-force or --pretension.")
    if slip_force is not None and friction_coefficient is not None:
        raise click.UsageError("--friction-coefficient goes with --pretension, not with --slip-force.")
    paths = [free(output, force=force)]
    if figure is not None:
        paths.append(free(figure, force=force, suffixes=PICTURES))

    from fdspec.model.building import Building
    from fdspec.model.building_file import read_building
    from fdspec.runs.simulate import simulate as compute
    from fdspec.runs.study_records import find_record
    from fdspec.store import save

    if pretension is not None:
        slip_force = (0.5 if friction_coefficient is None else friction_coefficient) * pretension
    frame = (
        read_building(building, design=True)
        if building is not None
        else Building.single_storey(
            period=period,  # type: ignore[arg-type]
            stiffness_ratio=stiffness_ratio,  # type: ignore[arg-type]
            slip_force=slip_force,  # type: ignore[arg-type]
            floor_mass=floor_mass,
            brace_mass=brace_mass,
            damping_ratio=damping_ratio,
            kinetic_slip_force=kinetic_slip_force,
            brace_damping_ratio=brace_damping_ratio,
            **given(devices),  # type: ignore[arg-type]
        )
    )
    named = named_record(record, units, dt, channel)
    motion = find_record(named, scaled=not raw)
    history = compute(frame, motion, dt_out=dt_out, free_vibration=free_vibration, at_rest=at_rest)
    save(history, paths[0], overwrite=force)
    if figure is not None:
        from fdspec.figures import plot_history

        save_picture(plot_history(history, storey=storey), paths[1])
    if as_json:
        echo_json({"files": [str(path) for path in paths], **of_dataset(_peaks(history))})
        return
    if building is not None:
        echo(_storeys(history))
        echo()
        if "link" in history:
            echo(_links(history))
            echo()
    echo(_results(history))
    echo("\n".join(map(str, paths)))


def _refuse_frame_options(building: str) -> None:
    """Raise UsageError for an option that tells what the building file tells."""
    context = click.get_current_context()
    for name in (*FRAME, *DEVICES):
        if context.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE:
            option = "--" + name.replace("_", "-")
            raise click.UsageError(f"{option} is of the single-storey frame; {building} tells the building.")


def _peaks(history: xr.Dataset) -> xr.Dataset:
    """Return what is one value for the whole history, save text about the record."""
    kept = [name for name, array in history.data_vars.items() if not {"time", "transition"} & set(array.dims)]
    told = history[kept]
    return told.drop_vars(
        [name for name, array in told.coords.items() if {"time", "transition"} & set(array.dims)]
    )


def _storeys(history: xr.Dataset) -> str:
    """Return a table of the storeys, the highest first as a building stands."""
    shown = {name: column for name, column in STOREY_COLUMNS.items() if name in history}
    values = {
        name: history[name].isel(time=-1) if "time" in history[name].dims else history[name] for name in shown
    }
    rows = [
        [
            str(int(history["storey"].values[k])),
            f"{history['slip_force'].values[k] / 1e3:.4g}",
            *(f"{column.scale * float(values[name].values[k]):.4g}" for name, column in shown.items()),
            str(int(history["storey_transitions"].values[k])),
        ]
        for k in reversed(range(history.sizes["storey"]))
    ]
    head = ["storey", "slips at kN", *(column.head for column in shown.values()), "phases"]
    return table(head, rows)


def _links(history: xr.Dataset) -> str:
    """Return a table of the links."""
    columns = {name: column for name, column in LINK_COLUMNS.items() if name in history}
    rows = [
        [
            str(link),
            *(f"{column.scale * float(history[name].values[k]):.4g}" for name, column in columns.items()),
        ]
        for k, link in enumerate(history["link"].values)
    ]
    return table(["link", *(column.head for column in columns.values())], rows)


def _results(history: xr.Dataset) -> str:
    """Return the peaks, a line each."""
    import numpy as np

    from fdspec.units import G

    one = abs(history[[name for name in OF_ALL_STOREYS if name in history]]).max("storey")
    last = history["residual_displacement"]
    last = last.isel(storey=int(np.argmax(np.abs(last.values))))
    lines = {
        "PGA": f"{history['pga'].item() / G:.4g} g",
        "peak acceleration": f"{one['peak_acceleration'].item() / G:.4g} g",
        "peak displacement": f"{one['peak_displacement'].item() * 1e3:.4g} mm",
        "peak velocity": f"{one['peak_velocity'].item():.4g} m/s",
        "peak base shear": f"{history['peak_base_shear'].item() / 1e3:.4g} kN",
        "residual displacement": f"{last.item() * 1e3:.4g} mm",
        "changes of phase": f"{history['transitions'].item()}",
        "energy of friction": f"{history['dissipated_energy'].item() / 1e3:.4g} kJ",
        "energy put in": f"{history['input_energy'].values[-1] / 1e3:.4g} kJ",
        "error of energy": f"{history['energy_error'].item():.1e} of the energy in play",
    }
    if "peak_slip" in one:
        lines["largest slip"] = f"{one['peak_slip'].item() * 1e3:.4g} mm"
    if "peak_brace_force" in one:
        lines["largest brace force"] = f"{one['peak_brace_force'].item() / 1e3:.4g} kN"
    if "ductility" in one:
        lines |= {
            "ductility": f"{one['ductility'].item():.4g}",
            "plastic drift": f"{one['plastic_drift'].item() * 1e3:.4g} mm",
            "energy of columns": f"{one['column_energy'].item() / 1e3:.4g} kJ",
        }
    width = max(map(len, lines))
    return "\n".join(f"{name:<{width}}  {value}" for name, value in lines.items())
