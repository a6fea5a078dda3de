"""export: one record for other tools, to the bit, and its refusals."""

import csv
import re

import netCDF4
import numpy as np
import pandas as pd
import pytest
import xarray as xr

from fdspec import store
from fdspec.errors import StoreError
from fdspec.variables import STATUSES
from tests.cubes import synthetic_building_cube, synthetic_cube, synthetic_history

DIMS = ("stiffness_ratio", "pretension", "period")


def test_netcdf_has_three_dims_and_no_text(tmp_path):
    cube = synthetic_cube()
    store.export(cube, tmp_path / "one.nc", record="FMR2")
    with netCDF4.Dataset(tmp_path / "one.nc") as file:
        assert tuple(file.dimensions) == DIMS
        for variable in file.variables.values():
            assert variable.dtype.kind in "if"
            assert "coordinates" not in variable.ncattrs()
        assert file["peak_acceleration"].dimensions == DIMS
        assert file.record == "FMR2"
        assert file.record_event == cube.sel(record="FMR2")["event"].item()
        assert file["pga"].units == "m/s^2"
        for name in ["peak_acceleration", "transitions", "braced_acceleration", "slip_force", "pga"]:
            expected = cube.sel(record="FMR2")[name].to_numpy()
            assert file[name][...].data.tobytes() == expected.tobytes()


def test_netcdf_of_buildings_names_them_in_their_order(tmp_path):
    cube = synthetic_building_cube()
    store.export(cube, tmp_path / "one.nc", record="FMR2")
    with netCDF4.Dataset(tmp_path / "one.nc") as file:
        assert all(variable.dtype.kind in "if" for variable in file.variables.values())
        assert file.building == "office, hôtel 2"
        assert file["peak_drift"].dimensions == ("building", "stiffness_scale", "slip_scale", "storey")
        expected = cube.sel(record="FMR2")["peak_drift"].to_numpy()
        assert file["peak_drift"][...].data.tobytes() == expected.tobytes()


def read_csv(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    heading = [line for line in lines if line.startswith("#")]
    assert lines[: len(heading)] == heading
    return heading, list(csv.DictReader(lines[len(heading) :]))


def test_csv_holds_every_cell_to_the_bit(tmp_path):
    cube = synthetic_cube()
    store.export(cube, tmp_path / "one.csv", record="FSR1")
    one = cube.sel(record="FSR1")
    _, rows = read_csv(tmp_path / "one.csv")
    assert len(rows) == one["peak_acceleration"].size
    everywhere = one["peak_acceleration"]
    names = [name for name in one.data_vars if one[name].ndim] + ["slip_force", *DIMS]
    for name in names:
        expected = one[name].broadcast_like(everywhere).transpose(*DIMS).to_numpy().ravel()
        written = np.array([row[name] for row in rows]).astype(expected.dtype)
        assert written.tobytes() == expected.tobytes(), name


def test_csv_holds_every_record_with_a_column_for_each_axis(tmp_path):
    cube = synthetic_cube()
    store.export(cube, tmp_path / "all.csv")
    heading, rows = read_csv(tmp_path / "all.csv")
    assert "# records: FSR1, FMR2, İzmit 1" in heading
    assert list(rows[0])[:4] == ["record", *DIMS]
    everywhere = cube["peak_acceleration"]
    names = [name for name in cube.data_vars if cube[name].ndim] + ["slip_force", "pga", *DIMS]
    for name in names:
        expected = cube[name].broadcast_like(everywhere).transpose("record", *DIMS).to_numpy().ravel()
        written = np.array([row[name] for row in rows]).astype(expected.dtype)
        assert written.tobytes() == expected.tobytes(), name
    assert [row["record"] for row in rows] == np.repeat(cube["record"].values, 2 * 3 * 4).tolist()


def test_csv_of_buildings_has_a_row_for_each_storey(tmp_path):
    cube = synthetic_building_cube()
    store.export(cube, tmp_path / "one.csv", record="FSR1")
    _, rows = read_csv(tmp_path / "one.csv")
    one = cube.sel(record="FSR1")
    everywhere = one["peak_drift"]
    assert len(rows) == everywhere.size
    for name in ["building", "storey", "slip_force", "peak_drift", "transitions", "braced_acceleration"]:
        expected = one[name].broadcast_like(everywhere).transpose(*everywhere.dims).to_numpy().ravel()
        assert np.array([row[name] for row in rows]).astype(expected.dtype).tolist() == expected.tolist(), (
            name
        )


def test_csv_has_a_column_for_each_link(tmp_path):
    cube = synthetic_building_cube()
    store.export(cube, tmp_path / "one.csv", record="FSR1")
    heading, rows = read_csv(tmp_path / "one.csv")
    one = cube.sel(record="FSR1")
    for k, link in enumerate(one["link"].values.tolist()):
        name = f"peak_link_slip_{link}"
        assert any(line.startswith(f"# {name} [m] largest slip") for line in heading)
        expected = one["peak_link_slip"][..., k].broadcast_like(one["peak_drift"])
        expected = expected.transpose(*one["peak_drift"].dims).to_numpy().ravel()
        assert [float(row[name]) for row in rows] == expected.tolist()


def test_the_heading_of_a_history_has_what_each_link_takes(tmp_path):
    history = synthetic_history()
    store.export(history, tmp_path / "history.csv")
    heading, _ = read_csv(tmp_path / "history.csv")
    (line,) = [line for line in heading if line.startswith("# peak_link_slip [m]")]
    assert line.endswith(": " + ", ".join(map(repr, history["peak_link_slip"].values.tolist())))


def test_csv_says_what_each_column_is(tmp_path):
    store.export(synthetic_cube(), tmp_path / "one.csv", record="FSR1")
    heading, rows = read_csv(tmp_path / "one.csv")
    assert heading[0] == "# record: FSR1"
    assert "# peak_acceleration [m/s^2] peak absolute acceleration of the floor" in heading
    codes = ", ".join(f"{code} {name}" for code, name in STATUSES.items())
    assert f"# status [-] how the integration ended ({codes})" in heading
    for column in rows[0]:
        assert any(line.startswith(f"# {column} [") for line in heading), column


def test_pandas_reads_the_csv(tmp_path):
    cube = synthetic_cube()
    store.export(cube, tmp_path / "one.csv", record="FSR1")
    back = pd.read_csv(tmp_path / "one.csv", comment="#").set_index(list(DIMS)).to_xarray()
    one = cube.sel(record="FSR1")
    assert (
        back["transitions"].transpose(*DIMS).equals(one["transitions"].drop_vars(set(one.coords) - set(DIMS)))
    )
    # Some versions of pandas read the last digit carelessly; the file itself is held to the bit above.
    np.testing.assert_allclose(back["peak_velocity"].transpose(*DIMS), one["peak_velocity"], rtol=1e-14)


def test_line_breaks_in_provenance_stay_in_the_heading(tmp_path):
    store.export(synthetic_cube().assign_attrs(comment="two\nlines"), tmp_path / "one.csv", record="FSR1")
    heading, _ = read_csv(tmp_path / "one.csv")
    assert "# comment: two lines" in heading


def test_a_single_record_needs_no_name(tmp_path):
    cube = synthetic_cube(["only"])
    store.export(cube, tmp_path / "a.csv")
    store.export(cube, tmp_path / "b.csv", record="only")
    store.export(cube.sel(record="only"), tmp_path / "c.csv")
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "c.csv").read_bytes()


