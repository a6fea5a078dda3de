"""Damaged files: every reader refuses them with RecordError, or reads what they still say; no third way.

A few hundred mutations a reader run always, 10,000 with `pytest -m slow`.
"""

import random
import time
import warnings

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fdspec.errors import RecordError
from fdspec.records import read_channels
from fdspec.records.reading import read_record
from tests.fixtures.records import samples
from tests.fixtures.records.layouts import layouts
from tests.fixtures.records.samples import SAMPLES

SEED = 20261122
LONGEST = 2.0  # s; the files are a few kB, and each is read in milliseconds

WORDS = [
    b"nan",
    b"inf",
    b"-inf",
    b"1e999",
    b"-1e-999",
    b"1e-99999999999999999999",
    b"9" * 400,
    b"*****",
    b"0",
    b"-1",
    b"2147483648",
    b"1e308",
    b"\x00",
    b"\xff\xfe",
    b"\r",
    b"\n\n",
    b"\t",
    b",",
    b";",
    b"1.5.2",
    b"0x1F",
    b"1_0",
    b"__import__('os').abort()",
    "\u0661\u0662".encode(),
    b" " * 300,
    b"NPTS=",
    b"=",
    b"(",
    b"%s%n",
]


def mutate(content: bytes, chance: random.Random) -> bytes:
    """Return the content with one to four wounds: bytes, words, lines, lengths."""
    damaged = bytearray(content)
    for _ in range(chance.randint(1, 4)):
        at = chance.randrange(len(damaged) + 1)
        kind = chance.randrange(9)
        if kind == 0 and at < len(damaged):
            damaged[at] = chance.randrange(256)
        elif kind == 1:
            damaged[at : at + chance.randint(1, 12)] = b""
        elif kind == 2:
            damaged[at:at] = chance.choice(WORDS)
        elif kind == 3:
            word = chance.choice(WORDS)
            damaged[at : at + len(word)] = word
        elif kind == 4:
            del damaged[at:]
        elif kind == 5:
            lines = bytes(damaged).split(b"\n")
            line = chance.randrange(len(lines))
            lines[line:line] = [lines[chance.randrange(len(lines))]] * chance.randint(1, 3)
            damaged = bytearray(b"\n".join(lines))
        elif kind == 6:
            lines = bytes(damaged).split(b"\n")
            del lines[chance.randrange(len(lines))]
            damaged = bytearray(b"\n".join(lines))
        elif kind == 7 and at < len(damaged):
            digits = [k for k in range(min(len(damaged), 6000)) if 48 <= damaged[k] <= 57]
            if digits:
                damaged[chance.choice(digits)] = 48 + chance.randrange(10)
        else:
            start = chance.randrange(len(damaged) + 1)
            damaged[at:at] = damaged[start : start + chance.randint(1, 400)]
    return bytes(damaged)


def check(path, content: bytes, count: int | None = None, **arguments) -> bool:
    """Read the content and say whether it was accepted; fail on any error but RecordError, and on delay.

    With `count`, what is accepted must have that many samples.
    """
    path.unlink(missing_ok=True)  # a file that is cut to nothing first waits for the disk
    path.write_bytes(content)
    start = time.perf_counter()
    refusal = None
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message=".*the unit looks wrong|.*look like g")
            motions = read_channels(path, **arguments)
    except RecordError as error:
        refusal = str(error)
    assert time.perf_counter() - start < LONGEST
    if refusal is not None:
        assert path.name in refusal
        assert "\n" not in refusal
        return False
    assert motions
    for motion in motions.values():
        assert len(motion) >= 2
        assert count is None or len(motion) == count
        assert np.isfinite(motion.acceleration).all()
        # A damaged header cannot make a file give more numbers than it holds.
        assert len(motion) <= len(content)
    return True


def fuzz(path, name: str, count: int) -> None:
    chance = random.Random(f"{SEED} {name}")
    content = SAMPLES[name][0].encode()
    units = {"units": "cm/s2"} if name == "columns of text" else {}
    path.write_bytes(content)
    # Plain columns carry no count, and a cut file is a shorter one; all other formats must keep theirs.
    whole = None if units else len(next(iter(read_channels(path).values())))
    accepted = sum(check(path, mutate(content, chance), whole, **units) for _ in range(count))
    # Not all wounds show: a changed digit of a value is another value. But most must.
    assert accepted < 0.7 * count


@pytest.mark.parametrize("name", SAMPLES)
def test_mutated_files(tmp_path, name):
    fuzz(tmp_path / "mutated.dat", name, 300)


