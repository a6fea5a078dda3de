"""Constants of unit; inside fdspec everything is SI."""

from typing import Final

G: Final = 9.80665
"""Standard gravity, m/s2 per g."""
