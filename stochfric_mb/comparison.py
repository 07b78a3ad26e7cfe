"""One scenario in several engines against the reference: the same law, seed and coefficient path in each."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from stochfric_mb import metrics
from stochfric_mb.coefficients.processes import EVENT
from stochfric_mb.engines import adapter, installed_engines
from stochfric_mb.errors import InputError, StochfricError
from stochfric_mb.scenario import Scenario, fitting_step, load_scenario
from stochfric_mb.trajectory import Trajectory

SCHEMA = "stochfric.comparison/1"

CONVERGENCE_DURATION = 2.0
"""Simulated time over which convergence is measured [s]."""
CONVERGENCE_BUDGET = 60.0
"""Computing time for all convergence runs together [s]; runs expected to take longer than what is left are skipped."""
COARSE_STEPS = (1.0e-3, 5.0e-4, 2.0e-4, 1.0e-4)
"""Steps of a convergence study [s]."""
FINE_STEPS = (6.0e-5, 4.0e-5, 2.0e-5, 1.0e-5)
"""Steps for laws that are not stable at the first of those [s]."""
LIMIT_SHARE = 0.95
"""Largest share of the law's explicit limit that a step of the study takes [-]."""

Advance = Callable[[float], None]
"""Called with the simulated time [s] now and then."""
Stage = Callable[[str, float], Advance]
"""Called with the name and the simulated time [s] of each run before it begins."""


@dataclasses.dataclass(frozen=True)
class ConvergencePoint:
    """The error of one engine at one step."""

    dt: float
    """Step [s]."""
    rms_position_error: float
    """Root mean square of the position's difference from the reference [m]."""
    max_abs_position_error: float
    """Largest difference of position from the reference [m]."""
    observed_order: float | None
    """Order from the next coarser step to this one: log of the ratio of errors over log of the ratio of steps [-]."""


@dataclasses.dataclass(frozen=True)
class EngineComparison:
    """One engine against the reference."""

    name: str
    """The engine."""
    trajectory: Trajectory
    """What it computed."""
    period: float
    """Mean interval between break-aways [s], NaN below two."""
    stick_fraction: float
    """Share of time with abs(v_rel) <= the law's stick speed [-]."""
    max_abs_position_error: float
    """Largest difference of position from the reference [m]."""
    rms_position_error: float
    """Root mean square of the position's difference from the reference [m]."""
    period_relative_error: float
    """(period - reference's)/reference's [-], NaN where either has none."""
    stick_fraction_error: float
    """Stick fraction - reference's [-]."""
    coefficient_path_max_difference: float
    """Largest difference of the coefficients used from those of the path [-]; see `metrics.coefficient_path_difference`."""
    convergence: tuple[ConvergencePoint, ...] = ()
    """Errors against step, from the coarsest on; empty if not asked for."""
    notes: tuple[str, ...] = ()
    """What the reader must know: a law that stands in for another, a step that was left out."""

    def to_dict(self) -> dict[str, Any]:
        """Return the numbers of this engine as in ``compare.json``."""
        about = self.trajectory.attributes
        return {
            "version": about.get("version"),
            "hook": about.get("hook"),
            "law": about.get("law"),
            "dt": about.get("dt"),
            "max_abs_position_error": self.max_abs_position_error,
            "rms_position_error": self.rms_position_error,
            "period": _or_none(self.period),
            "period_relative_error": _or_none(self.period_relative_error),
            "stick_fraction": self.stick_fraction,
            "stick_fraction_error": self.stick_fraction_error,
            "coefficient_path_max_difference": self.coefficient_path_max_difference,
            "seconds_per_step": about.get("seconds_per_step"),
            "n_steps": about.get("n_steps"),
            "convergence": [dataclasses.asdict(point) for point in self.convergence],
            "notes": list(self.notes),
        }


