"""save and open: what stands in the file, what comes back, and every refusal's text."""

import re
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray as xr

from fdspec import store
from fdspec.errors import StoreError
from tests.cubes import RECORDS, synthetic_cube, synthetic_history

DATASETS = {
    "cube": synthetic_cube(),
    "history": synthetic_history(),
    "history without transitions": synthetic_history(transitions=0),
}


def assert_same(one: xr.Dataset, other: xr.Dataset) -> None:
    """Equal to the bit, with types, order and attributes."""
    xr.testing.assert_identical(one, other)
    assert list(one.variables) == list(other.variables)
    assert list(one.attrs) == list(other.attrs)
    assert dict(one.sizes) == dict(other.sizes)
    for name, variable in one.variables.items():
        assert variable.dtype == other[name].dtype
        assert variable.to_numpy().tobytes() == other[name].to_numpy().tobytes()
        assert list(variable.attrs) == list(other[name].attrs)


@pytest.mark.parametrize("dataset", DATASETS.values(), ids=DATASETS)
def test_round_trip(tmp_path, dataset):
    path = tmp_path / "file.nc"
    store.save(dataset, path)
    assert_same(store.open(path), dataset)
    with store.open(path, lazily=True) as opened:
        assert_same(opened, dataset)


@pytest.mark.parametrize("dataset", DATASETS.values(), ids=DATASETS)
def test_same_dataset_same_bytes(tmp_path, dataset):
    first, second, again = (tmp_path / name for name in ["a.nc", "b.nc", "c.nc"])
    store.save(dataset, first)
    store.save(dataset, second)
    store.save(store.open(first), again)
    assert first.read_bytes() == second.read_bytes() == again.read_bytes()


def test_records_are_selected_by_name(tmp_path):
    cube = synthetic_cube()
    store.save(cube, tmp_path / "cube.nc")
    opened = store.open(tmp_path / "cube.nc")
    for record in RECORDS:
        np.testing.assert_array_equal(
            opened.sel(record=record)["peak_acceleration"], cube.sel(record=record)["peak_acceleration"]
        )


def test_save_changes_nothing_in_memory(tmp_path):
    cube = synthetic_cube()
    before = cube.copy(deep=True)
    store.save(cube, tmp_path / "cube.nc")
    assert_same(cube, before)


def test_lazily_reads_numbers_when_used(tmp_path):
    store.save(synthetic_cube(), tmp_path / "cube.nc")
    with store.open(tmp_path / "cube.nc", lazily=True) as opened:
        assert not opened["peak_acceleration"].variable._in_memory
        assert opened["source"].variable._in_memory


def test_opened_file_is_closed(tmp_path):
    path = tmp_path / "cube.nc"
    store.save(synthetic_cube(), path)
    opened = store.open(path)
    path.write_bytes(b"overwritten by somebody else")
    assert_same(opened, synthetic_cube())


@pytest.mark.parametrize("record", [["a", "longer"], ["a", "b"], ["", ""]])
@pytest.mark.parametrize("dtype", ["<U1", "<U12", "object", np.dtypes.StringDType()], ids=str)
def test_text_of_every_kind_keeps_its_type(tmp_path, record, dtype):
    labels = np.array(record, dtype="object" if dtype == "<U1" else dtype).astype(dtype)
    dataset = xr.Dataset({"note": ("n", labels), "one": ((), labels[0])}, coords={"n": [0.5, 1.5]})
    store.save(dataset, tmp_path / "file.nc")
    opened = store.open(tmp_path / "file.nc")
    assert opened["note"].dtype == dataset["note"].dtype
    assert opened["note"].values.tolist() == labels.tolist()
    assert opened["one"].item() == labels[0]


def test_layout_on_disk(tmp_path):
    store.save(synthetic_cube(), tmp_path / "cube.nc")
    with netCDF4.Dataset(tmp_path / "cube.nc") as file:
        assert file["record"].dtype == np.int32
        assert file["record_id"].dtype == "S1"
        assert file["record_id"].dimensions[0] == "record"
        assert "record_id" in file["peak_acceleration"].coordinates.split()
        for name, variable in file.variables.items():
            assert variable.dtype is not str, f"{name} is an NC_STRING"
            assert "_FillValue" not in variable.ncattrs()
            assert variable.dtype == file[name].dtype
        filters = file["peak_acceleration"].filters()
        assert (filters["zlib"], filters["complevel"], filters["shuffle"]) == (True, 1, True)
        assert not filters["zstd"]
        assert file["period"].dtype == np.float64
        assert file.Conventions == "CF-1.11"


def test_time_stands_along_samples_on_disk(tmp_path):
    store.save(synthetic_history(), tmp_path / "history.nc")
    with netCDF4.Dataset(tmp_path / "history.nc") as file:
        assert file["time"].dimensions == ("sample",)
        assert file["displacement"].dimensions == ("sample", "storey")


@pytest.mark.parametrize("value", [True, None, {"a": 1}, ["a", "b"], [], [[1.0]], 1j], ids=repr)
def test_attributes_that_a_file_cannot_hold(tmp_path, value):
    cube = synthetic_cube()
    with pytest.raises(StoreError, match=r"attribute 'odd' of the dataset is .* as JSON text"):
        store.save(cube.assign_attrs(odd=value), tmp_path / "cube.nc")
    cube["period"].attrs["odd"] = value
    with pytest.raises(StoreError, match="attribute 'odd' of variable 'period'"):
        store.save(cube, tmp_path / "cube.nc")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["fdspec_format", "fdspec_labels", "fdspec_dim", "fdspec_dtype"])
