"""Building files: a building with its braces and dampers, in TOML."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError, model_validator

from fdspec.errors import InvalidInput
from fdspec.model.building import Building
from fdspec.model.damping import Damping, DampingMatrix, ModalDamping, RayleighDamping
from fdspec.model.link import Link, TensionBrace
from fdspec.model.toml_lines import key_lines, line_of, parsed

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Force = Annotated[float, Field(ge=0.0)]
"""N; inf is a force too, that of a damper that never slips."""

Ratio = Annotated[float, Field(ge=0.0, lt=1.0)]
Storeys = list[Positive]


def _square(rows: list[list[float]]) -> list[list[float]]:
    if any(len(row) != len(rows) for row in rows):
        raise ValueError("a matrix should have as many values in each row as rows")
    return rows


Matrix = Annotated[list[list[float]], AfterValidator(_square)]
Where = tuple[str | int, ...]

DAMPING = ("damping_ratio", "rayleigh_damping", "damping_matrix")


class Mistakes(ValueError):
    """What is wrong with a building's table, as pairs of a key's place and a sentence."""

    def __init__(self, found: Iterable[tuple[Where, str]]) -> None:
        self.found = list(found)
        super().__init__("; ".join(sentence for _, sentence in self.found))


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


class LinkTable(BaseModel):
    """What a table ``[[links]]`` may hold: the parameters of `Link`."""

    model_config = ConfigDict(extra="forbid", strict=True)

    upper: int
    lower: int
    stiffness: Positive
    slip_force: Force
    mass: NotNegative = 0.0
    kinetic_slip_force: NotNegative | None = None
    slot_length: PositiveOrInf | None = None
    slot_stiffness: NotNegative | None = None
    recentring_stiffness: NotNegative | None = None
    recentring_preload: NotNegative | None = None
    friction_stiffness: NotNegative | None = None
    name: str | None = None

    def made(self) -> Link:
        """Return the link."""
        return Link(**self.model_dump())


class TensionBraceTable(BaseModel):
    """What a table ``[[tension_braces]]`` may hold: the parameters of `TensionBrace`."""

    model_config = ConfigDict(extra="forbid", strict=True)

    upper: int
    lower: int
    stiffness: Positive
    yield_force: PositiveOrInf | None = None
    slack: NotNegative = 0.0
    direction: int = 1
    name: str | None = None

    def made(self) -> TensionBrace:
        """Return the brace."""
        return TensionBrace(**self.model_dump(exclude_none=True))


class _Rayleigh(BaseModel):
    """Rayleigh damping: one ratio at two periods, s."""

    model_config = ConfigDict(extra="forbid", strict=True)

    ratio: Ratio
    period_1: Positive
    period_2: Positive


class _File(BaseModel):
    """What a building file may hold."""

    model_config = ConfigDict(extra="forbid", strict=True)

    floor_mass: Annotated[Storeys, Field(min_length=1)]
    storey_stiffness: Storeys | Matrix | Positive | None = None
    brace_stiffness: list[NotNegative] | NotNegative | None = None
    bare_period: Positive | None = None
    braced_period: Positive | None = None
    brace_mass: list[NotNegative] | NotNegative = 50.0
    brace_damping: list[NotNegative] | NotNegative | None = None
    slip_force: list[Force] | Force | None = None
    kinetic_slip_force: list[Force] | Force | None = None
    kinetic_ratio: Annotated[float, Field(ge=0.0, le=1.0)] = 1.0
    damping_ratio: list[Ratio] | Ratio | None = None
    rayleigh_damping: _Rayleigh | None = None
    damping_matrix: Matrix | None = None

    storey_height: list[Positive] | Positive | None = None
    yield_shear: list[PositiveOrInf] | PositiveOrInf | None = None
    hardening_ratio: list[LessThanOne] | LessThanOne = 0.0
    gravity_load: list[NotNegative] | NotNegative | None = None
    slot_length: list[PositiveOrInf] | PositiveOrInf | None = None
    slot_stiffness: list[NotNegative] | NotNegative | None = None
    recentring_stiffness: list[NotNegative] | NotNegative | None = None
    collapse_drift: list[PositiveOrInf] | PositiveOrInf | None = None
    stands_on: list[Annotated[int, Field(ge=0)]] | None = None
    links: list[LinkTable] = []
    tension_braces: list[TensionBraceTable] = []

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
        if self.stands_on is not None and self.bare_period is not None:
            raise ValueError("stands_on needs storey_stiffness: two periods fix one frame alone")
        if sum(getattr(self, name) is not None for name in DAMPING) > 1:
            raise ValueError(f"give one of {', '.join(DAMPING)}")
        if self.kinetic_slip_force is not None:
            if self.slip_force is None:
                raise ValueError("kinetic_slip_force needs slip_force beside it")
            if "kinetic_ratio" in self.model_fields_set:
                raise ValueError("give either kinetic_slip_force or kinetic_ratio")
        return self


def read_building(path: str | Path, *, design: bool = False) -> Building:
    """Read a building from a TOML file.

    Keys: `floor_mass`, kg, a list from the lowest floor up; `storey_stiffness` and `brace_stiffness`, N/m, a
    number or one a storey (a brace of 0 is none; the frame's stiffness may be a matrix, a list of rows), or
    in their place `bare_period` and `braced_period`, s, which fix one stiffness for all storeys and one for
    all braces; `brace_mass`, kg, 50 unless given; `brace_damping`, N s/m; `slip_force`, N, a number or one a
    storey, inf never slips; `kinetic_slip_force`, N, or `kinetic_ratio`, kinetic over static friction, 1
    unless given; one of `damping_ratio` in every mode of the bare frame, or one a mode, 0.05 unless given,
    `rayleigh_damping`, a table of ratio, period_1 and period_2, and `damping_matrix`, N s/m. What `Building`
    knows of devices goes by the same names (`storey_height`, `yield_shear`, `hardening_ratio`,
    `gravity_load`, `slot_length`, `slot_stiffness`, `recentring_stiffness`, `collapse_drift`, and `stands_on`
    for frames beside each other), and each link is a table ``[[links]]`` with the parameters of `Link`, or
    ``[[tension_braces]]`` with those of `TensionBrace`.

    Parameters
    ----------
    path : str or path
    design : bool
        Whether slip forces must be given; otherwise, to be chosen, each is 1 N where the file has none.

    Returns
    -------
    Building

    Raises
    ------
    InvalidInput
        When the file cannot be read or a key is wrong; every mistake with its line.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise InvalidInput(f"{path}: cannot be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise InvalidInput(f"{path}: is not a text file in UTF-8") from None
    try:
        table = parsed(text)
    except ValueError as error:
        raise InvalidInput(f"{path}: {error}") from None
    try:
        return building_of(table, design=design)
    except Mistakes as error:
        lines = key_lines(text)
        told = [
            f"{path}, line {line_of(lines, where)}: {sentence}" if where else f"{path}: {sentence}"
            for where, sentence in error.found
        ]
        raise InvalidInput("\n".join(told)) from None


def is_building(table: Mapping[str, Any]) -> bool:
    """Whether a table of TOML is meant as a building: it tells the masses of floors, one by one."""
    return isinstance(table.get("floor_mass"), list)


def building_of(table: Mapping[str, Any], *, design: bool = False) -> Building:
    """Return the building that a table with the keys of a building file tells.

    Raise Mistakes for what is wrong with it.
    """
    try:
        file = _File.model_validate(table)
    except ValidationError as error:
        raise Mistakes(_mistakes(table, error)) from None
    if (
        design
        and file.slip_force is None
        and np.any(np.asarray(1.0 if file.brace_stiffness is None else file.brace_stiffness) > 0.0)
    ):
        raise Mistakes([((), "has no slip_force, N, a number or one a storey; 'fdspec choose' finds some")])
    try:
        return _building(file)
    except InvalidInput as error:
        name = str(error).split(maxsplit=1)[0]
        raise Mistakes([((name,) if name in table else (), str(error))]) from None


def _building(file: _File) -> Building:
    size = len(file.floor_mass)
    periods = file.bare_period is not None
    braces = _each("brace_stiffness", 1.0 if periods else file.brace_stiffness, size)
    there = braces > 0.0
    given = 1.0 if file.slip_force is None else file.slip_force
    force = np.where(there, _each("slip_force", given, size), 0.0)
    if file.kinetic_slip_force is not None:
        kinetic = np.where(there, _each("kinetic_slip_force", file.kinetic_slip_force, size), 0.0)
    else:
        kinetic = force.copy()
        np.multiply(force, file.kinetic_ratio, out=kinetic, where=np.isfinite(force))
    options: dict[str, Any] = {
        **{name: getattr(file, name) for name in DEVICES},
        "links": [
            *(link.made() for link in file.links),
            *(brace.made() for brace in file.tension_braces),
        ],
        "slip_force": force,
        "kinetic_slip_force": kinetic,
        "damping": _damping(file),
        "brace_damping": np.where(there, _each("brace_damping", file.brace_damping or 0.0, size), 0.0),
    }
    if file.bare_period is not None and file.braced_period is not None:
        return Building.from_periods(
            file.floor_mass, file.bare_period, file.braced_period, brace_mass=file.brace_mass, **options
        )
    return Building(
        file.floor_mass,
        file.storey_stiffness,  # type: ignore[arg-type]
        np.where(there, _each("brace_mass", file.brace_mass, size), 0.0),
        braces,
        stands_on=file.stands_on,
        **options,
    )


def _each(name: str, values: object, size: int) -> NDArray[np.float64]:
    """Return one value a storey."""
    given = np.asarray(values, dtype=np.float64)
    if given.size not in (1, size):
        raise InvalidInput(
            f"{name} has {given.size} values, but the building has {size} storeys: give 1 or {size}"
        )
    return np.broadcast_to(given, size)


def _damping(file: _File) -> Damping:
    if file.rayleigh_damping is not None:
        return RayleighDamping(**file.rayleigh_damping.model_dump())
    if file.damping_matrix is not None:
        return DampingMatrix(file.damping_matrix)
    return ModalDamping(0.05 if file.damping_ratio is None else file.damping_ratio)


def _mistakes(table: Mapping[str, Any], error: ValidationError) -> list[tuple[Where, str]]:
    """Say one thing of each key: of a number what it should be, of a list which value."""
    found: dict[Where, tuple[Where, str]] = {}
    for mistake in error.errors():
        place = mistake["loc"]
        field = tuple(place[:1])
        is_list = bool(field) and isinstance(table.get(str(field[0])), list)
        kind = mistake["type"]
        if (kind == "list_type" and len(place) < 4 and not is_list and field in found) or (
            is_list and not any(isinstance(part, int) for part in place) and field in found
        ):
            continue
        sentence = mistake["msg"].removeprefix("Value error, ").replace("Input should be", "should be")
        if kind == "extra_forbidden":
            sentence = f"is no key of a building file; known are {', '.join(_File.model_fields)}"
            if len(place) > 1:
                sentence = f"there is no key {place[-1]}"
        if kind == "too_short":
            sentence = "must have one value for each storey, is empty"
        if kind == "missing":
            sentence = f"needs {place[-1]}" if len(place) > 1 else "must be given"
        at = next((f" at index {part}" for part in place[1:] if isinstance(part, int)), "")
        told = f"{field[0]}: {sentence}{at}" if field else sentence
        if field not in found or (found[field][1].endswith("valid list") and not is_list):
            found[field] = field, told
    return list(found.values())
