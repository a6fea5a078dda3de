"""Whether a file holds already what a sweep is asked to compute."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fdspec.model.motion import GroundMotion
    from fdspec.runs.studies import AnyStudy


def holds(path: Path, study: AnyStudy, motions: Sequence[GroundMotion]) -> bool:
    """Say whether a file holds the cube of this study: same version, parameters and numbers of the records.

    Any doubt is a no: a file that is none of ours, or was made otherwise.
    """
    import fdspec
    from fdspec.errors import FdspecError
    from fdspec.runs.studies import parameters
    from fdspec.store import provenance
    from fdspec.store.netcdf import is_complete
    from fdspec.store.origin import parameters_of

    try:
        with fdspec.open(path) as cube:
            told = dict(cube.attrs)
            if not is_complete(cube):
                return False
        held = parameters_of(told)
    except (FdspecError, ValueError):
        return False
    wanted = provenance("", parameters(study), motions)
    same_version = told.get("fdspec_version") == wanted["fdspec_version"]
    return bool(same_version and held == json.loads(wanted["parameters"]))
