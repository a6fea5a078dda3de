"""What `fdspec verify` runs: answers that fdspec gives beside answers from elsewhere, each computed anew."""

from typing import TYPE_CHECKING

from fdspec.on_demand import submodules
from fdspec.verification.families import FAMILIES, Family, verify
from fdspec.verification.row import Row

__all__ = ["FAMILIES", "Family", "Row", "verify"]

if not TYPE_CHECKING:
    __getattr__ = submodules(__name__)
