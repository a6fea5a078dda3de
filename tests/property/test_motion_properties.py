"""GroundMotion under any samples."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from fdspec.model.motion import GroundMotion

samples = arrays(np.float64, st.integers(2, 50), elements=st.floats(-40.0, 40.0))
steps = st.floats(1e-6, 10.0)


@given(samples, steps)
def test_keeps_what_it_is_given(acceleration, dt):
    motion = GroundMotion(acceleration, dt)
    assert np.array_equal(motion.acceleration, acceleration)
    assert motion.dt == dt
    assert motion.pga == np.abs(acceleration).max()


@given(samples, steps, st.floats(-1.0, 1.0))
def test_scaling_is_a_product_to_the_bit(acceleration, dt, factor):
    motion = GroundMotion(acceleration, dt).scaled(factor)
    assert np.array_equal(motion.acceleration, acceleration * factor)
    assert motion.scale_factor == factor


@given(samples.filter(lambda a: np.abs(a).max() > 1e-9), steps, st.floats(1e-3, 40.0))
def test_scaling_to_a_pga_reaches_it(acceleration, dt, pga):
    motion = GroundMotion(acceleration, dt).scaled_to_pga(pga)
    assert abs(motion.pga - pga) <= 2.0 * np.spacing(pga)  # one rounding of the factor, one of the product


@given(samples, steps)
def test_mirroring_twice_gives_the_same_bits(acceleration, dt):
    motion = GroundMotion(acceleration, dt)
    assert motion.scaled(-1.0).scaled(-1.0).checksum == motion.checksum