@dataclasses.dataclass(frozen=True)
class Comparison:
    """A scenario in several engines and in the reference."""

    scenario: Scenario
    """What was simulated."""
    seed: int
    """Seed of the coefficient path."""
    dt: float
    """Step asked of the engines [s]."""
    reference: Trajectory
    """The reference solution."""
    reference_period: float
    """Its period [s], NaN below two break-aways."""
    reference_stick_fraction: float
    """Its stick fraction [-]."""
    engines: tuple[EngineComparison, ...]
    """The engines, in the order asked for."""
    convergence_duration: float | None = None
    """Simulated time behind the convergence errors [s]; None: not measured."""

    def to_dict(self) -> dict[str, Any]:
        """Return the content of ``compare.json`` (``stochfric.comparison/1``)."""
        about = self.reference.attributes
        return {
            "schema": SCHEMA,
            "scenario": self.scenario.to_dict(),
            "seed": self.seed,
            "dt": self.dt,
            "stick_speed": self.scenario.law.stick_speed,
            "reference": {
                "version": about.get("version"),
                "hook": about.get("hook"),
                "law": about.get("law"),
                "period": _or_none(self.reference_period),
                "stick_fraction": self.reference_stick_fraction,
                "seconds_per_step": about.get("seconds_per_step"),
                "n_steps": about.get("n_steps"),
                "notes": list(about.get("notes", [])),
            },
            "convergence_duration": self.convergence_duration,
            "engines": {engine.name: engine.to_dict() for engine in self.engines},
        }


def compare(
    scenario: Scenario | str | Path,
    *,
    engines: Sequence[str] | None = None,
    seed: int = 0,
    dt: float | None = None,
    convergence: bool = True,
    stage: Stage | None = None,
) -> Comparison:
    """Return how far each engine is from the reference for the same law, seed and coefficient path.

    >>> comparison = compare("kang2015_table1", engines=["pymunk"], convergence=False)
    >>> comparison.engines[0].rms_position_error < 1e-8
    True

    Args:
        scenario: what is simulated, or the file or name of a scenario.
        engines: names of the engines; all that are installed if not given. The reference always runs.
        seed: seed of the coefficient path.
        dt: step of the engines [s], dividing the output step; `Scenario.default_dt` if not given.
        convergence: whether to measure each engine's error at four steps as well.
        stage: called with name and simulated time of each run; returns what is called with the time reached.

    Raises:
        InputError: unknown engine, or a step that cannot be used.
        MissingEngineError: an engine is not installed; raised before anything is computed.
        StabilityError: ``dt`` is beyond the law's stability limit.
        SimulationError: an engine failed.
    """
    if not isinstance(scenario, Scenario):
        scenario = load_scenario(scenario)
    names = [n for n in dict.fromkeys(installed_engines() if engines is None else engines) if n != "reference"]
    if not names:
        raise InputError(
            "no engine to compare with the reference; give at least one of mujoco, exudyn, pymunk, "
            "or install them, in a clone of this package: pip install '.[all]'"
        )
    for name in (*names, "reference"):
        adapter(name, effects=scenario.effects)
    dt = scenario.default_dt() if dt is None else scenario.dividing_step(dt)
    stage = stage or _silent
    reference = _run("reference", scenario, seed, None, stage("reference", scenario.duration))
    # the first comes last: on a first use it may be compiled meanwhile
    runs = {name: _run(name, scenario, seed, dt, stage(name, scenario.duration)) for name in reversed(names)}
    compared = [_compared(name, runs[name], reference, scenario, seed) for name in names]
    if convergence:
        compared = _with_convergence(compared, reference, scenario, seed, stage)
    return Comparison(
        scenario=scenario,
        seed=seed,
        dt=dt,
        reference=reference,
        reference_period=metrics.period(reference, scenario.law, scenario.mechanism),
        reference_stick_fraction=metrics.stick_fraction(reference, scenario.law, scenario.mechanism),
        engines=tuple(compared),
        convergence_duration=shortened(scenario).duration if convergence else None,
    )


def convergence_steps(scenario: Scenario) -> list[float]:
    """Return the steps of a convergence study [s], coarsest first, all dividing the output step.

    1e-3, 5e-4, 2e-4 and 1e-4 s where the law is stable at the first, otherwise 6e-5, 4e-5, 2e-5 and 1e-5 s, reduced in
    proportion where the first is above 0.95 of the law's explicit limit; each lowered to the nearest step that fits.
    """
    limit = LIMIT_SHARE * scenario.step_limit()
    steps = COARSE_STEPS if COARSE_STEPS[0] <= limit else FINE_STEPS
    scale = min(1.0, limit / steps[0])
    return list(dict.fromkeys(fitting_step(min(scale * dt, scenario.output_step), scenario.output_step) for dt in steps))


