"""The other ways of computing friction that the study names, as references beside the exact engine.

Each is one small file: a frozen class of its parameters, whose ``integrate`` takes what the exact engine
takes and gives back the same `Trajectory`. They serve to see the difference; none is meant to replace it.
"""

from typing import TYPE_CHECKING

from fdspec.methods.bilinear import Bilinear
from fdspec.methods.bouc_wen import BoucWen
from fdspec.methods.dimova import Dimova
from fdspec.methods.equivalent_linear import EquivalentLinear
from fdspec.methods.method import Method
from fdspec.methods.newmark import Newmark
from fdspec.methods.rigid_plastic import RigidPlastic
from fdspec.methods.selection import EXACT, METHODS, chosen_method
from fdspec.methods.state_space import StateSpace
from fdspec.on_demand import submodules

__all__ = [
    "EXACT",
    "METHODS",
    "Bilinear",
    "BoucWen",
    "Dimova",
    "EquivalentLinear",
    "Method",
    "Newmark",
    "RigidPlastic",
    "StateSpace",
    "chosen_method",
]

if not TYPE_CHECKING:
    __getattr__ = submodules(__name__)
