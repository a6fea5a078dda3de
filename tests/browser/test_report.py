"""The report of `fdspec choose` as a client sees it: on screens of three widths, and printed on A4."""

import io
import re
import subprocess
from dataclasses import replace
from html import unescape
from pathlib import Path

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe
from PIL import Image
from playwright.sync_api import Browser

import fdspec
from fdspec.figures import encode, plot_history
from fdspec.model.building import Building
from fdspec.report import page as report_page
from fdspec.report.compact_svg import compact

pytestmark = pytest.mark.browser

A4 = (595.0, 842.0)
"""Points."""

OVERFLOWING = """() => {
    const width = document.documentElement.clientWidth, found = [];
    for (const one of document.querySelectorAll("body *")) {
        if (one.closest(".wide") && !one.matches(".wide")) continue;
        const box = one.getBoundingClientRect();
        if (box.width && (box.left < -0.5 || box.right > width + 0.5)) found.push(one.outerHTML.slice(0, 90));
    }
    return found;
}"""


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the report of a building of two storeys under four records."""
    building = Building.from_periods([20e3, 15e3], 0.6, 0.35, 1.0, brace_mass=25.0)
    whole = [fdspec.load_record(name) for name in ("FSR1", "FSR3", "FMR2", "FHR1")]
    motions = [replace(motion, acceleration=motion.acceleration[:900]) for motion in whole]
    choice = fdspec.choose(building, motions, distribution="shear", stiffness_scale=[1])
    path = tmp_path_factory.mktemp("report") / "choice.html"
    how = {"title": "Dampers for Harbour Street 12", "project": "Project 4711", "author": "A. Engineer"}
    path.write_text(report_page(choice, building, motions, **how), encoding="utf-8")
    return path


@pytest.mark.parametrize("width", [390, 1440, 2560])
def test_nothing_sticks_out_and_axe_finds_nothing(browser: Browser, report: Path, width: int) -> None:
    context = browser.new_context(viewport={"width": width, "height": 900})
    page = context.new_page()
    page.goto(report.as_uri())
    assert page.evaluate(OVERFLOWING) == []
    assert page.evaluate("document.documentElement.scrollWidth") == width
    broken = "Array.from(document.images).filter((one) => !one.complete || one.naturalWidth === 0).length"
    assert page.evaluate(broken) == 0
    found = Axe().run(page)
    assert found.violations_count == 0, found.generate_report()
    context.close()


@pytest.fixture(scope="module")
def printed(browser: Browser, report: Path) -> Path:
    """Print it as a client would."""
    page = browser.new_page()
    page.goto(report.as_uri())
    path = report.with_suffix(".pdf")
    page.pdf(path=path, prefer_css_page_size=True, print_background=True)
    page.close()
    return path


def pages_of(pdf: Path) -> list[str]:
    done = subprocess.run(["pdftotext", "-layout", str(pdf), "-"], check=True, capture_output=True, text=True)
    return done.stdout.split("\f")[:-1]


def test_it_prints_on_numbered_pages_of_a4(printed: Path) -> None:
    pages = pages_of(printed)
    assert len(pages) >= 4
    for number, text in enumerate(pages, 1):
        assert f"Page {number} of {len(pages)}" in text
        assert "Project 4711 - Dampers for Harbour Street 12" in text
    told = subprocess.run(["pdfinfo", str(printed)], check=True, capture_output=True, text=True).stdout
    width, height = map(float, re.findall(r"Page size:\s+([\d.]+) x ([\d.]+)", told)[0])
    assert (width, height) == pytest.approx(A4, abs=1.0)
    assert "Dampers for Harbour Street 12" in re.findall(r"Title:\s+(.*)", told)[0]


def test_no_column_and_no_caption_is_lost_in_print(printed: Path, report: Path) -> None:
    text = " ".join(" ".join(pages_of(printed)).split())
    html = report.read_text(encoding="utf-8")
    captions = re.findall(r"<figcaption>(.*?)</figcaption>", html)
    assert len(captions) == 6
    for words in captions:
        assert unescape(words) in text
    # A head that is broken stands in two lines of the print.
    names = ("magnitude", "regret", "brace must", "carry, kN", "slip, mm", "Loma Prieta 1989-10-18")
    for name in (*names, "El Centro Array"):
        assert name in text, name


def test_tables_stand_whole_on_a_page(printed: Path) -> None:
    pages = pages_of(printed)

    def holding(name: str) -> list[int]:
        return [k for k, text in enumerate(pages) if re.search(rf"^\s*{name}\s+\d", text, re.MULTILINE)]

    assert holding("FSR1") == holding("FHR1") != []


def test_pictures_are_vectors(printed: Path) -> None:
    listed = subprocess.run(["pdfimages", "-list", str(printed)], check=True, capture_output=True, text=True)
    assert listed.stdout.strip().splitlines()[2:] == []


def test_a_picture_in_fewer_bytes_looks_the_same(browser: Browser) -> None:
    frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=20e3)
    svg = encode(plot_history(fdspec.simulate(frame, fdspec.load_record("FMR1")), 1), "svg").decode()
    # 384 dots an inch: more than half of what it is printed with.
    tab = browser.new_page(viewport={"width": 1060, "height": 640}, device_scale_factor=4)
    seen = []
    for one in (svg, compact(svg)):
        tab.set_content(one[one.index("<svg") :])
        seen.append(np.asarray(Image.open(io.BytesIO(tab.screenshot())).convert("L"), dtype=float))
    tab.close()
    apart = seen[0] - seen[1]
    assert seen[0].std() > 10.0
    # Edges may be a shade lighter; as far as the eye sees, 1/96 in, nothing is.
    assert (np.abs(apart) > 32.0).mean() < 2e-3
    assert np.abs(apart.reshape(640, 4, 1060, 4).mean(axis=(1, 3))).max() < 32.0
