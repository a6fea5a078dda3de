"""Every page of a built documentation, narrow and wide, light and dark: it fits, and can be read."""

import os
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from tests.browser.conftest import NARROW, WIDE

pytestmark = pytest.mark.docs

BUILT = Path(os.environ.get("FDSPEC_DOCS", Path(__file__).parents[2] / "docs" / "_build"))

STICKING_OUT = """() => {
    const width = document.documentElement.clientWidth;
    // What is wider than the box that it is scrolled in may be.
    const scrolled = (one) => one.parentElement.nodeName !== "BODY" && (
        ["auto", "scroll", "hidden"].includes(getComputedStyle(one.parentElement).overflowX)
        || scrolled(one.parentElement));
    const found = [...document.querySelectorAll("article *")].filter((one) => {
        const box = one.getBoundingClientRect();
        return box.width && (box.left < -0.5 || box.right > width + 0.5) && !scrolled(one);
    });
    if (document.documentElement.scrollWidth > width) found.push(document.documentElement);
    return found.map((one) => one.outerHTML.slice(0, 100));
}"""

MISSING = "[...document.images].filter((one) => !one.naturalWidth).map((one) => one.src.slice(-60))"

UNREADABLE = """() => {
    const numbers = (colour) => (colour.match(/[\\d.]+/g) || []).map(Number);
    const curve = (part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4);
    const light = ([r, g, b]) => 0.2126 * curve(r / 255) + 0.7152 * curve(g / 255) + 0.0722 * curve(b / 255);
    const over = (front, back) => {
        const share = front.length > 3 ? front[3] : 1;
        return [0, 1, 2].map((k) => share * front[k] + (1 - share) * back[k]);
    };
    function ground(one) {
        const layers = [];
        for (let each = one; each; each = each.parentElement) {
            const colour = numbers(getComputedStyle(each).backgroundColor);
            if (colour.length === 3 || colour[3] > 0) layers.push(colour);
            if (colour.length === 3) break;
        }
        return layers.reverse().reduce((back, front) => over(front, back), [255, 255, 255]);
    }
    const found = {}, texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (texts.nextNode()) {
        const words = texts.currentNode.textContent.trim(), one = texts.currentNode.parentElement;
        if (!words || !one.checkVisibility({ opacityProperty: true, visibilityProperty: true })) continue;
        if (one.closest("script, style, svg, mjx-container, .headerlink, .visually-hidden")) continue;
        const style = getComputedStyle(one), back = ground(one), front = over(numbers(style.color), back);
        const [dark, bright] = [light(front), light(back)].sort((a, b) => a - b);
        const ratio = (bright + 0.05) / (dark + 0.05), size = parseFloat(style.fontSize);
        const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
        const named = `${style.color} on ${back.map(Math.round)}: ${ratio.toFixed(2)}`;
        if (ratio < (large ? 3 : 4.5)) found[named] ??= words.slice(0, 60);
    }
    return found;
}"""
"""Colours of letters whose contrast is below WCAG's AA, each with words that have them."""


@pytest.fixture(scope="module")
def pages() -> list[Path]:
    found = [path for path in sorted(BUILT.rglob("*.html")) if not {"_static", "_modules"} & set(path.parts)]
    assert len(found) > 40, f"build the documentation first: {BUILT} has {len(found)} pages"
    return found


def test_every_page_fits_and_can_be_read(browser: Browser, pages: list[Path]) -> None:
    tab = browser.new_page(viewport=WIDE)
    faults = {}
    for path in pages:
        tab.emulate_media(color_scheme="light")
        tab.goto(path.resolve().as_uri())
        tab.wait_for_function("[...document.images].every((one) => one.complete)")
        told = {"pictures missing": tab.evaluate(MISSING), "light": tab.evaluate(UNREADABLE)}
        told["out at 1440"] = tab.evaluate(STICKING_OUT)
        tab.emulate_media(color_scheme="dark")
        told["dark"] = tab.evaluate(UNREADABLE)
        tab.set_viewport_size(NARROW)
        told["out at 390"] = tab.evaluate(STICKING_OUT)
        tab.set_viewport_size(WIDE)
        found = {name: fault for name, fault in told.items() if fault}
        if found:
            faults[str(path.relative_to(BUILT))] = found
    tab.close()
    assert faults == {}


def test_the_checks_find_what_they_are_for(browser: Browser) -> None:
    tab = browser.new_page(viewport=NARROW)
    tab.set_content(
        "<article><p style='color: #999; background: #fff'>pale</p><p style='color: #333'>dark</p>"
        "<div style='width: 600px; background: #eee'>wide</div><img src='data:,'></article>"
    )
    assert list(tab.evaluate(UNREADABLE).values()) == ["pale"]
    assert len(tab.evaluate(STICKING_OUT)) == 2
    assert tab.evaluate(MISSING) == ["data:,"]
    tab.close()
