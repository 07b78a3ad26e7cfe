"""The tutorials work as they stand: all their blocks, in their order, in an empty folder."""

import subprocess
import sys
from pathlib import Path

import pytest

from .doc_blocks import PAGES, blocks

TUTORIALS = [page for page in PAGES if "tutorial_" in page]
NEEDS = {"mujoco": ["mujoco"], "exudyn": ["exudyn"], "pymunk": ["pymunk"], "research": ["pymunk"], "test_engineer": []}


def _run(command, folder):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=900)
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"


def _shell(text, folder):
    for line in text.splitlines():
        words = line.partition("  #")[0].split()
        if words and words[0] == "stochfric":
            _run([sys.executable, "-m", "stochfric_mb", *words[1:]], folder)


@pytest.mark.parametrize("page", TUTORIALS)
def test_a_tutorial_runs_from_top_to_bottom(page, tmp_path):
    for package in NEEDS[Path(page).stem.removeprefix("tutorial_")]:
        pytest.importorskip(package, reason=f"{package} is not installed")
    pending = ""
    for block in blocks(page):
        if block.language == "python":
            pending += block.text + "\n"
        elif block.language == "toml":
            (tmp_path / block.title).parent.mkdir(exist_ok=True)
            (tmp_path / block.title).write_text(block.text, encoding="utf-8")
        else:
            if pending and "import" in pending and block.language in ("bash", "sh"):
                _run([sys.executable, "-c", pending], tmp_path)  # what comes before a command may write what it reads
            _shell(block.text, tmp_path)
    if pending:
        _run([sys.executable, "-c", pending], tmp_path)
