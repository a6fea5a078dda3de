"""Layouts from all combinations of words, units, separators, decimal marks, orders and encodings.

Each is read rightly or refused, never read wrongly; and what can be read in one way only is read.
"""

import warnings
from collections import Counter

import numpy as np
import pytest

from fdspec.errors import RecordError
from fdspec.records import read_channels
from tests.fixtures.records.layouts import KINDS, layouts

READ = {"columns": 0.93, "running": 0.98, "bare": 0.78}
"""Least share that is read; the rest can be read in two ways, and is refused."""


def judge(path, layout):
    """Return what became of a layout: "read", "refused"; fail when it was read wrongly."""
    path.write_bytes(layout.content)
    refusal = None
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message=".*the unit looks wrong|.*look like g")
            motions = read_channels(path, **layout.options)
    except RecordError as error:
        refusal = str(error)
    if refusal is not None:
        assert not (layout.clear and layout.motion), (layout.said, layout.options, refusal)
        assert "\n" not in refusal
        return "refused"
    assert layout.motion, layout.said
    about = (layout.said, layout.options, list(motions))
    assert len(motions) == len(layout.channels), about
    for motion, expected in zip(motions.values(), layout.channels, strict=True):
        assert motion.dt == pytest.approx(layout.dt, rel=1e-12), about
        assert motion.n == len(expected), about
        np.testing.assert_allclose(motion.acceleration, expected, rtol=1e-12, atol=1e-13, err_msg=str(about))
    return "read"


def judge_all(path, seed, count):
    found = Counter((layout.said["kind"], judge(path, layout)) for layout in layouts(seed, count))
    for kind, least in READ.items():
        read, refused = found[kind, "read"], found[kind, "refused"]
        assert read >= least * (read + refused)
    assert sum(read for (kind, what), read in found.items() if what == "read" and kind not in READ) == 0
    assert sum(found.values()) == count
    assert len(KINDS) == 4


def test_a_sample_of_all_layouts(tmp_path):
    judge_all(tmp_path / "layout.txt", 2026, 1200)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_thousands_of_layouts(tmp_path, seed):
    judge_all(tmp_path / "layout.txt", 7000 + seed, 6000)
