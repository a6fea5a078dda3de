"""Choosing a damper: what runs the engine again and again to find the best one."""

from fdspec.choice.choose import choose
from fdspec.choice.distribution import optimise
from fdspec.choice.pretension import best_pretension

__all__ = ["best_pretension", "choose", "optimise"]
