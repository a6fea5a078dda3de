"""Reports for people: what `fdspec.choose` found, as text and as a page."""

from typing import TYPE_CHECKING

from fdspec.on_demand import submodules
from fdspec.report.page import page
from fdspec.report.text import text

__all__ = ["page", "text"]

if not TYPE_CHECKING:
    __getattr__ = submodules(__name__)
