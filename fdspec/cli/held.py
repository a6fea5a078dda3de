"""Whether a file holds already what a sweep is asked to compute."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fdspec.model.motion import GroundMotion
    from fdspec.runs.study import Study


def holds(path: Path, study: Study, motions: Sequence[GroundMotion]) -> bool:
    """Say whether a file holds the cube of this study: same version, parameters and numbers of the records.

    Any doubt is a no: a file that is none of ours, or was made otherwise.
    """
    import fdspec
    from fdspec.errors import FdspecError
    from fdspec.runs.cube import chosen
    from fdspec.runs.sweep import ON_REQUEST, usual_outputs
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
    usual = usual_outputs(study.grid)
    outputs = usual if study.outputs is None else study.outputs
    parameters = {
        **study.grid.parameters,
        "certify": study.certify,
        "outputs": list(chosen(outputs, (*usual, *ON_REQUEST), study.certify)),
    }
    wanted = provenance("", parameters, motions)
    same_version = told.get("fdspec_version") == wanted["fdspec_version"]
    return bool(same_version and held == json.loads(wanted["parameters"]))
