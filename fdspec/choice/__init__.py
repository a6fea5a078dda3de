"""Choosing a damper: what runs the engine again and again to find the best one."""

from typing import TYPE_CHECKING

from fdspec.choice.distribution import optimise
from fdspec.choice.pretension import best_pretension
from fdspec.choice.recommendation import choose
from fdspec.on_demand import submodules

__all__ = ["best_pretension", "choose", "optimise"]

if not TYPE_CHECKING:
    __getattr__ = submodules(__name__)
