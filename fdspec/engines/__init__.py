"""Buildings and motions to arrays, kernels, and back."""

from typing import TYPE_CHECKING

from fdspec.on_demand import submodules

if not TYPE_CHECKING:
    __getattr__ = submodules(__name__)
