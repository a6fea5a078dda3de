"""Reports for people: what `fdspec.choose` found, as text and as a page."""

from fdspec.report.page import page
from fdspec.report.text import text

__all__ = ["page", "text"]
