"""The best pretension against brute force; slip forces of buildings."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import fdspec
from fdspec.choice.bench import Bench
from fdspec.errors import InvalidInput
from fdspec.measures import INDICES, best_for_all, index_of, needs_of, slip_load_spectrum
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.runs.sweep import OUTPUTS
from fdspec.validation import four_storey, kalamata

NAMES = ("FSR1", "FSR2", "FSR3", "FMR1", "FMR2", "FMR3", "FHR1", "FHR2", "FHR3")


def clipped(name: str, samples: int = 900) -> GroundMotion:
    """The strong part of a record, so that tests stay short."""
    record = fdspec.load_record(name)
    first = max(0, int(np.abs(record.acceleration).argmax()) - samples // 3)
    return GroundMotion(record.acceleration[first : first + samples], record.dt, name=name)


def off(best: Any, motion: GroundMotion) -> tuple[float, float]:
    """How far the refined best lies from a scan at 1 kN: in pretension (N), and in index (share above)."""
    period, ratio = best["period"].item(), best["stiffness_ratio"].item()
    building = Building.single_storey(period, ratio, 1.0)
    top = 2.0 * float(Bench(building, (motion,)).never_slips[0])
    pretension = np.arange(0.0, top + 1e3, 1e3)
    cube = fdspec.sweep(motion, period=period, stiffness_ratio=ratio, pretension=pretension, certify=False)
    index = index_of(cube).squeeze()
    place = int(index.values.argmin())
    return (
        abs(best["pretension"].item() - pretension[place]),
        best["index"].item() / index.values[place] - 1.0,
    )


def draws(count: int, seed: int) -> list[tuple[str, float, float]]:
    rng = np.random.default_rng(seed)
    return [
        (
            NAMES[rng.integers(9)],
            rng.uniform(0.05, 3.0),
            float(np.exp(rng.uniform(np.log(0.5), np.log(10.0)))),
        )
        for _ in range(count)
    ]


def agrees(motion: GroundMotion, period: float, ratio: float) -> bool:
    best = fdspec.best_pretension(motion, period=period, stiffness_ratio=ratio)
    in_pretension, in_index = off(best, motion)
    return in_pretension <= 1e3 or in_index <= 1e-3


@pytest.mark.parametrize(("name", "period", "ratio"), draws(12, seed=1))
def test_the_refined_best_is_that_of_a_scan_at_1_kn(name: str, period: float, ratio: float) -> None:
    assert agrees(clipped(name), period, ratio)


@pytest.mark.slow
def test_the_refined_best_is_that_of_a_scan_at_1_kn_over_200_cells() -> None:
    """The must-hold line, on whole records."""
    motions = {name: fdspec.load_record(name) for name in NAMES}
    wrong = [
        (name, period, ratio)
        for name, period, ratio in draws(200, seed=2)
        if not agrees(motions[name], period, ratio)
    ]
    assert wrong == []


@pytest.fixture(scope="module")
def motions() -> list[GroundMotion]:
    return [clipped("FSR1", 500), clipped("FMR2", 500)]


@pytest.mark.parametrize("index", [*INDICES, "weighted"])
def test_what_is_told_of_the_best_is_what_a_sweep_computes_there(
    motions: list[GroundMotion], index: str
) -> None:
    best = fdspec.best_pretension(motions, period=[0.3, 0.5], stiffness_ratio=4, index=index)
    outputs = (*OUTPUTS, *needs_of(index))
    for motion in motions:
        for period in (0.3, 0.5):
            at = best.sel(record=motion.name, period=period).squeeze()
            cube = fdspec.sweep(
                motion,
                period=period,
                stiffness_ratio=4,
                pretension=at["pretension"].item(),
                outputs=dict.fromkeys(outputs),
            ).squeeze()
            found = fdspec.sweep(
                motion,
                period=[period],
                stiffness_ratio=[4],
                pretension=[at["pretension"].item()],
                outputs=dict.fromkeys(outputs),
            )
            assert index_of(found, index).item() == pytest.approx(at["index"].item(), rel=1e-12)
            for name in ("peak_acceleration", "peak_displacement", "peak_base_shear"):
                assert at[name].item() == pytest.approx(cube[name].item(), rel=1e-12)
            assert at["bare_acceleration"].item() == cube["elastic_acceleration"].item()
            assert at["braced_acceleration"].item() == cube["braced_acceleration"].item()
            assert at["band_start"] <= at["pretension"] <= at["band_end"]


def test_one_pretension_for_all_and_the_regret_of_each(motions: list[GroundMotion]) -> None:
    how: dict[str, Any] = {"period": 0.5, "stiffness_ratio": 4}
    own = fdspec.best_pretension(motions, **how)
    for statistic, over in (("mean", np.mean), ("worst", np.max)):
        best = fdspec.best_pretension(motions, **how, statistic=statistic)
        assert best["index"].item() == over(best["index_of_record"].values)
        assert best["regret"].values == pytest.approx((best["index_of_record"] / own["index"] - 1.0).values)
        assert (best["regret"] >= 0.0).all()
        cube = fdspec.sweep(motions, **how, pretension=np.arange(0.0, 300e3, 2e3))
        on_grid = best_for_all(index_of(cube), statistic)
        assert best["index"].item() <= on_grid["index"].item() * (1 + 1e-12)
        assert abs(best["pretension"] - on_grid["pretension"]).item() <= 4e3


def test_the_number_of_workers_changes_no_bit(motions: list[GroundMotion]) -> None:
    how: dict[str, Any] = {"period": [0.3, 0.5], "stiffness_ratio": [2, 8], "statistic": "mean"}
    one = fdspec.best_pretension(motions, **how, workers=1)
    assert one.equals(fdspec.best_pretension(motions, **how, workers=3))


def test_friction_only_scales_the_pretension(motions: list[GroundMotion]) -> None:
    how: dict[str, Any] = {"period": 0.5, "stiffness_ratio": 4}
    plain = fdspec.best_pretension(motions[0], **how)
    bolts = fdspec.best_pretension(motions[0], **how, friction_coefficient=0.25, normal_force_factor=4.0)
    assert bolts["slip_force"].item() == plain["slip_force"].item()
    assert bolts["pretension"].item() == pytest.approx(plain["pretension"].item() / 2.0)


def test_a_slip_load_spectrum_of_the_best(motions: list[GroundMotion]) -> None:
    best = fdspec.best_pretension(motions, period=[0.3, 0.5], stiffness_ratio=4)
    found = slip_load_spectrum(best, 20e3)["slip_coefficient"]
    assert found.dims == ("record", "stiffness_ratio", "period")
    assert (found > 0.0).all()
    assert (found < 2.0).all()


def test_doubling_motion_doubles_the_best_slip_force() -> None:
    """Filiatrault and Cherry: the optimum slip load goes with the peak ground acceleration."""
    motion = clipped("FSR1", 500)
    twice = GroundMotion(2.0 * motion.acceleration, motion.dt, name="twice")
    best = fdspec.best_pretension([motion, twice], period=0.5, stiffness_ratio=4)
    single, double = best["pretension"].values.ravel()
    assert double == pytest.approx(2.0 * single, rel=1e-9)
    assert np.ptp(best["index"].values) < 1e-9


@pytest.mark.parametrize(
    ("how", "said"),
    [
        ({"friction_coefficient": 0.0}, "friction_coefficient must be positive"),
        ({"band": -0.1}, "band must be zero or positive, got -0.1"),
        ({"statistic": "most"}, "statistic must be one of mean, median, p84, worst, got 'most'"),
        ({"index": "drift"}, "'drift' is none of"),
    ],
)
def test_what_cannot_be_searched_is_refused(
    motions: list[GroundMotion], how: dict[str, Any], said: str
) -> None:
    with pytest.raises(InvalidInput, match=said):
        fdspec.best_pretension(motions, period=0.5, stiffness_ratio=4, **how)


def test_a_motion_that_moves_nothing_is_refused() -> None:
    still = GroundMotion(np.zeros(50), 0.01, name="still")
    with pytest.raises(InvalidInput, match="still does not move the bare frame"):
        fdspec.best_pretension(still, period=0.5, stiffness_ratio=4)


# ---- buildings ----


@pytest.fixture(scope="module")
def building() -> Building:
    """Two storeys with massless braces, which are quickly integrated."""
    return Building.from_periods([20e3, 15e3], 0.6, 0.35, 1.0)


@pytest.fixture(scope="module")
def short() -> list[GroundMotion]:
    return [clipped("FSR1", 250), clipped("FMR2", 250)]


def same(one: Any, other: Any) -> bool:
    return all(np.array_equal(one[name], other[name]) for name in one.data_vars)


def test_a_bench_of_one_storey_and_the_engine_of_many_agree(short: list[GroundMotion]) -> None:
    one = Building.single_storey(0.5, 4.0, 1.0)
    # The same storey below one that weighs nothing to speak of and has no brace.
    two = Building(
        [20e3, 1e-6],
        [*one.storey_stiffness, 1e3],
        [50.0, 0.0],
        [*one.brace_stiffness, 0.0],
        [1.0, 0.0],
        damping=fdspec.DampingMatrix([[one.damping_matrix[0, 0], 0.0], [0.0, 0.0]]),
    )
    forces = np.array([[0.0], [10e3], [25e3], [80e3]])
    single = Bench(one, short, "rpi").judge(forces)
    double = Bench(two, short, {"rpi": 1.0}).judge(np.hstack([forces, 0.0 * forces]))
    assert double == pytest.approx(single, rel=1e-5)


def test_no_damper_slips_at_the_forces_that_none_reaches(
    building: Building, short: list[GroundMotion]
) -> None:
    bench = Bench(building, short)
    for frame in (bench, Bench(Building.single_storey(0.5, 4.0, 1.0), short)):
        assert (frame.respond(frame.never_slips[np.newaxis])["slip_travel"] == 0.0).all()
        assert (frame.respond(0.8 * frame.never_slips[np.newaxis])["slip_travel"] > 0.0).any()


@pytest.mark.parametrize("index", ["acceleration", "rpi"])
def test_a_free_distribution_is_never_worse_than_the_uniform_force_it_starts_from(
    building: Building, short: list[GroundMotion], index: str
) -> None:
    free = fdspec.optimise(building, short, index=index, population=3, generations=3, seed=4)
    assert free["index"] <= free["start_index"].min()
    uniform = fdspec.optimise(building, short, index=index, distribution="uniform")
    assert free["start_index"].sel(distribution="uniform").item() == uniform["index"].item()
    assert (np.diff(free["generation_index"]) <= 0.0).all()
    assert free["generation_index"].values[-1] == free["index"].item()
    bench = Bench(building, short, index)
    assert bench.judge(free["slip_force"].values[np.newaxis])[0] == free["index"].item()


def test_no_generation_at_all_keeps_the_best_start(building: Building, short: list[GroundMotion]) -> None:
    free = fdspec.optimise(building, short, population=1, generations=0)
    assert free["index"] <= free["start_index"].min()


def test_the_same_seed_gives_the_same_bits(building: Building, short: list[GroundMotion]) -> None:
    how: dict[str, Any] = {"index": "displacement", "population": 3, "generations": 4}
    one = fdspec.optimise(building, short, **how, seed=7, workers=1)
    assert same(one, fdspec.optimise(building, short, **how, seed=7, workers=3))
    assert not same(one, fdspec.optimise(building, short, **how, seed=8))


@pytest.mark.slow
def test_the_study_s_four_storeys_repeat_bit_for_bit() -> None:
    """The must-hold line: the same seed, other threads, the same bits; no worse than its start."""
    how: dict[str, Any] = {"index": "displacement", "population": 3, "generations": 5, "seed": 3}
    motions = [kalamata.stand_in(), fdspec.load_record("FSR1")]
    one = fdspec.optimise(four_storey.building(), motions, **how, workers=1)
    assert same(one, fdspec.optimise(four_storey.building(), motions, **how, workers=2))
    assert one["index"] < one["start_index"].min()


@pytest.mark.parametrize("statistic", ["mean", "median", "p84", "worst"])
def test_a_history_that_did_not_end_well_rules_its_forces_out(
    building: Building, short: list[GroundMotion], statistic: str
) -> None:
    bench = Bench(building, short, statistic=statistic)
    responses = bench.respond(np.array([[10e3, 10e3], [20e3, 20e3]]))
    responses["status"][0, 0] = 1.0
    found = bench.together(bench.index_of(responses))
    assert np.isinf(found[0])
    assert np.isfinite(found[1])


def test_uniform_and_shear_are_what_they_say(building: Building, short: list[GroundMotion]) -> None:
    uniform = fdspec.optimise(building, short, distribution="uniform")["slip_force"].values
    assert np.ptp(uniform) == 0.0
    shear = fdspec.optimise(building, short, distribution="shear")["slip_force"].values
    cube = fdspec.sweep_buildings(short, building, slip_scale=np.inf, stiffness_scale=1)
    profile = cube["peak_storey_shear"].mean("record").values.ravel()
    assert shear / shear[0] == pytest.approx(profile / profile[0], rel=1e-9)


def test_the_uniform_optimum_is_that_of_a_plain_scan(building: Building, short: list[GroundMotion]) -> None:
    best = fdspec.optimise(building, short, distribution="uniform", index="displacement")
    forces = np.linspace(0.0, best["slip_force"].values[0] * 3.0, 60)
    bench = Bench(building, short, "displacement")
    brute: NDArray[np.float64] = bench.judge(forces[:, np.newaxis] * np.ones(2))
    assert best["index"].item() <= brute.min() * (1 + 1e-3)


def test_storeys_without_a_brace_get_no_force(short: list[GroundMotion]) -> None:
    part = Building([20e3, 20e3], 30e6, [25.0, 0.0], [90e6, 0.0], [1.0, 0.0])
    free = fdspec.optimise(part, short, population=2, generations=1)
    assert free["slip_force"].values[1] == 0.0
    none = Building([20e3, 20e3], 30e6, 0.0, 0.0, 0.0)
    with pytest.raises(InvalidInput, match="no brace"):
        fdspec.optimise(none, short)


@pytest.mark.parametrize(
    ("how", "said"),
    [
        ({"distribution": "even"}, "distribution must be one of uniform, shear, free, got 'even'"),
        ({"population": 0}, "population must be a whole number of at least 1, got 0"),
        ({"generations": 1.5}, "generations must be a whole number of at least 0, got 1.5"),
        ({"seed": -1}, "seed must be a whole number of at least 0, got -1"),
    ],
)
def test_what_cannot_be_optimised_is_refused(
    building: Building, short: list[GroundMotion], how: dict[str, Any], said: str
) -> None:
    with pytest.raises(InvalidInput, match=said):
        fdspec.optimise(building, short, **how)


def test_a_building_is_asked_for(short: list[GroundMotion]) -> None:
    with pytest.raises(InvalidInput, match="building must be a Building, got str"):
        fdspec.optimise("four storeys", short)  # type: ignore[arg-type]
