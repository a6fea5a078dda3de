"""Building files: a building with its braces, in TOML."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from fdspec.errors import InvalidInput
from fdspec.model.building import Building
from fdspec.model.damping import ModalDamping
from fdspec.model.toml_lines import key_lines, line_of

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Storeys = list[Positive]


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
    friction, 1 unless given.

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
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InvalidInput(f"{path} is no TOML: {error}") from None
    try:
        file = _File.model_validate(table)
    except ValidationError as error:
        raise InvalidInput("\n".join(_mistakes(path, text, error))) from None
    options: dict[str, Any] = {"damping": ModalDamping(file.damping_ratio)}
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
