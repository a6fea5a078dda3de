"""Building files: a building with its braces, in TOML."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from fdspec.errors import InvalidInput
from fdspec.model.building import Building
from fdspec.model.damping import ModalDamping
from fdspec.model.link import Link
from fdspec.model.toml_lines import key_lines, line_of, parsed

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Storeys = list[Positive]


PositiveOrInf = Annotated[float, Field(gt=0.0)]
LessThanOne = Annotated[float, Field(lt=1.0, allow_inf_nan=False)]
DEVICES = (
    "storey_height",
    "yield_shear",
    "hardening_ratio",
    "gravity_load",
    "slot_length",
    "slot_stiffness",
    "recentring_stiffness",
    "collapse_drift",
)


class _Link(BaseModel):
    """What a table ``[[links]]`` may hold: the parameters of `Link`."""

    model_config = ConfigDict(extra="forbid")

    upper: int
    lower: int
    stiffness: Positive
    slip_force: Annotated[float, Field(ge=0.0)]
    mass: NotNegative = 0.0
    kinetic_slip_force: NotNegative | None = None
    slot_length: PositiveOrInf | None = None
    slot_stiffness: NotNegative | None = None
    recentring_stiffness: NotNegative | None = None
    recentring_preload: NotNegative | None = None
    friction_stiffness: NotNegative | None = None
    name: str | None = None


class _File(BaseModel):
    """What a building file may hold."""

    model_config = ConfigDict(extra="forbid")

    floor_mass: Annotated[Storeys, Field(min_length=1)]
    storey_stiffness: Storeys | Positive | None = None
    brace_stiffness: list[NotNegative] | Positive | None = None
    bare_period: Positive | None = None
    braced_period: Positive | None = None
    brace_mass: list[NotNegative] | NotNegative = 50.0
    damping_ratio: Annotated[float, Field(ge=0.0, lt=1.0)] = 0.05
    kinetic_ratio: Annotated[float, Field(ge=0.0, le=1.0)] = 1.0
    storey_height: list[Positive] | Positive | None = None
    yield_shear: list[PositiveOrInf] | PositiveOrInf | None = None
    hardening_ratio: list[LessThanOne] | LessThanOne = 0.0
    gravity_load: list[NotNegative] | NotNegative | None = None
    slot_length: list[PositiveOrInf] | PositiveOrInf | None = None
    slot_stiffness: list[NotNegative] | NotNegative | None = None
    recentring_stiffness: list[NotNegative] | NotNegative | None = None
    collapse_drift: list[PositiveOrInf] | PositiveOrInf | None = None
    links: list[_Link] = []

    @model_validator(mode="after")
    def _told_once(self) -> _File:
        stiffness = (self.storey_stiffness, self.brace_stiffness)
        periods = (self.bare_period, self.braced_period)
        if (None in stiffness) == (None in periods) or any(
            value is not None for value in (stiffness if None in stiffness else periods)
        ):
            raise ValueError(
                "give either storey_stiffness and brace_stiffness, or bare_period and braced_period"
            )
        return self


def read_building(path: str | Path) -> Building:
    """Read a building from a TOML file; its slip forces are left to be chosen.

    Keys: `floor_mass`, kg, a list from the lowest floor up; `storey_stiffness` and `brace_stiffness`, N/m, a
    number or one a storey (a brace of 0 is none), or in their place `bare_period` and `braced_period`, s,
    which fix one stiffness for all storeys and one for all braces; `brace_mass`, kg, 50 unless given;
    `damping_ratio` in every mode of the bare frame, 0.05 unless given; `kinetic_ratio`, kinetic over static
    friction, 1 unless given. What `Building` knows of devices goes by the same names (`storey_height`,
    `yield_shear`, `hardening_ratio`, `gravity_load`, `slot_length`, `slot_stiffness`, `recentring_stiffness`,
    `collapse_drift`), and each link is a table ``[[links]]`` with the parameters of `Link`.

    Parameters
    ----------
    path : str or path

    Returns
    -------
    Building
        Its static slip force is 1 N in each storey with a brace.

    Raises
    ------
    InvalidInput
        When the file cannot be read or a key is wrong; every mistake with its line.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise InvalidInput(f"cannot read the building {path}: {error}") from None
    try:
        table = parsed(text)
    except ValueError as error:
        raise InvalidInput(f"{path}: {error}") from None
    try:
        file = _File.model_validate(table)
    except ValidationError as error:
        raise InvalidInput("\n".join(_mistakes(path, text, error))) from None
    options: dict[str, Any] = {
        "damping": ModalDamping(file.damping_ratio),
        **{name: getattr(file, name) for name in DEVICES},
    }
    try:
        options["links"] = [Link(**link.model_dump()) for link in file.links]
        return _building(file, options)
    except InvalidInput as error:
        raise InvalidInput(f"{path}: {error}") from None


def _building(file: _File, options: dict[str, Any]) -> Building:
    if file.bare_period is not None and file.braced_period is not None:
        return Building.from_periods(
            file.floor_mass,
            file.bare_period,
            file.braced_period,
            slip_force=1.0,
            kinetic_slip_force=file.kinetic_ratio,
            brace_mass=file.brace_mass,
            **options,
        )
    braces = np.broadcast_to(np.asarray(file.brace_stiffness, dtype=np.float64), len(file.floor_mass))
    there = np.where(braces > 0.0, 1.0, 0.0)
    return Building(
        file.floor_mass,
        file.storey_stiffness,  # type: ignore[arg-type]
        np.asarray(file.brace_mass) * there,
        braces,
        there,
        file.kinetic_ratio * there,
        **options,
    )


def _mistakes(path: Path, text: str, error: ValidationError) -> list[str]:
    lines = key_lines(text)
    said = []
    for mistake in error.errors():
        field = mistake["loc"][:1]
        sentence = mistake["msg"].removeprefix("Value error, ")
        where = f"{path}, line {line_of(lines, field)}: {field[0]}" if field else str(path)
        said.append(f"{where}: {sentence}")
    return list(dict.fromkeys(said))
