"""Parametrises every test that asks for ``engine`` over the engines chosen on the command line."""

from __future__ import annotations

from pathlib import Path

import pytest

from stochfric_mb.errors import InputError
from stochfric_mb.testing.candidates import Candidate, candidate
from stochfric_mb.testing.plugin import chosen


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run each test on each engine."""
    if "engine" in metafunc.fixturenames:
        names = chosen(metafunc.config)
        metafunc.parametrize("engine", names, indirect=True, ids=[Path(n).stem if n.endswith(".py") else n for n in names])


@pytest.fixture(scope="session")
def engine(request: pytest.FixtureRequest) -> Candidate:
    """The engine under test; skips, with what to install, where it is not there."""
    try:
        result = candidate(request.param)
    except InputError as error:
        raise pytest.UsageError(str(error)) from None
    if result.module is None:
        pytest.skip(result.reason)
    return result
