"""How the runs of an ensemble are computed: a kernel for samples side by side, or an engine one sample at a time."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from types import ModuleType
from typing import Any

from stochfric_mb.coefficients.processes import TIME
from stochfric_mb.effects.combine import any_but_random
from stochfric_mb.engines import adapter
from stochfric_mb.ensemble import coulomb, elastic_stick, fixed_step, havsin
from stochfric_mb.ensemble.result import Block, empty_block
from stochfric_mb.ensemble.schedule import Array
from stochfric_mb.ensemble.single import one_at_a_time
from stochfric_mb.errors import SimulationError, require_number
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.metrics import least_slip
from stochfric_mb.scenario import Scenario

Compute = Callable[[int, int, int], Block]
"""(seed, first sample, number of samples) -> their runs."""

EVENT_DRIVEN: dict[str, ModuleType] = {"coulomb": coulomb}
"""Laws with a kernel that needs no step."""
FIXED_STEP: dict[str, ModuleType] = {"havsin": havsin, "elastic_stick": elastic_stick}
"""Laws with a kernel that steps."""


@dataclasses.dataclass(frozen=True)
class Method:
    """One way to compute runs."""

    text: str
    """What it does, in one line."""
    side_by_side: bool
    """Whether a kernel runs samples side by side."""
    dt: float
    """Step [s]; 0 where there is none."""
    block: int
    """Runs in a block, unless stated otherwise."""
    prepare: Callable[[Array], Compute]
    """Output times -> the function that computes runs."""


def method(scenario: Scenario, engine: str, dt: float | None) -> Method:
    """Return how the runs of a scenario are computed.

    Raises:
        InputError: the engine or the step cannot be used.
    """
    kind = scenario.law.kind
    process = scenario.coefficient_process
    along_time = process is None or (process.clock == TIME and process.linear)
    plain = not any_but_random(scenario.effects)
    if engine == "reference" and plain and along_time and kind in EVENT_DRIVEN:
        return Method(
            "event-driven, samples side by side", True, 0.0, 256,
            lambda times: _event_driven(EVENT_DRIVEN[kind], scenario, times),
        )  # fmt: skip
    if engine == "reference" and plain and along_time and kind in FIXED_STEP:
        step = min(1.0e-4, 0.5 * scenario.step_limit()) if dt is None else require_number("dt", dt, above=0.0, unit="s")
        return Method(
            f"Runge-Kutta 4, steps of at most {step:.4g} s, samples side by side", True, step, 256,
            lambda times: _fixed_step(FIXED_STEP[kind], scenario, times, step),
        )  # fmt: skip
    adapter(engine)
    step = 0.0 if dt is None else dt
    if engine == "reference":
        step = 0.0
    elif dt is None and isinstance(scenario.mechanism, BeltBox):
        step = scenario.default_dt()
    return Method(f"{engine}, one sample at a time", False, step, 16, lambda times: one_at_a_time(scenario, engine, dt, times))


def _event_driven(kernel: ModuleType, scenario: Scenario, times: Array) -> Compute:
    return _kernel(kernel, kernel.problem(scenario, times, least_slip(scenario.law, scenario.mechanism)), len(times))


def _fixed_step(kernel: ModuleType, scenario: Scenario, times: Array, dt: float) -> Compute:
    problem = fixed_step.problem(scenario, times, least_slip(scenario.law, scenario.mechanism), dt)
    return _kernel(kernel, problem, len(times))


def _kernel(kernel: ModuleType, problem: Any, n_times: int) -> Compute:
    def compute(seed: int, first: int, n: int) -> Block:
        block = empty_block(n, n_times)
        failed = kernel.simulate(problem, seed, first, n, *block)
        if failed > 0:
            t = float(problem.legs.start[failed - 1])
            raise SimulationError(
                f"samples {first} .. {first + n - 1}: a contact switches without end near t = {t:g} s; "
                "run that sample alone with the reference"
            )
        return block

    return compute
