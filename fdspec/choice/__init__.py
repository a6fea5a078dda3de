"""Choosing a damper: what runs the engine again and again to find the best one."""

from fdspec.choice.distribution import optimise
from fdspec.choice.pretension import best_pretension
from fdspec.choice.recommendation import choose

__all__ = ["best_pretension", "choose", "optimise"]