def test_a_slice_of_a_cube(tmp_path):
    one = synthetic_cube().sel(record="FSR1").isel(pretension=1)
    store.export(one, tmp_path / "one.csv")
    _, rows = read_csv(tmp_path / "one.csv")
    written = [float(row["peak_acceleration"]) for row in rows]
    assert written == one["peak_acceleration"].to_numpy().ravel().tolist()


def test_a_single_cell(tmp_path):
    one = synthetic_cube().isel(record=0, stiffness_ratio=0, pretension=0, period=0)
    store.export(one, tmp_path / "one.csv")
    _, (row,) = read_csv(tmp_path / "one.csv")
    assert float(row["peak_acceleration"]) == one["peak_acceleration"].item()


@pytest.mark.parametrize(
    ("cube", "name", "record", "text"),
    [
        (synthetic_cube(), "one.nc", None, "the cube holds 3 records; name one of FSR1, FMR2, İzmit 1"),
        (synthetic_cube(), "one.nc", "FSR9", "the cube holds no record 'FSR9'; it has FSR1, FMR2, İzmit 1"),
        (
            synthetic_cube(),
            "one.xls",
            "FSR1",
            "the name should end in .nc or .nc4 or .netcdf or .cdf or .csv or .xlsx or .mat",
        ),
        (synthetic_cube(), "one", "FSR1", "the name should end in .nc, .csv, .xlsx or .mat"),
        (
            xr.Dataset({"x": 1.0}),
            "one.nc",
            None,
            "the dataset has no record coordinate; export takes what sweep",
        ),
    ],
)
def test_refusals(tmp_path, cube, name, record, text):
    with pytest.raises(StoreError, match=re.escape(text)):
        store.export(cube, tmp_path / name, record=record)
    assert list(tmp_path.iterdir()) == []


def test_a_history_can_be_exported_over_its_time(tmp_path):
    history = synthetic_history(transitions=2, storeys=1).drop_dims("transition")
    store.export(history, tmp_path / "history.csv")
    _, rows = read_csv(tmp_path / "history.csv")
    assert [float(row["displacement"]) for row in rows] == history["displacement"].to_numpy().ravel().tolist()
