"""Debian's Chromium, which can reach loopback and nothing else, and a page that fails on console errors."""

import shutil
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import pytest
import xarray as xr
from playwright.sync_api import Browser, Page, sync_playwright

import fdspec
from fdspec import store
from fdspec.cli import main
from fdspec.runs.sweep import ON_REQUEST, OUTPUTS
from tests.explored import own_motion, small_cube

FLAGS = [
    "--no-sandbox",  # Chromium has none for root, who runs CI
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
]
WIDE, NARROW = {"width": 1440, "height": 900}, {"width": 390, "height": 844}
PATIENCE = 60_000
"""ms; software renders the surface."""


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    executable = shutil.which("chromium")
    assert executable, "the page is tested in Debian's Chromium: apt-get install chromium"
    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=executable, args=FLAGS)
        yield launched
        launched.close()


@pytest.fixture(scope="session")
def cube() -> xr.Dataset:
    """Give a cube of every result: two records of the catalogue and one whose file is nowhere."""
    motions = fdspec.load_record("FSR1"), fdspec.load_record("FMR1"), own_motion("mine")
    return small_cube(*motions, outputs=[*OUTPUTS, *ON_REQUEST])


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory, cube: xr.Dataset) -> Path:
    """Give a folder with the cube and the page that `fdspec export` makes of it."""
    made = tmp_path_factory.mktemp("explore")
    store.save(cube, made / "cube.nc")
    assert main(["export", str(made / "cube.nc"), "-o", str(made / "cube.html")]) == 0
    return made


@contextmanager
def served(folder: Path, *cubes: str) -> Iterator[str]:
    """Serve these files of the folder on one page; give its address."""
    command = [sys.executable, "-m", "fdspec", "explore", *cubes, "--no-browser"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=folder)
    try:
        assert process.stdout is not None
        yield process.stdout.readline().split()[0]
    finally:
        process.kill()
        process.communicate()


@pytest.fixture(scope="session")
def address(folder: Path) -> Iterator[str]:
    """Serve the cube."""
    with served(folder, "cube.nc") as found:
        # Where no kernel is compiled yet, the tests' patience must not pay for it.
        place = "record=0&stiffness_ratio=0&period=0"
        for path in (f"history?{place}&pretension=0", f"best?{place}&index=acceleration"):
            with urllib.request.urlopen(found + path, timeout=600) as answer:
                assert answer.status == 200
        yield found


@dataclass
class Watched:
    """A page, what it asked for, and what it complained of."""

    page: Page
    complaints: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    def open(self, address: str) -> Page:
        """Open an address and wait until everything is drawn."""
        self.page.goto(address)
        self.settled()
        return self.page

    def settled(self) -> None:
        """Wait until all pictures show what the controls say."""
        self.page.wait_for_function(SETTLED, timeout=PATIENCE)


SETTLED = """() => document.getElementById("pictures")?.getAttribute("aria-busy") === "false" """


def watched(browser: Browser, size: dict[str, int]) -> Iterator[Watched]:
    context = browser.new_context(viewport=size, accept_downloads=True)
    context.set_default_timeout(PATIENCE)
    made = Watched(context.new_page())
    made.page.on("console", lambda said: said.type == "error" and made.complaints.append(said.text))
    made.page.on("pageerror", lambda error: made.complaints.append(str(error)))
    made.page.on("request", lambda asked: made.requests.append(asked.url))
    yield made
    context.close()
    assert made.complaints == []


@pytest.fixture
def wide(browser: Browser) -> Iterator[Watched]:
    """Give a page of 1440 pixels."""
    yield from watched(browser, WIDE)


@pytest.fixture
def narrow(browser: Browser) -> Iterator[Watched]:
    """Give a page of 390 pixels."""
    yield from watched(browser, NARROW)