@pytest.mark.slow
@pytest.mark.parametrize("name", SAMPLES)
def test_ten_thousand_mutated_files(tmp_path, name):
    fuzz(tmp_path / "mutated.dat", name, 10_000)


def fuzz_miniseed(path, count: int) -> None:
    pytest.importorskip("obspy", reason="obspy is in the extra miniseed")
    chance = random.Random(f"{SEED} miniseed")
    content = samples.miniseed()
    for _ in range(count):
        check(path, mutate(content, chance), units="cm/s2")


@pytest.mark.filterwarnings("ignore")  # obspy's own
def test_mutated_miniseed(tmp_path):
    fuzz_miniseed(tmp_path / "mutated.dat", 300)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_ten_thousand_mutated_miniseed(tmp_path):
    fuzz_miniseed(tmp_path / "mutated.dat", 10_000)


def fuzz_sac(path, count: int) -> None:
    pytest.importorskip("obspy", reason="obspy is in the extra miniseed")
    chance = random.Random(f"{SEED} sac")
    content = samples.sac()
    for _ in range(count):
        check(path, mutate(content, chance), units="cm/s2")


@pytest.mark.filterwarnings("ignore")
def test_mutated_sac(tmp_path):
    fuzz_sac(tmp_path / "mutated.dat", 300)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_ten_thousand_mutated_sac(tmp_path):
    fuzz_sac(tmp_path / "mutated.dat", 10_000)


def fuzz_layouts(path, count: int) -> None:
    """Damage rows under words too: what is read then is no error, but nothing may crash or hang."""
    chance = random.Random(f"{SEED} layouts")
    drawn = layouts(SEED, 40)
    for _ in range(count):
        layout = chance.choice(drawn)
        check(path, mutate(layout.content, chance), **layout.options)


def test_mutated_layouts(tmp_path):
    fuzz_layouts(tmp_path / "mutated.dat", 600)


@pytest.mark.slow
def test_ten_thousand_mutated_layouts(tmp_path):
    fuzz_layouts(tmp_path / "mutated.dat", 10_000)


@pytest.mark.parametrize("name", sorted(set(SAMPLES) - {"columns of text"}))
def test_a_lost_or_doubled_line_of_values_is_never_read(tmp_path, name):
    """All formats but plain columns say how many values there are; a line too few or too many shows."""
    lines = SAMPLES[name][0].splitlines()
    path = tmp_path / "damaged.dat"
    first = {"GeoNet V1A or V2A": 68, "COSMOS V1 or V2": 94}.get(name, len(lines) - 4)
    for line in range(first, len(lines) - 1):
        assert not check(path, "\n".join(lines[:line] + lines[line + 1 :]).encode())
        assert not check(path, "\n".join([*lines[:line], lines[line], *lines[line:]]).encode())


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.binary(max_size=400))
def test_any_bytes(tmp_path, content):
    if content:
        check(tmp_path / "any.dat", content)
        check(tmp_path / "any.AT2", content, units="g", dt=0.01)


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.text(alphabet="0123456789+-.eED,; \t\n#[]gm/s2", max_size=300))
def test_any_text_of_numbers(tmp_path, content):
    if content:
        check(tmp_path / "any.dat", content.encode(), units="g", dt=0.01)
        check(tmp_path / "any.dat", content.encode())


@pytest.mark.parametrize("name", SAMPLES)
def test_memory_does_not_follow_a_claimed_count(tmp_path, name):
    """A header that claims 10^9 values must not make room for them."""
    import tracemalloc

    content = SAMPLES[name][0].replace("23", "999999999").encode()
    path = tmp_path / "claims.dat"
    tracemalloc.start()
    check(path, content, **({"units": "cm/s2"} if name == "columns of text" else {}))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 20e6


@pytest.mark.parametrize("filler", [" ", "\t", "0", "station ", "1.0-", "#", "units=(", "("])
def test_long_lines_do_not_hang(tmp_path, filler):
    for first in ("station = ", "Sta Chan ", "Corrected acceleration (Format ", ""):
        line = (first + filler * 9_000)[:9_990]
        check(tmp_path / "long.dat", "\n".join([line] * 40).encode())


def test_a_file_that_vanishes_is_refused(tmp_path):
    path = tmp_path / "gone.AT2"
    path.symlink_to(tmp_path / "nowhere")
    with pytest.raises(RecordError, match="there is no such file"):
        read_record(path)
