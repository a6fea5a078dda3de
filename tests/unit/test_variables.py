"""The registry of variables: complete, consistent, and it refuses what it does not know."""

import numpy as np
import pytest
import xarray as xr

from fdspec.errors import InvalidInput
from fdspec.kernels import types
from fdspec.variables import (
    BUILDING_CUBE,
    BUILDING_DIMS,
    CUBE,
    HISTORY,
    PHASES,
    STATUSES,
    STUDY_DIMS,
    describe,
    registry_of,
    response_variables,
)

UNITS = {"m/s^2", "m", "m/s", "N", "N/m", "J", "J s", "s", "kg", "1"}
CONTRACT_OF_SWEEP = [
    "peak_acceleration",
    "peak_displacement",
    "peak_velocity",
    "peak_base_shear",
    "residual_displacement",
    "slip_travel",
    "transitions",
    "dissipated_energy",
    "input_energy",
    "energy_error",
    "status",
    "peak_slip",
    "residual_slip",
    "peak_brace_force",
    "peak_column_shear",
]


@pytest.mark.parametrize(
    "registry", [CUBE, BUILDING_CUBE, HISTORY], ids=["cube", "cube of buildings", "history"]
)
def test_every_variable_has_a_sentence_and_a_known_unit(registry):
    for name, variable in registry.items():
        assert variable.name == name
        assert name.isidentifier()
        assert variable.long_name
        assert not variable.long_name.endswith(".")
        if variable.dtype == "str" or "flag_values" in variable.attributes:
            assert variable.units == ""
            assert "units" not in variable.cf_attributes
        else:
            assert variable.units in UNITS


@pytest.mark.parametrize("registry", [CUBE, BUILDING_CUBE], ids=["cube", "cube of buildings"])
def test_same_name_means_same_unit_in_all(registry):
    for name in set(registry) & set(HISTORY):
        assert registry[name].units == HISTORY[name].units
        assert registry[name].dtype == HISTORY[name].dtype
    for name in set(registry) & set(CUBE):
        assert registry[name].units == CUBE[name].units


def test_what_a_cube_of_buildings_tells_of_a_storey_a_history_tells_too():
    for name in set(BUILDING_CUBE) & set(HISTORY):
        if BUILDING_CUBE[name].dims[:4] == BUILDING_DIMS:
            assert ("storey" in BUILDING_CUBE[name].dims) == ("storey" in HISTORY[name].dims), name


@pytest.mark.parametrize("name", CONTRACT_OF_SWEEP)
def test_what_sweep_promises_is_there_over_the_whole_grid(name):
    assert CUBE[name].dims == STUDY_DIMS


def test_types_that_are_not_floats():
    assert CUBE["transitions"].dtype == "int64"
    assert CUBE["status"].dtype == "int8"
    assert HISTORY["phase"].dtype == "int8"


def test_flags_name_every_code():
    attributes = CUBE["status"].cf_attributes
    assert attributes["flag_meanings"] == " ".join(types.STATUS_MEANINGS)
    np.testing.assert_array_equal(
        attributes["flag_values"], np.arange(len(types.STATUS_MEANINGS), dtype=np.int8)
    )
    assert attributes["flag_values"].dtype == np.int8
    assert len(str(HISTORY["phase"].cf_attributes["flag_meanings"]).split()) == len(PHASES)
    assert len(str(attributes["flag_meanings"]).split()) == len(STATUSES)


def test_a_sweep_over_buildings_adds_the_storey_only_to_what_a_storey_has():
    grid = ("record", "building", "slip_scale", "stiffness_scale")
    dims = {variable.name: variable.dims for variable in response_variables(grid, ("storey",))}
    assert dims["peak_acceleration"] == (*grid, "storey")
    assert dims["peak_base_shear"] == grid
    assert dims["status"] == grid


def _small_cube() -> xr.Dataset:
    return xr.Dataset(
        {"pga": ("record", [1.0, 2.0]), "status": (STUDY_DIMS, np.zeros((2, 1, 1, 3), np.int8))},
        coords={"record": ["A", "B"], "period": [0.1, 0.2, 0.3]},
        attrs={"title": "kept"},
    )


def test_describe_writes_attributes_and_leaves_its_input_alone():
    cube = _small_cube()
    cube["pga"].attrs["stale"] = "dropped"
    described = describe(cube, CUBE)
    assert described["pga"].attrs == {"units": "m/s^2", "long_name": CUBE["pga"].long_name}
    assert described["record"].attrs == {"long_name": CUBE["record"].long_name}
    assert described["period"].attrs["units"] == "s"
    assert described.attrs == {"title": "kept"}
    assert np.shares_memory(described["pga"].values, cube["pga"].values)
    assert cube["pga"].attrs == {"stale": "dropped"}
    assert cube["period"].attrs == {}


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        (
            {"peak_sorrow": ("record", [0.0, 0.0])},
            r"'peak_sorrow' is not registered; known are record, pga, ",
        ),
        ({"dt": ("period", [0.0, 0.0, 0.0])}, r"'dt' has dims \('period',\); it should have \('record',\)"),
        ({"dt": ("record", [1, 2])}, r"'dt' has dtype int64; it should have float64"),
        ({"source": ("record", [1.0, 2.0])}, r"'source' has dtype float64; it should have str"),
    ],
)
def test_describe_refuses_what_the_registry_does_not_hold(change, complaint):
    with pytest.raises(InvalidInput, match=complaint):
        describe(_small_cube().assign(change), CUBE)


def test_a_name_is_registered_once():
    motion = CUBE["pga"]
    with pytest.raises(InvalidInput, match="each variable is registered once, but not pga"):
        registry_of((motion,), (motion,))


def test_flags_agree_with_the_kernels():
    assert tuple(STATUSES.values()) == types.STATUS_MEANINGS
    assert STATUSES[types.COLLAPSED] == "collapsed"
    assert STATUSES[types.ITERATION_NOT_CONVERGED] == "iteration_not_converged"
    assert STATUSES[types.OK] == "ok"
    assert STATUSES[types.TRANSITION_CAP_REACHED] == "transition_cap_reached"
    assert STATUSES[types.NON_FINITE_STATE] == "non_finite_state"
    assert STATUSES[types.ENERGY_NOT_CLOSED] == "energy_not_closed"
    assert PHASES[types.STICK] == "stick"
