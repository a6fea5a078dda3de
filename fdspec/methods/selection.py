"""Methods by name: a name stands for the method with its default parameters."""

from __future__ import annotations

from typing import Final

from fdspec.errors import InvalidInput
from fdspec.methods.bilinear import Bilinear
from fdspec.methods.bouc_wen import BoucWen
from fdspec.methods.dimova import Dimova
from fdspec.methods.equivalent_linear import EquivalentLinear
from fdspec.methods.method import Method
from fdspec.methods.newmark import Newmark
from fdspec.methods.rigid_plastic import RigidPlastic
from fdspec.methods.state_space import StateSpace

EXACT: Final = "exact"
"""Name of the exact engine, which is no method of this package."""

METHODS: Final[dict[str, type[Method]]] = {
    method.name: method
    for method in (Newmark, Dimova, Bilinear, RigidPlastic, BoucWen, EquivalentLinear, StateSpace)
}
"""Name -> class."""


def chosen_method(method: str | Method) -> Method | None:
    """Return the method of this name, or the one given; None is the exact engine."""
    if isinstance(method, Method):
        return method
    if str(method) == EXACT:
        return None
    if str(method) in METHODS:
        return METHODS[str(method)]()
    raise InvalidInput(f"method must be one of {', '.join((EXACT, *METHODS))}, or a Method; got {method!r}")
