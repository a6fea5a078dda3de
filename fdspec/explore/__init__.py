"""A cube in the browser: one page, with a server for histories, or as a file that needs none.

`content` says what the page shows of a cube, `packing` how numbers travel, `motions` and `rerun` run the
history of a cell, `page` puts the page together, `server` answers it. What the browser does is in `assets`.
"""

from typing import TYPE_CHECKING

from fdspec.explore.content import Content
from fdspec.explore.page import write_page
from fdspec.explore.rerun import Rerun
from fdspec.explore.server import serve
from fdspec.on_demand import submodules

__all__ = ["Content", "Rerun", "serve", "write_page"]

if not TYPE_CHECKING:
    __getattr__ = submodules(__name__)
