"""The study's claims: each part on cubes that are made to obey it, to break it, and to lack its cells."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from fdspec import store
from fdspec.cli import main
from fdspec.errors import InvalidInput
from fdspec.measures import study_claims
from fdspec.measures.claim_parts import PARTS
from fdspec.measures.claims import CLAIMS, together, verdict, verdict_of_claim
from tests.cubes import synthetic_cube

RATIOS = np.array([0.5, 1.0, 2.0, 4.0, 6.0, 8.0, 10.0])
PRETENSION = 10e3 + 100e3 * np.arange(11)
PERIOD = 0.1 * np.arange(1, 13)
DIMS = ("record", "stiffness_ratio", "pretension", "period")


def cube_of(
    peak: np.ndarray, free: np.ndarray | float = 10.0, braced: np.ndarray | float = 20.0
) -> xr.Dataset:
    """Make a cube of two records; responses are broadcast over (stiffness_ratio, pretension, period)."""
    shape = (2, RATIOS.size, PRETENSION.size, PERIOD.size)
    return xr.Dataset(
        {
            "peak_acceleration": (DIMS, np.broadcast_to(peak, shape).copy()),
            "elastic_acceleration": (("record", "period"), np.broadcast_to(free, (2, PERIOD.size)).copy()),
            "braced_acceleration": (
                ("record", "stiffness_ratio", "period"),
                np.broadcast_to(braced, (2, RATIOS.size, PERIOD.size)).copy(),
            ),
            "status": (DIMS, np.zeros(shape, dtype=np.int8)),
        },
        coords={"record": ["A", "B"], "stiffness_ratio": RATIOS, "pretension": PRETENSION, "period": PERIOD},
    )


@pytest.fixture
def obedient() -> xr.Dataset:
    """Give a cube that does all the study says."""
    ratio, force, period = np.meshgrid(RATIOS, PRETENSION / 1e3, PERIOD, indexing="ij")
    dip = np.where(ratio > 4.0, 6.0 + 8.0 * np.abs(force - 160.0) / 850.0, 9.5)
    rise = np.where(ratio <= 4.0, 1.0 + 0.2 * np.minimum(force, 300.0) / 300.0, 1.0)
    level = np.where(ratio > 4.0, dip, dip * rise) * (1.0 + 0.01 * ratio)
    return cube_of(level * decay(period, 0.01), free=9.8 * decay(PERIOD, -0.01), braced=40.0 / (1.0 + PERIOD))


def decay(period: np.ndarray, slope: float) -> np.ndarray:
    """Rise or fall a little to 0.4 s, and fall beyond."""
    return np.where(period < 0.41, (1.0 + slope * (period - 0.4)) / 1.4, 1.0 / (1.0 + period))


def shares(cube: xr.Dataset, **options) -> dict[str, list[float]]:
    found = study_claims(cube, **options)
    general = [part.name for part in PARTS if not part.records]
    return {part: found.share.sel(part=part).values.tolist() for part in general}


def test_a_cube_that_does_all_the_study_says_holds_everywhere(obedient: xr.Dataset) -> None:
    found = study_claims(obedient)
    assert found.share.min() == 1.0
    general = found.sel(part=[part.name for part in PARTS if not part.records])
    assert set(general.verdict.values.ravel()) == {"holds"}
    assert [verdict_of_claim(found, letter) for letter in "abcdefg"] == ["holds"] * 7
    assert verdict_of_claim(found, "h") == "not tested"


def test_cells_are_counted_as_the_sentences_say(obedient: xr.Dataset) -> None:
    counted = study_claims(obedient).cells.sel(record="A").to_series().to_dict()
    pairs = 7 * 11 * (8 * 7 // 2)
    assert counted == {
        "a": 6, "b1": 24, "b2": 24, "c1": 3, "c2": 36, "d1": 28, "d2": pairs, "d3": 420, "e1": 24,
        "e2": 24, "f": 72, "g1": 66, "g2": 7 * 66, "h1": 0, "h2": 0, "h3": 0, "h4": 0, "h5": 0,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("part", "record", "cells"),
    [
        ("h1", "FSR3", 2),
        ("h2", "FMR2", 4 * 11 * 21),
        ("h3", "FMR3", 2 * 3 * 5),
        ("h4", "FHR1", 11 * 12),
        ("h5", "FHR3", 28),
    ],
)
def test_a_sentence_on_a_figure_counts_its_record_alone(
    obedient: xr.Dataset, part: str, record: str, cells: int
) -> None:
    found = study_claims(obedient.assign_coords(record=["A", record])).sel(part=part)
    assert found.cells.values.tolist() == [0, cells]
    assert found.verdict.values[0] == "not tested"


def test_sentences_on_figures_are_decided_by_their_cells(obedient: xr.Dataset) -> None:
    peak, free = obedient["peak_acceleration"].values[1], obedient["elastic_acceleration"].values[1]

    def share(part: str, record: str) -> float:
        return (
            study_claims(obedient.assign_coords(record=["A", record]))
            .share.sel(part=part, record=record)
            .item()
        )

    assert share("h1", "FSR2") == 1.0
    peak[5, 5:] *= 0.5  # at ratio 8 strong dampers are the best by far
    assert share("h1", "FSR2") == 0.5
    peak[:] = 1.0 + 0.01 * PERIOD
    assert share("h2", "FMR1") == 1.0
    peak[3] = 1.0 - 0.01 * PERIOD  # one of the four stiffness ratios over 2 falls
    assert share("h2", "FMR1") == 0.75
    peak[:] = 0.95 * free
    assert [share("h3", "FMR3"), share("h4", "FHR1"), share("h5", "FHR3")] == [1.0, 1.0, 1.0]
    peak[0, 0, :6] = 1.11 * free[:6]
    assert share("h4", "FHR1") == pytest.approx(1.0 - 6 / 132)
    assert share("h5", "FHR3") == pytest.approx(1.0 - 4 / 28)
    peak[6, 1, 0] = 1.01 * free[0]
    assert share("h3", "FMR3") == pytest.approx(1.0 - 1 / 30)


def broken(part: str, cube: xr.Dataset) -> tuple[xr.Dataset, float]:
    """Break one part for record B alone, in cells counted by hand; return the share that is left."""
    peak = cube["peak_acceleration"].values[1]
    free, braced = cube["elastic_acceleration"].values[1], cube["braced_acceleration"].values[1]
    if part == "a":  # the step from 8 to 10 falls
        peak[6] *= peak[5].max() / peak[6].max() * 0.99
        return cube, 5 / 6
    if part == "b1":  # one of 24 moves by 1.1 % at its highest pretension
        peak[0, -1, 3] *= 1.011
        return cube, 23 / 24
    if part == "b2":
        peak[1, 1, 2:5] = 0.89 * free[2:5]
        return cube, 21 / 24
    if part == "c1":  # at ratio 6 the largest response is least at 610 kN
        peak[4, 6] = 0.9 * peak[4, 1:3].max(axis=-1).min() * np.ones(12)
        return cube, 2 / 3
    if part == "c2":
        peak[5, 0, 4] = 0.94 * peak[5, 1:3, 4].min()
        return cube, 35 / 36
    if part == "d1":  # a fall of 2 % past the optimum at 0.2 s and ratio 4
        peak[3, 5, 1] *= 1.02
        return cube, 27 / 28
    if part == "d2":  # the longest period responds more than all seven between
        peak[2, 0, -1] = 1.1 * peak[2, 0, 4]
        return cube, 1 - 7 / (77 * 28)
    if part == "d3":  # at 0.1 s one cell responds more than all three longer periods
        peak[2, 5, 0] *= 1.1
        return cube, 1 - 3 / (70 * 6)
    if part == "g1":  # the shortest period of the free frame responds least
        free[0] = 0.9 * free[-1]
        return cube, 1 - 11 / 66
    if part == "g2":
        braced[3, 0] = 0.9 * braced[3, -1]
        return cube, 1 - 11 / (7 * 66)
    if part == "e1":
        peak[5, 1, 0] = 1.01 * free[0]
        return cube, 23 / 24
    if part == "e2":
        braced[6, 2] = 0.99 * peak[6, 1:3, 2].min()
        return cube, 22 / 24
    peak[4:, 1:3, 7] *= 0.5  # f: at one period the reduction is another
    return cube, 66 / 72


@pytest.mark.parametrize("part", [part.name for part in PARTS if not part.records])
def test_each_part_is_broken_by_the_cells_it_speaks_of(part: str, obedient: xr.Dataset) -> None:
    cube, left = broken(part, obedient)
    found = study_claims(cube).share.sel(part=part)
    assert found.values == pytest.approx([1.0, left], rel=1e-12)


def test_pretension_read_as_the_force_of_a_bolt_moves_the_bounds(obedient: xr.Dataset) -> None:
    """The dip at 110 to 210 kN stands at 55 to 105 kN of a bolt, of which only 105 is in 100 to 250 kN."""
    doubled = obedient.assign_coords(pretension=2.0 * obedient["pretension"])
    assert shares(doubled, normal_force_factor=2.0) == shares(obedient)
    peak = obedient["peak_acceleration"].values
    peak[:, 4:, 1] *= 0.8
    assert shares(obedient)["c1"] == [1.0, 1.0]
    assert shares(obedient, normal_force_factor=2.0)["c1"] == [0.0, 0.0]


def test_histories_that_failed_count_nowhere(obedient: xr.Dataset) -> None:
    obedient["status"].values[0, 5, 1, 2] = 2
    obedient["peak_acceleration"].values[0, 5, 1, 2] = np.nan
    found = study_claims(obedient)
    assert found.cells.sel(part="e1").values.tolist() == [23, 24]
    assert found.cells.sel(part="c2").values.tolist() == [35, 36]
    assert found.share.min() == 1.0


def test_what_the_cube_has_not_is_not_tested(obedient: xr.Dataset) -> None:
    found = study_claims(obedient.sel(stiffness_ratio=[2.0], period=[0.2]))
    told = dict(zip(found.part.values.tolist(), found.verdict_of_part.values.tolist(), strict=True))
    assert {part for part, one in told.items() if one != "not tested"} == {"d1"}
    assert np.isnan(found.share.sel(part="a")).all()


def test_neither_order_nor_units_of_the_grid_matter(obedient: xr.Dataset) -> None:
    cube, _ = broken("a", obedient)
    assert shares(cube.isel(stiffness_ratio=slice(None, None, -1))) == shares(cube)
    assert shares(cube.transpose(..., "record")) == shares(cube)


@pytest.mark.parametrize("factor", [0.0, -1.0, float("nan"), float("inf"), "2"])
def test_a_factor_that_cannot_be(obedient: xr.Dataset, factor) -> None:
    with pytest.raises(InvalidInput, match="normal_force_factor must be a positive number, got"):
        study_claims(obedient, normal_force_factor=factor)


def test_a_cube_without_its_limits(obedient: xr.Dataset) -> None:
    with pytest.raises(InvalidInput, match="has no braced_acceleration"):
        study_claims(obedient.drop_vars("braced_acceleration"))


def test_verdicts() -> None:
    shares_ = [1.0, 0.9, 0.899, 0.5, 0.499, 0.0, float("nan")]
    yes, part, no = "holds", "holds in part", "does not hold"
    assert [verdict(share) for share in shares_] == [yes, yes, part, part, no, no, "not tested"]
    assert together([yes, yes]) == yes
    assert together([no, "not tested"]) == no
    assert together([yes, no]) == part
    assert together(["not tested"]) == "not tested"


def test_every_claim_has_a_part() -> None:
    assert {part.claim for part in PARTS} == set(CLAIMS)


@pytest.fixture
def file(obedient: xr.Dataset, tmp_path: Path) -> str:
    """Write the obedient cube with cells of (f) broken for both records and of (b2) for B."""
    obedient["peak_acceleration"].values[:, 4:, 1:3, 0] *= 0.5
    cube, _ = broken("b2", obedient)
    whole = synthetic_cube(["A", "B"], (7, 11, 12)).assign_coords(
        {name: obedient[name].values for name in ("stiffness_ratio", "pretension", "period")}
    )
    for name in cube.data_vars:
        whole[name].values[:] = cube[name].values
    whole.attrs["comment"] = "Stand-ins: A, B."
    store.save(whole, tmp_path / "cube.nc")
    return str(tmp_path / "cube.nc")


def test_the_command_prints_shares_verdicts_and_sources(
    file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["claims", file]) == 0
    out = capsys.readouterr().out
    lines = out.splitlines()
    assert lines[0].split() == ["part", "A", "B", "verdict"]
    assert next(line for line in lines if line.startswith("b2 ")).split() == [
        *("b2", "100", "+", "87", "~", "holds", "in", "part")
    ]
    claim_b = next(line for line in lines if line.startswith("(b)"))
    assert claim_b.split()[1:5] == ["holds", "in", "part", "differ"]
    assert "Stand-ins: A, B." in lines
    assert max(map(len, lines)) < 150


def test_the_command_writes_markdown(file: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["claims", file, "--markdown", "--normal-force-factor", "2"]) == 0
    rows = [line for line in capsys.readouterr().out.splitlines() if line.startswith("|")]
    assert rows[0] == "| part | A | B | verdict |"
    assert rows[1] == "| :-- | --: | --: | :-- |"
    assert len(rows) == 2 + len(PARTS) + 2 + len(CLAIMS)


def test_a_share_just_short_of_all_is_not_rounded_up(file: str, capsys: pytest.CaptureFixture[str]) -> None:
    cube = store.open(file).load()
    cube["peak_acceleration"].values[0, 2, 0, -1] *= 3.0  # 7 of 2156 pairs
    store.save(cube, Path(file).with_name("other.nc"))
    assert main(["claims", str(Path(file).with_name("other.nc"))]) == 0
    row = next(line for line in capsys.readouterr().out.splitlines() if line.startswith("d2"))
    assert row.split()[1:3] == ["99", "+"]
