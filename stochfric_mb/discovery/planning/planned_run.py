"""Runs that are planned: what will be set, for how long, how often and how well it will be measured."""

from __future__ import annotations

import dataclasses
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError, require_name, require_number
from stochfric_mb.measurement.run import Run
from stochfric_mb.scenario import Scenario, load_any_scenario

Array = npt.NDArray[np.float64]

SCHEMA = "stochfric.plan/1"
"""Schema of a file of planned runs."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class PlannedRun:
    """One run that may be measured."""

    name: str
    """What it is called."""
    duration: float
    """Its length [s], > 0."""
    sample_rate: float
    """Samples a second [Hz], > 0."""
    noise: float | None = None
    """Standard deviation of the position sensor's noise [m or rad], >= 0; none: a thousandth of the motion."""
    force_noise: float | None = None
    """That of a joint's driving force [N or N m], >= 0 (none: a hundredth of the friction), or of a spring slider's friction
    [N] (none: a thousandth of it)."""
    stroke: float | None = None
    """Distance between the turning points of a driven joint [m or rad], > 0."""
    period: float | None = None
    """Time of a stroke there and back of a driven joint, or of a step up and one down of a spring slider [s], > 0."""
    slow_speed: float | None = None
    """Speed of a spring slider's load point before a step up [m/s], > 0."""
    fast_speed: float | None = None
    """Its speed after it [m/s], > 0."""
    settings: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Numbers of the mechanism that differ from the scenario's in this run (key ``set``)."""

    def __post_init__(self) -> None:
        require_number(f"{self.name}: duration", self.duration, above=0.0, unit="s")
        require_number(f"{self.name}: sample_rate", self.sample_rate, above=0.0, unit="Hz")
        for key in ("noise", "force_noise"):
            if getattr(self, key) is not None:
                require_number(f"{self.name}: {key}", getattr(self, key), low=0.0)
        for key in ("stroke", "period", "slow_speed", "fast_speed"):
            if getattr(self, key) is not None:
                require_number(f"{self.name}: {key}", getattr(self, key), above=0.0)

    @property
    def time(self) -> Array:
        """Time of its samples [s], shape (n,)."""
        return np.asarray(np.arange(round(self.duration * self.sample_rate)) / self.sample_rate, dtype=np.float64)

    def with_noise(self, noise: float, force_noise: float | None = None) -> PlannedRun:
        """Return it with its noise stated: these numbers where it was not."""
        noise = noise if self.noise is None else self.noise
        return dataclasses.replace(self, noise=noise, force_noise=force_noise if self.force_noise is None else self.force_noise)

    def record(self, channels: Mapping[str, Array], covariates: Mapping[str, Array] | None = None) -> Run:
        """Return it as measured, columns of shape (n,) given."""
        return Run(
            name=self.name, role="fit", time=self.time, channels=channels, covariates=covariates or {}, settings=self.settings,
            sample_interval=1.0 / self.sample_rate,
        )  # fmt: skip


KEYS = tuple(f.name for f in dataclasses.fields(PlannedRun) if f.name not in ("name", "settings"))
"""Numbers of a planned run; others are numbers of the mechanism."""


def usual_run(scenario: Scenario[Any], noise: float | None = None) -> PlannedRun:
    """Return the run that a scenario's ``[simulation]`` describes."""
    return PlannedRun(name="run 1", duration=scenario.duration, sample_rate=1.0 / scenario.output_step, noise=noise)


def run_from_text(text: str, usual: PlannedRun, number: int) -> PlannedRun:
    """Return a planned run from ``belt_velocity=1e-3,duration=20``: its own numbers and the mechanism's.

    Raises:
        InputError: no number, or not of this form.
    """
    values: dict[str, float] = {}
    for part in text.split(","):
        key, equals, value = part.partition("=")
        try:
            values[key.strip()] = float(value)
        except ValueError:
            equals = ""
        if not equals:
            raise InputError(f"--run {text!r}: {part!r} is not KEY=NUMBER; write such as belt_velocity=1e-3,duration=20")
    return _changed(usual, f"run {number}", values)


def _changed(usual: PlannedRun, name: str, values: Mapping[str, float]) -> PlannedRun:
    own: dict[str, Any] = {key: value for key, value in values.items() if key in KEYS}
    settings = {key: value for key, value in values.items() if key not in KEYS}
    return dataclasses.replace(usual, name=name, settings=settings, **own)


def load_plan(file: Path) -> tuple[Scenario[Any], list[PlannedRun]]:
    """Return the scenario and the runs of a file ``stochfric.plan/1``.

    Raises:
        InputError: no such file, not TOML, or a key or value that cannot be used.
    """
    try:
        tables = tomllib.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise InputError(f"{file}: no such file; give a scenario, its name, or a plan (schema = {SCHEMA!r})") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{file}: not a TOML file: {error}") from None
    try:
        return _described(tables, file.parent)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None


def is_plan(file: Path) -> bool:
    """Return whether a file says that it holds planned runs."""
    try:
        return file.suffix == ".toml" and SCHEMA in file.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return False


def _described(tables: Mapping[str, Any], folder: Path) -> tuple[Scenario[Any], list[PlannedRun]]:
    for key in tables:
        require_name("key", key, ("schema", "scenario", "noise", "runs"))
    if not isinstance(tables.get("scenario"), str):
        raise InputError('scenario is missing; write scenario = "scenario.toml", or the name of a bundled one')
    named = folder / tables["scenario"]
    scenario = load_any_scenario(named if named.is_file() else tables["scenario"])
    usual = usual_run(scenario, require_number("noise", tables["noise"], low=0.0) if "noise" in tables else None)
    runs = tables.get("runs")
    if not isinstance(runs, list) or not runs:
        raise InputError("no runs; add a [[runs]] table for each run that is planned, such as duration = 20.0")
    return scenario, [_run(run, usual, i) for i, run in enumerate(cast(list[Any], runs), start=1)]


def _run(table: Any, usual: PlannedRun, number: int) -> PlannedRun:
    if not isinstance(table, Mapping):
        raise InputError(f"runs {number} = {table!r} is not a table of keys and values")
    entry = cast(Mapping[str, Any], table)
    for key in entry:
        require_name(f"key of runs {number}", key, ("name", "set", *KEYS))
    values = {key: require_number(f"runs {number}: {key}", entry[key]) for key in KEYS if key in entry}
    settings = entry.get("set", {})
    if not isinstance(settings, Mapping):
        raise InputError(f"runs {number}: set = {settings!r}; write such as set = {{ belt_velocity = 1.0e-3 }}")
    given = cast(Mapping[str, Any], settings)
    values |= {str(key): require_number(f"runs {number}: set.{key}", value) for key, value in given.items()}
    return _changed(usual, str(entry.get("name", f"run {number}")), values)
