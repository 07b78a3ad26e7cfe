"""Pages in a real browser: nothing on the console or fetched, nothing wider than the screen, every number of the result.

Needs playwright and a Chromium: ``pip install -e '.[pages]'`` and, on Debian, ``apt-get install chromium``.
"""

import functools
import json
import re
import shutil

import numpy as np
import pytest

from stochfric_mb.report.discovery import page
from stochfric_mb.report.page import render
from stochfric_mb.report.record_picture import record

from .command_pages import COMMANDS, made
from .test_discovery_page import RESULTS, leaves, outcome_of, shows, written

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


NAMES = [*RESULTS, "records", *COMMANDS]


def _page(name, folder):
    """Return the text of a page and the content of its result file."""
    if name in RESULTS:
        content, _, drawn = written(outcome_of(RESULTS[name]))
        return page(content, drawn, records=3 * [RECORD]), content
    if name == "records":
        return render("records.html", title="Rig", refused="too few samples", records=[RECORD], lines=["a line"]), {}
    return made(name, folder)


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """Return a function that gives the text of a page and the content of its result file, each made once."""
    return functools.cache(lambda name: _page(name, tmp_path_factory.mktemp("page")))


@pytest.fixture
def opened(browser, tmp_path, pages):
    contexts = []

    def show(name, width, scheme):
        file = tmp_path / "report.html"
        file.write_text(pages(name)[0], encoding="utf-8")
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
@pytest.mark.parametrize("name", NAMES)
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

    readout = tell(0.5, 0.5)
    assert "time [s]: " in readout
    assert 8.0 < float(re.search(r"time \[s\]: ([\d.]+)", readout)[1]) < 12.0  # the middle of 20 s, and the margins
    ticks = "all => all.map(one => one.textContent)"
    assert shown.eval_on_selector_all("svg .zoomed", ticks) == []
    shown.mouse.move(place["x"] + 0.4 * place["width"], place["y"] + 0.5 * place["height"])
    shown.mouse.down()
    shown.mouse.move(place["x"] + 0.6 * place["width"], place["y"] + 0.5 * place["height"], steps=4)
    shown.mouse.up()
    seen = [float(t) for t in shown.eval_on_selector_all("svg .zoomed text", ticks) if re.fullmatch(r"[\d.]+", t)]
    assert sum(7.0 < t < 13.0 for t in seen) >= 4  # a fifth of 20 s has more ticks than the whole had there
    assert 7.0 < float(re.search(r"time \[s\]: ([\d.]+)", tell(0.1, 0.5))[1]) < 9.5
    shown.mouse.dblclick(place["x"] + 0.5 * place["width"], place["y"] + 0.5 * place["height"])
    assert shown.eval_on_selector_all("svg .zoomed", ticks) == []
    assert said == []


def test_figures_are_drawn_without_scripts_and_the_library_comes_once_with_its_licence(browser, tmp_path, pages):
    text = pages("records")[0]
    assert text.count("https://d3js.org v7") == 1
    assert "Permission to use, copy, modify, and/or distribute this software" in text
    (tmp_path / "report.html").write_text(text, encoding="utf-8")
    context = browser.new_context(java_script_enabled=False)
    shown = context.new_page()
    shown.goto((tmp_path / "report.html").as_uri())
    curve = shown.locator("svg[data-axes] [data-series='0'] path").first.bounding_box()
    context.close()
    assert curve["width"] > 300.0
    assert curve["height"] > 50.0


@pytest.mark.parametrize("name", [*RESULTS, *(n for n, command in COMMANDS.items() if command.numbers)])
def test_every_number_is_one_of_the_result(opened, pages, name):
    shown, _, _ = opened(name, 1200, "light")
    numbers, strings = leaves(pages(name)[1])
    read = shown.eval_on_selector_all("data", "all => all.map(one => [one.value, one.textContent])")
    assert read
    for value, text in read:
        assert float(value) in numbers, value
        assert text.startswith("<") or shows(text, float(value)), (value, text)
    for text in shown.eval_on_selector_all(".said", "all => all.map(one => one.textContent)"):
        assert text in strings or text + "." in strings, text
    # what is left of a table, its head aside, are words
    rest = """all => all.map(one => {
        const copy = one.cloneNode(true);
        copy.querySelectorAll("data, .said, .unit, code").forEach(inner => inner.remove());
        return copy.textContent;
    })"""
    for text in shown.eval_on_selector_all("tbody", rest):
        assert not re.findall(r"[^\n]*\d[^\n]*", text), text


@pytest.mark.parametrize("name", ["comparison", "reproduction", "ensemble", "plan"])
def test_the_first_sentence_is_the_answer(opened, name):
    shown, _, _ = opened(name, 390, "light")
    answer = shown.locator("h1 + p strong")
    assert answer.count() == 1
    assert re.search(r"\d.*\.$", answer.inner_text(), re.DOTALL)
    assert answer.bounding_box()["y"] < 900  # on the first screen of a telephone


@pytest.mark.parametrize("name", ["refused", "dry run", "joint"])
def test_records_are_drawn_before_anything_is_inferred(opened, name):
    shown, _, _ = opened(name, 1200, "light")
    assert shown.locator("figure").first.locator("svg[data-axes]").count() == 1
    assert "as measured" in shown.locator("figcaption").first.inner_text()
    slips = "slip" in shown.locator("main").inner_text()
    assert slips == (name != "joint")  # a driven joint has none


def _brightness(colour):
    return sum(map(float, colour.partition("(")[2].rstrip(")").split(",")[:3]))


def test_what_is_folded_away_is_printed(opened):
    shown, _, _ = opened("none", 1200, "light")
    seen = "all => all.map(one => one.checkVisibility({contentVisibilityAuto: true}))"
    inner = "details > :not(summary)"
    assert not any(shown.eval_on_selector_all(inner, seen))
    shown.emulate_media(media="print")
    assert len(shown.eval_on_selector_all(inner, seen)) > 0
    # a busy browser lays the page out for paper some time after it was asked to
    shown.wait_for_function(f"() => ({seen})([...document.querySelectorAll('{inner}')]).every(Boolean)")


def test_the_result_itself_is_json(pages):
    assert json.dumps(pages("none")[1])
