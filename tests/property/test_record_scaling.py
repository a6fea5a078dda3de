"""Long files: every reader's work grows as their length does, and its memory stays within ten times of it.

Work is counted in calls, not timed, so that the machine's other business does not matter. What a search does
inside is not counted; each works on the head of a line, which is bounded, and their time has a bound that
only a search whose time grows with the square of its text misses.
"""

import sys
import time
import tracemalloc
import warnings

import numpy as np
import pytest

from fdspec.errors import RecordError
from fdspec.records import read_channels
from tests.fixtures.records.samples import SAMPLES

FILLERS = [
    " ", "0 ", "1.0-", "(", "acceleration in ", "units ", "x y ", ": ", '"', "\t", "1.5", "[", "a", "accel ",
    "in ", "= ", ";", ",", "#", "-", "e", "999", "NPTS=1 ", "time step ", "number of of of ", "units=(",
    "station ", "|",
]  # fmt: skip


def read(path, content, **given):
    path.write_bytes(content.encode())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return read_channels(path, **given)
        except RecordError:
            return {}


def work(path, content, **given):
    """Return how many Python functions, and built-in ones, a reading calls."""
    calls = 0

    def count(frame, event, argument):
        nonlocal calls
        calls += event in {"call", "c_call"}

    sys.setprofile(count)
    try:
        read(path, content, **given)
    finally:
        sys.setprofile(None)
    return calls


def adversary(filler, size, shape):
    line = (filler * 9_000)[:9_000]
    if shape == "one line":
        return (filler * size)[:size]
    if shape == "lines":
        return "\n".join([line] * (size // 9_000))
    return "\n".join([line] * (size // 18_000)) + "\n" + "0.1 0.2\n" * (size // 16)


@pytest.mark.parametrize("shape", ["one line", "lines", "long header"])
@pytest.mark.parametrize("filler", FILLERS[:9])
def test_work_grows_no_faster_than_the_file(tmp_path, filler, shape):
    path = tmp_path / "long.dat"
    sizes = (36_000, 72_000)
    small, large = (work(path, adversary(filler, size, shape), units="g", dt=0.01) for size in sizes)
    assert large <= 2.5 * small + 2_000


@pytest.mark.slow
@pytest.mark.parametrize("shape", ["one line", "lines", "long header"])
def test_megabytes_of_nonsense_are_judged_in_seconds(tmp_path, shape):
    """A search whose time grows with the square of a line takes minutes here."""
    for filler in FILLERS:
        start = time.perf_counter()
        read(tmp_path / "long.dat", adversary(filler, 1_500_000, shape), units="g", dt=0.01)
        assert time.perf_counter() - start < 60.0, filler


@pytest.mark.parametrize("name", SAMPLES)
def test_a_long_line_anywhere_in_a_header_costs_no_more_than_its_length(tmp_path, name):
    lines = SAMPLES[name][0].splitlines()
    path = tmp_path / "long.dat"
    plain = work(path, "\n".join(lines))
    for number in range(0, len(lines), max(len(lines) // 6, 1)):
        for filler in (" ", "units=", "(", "a: "):
            damaged = [*lines]
            damaged[number] += (filler * 9_000)[:9_000]
            start = time.perf_counter()
            calls = work(path, "\n".join(damaged))
            assert calls <= 30 * plain + 60_000
            assert time.perf_counter() - start < 20.0


def long_files(n):
    values = np.sin(0.01 * np.arange(n)) + 0.3 * np.sin(1.7 * np.arange(n))
    words = [f"{value:.4f}" for value in values]
    times = [f"{0.01 * k:.2f}" for k in range(n)]
    rows = list(zip(times, words, strict=True))
    at2 = f"PEER\nA,B,C\nACCELERATION TIME HISTORY IN UNITS OF G\nNPTS={n}, DT=0.01\n"
    return {
        "one value a line": "Accel (g)\nDT = 0.01\n" + "\n".join(words),
        "comma": "Time (s),Accel (g)\n" + "\n".join(f"{t},{a}" for t, a in rows),
        "decimal comma": ("Zeit (s);a (g)\n" + "\n".join(f"{t};{a}" for t, a in rows)).replace(".", ","),
        "quoted": "Time (s),Accel (g)\n" + "\n".join(f'"{t}","{a}"' for t, a in rows),
        "running": f"NPTS={n}, DT=0.01\nAcceleration in g\n"
        + "\n".join(" ".join(words[k : k + 8]) for k in range(0, n, 8)),
        "AT2": at2 + "\n".join("".join(f"{x:15.7E}" for x in values[k : k + 5]) for k in range(0, n, 5)),
    }


@pytest.mark.parametrize("name", long_files(1))
def test_memory_stays_within_ten_times_the_file(tmp_path, name):
    content = long_files(20_000)[name]
    path = tmp_path / "long.dat"
    path.write_text(content)
    read_channels(path)  # what is imported and cached is no part of it
    tracemalloc.start()
    (motion,) = read_channels(path).values()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert motion.n == 20_000
    assert peak < 10 * len(content)
