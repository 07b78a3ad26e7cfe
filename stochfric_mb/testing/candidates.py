"""The engines that the suite runs on: those of the registry, and adapters that the user names."""

from __future__ import annotations

import dataclasses
import functools
import importlib
import importlib.util
import sys
from pathlib import Path
from typing import Any

from stochfric_mb.engines import ENGINES, adapter
from stochfric_mb.errors import InputError, MissingEngineError
from stochfric_mb.scenario import Scenario
from stochfric_mb.testing.accuracy import BUILT_IN, Accuracy
from stochfric_mb.trajectory import Trajectory


@dataclasses.dataclass(frozen=True)
class Candidate:
    """An engine under test."""

    name: str
    """Its name in the registry, or the module or file of its adapter."""
    module: Any
    """Its adapter, None if it cannot be used here."""
    reason: str = ""
    """Why it cannot be used here, and what to install."""

    @property
    def accuracy(self) -> Accuracy:
        """Its class of accuracy: the adapter's own ``ACCURACY``, that of the built-in table, or first order."""
        return getattr(self.module, "ACCURACY", BUILT_IN.get(self.name, Accuracy()))

    def simulate(self, scenario: Scenario, **options: Any) -> Trajectory:
        """Return what the engine makes of a scenario."""
        return self.module.simulate(scenario, **options)


@functools.cache
def candidate(name: str) -> Candidate:
    """Return the engine ``name``: of the registry, a module, or a file that ends in ``.py``.

    Raises:
        InputError: there is no such engine, module or file, or it has no ``simulate``.
    """
    try:
        module = adapter(name) if name in ENGINES else _load(name)
    except MissingEngineError as error:
        return Candidate(name, None, str(error))
    except ModuleNotFoundError as error:
        if error.name and (name == error.name or name.startswith(f"{error.name}.")):
            raise InputError(f"no engine and no module {name!r}; give a name of {', '.join(ENGINES)}, or an adapter") from None
        return Candidate(name, None, f"{name} needs {error.name}, which is not installed; run: pip install {error.name}")
    if not callable(getattr(module, "simulate", None)):
        raise InputError(f"adapter {name!r} has no function simulate(scenario, *, seed, sample, dt, progress)")
    return Candidate(name, module)


def _load(name: str) -> Any:
    if not name.endswith(".py"):
        return importlib.import_module(name)
    path = Path(name).resolve()
    if not path.is_file():
        raise InputError(f"no adapter file {path}; give a module or the path of a Python file")
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules.setdefault(path.stem, module)
    spec.loader.exec_module(module)
    return module
