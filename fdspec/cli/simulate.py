"""`fdspec simulate`: the history of one frame under one record."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fdspec.cli.device_options import device_options, given
from fdspec.cli.echo import echo
from fdspec.cli.output import PICTURES, force_option, free, save_picture
from fdspec.cli.record_options import file_options, named_record

if TYPE_CHECKING:
    import xarray as xr


@click.command()
@click.option("--record", required=True, metavar="NAME|FILE", help="A record of the catalogue, or a file.")
@file_options
@click.option(
    "--raw", is_flag=True, help="Leave a catalogue's record as recorded, not scaled to the study's PGA."
)
@click.option("--period", type=float, required=True, metavar="S", help="Of the frame without its brace, s.")
@click.option("--stiffness-ratio", type=float, required=True, metavar="X", help="Brace over frame stiffness.")
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
@click.option(
    "--dt-out", type=float, metavar="S", help="Time between outputs, s.  [default: the record's step]"
)
@click.option(
    "-o", "--output", default="history.nc", show_default=True, metavar="FILE", help="The history, netCDF."
)
@click.option("--figure", metavar="FILE", help="A picture of it too: .png, .pdf or .svg.")
@force_option
def simulate(
    record: str,
    units: str | None,
    dt: float | None,
    channel: str | None,
    raw: bool,
    period: float,
    stiffness_ratio: float,
    slip_force: float | None,
    pretension: float | None,
    friction_coefficient: float | None,
    kinetic_slip_force: float | None,
    floor_mass: float,
    brace_mass: float,
    damping_ratio: float,
    brace_damping_ratio: float,
    free_vibration: float,
    dt_out: float | None,
    output: str,
    figure: str | None,
    force: bool,
    **devices: float | None,
) -> None:
    """Compute the history of one single-storey frame under one record: motion, friction, phases, energies.

    \b
    Example:
        fdspec simulate --record FSR1 --period 0.5 --stiffness-ratio 4 --slip-force 50e3 --figure history.png
    """
    if (slip_force is None) == (pretension is None):
        raise click.UsageError("Give either --slip-force or --pretension.")
    if slip_force is not None and friction_coefficient is not None:
        raise click.UsageError("--friction-coefficient goes with --pretension, not with --slip-force.")
    paths = [free(output, force=force)]
    if figure is not None:
        paths.append(free(figure, force=force, suffixes=PICTURES))

    from fdspec.model.building import Building
    from fdspec.runs.simulate import simulate as compute
    from fdspec.runs.study import find_record
    from fdspec.store import save

    if pretension is not None:
        slip_force = (0.5 if friction_coefficient is None else friction_coefficient) * pretension
    frame = Building.single_storey(
        period=period,
        stiffness_ratio=stiffness_ratio,
        slip_force=slip_force,  # type: ignore[arg-type]
        floor_mass=floor_mass,
        brace_mass=brace_mass,
        damping_ratio=damping_ratio,
        kinetic_slip_force=kinetic_slip_force,
        brace_damping_ratio=brace_damping_ratio,
        **given(devices),  # type: ignore[arg-type]
    )
    named = named_record(record, units, dt, channel)
    motion = find_record(named, scaled=not raw)
    history = compute(frame, motion, dt_out=dt_out, free_vibration=free_vibration)
    save(history, paths[0], overwrite=force)
    if figure is not None:
        from fdspec.figures import plot_history

        save_picture(plot_history(history), paths[1])
    echo(_results(history))
    echo("\n".join(map(str, paths)))


def _results(history: xr.Dataset) -> str:
    """Return the peaks, a line each."""
    from fdspec.units import G

    one = history.isel(storey=0)
    lines = {
        "PGA": f"{history['pga'].item() / G:.4g} g",
        "peak acceleration": f"{one['peak_acceleration'].item() / G:.4g} g",
        "peak displacement": f"{one['peak_displacement'].item() * 1e3:.4g} mm",
        "peak velocity": f"{one['peak_velocity'].item():.4g} m/s",
        "peak base shear": f"{history['peak_base_shear'].item() / 1e3:.4g} kN",
        "residual displacement": f"{one['residual_displacement'].item() * 1e3:.4g} mm",
        "changes of phase": f"{history['transitions'].item()}",
        "energy of friction": f"{history['dissipated_energy'].item() / 1e3:.4g} kJ",
        "energy put in": f"{history['input_energy'].values[-1] / 1e3:.4g} kJ",
        "error of energy": f"{history['energy_error'].item():.1e} of the energy put in",
    }
    if "ductility" in one:
        lines |= {
            "largest slip": f"{one['peak_slip'].item() * 1e3:.4g} mm",
            "ductility": f"{one['ductility'].item():.4g}",
            "plastic drift": f"{one['plastic_drift'].item() * 1e3:.4g} mm",
            "energy of columns": f"{one['column_energy'].item() / 1e3:.4g} kJ",
        }
    width = max(map(len, lines))
    return "\n".join(f"{name:<{width}}  {value}" for name, value in lines.items())
