"""Settings for all tests: repeatable examples of hypothesis (HYPOTHESIS_PROFILE=explore draws new ones), and which are slow."""

import os
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as `discover` limits it; before numpy is imported

import pytest
from hypothesis import settings

settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.register_profile("explore", deadline=None)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeatable"))


def _lines(file: str) -> tuple[str, ...]:
    text = Path(__file__).with_name(file).read_text(encoding="utf-8")
    return tuple(line for line in text.splitlines() if line[:1] not in ("", "#"))


MARKS = {mark: _lines(f"{mark}.txt") for mark in ("slow", "long")}
"""Beginnings of the names of slow and of long tests; what follows a star may stand anywhere in the name."""


def pytest_ignore_collect(collection_path, config):
    """Leave files and folders of long tests alone where none is asked for: to collect them takes as long as to run many."""
    name = collection_path.relative_to(config.rootpath).as_posix() + "/" * collection_path.is_dir()
    return True if name in MARKS["long"] and "not long" in config.option.markexpr else None


@pytest.hookimpl(tryfirst=True)  # before options select by marker
def pytest_collection_modifyitems(items):
    """Mark the slow and the long tests."""
    for item in items:
        for mark, lines in MARKS.items():
            if item.nodeid.startswith(lines) or any(part[1:] in item.nodeid for part in lines if part.startswith("*")):
                item.add_marker(mark)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """With workers (``-n``), give each a half of the tests in their order: what one file needs is compiled and built once."""
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log)
