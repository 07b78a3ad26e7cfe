"""The registry of engines: where each adapter lives and what it needs, without loading any.

An adapter module has one function::

    simulate(scenario, *, seed=0, sample=0, dt=None, progress=None) -> Trajectory

`progress`, if given, is called with the simulated time [s] now and then. A module that carries a scenario's effects
(`stochfric_mb.effects.carry`) says ``CARRIES_EFFECTS = True``. Engines of other packages join by an entry
point in the group `GROUP`, name = module, or by `register_engine`.
"""

from __future__ import annotations

import dataclasses
import importlib
import importlib.metadata
import importlib.util
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stochfric_mb.errors import InputError, MissingEngineError, require_name

if TYPE_CHECKING:
    from stochfric_mb.effects import Effect
    from stochfric_mb.scenario import Scenario
    from stochfric_mb.trajectory import Trajectory


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
    distribution: str = ""
    """Name to install it by, where it is not ``package``."""
    extra: str = ""
    """Extra of this package that brings it, where it is not ``name``."""
    needs: tuple[str, ...] = ()
    """Packages that it needs beside its own."""
    compared: bool = True
    """Whether it is compared with others unless named; an engine for many worlds at once in float32 is not."""

    @property
    def installed(self) -> bool:
        """Whether the engine can be imported here."""
        return all(importlib.util.find_spec(package) is not None for package in (self.package, *self.needs) if package)

    @property
    def remedy(self) -> str:
        """What to do where the engine is missing."""
        if self.distribution:
            return f"run: pip install {self.distribution}"
        return f"in a clone of this package run: pip install '.[{self.extra or self.name}]'"

    @property
    def version(self) -> str | None:
        """The installed version, or None."""
        if not self.package:
            from stochfric_mb import __version__

            return __version__
        return importlib.metadata.version(self.distribution or self.package) if self.installed else None


GROUP = "stochfric_mb.engines"
"""Group of the entry points by which other packages bring engines."""


def _brought() -> dict[str, Engine]:
    """Return the engines that installed packages bring by an entry point; nothing is loaded."""
    known: dict[str, Engine] = {}
    for entry in importlib.metadata.entry_points(group=GROUP):
        distribution = entry.dist.name if entry.dist is not None else ""
        package = entry.module.partition(".")[0]
        known[entry.name] = Engine(entry.name, entry.module, package, "see its adapter", distribution, distribution)
    return known


_BUILT_IN = {
    e.name: e
    for e in (
        Engine("reference", "stochfric_mb.reference", "", "event-located integration", "this package"),
        Engine("mujoco", "stochfric_mb.mujoco.belt_box", "mujoco", "engine plugin, passive force, RK4", "Google DeepMind"),
        Engine("exudyn", "stochfric_mb.exudyn.belt_box", "exudyn", "compiled user function, PostStep commit", "J. Gerstmayr"),
        Engine(
            "pymunk",
            "stochfric_mb.pymunk.belt_box",
            "pymunk",
            "force before the step; cap override for coulomb",
            "V. Blomqvist",
        ),
        Engine(
            "fmu",
            "stochfric_mb.export.engine",
            "fmpy",
            "the exported belt-box, compiled at its first run; FMI 3.0 co-simulation",
            "this package; FMPy by Dassault Systemes steps it",
            extra="fmi",
            needs=("ziglang",),
        ),
        Engine(
            "warp",
            "stochfric_mb.warp.simulate",
            "mujoco_warp",
            "steers the constraint solver, float32, a world for each sample",
            "Google DeepMind and NVIDIA",
            compared=False,
        ),
    )
}
ENGINES: dict[str, Engine] = _BUILT_IN | {name: e for name, e in _brought().items() if name not in _BUILT_IN}
"""Name of an engine -> where it lives."""


def register_engine(engine: Engine) -> Engine:
    """Add an engine to the registry of this process, in the place of one of the same name; return it."""
    ENGINES[engine.name] = engine
    return engine


def installed_engines() -> list[str]:
    """Return the names of the engines that can be compared here, the reference first."""
    return [name for name, engine in ENGINES.items() if engine.compared and engine.installed]


def adapter(name: str, *, effects: Sequence[Effect] = ()) -> Any:
    """Return the adapter module of an engine.

    Args:
        name: the engine.
        effects: what it is to carry; a module that can says ``CARRIES_EFFECTS = True``.

    Raises:
        InputError: unknown name, or effects that the engine would leave out.
        MissingEngineError: the engine is not installed; says what to install.
    """
    engine = ENGINES[require_name("engine", name, ENGINES)]
    if not engine.installed:
        raise MissingEngineError(f"engine {name!r} is not installed; {engine.remedy}")
    module = importlib.import_module(engine.adapter)
    if not effects:
        return module
    from stochfric_mb.effects.combine import any_but_random

    if any_but_random(effects) and not getattr(module, "CARRIES_EFFECTS", False):
        kinds = ", ".join(effect.kind for effect in effects)
        raise InputError(
            f"engine {name!r} knows no effects and would leave out {kinds}; use {', '.join(_BUILT_IN)}, or remove the "
            "[[effects]] tables"
        )
    return module


def run(
    scenario: Scenario | str | Path,
    *,
    engine: str = "reference",
    seed: int = 0,
    sample: int = 0,
    dt: float | None = None,
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """Return one trajectory of a scenario.

    >>> trajectory = run("kang2015_table1", seed=1)
    >>> f"{trajectory.time[-1]:g} s, {1e3 * trajectory.position.max():.2f} mm at most"
    '10 s, 2.67 mm at most'

    Args:
        scenario: what is simulated, or the file or name of a scenario.
        engine: what computes it, see `installed_engines`.
        seed: seed of the coefficient path.
        sample: number of the realisation.
        dt: step of an engine [s], dividing the output step; `Scenario.default_dt` if not given.
        progress: called with the simulated time [s] now and then.

    Raises:
        InputError: a scenario, engine or step that cannot be used.
        MissingEngineError: the engine is not installed.
        StabilityError: ``dt`` is beyond the law's stability limit.
        SimulationError: the run broke down.
    """
    from stochfric_mb.scenario import Scenario, load_scenario

    problem = scenario if isinstance(scenario, Scenario) else load_scenario(scenario)
    return adapter(engine, effects=problem.effects).simulate(problem, seed=seed, sample=sample, dt=dt, progress=progress)
