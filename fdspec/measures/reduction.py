"""How much the damper takes off the response, against the bare and against the braced frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fdspec.errors import InvalidInput
from fdspec.measures.cells import ended_well, require

if TYPE_CHECKING:
    import xarray as xr

LIMITS: Final = {
    "peak_acceleration": ("elastic_acceleration", "braced_acceleration"),
    "peak_displacement": ("bare_peak_displacement", "braced_peak_displacement"),
    "peak_base_shear": ("bare_peak_base_shear", "braced_peak_base_shear"),
}
"""Response -> the same of the frame without brace, and of the frame whose damper never slips."""


def reduction(cube: xr.Dataset, response: str = "peak_acceleration") -> xr.Dataset:
    """Compute what the damper takes off a response, as a share of it without brace and with a rigid one.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep` returns, with the response and its two limits among the outputs.
    response : str
        "peak_acceleration", "peak_displacement" or "peak_base_shear".

    Returns
    -------
    xarray.Dataset
        Over (record, stiffness_ratio, pretension, period): `against_bare` and `against_braced`, 1;
        1 - response / limit, so that 0.4 is 40 % less and a negative number is more.

    Raises
    ------
    InvalidInput
        When the response is none of these or the cube lacks a variable.
    """
    if response not in LIMITS:
        raise InvalidInput(f"response must be one of {', '.join(LIMITS)}, got {response!r}")
    bare, braced = LIMITS[response]
    require(cube, (response, bare, braced))
    import xarray as xr

    peak = ended_well(cube, response)
    said = response.replace("_", " ")
    found = xr.Dataset(
        {
            "against_bare": (1.0 - peak / cube[bare]).transpose(*peak.dims),
            "against_braced": (1.0 - peak / cube[braced]).transpose(*peak.dims),
        }
    )
    found["against_bare"].attrs = {"units": "1", "long_name": f"reduction of {said} against the bare frame"}
    found["against_braced"].attrs = {
        "units": "1",
        "long_name": f"reduction of {said} against the braced frame",
    }
    return found
