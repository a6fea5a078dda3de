"""Any dataset of numbers and text comes back from its file, to the bit."""

import tempfile
from pathlib import Path

import hypothesis.extra.numpy as arrays
import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from fdspec import store
from tests.cubes import synthetic_cube, synthetic_history

# No surrogates: they are no text to UTF-8. No NUL: C programs end their text there.
TEXT = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=12)
NAMES = st.sampled_from(["alpha", "beta", "gamma", "delta", "time", "record", "period", "x_id"])
DTYPES = ["float64", "float32", "int64", "int32", "int8", "uint8", "bool", "text", "object"]


@st.composite
def variables(draw, sizes):
    dims = tuple(draw(st.lists(st.sampled_from(sorted(sizes)), unique=True, max_size=3))) if sizes else ()
    return dims, draw(values(tuple(sizes[dim] for dim in dims))), draw(attributes())


@st.composite
def values(draw, shape):
    dtype = draw(st.sampled_from(DTYPES))
    if dtype in {"text", "object"}:
        texts = draw(st.lists(TEXT, min_size=int(np.prod(shape)), max_size=int(np.prod(shape))))
        return np.array(texts, dtype=object).reshape(shape).astype(str if dtype == "text" else object)
    return draw(arrays.arrays(dtype, shape))


def attributes():
    numbers = st.integers(-(2**31), 2**31 - 1) | st.floats(allow_nan=False) | TEXT
    lists = arrays.arrays("float64", st.integers(2, 4), elements=st.floats(allow_nan=False))
    return st.dictionaries(
        st.sampled_from(["units", "long_name", "note", "coefficient"]), numbers | lists, max_size=3
    )


@st.composite
def datasets(draw):
    sizes = draw(st.dictionaries(NAMES, st.integers(0, 4), max_size=3))
    coords = {}
    for dim, size in sizes.items():
        if draw(st.booleans()):
            coords[dim] = (dim, draw(values((size,))), draw(attributes()))
    taken = set(sizes) | {"record_id"}
    data = draw(st.dictionaries(st.sampled_from(["a", "b", "c", "d"]), variables(sizes), max_size=3))
    auxiliary = draw(st.dictionaries(st.sampled_from(["e", "f"]), variables(sizes), max_size=2))
    assert not taken & {*data, *auxiliary}
    return xr.Dataset(data, coords | auxiliary, draw(attributes()))


def bits(variable):
    array = variable.to_numpy()
    return array.tolist() if array.dtype.kind == "O" else array.tobytes()


@given(datasets())
@settings(max_examples=40)
def test_round_trip(dataset):
    goes_round(dataset)


@pytest.mark.slow
@given(datasets())
@settings(max_examples=600)
def test_many_round_trips(dataset):
    goes_round(dataset)


def goes_round(dataset):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "file.nc")
        store.save(dataset, path)
        opened = store.open(path)
        store.save(opened, Path(folder, "again.nc"))
        assert path.read_bytes() == Path(folder, "again.nc").read_bytes()
    assert list(opened.variables) == list(dataset.variables)
    assert list(opened.coords) == list(dataset.coords)
    assert dict(opened.sizes) == {
        name: size
        for name, size in dataset.sizes.items()
        if any(name in v.dims for v in dataset.variables.values())
    }
    assert opened.attrs.keys() == dataset.attrs.keys()
    for name, variable in dataset.variables.items():
        back = opened.variables[name]
        assert back.dims == variable.dims
        assert back.dtype == variable.dtype
        assert bits(back) == bits(variable)
        assert list(back.attrs) == list(variable.attrs)
        for key, value in variable.attrs.items():
            np.testing.assert_array_equal(back.attrs[key], value)


@given(
    st.lists(TEXT.filter(bool), min_size=1, max_size=3, unique=True),
    st.tuples(st.integers(1, 3), st.integers(1, 3), st.integers(1, 3)),
    st.integers(0, 100),
)
@settings(max_examples=25)
def test_cubes(records, shape, seed):
    cube = synthetic_cube(records, shape, seed)
    with tempfile.TemporaryDirectory() as folder:
        store.save(cube, Path(folder, "cube.nc"))
        opened = store.open(Path(folder, "cube.nc"))
    xr.testing.assert_identical(opened, cube)
    for record in records:
        assert opened.sel(record=record).identical(cube.sel(record=record))


@given(st.integers(1, 4), st.integers(1, 3), st.integers(0, 3), TEXT, st.integers(0, 100))
@settings(max_examples=25)
def test_histories(samples, storeys, transitions, record, seed):
    history = synthetic_history(samples, storeys, transitions, record, seed)
    with tempfile.TemporaryDirectory() as folder:
        store.save(history, Path(folder, "history.nc"))
        opened = store.open(Path(folder, "history.nc"))
    xr.testing.assert_identical(opened, history)
