"""Buildings, damping, motions and grids: frozen, validated, SI units."""

from typing import TYPE_CHECKING

from fdspec.on_demand import submodules

if not TYPE_CHECKING:
    __getattr__ = submodules(__name__)
