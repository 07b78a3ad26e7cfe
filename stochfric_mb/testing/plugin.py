"""The pytest plugin of the suite: which engines it runs on. pytest finds it by itself once the package is installed."""

from __future__ import annotations

from pathlib import Path

import pytest

OPTION, INI = "stochfric_engine", "stochfric_engines"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add ``--stochfric-engine`` and the setting ``stochfric_engines``."""
    group = parser.getgroup("stochfric_mb")
    group.addoption(
        "--stochfric-engine",
        dest=OPTION,
        action="append",
        default=[],
        metavar="NAME",
        help="run the suite of stochfric_mb on this engine: a registered name, a module or a .py file with simulate(); "
        "may be repeated; without it, on every registered engine and those of the setting stochfric_engines",
    )
    parser.addini(INI, "adapters that the suite of stochfric_mb runs on as well: modules or .py files", type="linelist")


def chosen(config: pytest.Config) -> list[str]:
    """Return the names of the engines to run on, each once; files relative to where they are named."""
    from stochfric_mb.engines import ENGINES

    named: list[str] = [_resolved(name, config.invocation_params.dir) for name in config.getoption(OPTION) or ()]
    if not named:
        named = [
            *(name for name, engine in ENGINES.items() if engine.compared),
            *(_resolved(name, config.rootpath) for name in config.getini(INI)),
        ]
    return list(dict.fromkeys(named))


def _resolved(name: str, folder: Path) -> str:
    return str(folder / name) if name.endswith(".py") else name
