"""Kang, Choi and Yoo 2015: each of its claims, tested.

Reference: J. Mech. Sci. Tech. 29 (9), 2015, 3645-3652, doi 10.1007/s12206-015-0808-4.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

from stochfric_mb.reproduction import coefficients, cost, defaults, output_step, portraits, scaling
from stochfric_mb.reproduction.claims import Claim
from stochfric_mb.reproduction.settings import FULL, Settings
from stochfric_mb.scenario import Scenario, load_scenario

SCHEMA = "stochfric.reproduction/1"
TITLE = "Stochastic modeling of friction force and vibration analysis of a mechanical system using the model"
SOURCE = "W. S. Kang, C. K. Choi and H. H. Yoo, J. Mech. Sci. Tech. 29 (9), 2015, 3645-3652, doi 10.1007/s12206-015-0808-4"
LAWS = ("coulomb", "havsin", "elastic_stick")
SCENARIOS = {
    "Table 1": "kang2015_table1",
    "Table 2, 13.8 rad/s": "kang2015_table2_13_8",
    "Table 2, 18.7 rad/s": "kang2015_table2_18_7",
}

Stage = Callable[[str, int], Callable[[int], None]]
"""(name of what is counted, how many) -> function called with how many are done."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Reproduction:
    """All claims, and what their figures are drawn from."""

    settings: Settings
    """Sizes."""
    seed: int
    """Seed of all random numbers."""
    claims: tuple[Claim, ...]
    """The claims, in the order of the page."""
    gaps: tuple[defaults.Gap, ...]
    """What the paper leaves open."""
    sensitivities: tuple[defaults.Sensitivity, ...]
    """Defaults halved and doubled."""
    steps: output_step.StepStudy
    """Ensembles at several output steps."""
    rejections: tuple[coefficients.Rejection, ...]
    """Pairs before and after rejection."""
    interpolation: coefficients.Interpolation
    """Standard deviation between knots."""
    portraits: tuple[portraits.Portrait, ...]
    """Phase portraits."""
    growth: tuple[scaling.Scaling, ...]
    """Cost along samples and time."""

    def claim(self, name: str) -> Claim:
        """Return a claim by its id."""
        return next(claim for claim in self.claims if claim.id == name)

    def to_dict(self) -> dict[str, Any]:
        """Return the content of reproduce.json."""
        return {
            "schema": SCHEMA,
            "source": SOURCE,
            "seed": self.seed,
            "settings": dataclasses.asdict(self.settings),
            "claims": [claim.to_dict() for claim in self.claims],
            "left_open": [dataclasses.asdict(gap) for gap in self.gaps],
            "sensitivity": [s.to_dict() for s in self.sensitivities],
            "cost_growth": [s.to_dict() for s in self.growth],
        }


def no_stage(_name: str, _total: int) -> Callable[[int], None]:
    """Return a function that ignores progress."""
    return lambda _done: None


def reproduce(*, settings: Settings = FULL, seed: int = 0, stage: Stage = no_stage) -> Reproduction:
    """Return every claim of the paper with its numbers and verdict.

    The same seed gives the same numbers, apart from the claim on computing cost.

    Args:
        settings: sizes; `FULL` takes a few minutes, `QUICK` some seconds.
        seed: of all random numbers.
        stage: called at the begin of each study, for progress.
    """
    scenarios = {name: {law: load_scenario(file, law=law) for law in LAWS} for name, file in SCENARIOS.items()}
    table_1 = scenarios["Table 1"]
    tables = {"Table 1": table_1["elastic_stick"], "Table 2": scenarios["Table 2, 13.8 rad/s"]["elastic_stick"]}
    n_steps = len(LAWS) * len(settings.steps) * settings.n_many
    steps = output_step.run_steps(table_1, settings, seed, stage("runs at each output step", n_steps))
    mends = output_step.run_mends(table_1["coulomb"], settings, seed, stage("processes", output_step.N_MENDS))
    drawn = stage("portraits", len(LAWS) * len(scenarios))
    pictures = portraits.make_portraits(scenarios, settings, seed, drawn)
    varied = defaults.vary(table_1, settings, seed, stage("values of defaults", defaults.n_responses()))
    growth = scaling.measure(table_1, settings, seed, stage("costs measured", 2 * len(LAWS)))
    price = cost.cost_claim(table_1, growth, settings, seed, stage("laws timed", len(LAWS)))
    tick = stage("claims judged", 5)
    rejections = coefficients.draw_rejections(tables, settings, seed)
    interpolation = coefficients.measure_interpolation(tables["Table 1"], settings, seed)
    tick(1)
    claims = output_step.claims(steps, mends, settings)
    tick(2)
    claims.append(coefficients.rejection_claim(rejections))
    claims += coefficients.interpolation_claims(interpolation, tables, settings, seed)
    tick(3)
    claims += portraits.claims(pictures, settings, seed)
    claims.append(defaults.laws_claim(varied, steps.ensembles, settings))
    tick(4)
    claims += [price, *coefficients.sigma_claims(tables)]
    forced: Scenario = scenarios["Table 2, 18.7 rad/s"]["elastic_stick"]
    left_open = defaults.gaps(table_1, forced, varied, settings, seed)
    tick(5)
    return Reproduction(
        settings=settings,
        seed=seed,
        claims=tuple(claims),
        gaps=tuple(left_open),
        sensitivities=tuple(varied),
        steps=steps,
        rejections=tuple(rejections),
        interpolation=interpolation,
        portraits=tuple(pictures),
        growth=tuple(growth),
    )
