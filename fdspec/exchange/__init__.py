"""Buildings in the languages of other programs."""

from typing import TYPE_CHECKING

from fdspec.on_demand import submodules

if not TYPE_CHECKING:
    __getattr__ = submodules(__name__)
