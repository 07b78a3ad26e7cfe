"""Pages in a real browser: nothing on the console or fetched, nothing wider than the screen, every number of the result.

Needs playwright and a Chromium: ``pip install -e '.[pages]'`` and, on Debian, ``apt-get install chromium``.
"""

import json
import re
import shutil

import numpy as np
import pytest

from stochfric_mb.report.discovery import page
from stochfric_mb.report.page import render
from stochfric_mb.report.record_picture import record

from .test_discovery_page import RESULTS, outcome_of, written

playwright = pytest.importorskip("playwright.sync_api", reason="pages in a browser need playwright: pip install -e '.[pages]'")
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="pages in a browser need Chromium: apt-get install chromium")
TIME = np.arange(20_000) * 1e-3
RECORD = ("run (used to fit): position as measured", record(TIME, np.sin(TIME), "position [m]", [(100, 300), (900, 1000)]))


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as driver:
        running = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield running
        running.close()


def _pages():
    for name, result in RESULTS.items():
        content, _, drawn = written(outcome_of(result))
        yield name, page(content, drawn, records=[RECORD]), content
    yield "records", render("records.html", title="Rig", refused="too few samples", records=[RECORD], lines=["a line"]), {}


PAGES = {name: (text, content) for name, text, content in _pages()}


@pytest.fixture
def opened(browser, tmp_path):
    contexts = []

    def show(name, width, scheme):
        file = tmp_path / "report.html"
        file.write_text(PAGES[name][0], encoding="utf-8")
        context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme)
        contexts.append(context)
        shown = context.new_page()
        said, asked = [], []
        shown.on("console", lambda message: said.append(message.text))
        shown.on("pageerror", lambda error: said.append(str(error)))
        shown.on("request", lambda request: asked.append(request.url))
        shown.goto(file.as_uri())
        return shown, said, [url for url in asked if not url.startswith(("file:", "data:"))]

    yield show
    for context in contexts:
        context.close()


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [390, 1200])
@pytest.mark.parametrize("name", list(PAGES))
def test_a_page_is_quiet_complete_and_fits(opened, name, width, scheme):
    shown, said, asked = opened(name, width, scheme)
    assert said == []
    assert asked == []
    assert shown.evaluate("document.documentElement.scrollWidth") <= width
    ink, paper = shown.evaluate("[getComputedStyle(document.body).color, getComputedStyle(document.body).backgroundColor]")
    assert (_brightness(ink) > _brightness(paper)) == (scheme == "dark")


def test_a_curve_tells_its_values_zooms_and_goes_back(opened):
    shown, said, _ = opened("records", 1200, "light")
    svg = shown.locator("svg[data-axes]").first
    place = svg.bounding_box()

    def tell(x, y):
        shown.mouse.move(place["x"] + x * place["width"], place["y"] + y * place["height"])
        return shown.locator(".tip").inner_text()

    told = tell(0.5, 0.5)
    assert "time [s]: " in told
    assert 8.0 < float(re.search(r"time \[s\]: ([\d.]+)", told)[1]) < 12.0  # the middle of 20 s, and the margins
    ticks = "all => all.map(one => one.textContent)"
    assert shown.eval_on_selector_all("svg .zoomed", ticks) == []
    shown.mouse.move(place["x"] + 0.4 * place["width"], place["y"] + 0.5 * place["height"])
    shown.mouse.down()
    shown.mouse.move(place["x"] + 0.6 * place["width"], place["y"] + 0.5 * place["height"], steps=4)
    shown.mouse.up()
    seen = [float(t) for t in shown.eval_on_selector_all("svg text.zoomed", ticks) if re.fullmatch(r"[\d.]+", t)]
    assert sum(7.0 < t < 13.0 for t in seen) >= 4  # a fifth of 20 s has more ticks than the whole had there
    assert 7.0 < float(re.search(r"time \[s\]: ([\d.]+)", tell(0.1, 0.5))[1]) < 9.5
    shown.mouse.dblclick(place["x"] + 0.5 * place["width"], place["y"] + 0.5 * place["height"])
    assert shown.eval_on_selector_all("svg .zoomed", ticks) == []
    assert said == []


@pytest.mark.parametrize("name", list(RESULTS))
def test_every_number_is_one_of_the_result(opened, name):
    shown, _, _ = opened(name, 1200, "light")
    known = set(_numbers(PAGES[name][1]))
    values = shown.eval_on_selector_all("data", "all => all.map(one => one.value)")
    for value in map(float, values):
        assert value in known or abs(value) in known, value


def _numbers(content):
    if isinstance(content, bool) or content is None:
        return
    if isinstance(content, int | float):
        yield float(content)
        yield abs(float(content))
    elif isinstance(content, dict):
        for inner in content.values():
            yield from _numbers(inner)
    elif isinstance(content, list):
        for inner in content:
            yield from _numbers(inner)


def _brightness(colour):
    return sum(map(float, colour.partition("(")[2].rstrip(")").split(",")[:3]))


def test_the_result_itself_is_json():
    assert json.dumps(PAGES["none"][1])
