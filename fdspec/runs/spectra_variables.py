"""The registry of inelastic spectra: every variable, its dims, units and a sentence."""

from __future__ import annotations

from typing import Final

import numpy as np

from fdspec.variables import Registry, Variable, motion_variables, registry_of

SPECTRA_STATUSES: Final = ("ok", "collapsed", "still_moving", "non_finite_state")
"""Name of each status, in the order of the kernel's codes."""

ROOT_DIMS: Final = ("record", "period", "ductility_target", "root")

_FLAGS: Final = {
    "flag_values": np.arange(len(SPECTRA_STATUSES), dtype=np.int8),
    "flag_meanings": " ".join(SPECTRA_STATUSES),
}

_LEVELS: Final = {
    "strength": Variable(
        "strength", ("strength",), "m/s^2", "yield strength of the oscillator per unit mass"
    ),
    "ductility": Variable(
        "ductility_target", ("ductility_target",), "1", "ductility that must not be exceeded"
    ),
    "reduction_factor": Variable(
        "reduction_factor", ("reduction_factor",), "1", "elastic strength over yield strength, R"
    ),
}


def registry(kind: str) -> Registry:
    """Return the variables of spectra for one kind of level: strength, ductility or reduction_factor."""
    level = _LEVELS[kind]
    each = ("record", "period", level.name)
    told = [
        Variable("peak_displacement", each, "m", "largest displacement relative to the ground"),
        Variable("ductility", each, "1", "largest displacement over yield displacement"),
        Variable("peak_acceleration", each, "m/s^2", "largest absolute acceleration"),
        Variable("residual_displacement", each, "m", "displacement at which the oscillator comes to rest"),
        Variable("plastic_travel", each, "m", "total distance yielded"),
        Variable("hysteretic_energy", each, "J/kg", "energy dissipated by yielding, per unit mass"),
        Variable("input_energy", each, "J/kg", "energy put in by the ground motion, per unit mass"),
        Variable("energy_error", each, "1", "error of the energy balance relative to the energy in play"),
        Variable("transitions", each, "1", "number of yields and unloadings", "int64"),
        Variable("status", each, "", "how the integration ended", "int8", _FLAGS),
        Variable(
            "elastic_strength",
            ("record", "period"),
            "m/s^2",
            "strength per unit mass from which the oscillator stays elastic",
        ),
    ]
    if kind != "strength":
        told.append(Variable("strength", each, "m/s^2", "yield strength of the oscillator per unit mass"))
    if kind != "reduction_factor":
        told.append(Variable("reduction_factor", each, "1", "elastic strength over yield strength, R"))
    if kind == "ductility":
        told += [
            Variable("roots", each, "1", "number of strengths at which the ductility is reached", "int64"),
            Variable(
                "root_strength",
                ROOT_DIMS,
                "m/s^2",
                "strengths at which the ductility is reached, largest first",
            ),
            Variable("root", ("root",), "1", "number of the root, the largest strength first", "int64"),
        ]
    return registry_of(
        motion_variables(("record",)),
        (Variable("period", ("period",), "s", "natural period of the elastic oscillator"), level),
        told,
    )
