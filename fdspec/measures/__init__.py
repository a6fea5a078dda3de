"""Measures of a cube: what an engineer reads off it, Dataset -> Dataset."""

from fdspec.measures.claims import study_claims
from fdspec.measures.damper import best_damper

__all__ = ["best_damper", "study_claims"]