def shortened(scenario: Scenario) -> Scenario:
    """Return the scenario over the time for which convergence is measured, a whole number of output steps."""
    n = max(math.floor(CONVERGENCE_DURATION / scenario.output_step + 1.0e-9), 1)
    return dataclasses.replace(scenario, duration=min(scenario.duration, n * scenario.output_step))


def _compared(name: str, run: Trajectory, reference: Trajectory, scenario: Scenario, seed: int) -> EngineComparison:
    law, mechanism = scenario.law, scenario.mechanism
    period, true_period = (metrics.period(t, law, mechanism) for t in (run, reference))
    stick, true_stick = (metrics.stick_fraction(t, law, mechanism) for t in (run, reference))
    return EngineComparison(
        name=name,
        trajectory=run,
        period=period,
        stick_fraction=stick,
        max_abs_position_error=metrics.max_abs_difference(run.position, reference.position),
        rms_position_error=metrics.rms_difference(run.position, reference.position),
        period_relative_error=(period - true_period) / true_period,
        stick_fraction_error=stick - true_stick,
        coefficient_path_max_difference=metrics.coefficient_path_difference(run, reference, scenario, seed=seed),
        notes=(*run.attributes.get("notes", []), *_event_notes(run, reference, scenario, seed)),
    )


def _event_notes(run: Trajectory, reference: Trajectory, scenario: Scenario, seed: int) -> list[str]:
    """Return a note if the run ends with another draw than the reference: one of them saw a stick phase more."""
    if scenario.coefficient_process is None or scenario.coefficient_process.clock != EVENT:
        return []
    mine, theirs = (int(metrics.draws_used(t, scenario, seed=seed)[-1]) for t in (run, reference))
    if mine == theirs:
        return []
    return [
        f"ends with draw {mine} of the coefficients, the reference with draw {theirs}: not every stick phase is seen by both"
    ]


def _with_convergence(
    compared: Sequence[EngineComparison], reference: Trajectory, scenario: Scenario, seed: int, stage: Stage
) -> list[EngineComparison]:
    """Return the comparisons with their convergence points, coarse steps of all engines first."""
    short = shortened(scenario)
    points: dict[str, list[ConvergencePoint]] = {c.name: [] for c in compared}
    notes: dict[str, list[str]] = {c.name: [] for c in compared}
    left = CONVERGENCE_BUDGET
    for step in convergence_steps(scenario):
        for c in compared:
            expected = float(c.trajectory.attributes.get("seconds_per_step") or 0.0) * short.duration / step
            if expected > left:
                notes[c.name].append(f"convergence at dt = {step:g} s left out: it would take about {expected:.0f} s")
                continue
            left -= expected
            try:
                run = _run(c.name, short, seed, step, stage(f"{c.name} at dt = {step:.3g} s", short.duration))
            except StochfricError as error:
                notes[c.name].append(f"convergence at dt = {step:g} s left out: {error}")
                continue
            points[c.name].append(_point(step, run, reference, points[c.name]))
    return [dataclasses.replace(c, convergence=tuple(points[c.name]), notes=(*c.notes, *notes[c.name])) for c in compared]


def _point(step: float, run: Trajectory, reference: Trajectory, coarser: Sequence[ConvergencePoint]) -> ConvergencePoint:
    true = reference.position[: len(run.position)]
    rms = metrics.rms_difference(run.position, true)
    order = None
    if coarser and rms > 0.0 and coarser[-1].rms_position_error > 0.0:
        order = math.log(coarser[-1].rms_position_error / rms) / math.log(coarser[-1].dt / step)
    return ConvergencePoint(step, rms, metrics.max_abs_difference(run.position, true), order)


def _run(name: str, scenario: Scenario, seed: int, dt: float | None, progress: Advance) -> Trajectory:
    """Return an engine's trajectory; its errors name the engine."""
    try:
        return adapter(name, effects=scenario.effects).simulate(scenario, seed=seed, dt=dt, progress=progress)
    except StochfricError as error:
        raise type(error)(f"{name}: {error}") from None


def _silent(_name: str, _duration: float) -> Advance:
    return lambda _time: None


def _or_none(value: float) -> float | None:
    return value if math.isfinite(value) else None
