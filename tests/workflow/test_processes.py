"""Workers may be processes: the same bits as from threads."""

from __future__ import annotations

import multiprocessing

import numpy as np
import pytest
import xarray as xr

import fdspec
import fdspec.errors


def motion() -> fdspec.GroundMotion:
    """One second of noise, 4 m/s2 at most, from a fixed seed."""
    noise = np.random.default_rng(5).standard_normal(50)
    return fdspec.GroundMotion(noise, 0.02, "short").scaled_to_pga(4.0)


def frames(scheduler: str) -> xr.Dataset:
    return fdspec.sweep(
        motion(),
        period=[0.2, 0.5],
        pretension=[20e3, np.inf],
        stiffness_ratio=[4.0],
        workers=2,
        scheduler=scheduler,
        columns_per_task=1,
    )


def buildings(scheduler: str) -> xr.Dataset:
    building = fdspec.Building([20e3, 18e3], [12e6, 9e6], 50.0, 30e6, [20e3, 10e3])
    return fdspec.sweep_buildings(
        motion(),
        {"two": building},
        slip_scale=[0.5, 1.0],
        stiffness_scale=[1.0],
        workers=2,
        scheduler=scheduler,
        cells_per_task=1,
    )


@pytest.mark.slow
@pytest.mark.parametrize("swept", [frames, buildings])
def test_processes_give_the_bits_of_threads(swept) -> None:
    threads, processes = swept("threads"), swept("processes")
    assert int(threads.transitions.sum()) > 10
    assert processes.drop_attrs(deep=False).identical(threads.drop_attrs(deep=False))


def peak(scheduler: str) -> float:
    return float(frames(scheduler).peak_acceleration.max())


def answered(scheduler: str) -> object:
    """Give what a sweep says in a forked process, the answer or the error."""
    try:
        return peak(scheduler)
    except fdspec.errors.InvalidInput as error:
        return str(error)


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="no fork here")
@pytest.mark.filterwarnings("ignore:.*use of fork:DeprecationWarning")
def test_a_forked_child_sweeps_after_its_parent() -> None:
    expected = peak("threads")
    with multiprocessing.get_context("fork").Pool(1) as pool:
        told = pool.map_async(answered, ["threads", "synchronous", "processes"], chunksize=1).get(60)
    assert told[:2] == [expected, expected]
    assert told[2].startswith("a process of a multiprocessing.Pool can start no processes")
