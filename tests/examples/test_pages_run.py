"""Every code block of README and docs runs, page by page; the tutorials run in test_tutorials.py as they stand."""

import os
import subprocess
import sys

import pytest

from stochfric_mb.measurement.entries import data_folder

from .doc_blocks import PAGES, ROOT, blocks
from .page_settings import SETTINGS, Setting

RUN = [page for page in PAGES if "tutorial_" not in page and page != "CONTRIBUTING.md" and blocks(page)]
"""Pages with blocks; CONTRIBUTING's one command is that of the README."""


@pytest.mark.parametrize("page", RUN)
def test_all_blocks_of_a_page_run(page, tmp_path):
    setting = SETTINGS.get(page, Setting())
    for package in setting.needs:
        pytest.importorskip(package, reason=f"{page} needs {package}")
    if any("STOCHFRIC_DATA" in block.text for block in blocks(page)) and data_folder() is None:
        pytest.skip("the measured data are not here: set STOCHFRIC_DATA to their folder")
    known = os.environ | {"PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-W", "ignore", "-m", "tests.examples.run_page", page]
    done = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, timeout=setting.seconds, env=known, check=False
    )
    assert done.returncode == 0, f"{done.stdout[-3000:]}\n{done.stderr[-5000:]}"


@pytest.mark.parametrize("page", SETTINGS)
def test_what_a_setting_replaces_stands_on_the_page(page):
    text = "".join(block.text for block in blocks(page))
    assert not [part for part in SETTINGS[page].shorter if part not in text]
    assert set(SETTINGS[page].code) <= set(range(len(blocks(page))))
