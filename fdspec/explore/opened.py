"""A cube that was opened, as what the page shows of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fdspec.explore.building_content import BuildingContent
from fdspec.explore.content import Content
from fdspec.store.suitable import require_cube, require_sound

if TYPE_CHECKING:
    import xarray as xr


def content_of(cube: xr.Dataset, path: str, name: str) -> Content | BuildingContent:
    """Return what the page shows of a cube of frames or of buildings.

    Raises
    ------
    InvalidInput
        When it is no cube, is damaged, or has too little to draw; `path` is what the text calls it.
    """
    if "building" in cube.dims:
        require_sound(cube, path)
        return BuildingContent(cube, name)
    require_cube(cube, path, "pages")
    return Content(cube, name)
