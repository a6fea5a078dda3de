"""What a user of `fdspec explore` waits for: the address, the page, a slider, a history."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING

import fdspec

if TYPE_CHECKING:
    from playwright.sync_api import Page

FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
"""A browser without a screen: the surface is drawn by the processor."""

IMPORTS = "import numpy, xarray, netCDF4, numba, tornado.web, plotly.offline, fdspec.explore"

MOVED = """async () => {
    const slider = document.getElementById("ratio"), pictures = document.getElementById("pictures");
    const waits = [];
    const pause = (ms) => new Promise((done) => setTimeout(done, ms));
    const marked = (name) => performance.getEntriesByName(name)[0];
    for (const value of [0, 1, 2, 4, 5, 6, 4, 2, 1, 0]) {
        performance.clearMarks();
        const start = performance.now();
        slider.value = value;
        slider.dispatchEvent(new Event("input"));
        while (!marked("surface")) await pause(2);
        waits.push(["map", "surface"].map((name) => (marked(name).startTime - start) / 1000));
        while (pictures.ariaBusy === "true") await pause(20);
    }
    return waits;
}"""


def rows() -> list[tuple[str, str, float]]:
    """What, how often measured, seconds."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "study.nc"
        study = fdspec.Study()
        cube = fdspec.sweep(
            study.motions(),
            period=study.grid.period,
            pretension=study.grid.pretension,
            stiffness_ratio=study.grid.stiffness_ratio,
        )
        fdspec.save(cube, path)
        return [*_starts(path), *_waits(path)]


def _starts(path: Path) -> list[tuple[str, str, float]]:
    def imports() -> float:
        began = time.perf_counter()
        subprocess.run([sys.executable, "-c", IMPORTS], check=True)
        return time.perf_counter() - began

    def address() -> float:
        began = time.perf_counter()
        with served(path):
            return time.perf_counter() - began

    imported = median(imports() for _ in range(5))
    started = median(address() for _ in range(5))
    return [
        ("python and its imports", "5", imported),
        ("fdspec explore study.nc, command to address", "5", started),
    ]


def _waits(path: Path) -> list[tuple[str, str, float]]:
    from playwright.sync_api import sync_playwright

    with served(path) as address, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        page = browser.new_page(viewport={"width": 1440, "height": 900})
        opened = [_opened(page, address) for _ in range(6)][1:]
        moved = page.evaluate(MOVED)
        browser.close()
    return [
        ("page asked for, to map drawn", "5", median(one[0] for one in opened)),
        ("page asked for, to all but the surface drawn", "5", median(one[1] for one in opened)),
        ("page asked for, to surface drawn", "5", median(one[2] for one in opened)),
        ("slider moved, to map drawn", "10", median(one[0] for one in moved)),
        ("slider moved, to surface drawn", "10", median(one[1] for one in moved)),
    ]


def _opened(page: Page, address: str) -> tuple[float, float, float]:
    page.goto("about:blank")
    page.goto(address)
    page.wait_for_function("document.getElementById('pictures')?.ariaBusy === 'false'", timeout=60_000)
    at = page.evaluate(
        "['map', 'ready', 'surface'].map((name) => performance.getEntriesByName(name)[0].startTime / 1000)"
    )
    return at[0], at[1], at[2]


@contextmanager
def served(path: Path) -> Iterator[str]:
    """Run `fdspec explore` while the block runs; give its address."""
    command = [sys.executable, "-m", "fdspec", "explore", str(path), "--no-browser"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        yield process.stdout.readline().split()[0]
    finally:
        process.kill()
        process.communicate()
