"""The registry of engines: where each adapter lives and what it needs, without loading any.

An adapter module has one function::

    simulate(scenario, *, seed=0, sample=0, dt=None, progress=None) -> Trajectory

`progress`, if given, is called with the simulated time [s] now and then.
"""

from __future__ import annotations

import dataclasses
import importlib
import importlib.metadata
import importlib.util
from typing import Any

from stochfric_mb.errors import MissingEngineError, require_name


@dataclasses.dataclass(frozen=True)
class Engine:
    """One engine and its adapter."""

    name: str
    """Name on the command line."""
    adapter: str
    """Module with ``simulate``."""
    package: str
    """Name of the engine's distribution; empty for the reference."""
    hook: str
    """How friction enters."""
    source: str
    """Who makes the engine."""

    @property
    def installed(self) -> bool:
        """Whether the engine can be imported here."""
        return not self.package or importlib.util.find_spec(self.package) is not None

    @property
    def version(self) -> str | None:
        """The installed version, or None."""
        if not self.package:
            from stochfric_mb import __version__

            return __version__
        return importlib.metadata.version(self.package) if self.installed else None


ENGINES: dict[str, Engine] = {
    e.name: e
    for e in (
        Engine("reference", "stochfric_mb.reference", "", "event-located integration", "this package"),
        Engine("mujoco", "stochfric_mb.mujoco.belt_box", "mujoco", "engine plugin, passive force, RK4", "Google DeepMind"),
        Engine("exudyn", "stochfric_mb.exudyn.belt_box", "exudyn", "symbolic user function, PostStep commit", "J. Gerstmayr"),
        Engine(
            "pymunk",
            "stochfric_mb.pymunk.belt_box",
            "pymunk",
            "force before the step; cap override for coulomb",
            "V. Blomqvist",
        ),
    )
}
"""Name of an engine -> where it lives."""


def installed_engines() -> list[str]:
    """Return the names of the engines that can be used here, the reference first."""
    return [name for name, engine in ENGINES.items() if engine.installed]


def adapter(name: str) -> Any:
    """Return the adapter module of an engine.

    Raises:
        InputError: unknown name.
        MissingEngineError: the engine is not installed; says what to install.
    """
    engine = ENGINES[require_name("engine", name, ENGINES)]
    if not engine.installed:
        raise MissingEngineError(f"engine {name!r} is not installed; run: pip install 'stochfric_mb[{name}]'")
    return importlib.import_module(engine.adapter)
