"""What `fdspec verify` runs: answers that fdspec gives beside answers from elsewhere, each computed anew."""

from fdspec.verification.families import FAMILIES, Family, verify
from fdspec.verification.row import Row

__all__ = ["FAMILIES", "Family", "Row", "verify"]