def test_attributes_that_a_file_needs(tmp_path, name):
    with pytest.raises(StoreError, match=f"a file needs the attribute '{name}' for itself"):
        store.save(synthetic_cube().assign_attrs({name: 1}), tmp_path / "cube.nc")


@pytest.mark.parametrize(
    ("values", "text"),
    [
        (np.array([1j, 2j]), "has dtype complex128; a file holds numbers and text only"),
        (np.array(["2020-01-01", "2021-01-01"], dtype="M8[ns]"), r"has dtype datetime64\[ns\]"),
        (np.array(["a", 1], dtype=object), "holds objects that are no text"),
        (np.array([1.0, 2.0], dtype="float16"), "cannot write"),
    ],
    ids=["complex", "datetime", "object", "half"],
)
def test_values_that_a_file_cannot_hold(tmp_path, values, text):
    with pytest.raises(StoreError, match=text):
        store.save(xr.Dataset({"odd": ("n", values)}), tmp_path / "cube.nc")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("dataset", "name"),
    [
        (xr.Dataset({"record_id": 1.0}, coords={"record": ["a", "b"]}), "record_id"),
        (xr.Dataset({"sample": 1.0}, coords={"time": [0.0, 1.0]}), "sample"),
    ],
    ids=["labels", "time"],
)
def test_names_that_a_file_needs(tmp_path, dataset, name):
    with pytest.raises(StoreError, match=f"a file needs the name '{name}' for itself"):
        store.save(dataset, tmp_path / "file.nc")


def test_save_does_not_overwrite_when_told(tmp_path):
    store.save(synthetic_cube(seed=1), tmp_path / "cube.nc")
    with pytest.raises(StoreError, match="exists already"):
        store.save(synthetic_cube(seed=2), tmp_path / "cube.nc", overwrite=False)
    assert_same(store.open(tmp_path / "cube.nc"), synthetic_cube(seed=1))
    store.save(synthetic_cube(seed=2), tmp_path / "cube.nc")
    assert_same(store.open(tmp_path / "cube.nc"), synthetic_cube(seed=2))


def test_interrupted_save_keeps_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "cube.nc"
    store.save(synthetic_cube(seed=1), path)
    write = xr.Dataset.to_netcdf

    def interrupted(self, *arguments, **options):
        write(self, *arguments, **options)
        raise KeyboardInterrupt

    monkeypatch.setattr(xr.Dataset, "to_netcdf", interrupted)
    with pytest.raises(KeyboardInterrupt):
        store.save(synthetic_cube(seed=2), path)
    assert [file.name for file in tmp_path.iterdir()] == ["cube.nc"]
    assert_same(store.open(path), synthetic_cube(seed=1))


def refusal(path: Path, text: str) -> str:
    return f"cannot open {re.escape(str(path))}: {text}"


def test_open_missing(tmp_path):
    path = tmp_path / "cube.nc"
    with pytest.raises(StoreError, match=refusal(path, "there is no such file")):
        store.open(path)


def test_open_folder(tmp_path):
    with pytest.raises(StoreError, match=refusal(tmp_path, "it is a folder; name a netCDF file in it")):
        store.open(tmp_path)


def test_open_through_a_file(tmp_path):
    (tmp_path / "file").write_text("x")
    with pytest.raises(StoreError, match="cannot open .*Not a directory"):
        store.open(tmp_path / "file" / "cube.nc")


@pytest.mark.parametrize("content", [b"", b"record,period\n", b"\x89PNG\r\n\x1a\n"])
def test_open_what_is_not_netcdf(tmp_path, content):
    path = tmp_path / "cube.nc"
    path.write_bytes(content)
    with pytest.raises(StoreError, match=refusal(path, "it is not a netCDF file")):
        store.open(path)


def test_open_what_another_program_wrote(tmp_path):
    path = tmp_path / "cube.nc"
    xr.Dataset({"x": ("n", [1.0, 2.0])}).to_netcdf(path)
    with pytest.raises(StoreError, match=refusal(path, "it is an export or another program's netCDF file; ")):
        store.open(path)


def test_open_what_a_later_version_wrote(tmp_path):
    path = tmp_path / "cube.nc"
    store.save(synthetic_cube(), path)
    with netCDF4.Dataset(path, "a") as file:
        file.fdspec_format = np.int32(99)
    with pytest.raises(StoreError, match=refusal(path, "its layout is version 99, .* upgrade fdspec")):
        store.open(path)


@pytest.mark.parametrize("part", [0.02, 0.5, 0.99])
def test_open_damaged(tmp_path, part):
    path = tmp_path / "cube.nc"
    store.save(synthetic_cube(), path)
    content = path.read_bytes()
    path.write_bytes(content[: int(part * len(content))])
    with pytest.raises(StoreError, match=refusal(path, "the file is damaged or incomplete")):
        store.open(path)


def test_open_with_damaged_values(tmp_path):
    path = tmp_path / "cube.nc"
    cube = synthetic_cube(shape=(4, 10, 50))
    store.save(cube, path)
    content = bytearray(path.read_bytes())
    # Only compressed values are that dense: break the middle of the file and leave its directory alone.
    middle = len(content) // 2
    content[middle : middle + 2000] = bytes(2000)
    path.write_bytes(content)
    with pytest.raises(StoreError, match=refusal(path, "the file is damaged or incomplete")):
        store.open(path)
