"""The page that needs no server, printed to PDF on A4 as a reader would."""

import subprocess
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser

from tests.browser.conftest import PATIENCE, SETTLED

pytestmark = pytest.mark.browser

DPI = 60
A4 = (round(210 / 25.4 * DPI), round(297 / 25.4 * DPI))
MARGIN = int(13 / 25.4 * DPI)
"""Pixels of the margin of 14 mm, less one that a frame's line may touch."""

VIRIDIS = np.array(
    [
        (68, 1, 84),
        (62, 74, 137),
        (49, 104, 142),
        (38, 130, 142),
        (31, 158, 137),
        (53, 183, 121),
        (253, 231, 37),
    ]
)


def printed(browser: Browser, page_file: Path, folder: Path, scheme: str) -> list[np.ndarray]:
    """Return the sheets of a printed page, shape (rows, columns, 3)."""
    context = browser.new_context(viewport={"width": 1440, "height": 900}, color_scheme=scheme)  # type: ignore[arg-type]
    page = context.new_page()
    page.goto(page_file.as_uri())
    page.wait_for_function(SETTLED, timeout=PATIENCE)
    page.pdf(path=folder / "page.pdf", prefer_css_page_size=True)
    # What the print changed is as it was before.
    assert page.evaluate("document.documentElement.dataset.theme") == scheme
    context.close()
    subprocess.run(["pdftoppm", "-r", str(DPI), "-png", "page.pdf", "sheet"], check=True, cwd=folder)
    sheets = [np.asarray(Image.open(path).convert("RGB")) for path in sorted(folder.glob("sheet-*.png"))]
    assert 1 <= len(sheets) <= 3
    return sheets


@pytest.fixture(params=["light", "dark"])
def sheets(
    browser: Browser, folder: Path, tmp_path: Path, request: pytest.FixtureRequest
) -> list[np.ndarray]:
    return printed(browser, folder / "cube.html", tmp_path, request.param)


def test_the_file_prints_on_a4_with_nothing_cut(sheets: list[np.ndarray], tmp_path: Path) -> None:
    for sheet in sheets:
        assert abs(sheet.shape[1] - A4[0]) <= 1
        assert abs(sheet.shape[0] - A4[1]) <= 1
        for edge in (sheet[:, :MARGIN], sheet[:, -MARGIN:], sheet[:MARGIN], sheet[-MARGIN:]):
            assert (edge > 250).all()  # white in both themes
        assert np.median(sheet) == 255
    told = subprocess.run(
        ["pdftotext", "-layout", "page.pdf", "-"], check=True, cwd=tmp_path, capture_output=True, text=True
    ).stdout
    for words in (
        "period without brace, s",
        "pretension, kN",
        "Peak absolute acceleration",
        "Where the numbers come from",
        "floor mass 20 t",
    ):
        assert words in told, words
    # The axes of both curves over pretension are whole; names that stand upright come out letter by letter.
    assert told.count("pretension, kN") >= 2
    assert "Search the best line" not in told


def test_the_scale_of_colours_is_kept(sheets: list[np.ndarray]) -> None:
    right = sheets[0][:, int(0.85 * A4[0]) : A4[0] - MARGIN].astype(int)
    near = np.abs(right[:, :, np.newaxis, :] - VIRIDIS).max(axis=3) <= 12
    # One column of pixels beside the map holds the colours from one end to the other.
    assert near.any(axis=0).sum(axis=1).max() >= 5


def test_profiles_print_two_in_a_row(browser: Browser, tmp_path: Path) -> None:
    from fdspec.explore.building_content import BuildingContent
    from fdspec.explore.page import write_page
    from tests.cubes import synthetic_building_cube

    cube = synthetic_building_cube()
    cube["status"].values[:] = 0
    write_page(BuildingContent(cube, "b.nc"), tmp_path / "b.html")
    context = browser.new_context(viewport={"width": 1440, "height": 900}, color_scheme="dark")
    page = context.new_page()
    page.goto((tmp_path / "b.html").as_uri())
    page.wait_for_function(SETTLED, timeout=PATIENCE)
    page.emulate_media(media="print")
    page.set_viewport_size({"width": 688, "height": 1000})  # A4 less its margins
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    page.wait_for_timeout(1000)
    boxes = [figure.bounding_box() for figure in page.locator("#maps figure").all()]
    assert boxes[0] is not None
    assert boxes[1] is not None
    assert boxes[0]["y"] == boxes[1]["y"]
    for plot in page.locator(".plot").all():
        inner, outer = plot.locator(".main-svg").first.bounding_box(), plot.bounding_box()
        assert inner is not None
        assert outer is not None
        assert inner["x"] + inner["width"] <= outer["x"] + outer["width"] + 1
        assert inner["y"] + inner["height"] <= outer["y"] + outer["height"] + 1
        assert outer["x"] + outer["width"] <= 688
    context.close()
