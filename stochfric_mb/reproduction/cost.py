"""Claim: a stochastic run costs little more than a deterministic one."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Mapping

import numpy as np

from stochfric_mb import ensemble, statistics
from stochfric_mb.reproduction import scaling
from stochfric_mb.reproduction.claims import FAILS, HOLDS, UNDECIDABLE, Claim, Number, of_estimate
from stochfric_mb.reproduction.output_step import paper_process
from stochfric_mb.reproduction.settings import Settings
from stochfric_mb.scenario import Scenario

LITTLE = 2.0
"""Ratio of costs up to which a stochastic run costs little more [-]."""
STEPPED = ("havsin", "elastic_stick")
"""Laws whose kernel steps, as the paper's integration must have."""


def cost_claim(
    scenarios: Mapping[str, Scenario], growth: list[scaling.Scaling], settings: Settings, seed: int, tick: Callable[[int], None]
) -> Claim:
    """Return the claim on the cost of a run; the only one whose numbers are not the same in each repetition."""
    numbers: list[Number] = []
    ratios: dict[str, statistics.Estimate] = {}
    for done, (law, scenario) in enumerate(scenarios.items(), start=1):
        seconds = _timed(scenario, settings, seed)
        for kind, result in seconds.items():
            each = statistics.mean(1.0e3 * result / settings.n_cost)
            numbers.append(
                of_estimate(f"ms_{kind}_{law}", f"processor time of a run of {scenario.duration:g} s, {kind}, {law}", each,
                            unit="ms", n=settings.cost_repeats, group="Times")
            )  # fmt: skip
        ratios[law] = statistics.mean(seconds["stochastic"] / seconds["deterministic"])
        text = "fixed steps" if law in STEPPED else "event-driven, a knot each 1 ms"
        numbers.append(
            of_estimate(f"ratio_{law}", f"stochastic over deterministic, {law} ({text})", ratios[law], n=settings.cost_repeats)
        )
        tick(done)
    judged = [ratios[law] for law in STEPPED if law in ratios]
    verdict = UNDECIDABLE
    if all(r.high <= LITTLE for r in judged):
        verdict = HOLDS
    elif any(r.low > LITTLE for r in judged):
        verdict = FAILS
    return Claim(
        id="cost_of_a_run",
        claim="A stochastic run costs little more than a deterministic one",
        where="section 4, computing cost",
        test=f"processor time of {settings.n_cost} runs of Table 1 side by side on one core, pairs every 1 ms against constant "
        f"coefficients, {settings.cost_repeats} times in turn",
        rule=f"for the laws that step: holds if the interval of the ratio lies below {LITTLE:g}, fails if one lies above; "
        "undecidable otherwise",
        verdict=verdict,
        reason="Ratio " + ", ".join(f"{ratios[law].value:.2f} ({law})" for law in STEPPED if law in ratios),
        numbers=(*numbers, *scaling.numbers(growth)),
        remark=f"Wording and limit are ours. A distribution needs an ensemble: {settings.n_paper} runs cost {settings.n_paper} "
        "times as much: the cost is linear in samples and in time. These numbers depend on the machine and its load.",
    )


def _timed(scenario: Scenario, settings: Settings, seed: int) -> dict[str, np.ndarray]:
    """Return processor times [s] of whole ensembles, deterministic and stochastic in turn, shape (cost_repeats,) each."""
    assert scenario.process is not None
    process = paper_process(scenario.process.sigma_s, scenario.process.sigma_k, 1.0e-3)
    problems = {
        "deterministic": dataclasses.replace(scenario, process=None),
        "stochastic": dataclasses.replace(scenario, process=process),
    }
    table: dict[str, list[float]] = {kind: [] for kind in problems}
    for repeat in range(settings.cost_repeats + 1):
        for kind, problem in problems.items():
            before = time.process_time()
            ensemble.run(problem, settings.n_cost, seed=seed, output_times=[scenario.duration])
            if repeat > 0:  # the first loads compiled code
                table[kind].append(time.process_time() - before)
    return {kind: np.array(times) for kind, times in table.items()}
