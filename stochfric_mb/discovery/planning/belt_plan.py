"""Planned runs of a belt-box: simulated as stated, taken through discovery's own extraction, and screened for effects.

The regressors by which discovery screens for effects are the change of the slips' features with each effect, to first order;
the covariance of these features comes from simulating the stated model with the sensor's noise.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy.optimize import brentq

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.planning.planned_run import PlannedRun
from stochfric_mb.discovery.planning.rig_plan import Further, Part, RigPlan
from stochfric_mb.discovery.planning.signature import Signature, needed_for_a_name
from stochfric_mb.discovery.stick_slip.advice import SEEN_BY, constant_conditions
from stochfric_mb.discovery.stick_slip.records.calibration import Calibration, calibrate
from stochfric_mb.discovery.stick_slip.records.pool import Pool, make_pool
from stochfric_mb.discovery.stick_slip.records.preconditions import require_usable
from stochfric_mb.discovery.stick_slip.records.slips import SETTLING, Slips, extract
from stochfric_mb.discovery.stick_slip.screening.hypotheses import hypotheses_in, waves_in
from stochfric_mb.discovery.stick_slip.screening.power import simulated_limit
from stochfric_mb.discovery.stick_slip.screening.regression import Regression, Solution, Terms, stated_terms
from stochfric_mb.discovery.stick_slip.screening.waves import slow_frequencies, wave_columns
from stochfric_mb.discovery.stick_slip.simulation.prior_model import assumed, prior_model
from stochfric_mb.discovery.stick_slip.study import record_of
from stochfric_mb.effects import effect_class, effect_kinds, kind_with_signature
from stochfric_mb.effects.marks import Hypothesis
from stochfric_mb.effects.traits import DRAWN_ANEW, SHAPES_SLIPS
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.run import Run, apply_settings
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.reference.augmented import Start, augmented_system

LOOKED_AT = 6
"""Frequencies that stand for all: periodic effects are all alike."""
PROBE = 0.5
"""Coefficient at which the size of a hypothesis is read off: below, the size may have reached a bound of fits."""
CYCLES = 3.0
"""Times that the belt needs to stretch the spring to break-away, that are simulated before a record at least [-]."""
SHARE_OF_TRAVEL = 1.0e-3
"""Noise of a sensor of which nobody said how good it is, over the motion that it sees [-]."""


@dataclasses.dataclass(frozen=True)
class BeltPart(Part):
    """One planned run, as discovery would see it."""

    slips: Slips
    """The slips of its simulated record."""
    calibration: Calibration
    """Errors of their features."""


@dataclasses.dataclass(frozen=True)
class BeltPlan(RigPlan):
    """Planned runs of a belt-box."""

    def facts(self, part: BeltPart) -> dict[str, Any]:
        """Return what there is to say of a planned run."""
        return super().facts(part) | {"slips": len(part.slips)}

    def part(self, run: PlannedRun, seed: int) -> BeltPart:
        """Return a planned run, simulated and taken through discovery's extraction.

        Raises:
            InputError: the belt rests, the sampling is too slow, or the box slips too seldom; says what would do.
        """
        run, measured = self._measured(run, seed)
        data = assumed(self.records(measured))
        require_usable(data)
        slips = extract(record_of(data.fit[0], data))
        if len(slips) < criteria.FEWEST_SLIPS:
            cycle = run.duration / max(len(slips), 1)
            raise InputError(
                f"{run.name}: {len(slips)} slips in {run.duration:g} s; at least {criteria.FEWEST_SLIPS} are needed"
                + (f": plan {math.ceil(1.2 * criteria.FEWEST_SLIPS * cycle)} s or more" if len(slips) else "; the box does "
                   "not slip with the stated numbers: check mu_s against mu_k, and the speed of the belt")
            )  # fmt: skip
        return BeltPart(run, measured, slips, calibrate(slips, seed=11 + seed))

    def signatures(self, parts: Sequence[BeltPart]) -> tuple[list[Signature], dict[str, str]]:
        """Return what effects would leave in some runs, and effect -> what would show it, for those that leave nothing."""
        pool = make_pool([p.slips for p in parts], [p.calibration for p in parts])
        terms = stated_terms(pool, dict(assumed(self.records()).scenario.uncertainty))
        regression = Regression(pool)
        solution = regression.fit(terms)
        forms = list(_forms(pool, regression, terms, solution))
        constant = constant_conditions(pool)
        blind = {
            kind: SEEN_BY.get(effect_class(kind).answers_to, f"another {effect_class(kind).answers_to}")
            for kind in effect_kinds()
            if effect_class(kind).answers_to in constant
        }
        stated_kinds = {e.kind for e in self.scenario.effects}
        if self.scenario.process is not None:
            stated_kinds |= {kind_with_signature(DRAWN_ANEW)}
        return [f for f in forms if f.kind not in {*blind, *stated_kinds}], blind

    @property
    def no_limit(self) -> tuple[str, ...]:
        """The effects for which discovery has detectors and no regressors."""
        return tuple(k for k in effect_kinds() if effect_class(k).searched_in_slips())

    def further(self, first: PlannedRun) -> list[Further]:
        """Return runs that may be added: other speeds, the belt reversed, another load, finer sampling."""
        box = self._box(first)
        speed, load = box.belt_velocity, box.normal_force

        def setting(**settings: float) -> dict[str, Any]:
            return {"settings": dict(first.settings) | settings}

        twice = 2.0 * first.duration
        return [
            (f"a run at belt_velocity = {2.0 * speed:.3g} m/s", setting(belt_velocity=2.0 * speed)),
            (
                f"a run of {twice:g} s at belt_velocity = {0.5 * speed:.3g} m/s",
                setting(belt_velocity=0.5 * speed) | {"duration": twice},
            ),
            (f"a run with the belt reversed, belt_velocity = {-speed:.3g} m/s", setting(belt_velocity=-speed)),
            (f"a run at normal_force = {2.0 * load:.3g} N", setting(normal_force=2.0 * load)),
            (f"a run at {2.0 * first.sample_rate:g} samples a second", {"sample_rate": 2.0 * first.sample_rate}),
        ]

    def _box(self, run: PlannedRun) -> BeltBox:
        return apply_settings(self.scenario, run.settings, f"run {run.name!r}")

    def _measured(self, run: PlannedRun, seed: int) -> tuple[PlannedRun, Run]:
        """Return a planned run with its noise stated, and what would be measured with the stated model."""
        if run.stroke is not None or run.period is not None:
            raise InputError(f"{run.name}: stroke and period are those of a driven joint; a belt-box has belt_velocity")
        box, step = self._box(run), 1.0 / run.sample_rate
        if box.belt_velocity == 0.0:
            raise InputError(f"{run.name}: belt_velocity is 0 m/s; plan a belt that runs")
        model = prior_model(self.scenario)
        system = augmented_system(box, model.law, model.effects, model.process, seed=seed + 1)
        loaded = CYCLES * model.law.mu_s * box.normal_force / (box.stiffness * abs(box.belt_velocity))
        settling = max(SETTLING * math.sqrt(box.mass / box.stiffness), loaded)
        start = Start(-settling, 0.0, box.belt_velocity, stick=True)
        settled = system.march(start, step, round(settling * run.sample_rate)).end
        position = system.march(settled, step, round(run.duration * run.sample_rate)).position
        run = run.with_noise(SHARE_OF_TRAVEL * float(np.ptp(position)))
        position = position + (run.noise or 0.0) * np.random.default_rng(seed).standard_normal(len(position))
        return run, run.record({"position": position})


@dataclasses.dataclass(frozen=True)
class _Form:
    """A hypothesis or a wave before the terms of the stated model are taken out."""

    kind: str
    columns: Sequence[Any]
    grid: int
    value: Callable[[float], tuple[str, float, dict[str, float | str], bool]]
    limited: bool = True
    """Whether it has a limit of its own; if not, it is what another effect may be taken for."""
    least: float = 0.0
    """Coefficient from which simulating the effect confirms it; 0 where it is not simulated."""
    wave: bool = False
    """Whether columns are the effect at its phases in turn; if not, the first one is the effect."""


def _forms(pool: Pool, regression: Regression, terms: Terms, solution: Solution) -> list[Signature]:
    """Return the forms of all effects that the slips could show."""
    periodic: list[_Form] = []
    for kind, wave in waves_in(pool).items():
        every = slow_frequencies(pool, wave.pace)
        for f in every[len(every) // (2 * LOOKED_AT) :: max(len(every) // LOOKED_AT, 1)]:
            place = _wave_value(kind, wave.setting(float(f)))
            periodic.append(_Form(kind, wave_columns(pool, wave, float(f), 1), 3 * len(every), place, wave=True))
    known = {f.kind for f in periodic}
    plain = [
        _Form(
            kind,
            h.columns,
            len(ways),
            _value_of(kind, h, len(h.columns)),
            limited=kind not in known and h.variant == ways[0].variant,
            least=_least(pool, terms, h),
        )
        for kind, ways in hypotheses_in(pool).items()
        for h in ways
    ]
    forms = [(f, regression.beyond(terms, solution.scatter, f.columns)) for f in (*plain, *periodic)]
    signatures = [s for f, columns in forms if (s := _signature(f, columns, regression.n)) is not None]
    return [*signatures, _scatter_signature(pool, regression, solution)]


def _least(pool: Pool, terms: Terms, hypothesis: Hypothesis) -> float:
    """Return the coefficient from which simulating an effect confirms it, 0 for one that is not simulated."""
    simulated = SHAPES_SLIPS in effect_class(hypothesis.kind).traits
    return simulated_limit(pool, terms, hypothesis) if simulated else 0.0


def _signature(form: _Form, columns: Any, n: int) -> Signature | None:
    """Return a form at its limit; None: the numbers of the stated model imitate it."""
    needed = needed_for_a_name(columns.shape[1], n, form.grid)
    plain = (columns[:, 0::2], columns[:, 1::2]) if form.wave else (columns[:, :1],)
    signals = [c.sum(axis=1) for c in plain]
    evidence = float(np.mean([s @ s for s in signals]))
    raw = float(sum(np.sum(np.square(c)) for c in form.columns))
    if evidence <= 1.0e-9 * raw:
        return None
    strength = max(math.sqrt(needed / evidence), form.least)
    name, value, beside, at_most = form.value(strength)
    limit = abs(value) if form.limited and name else math.inf
    unit = effect_class(form.kind).__dataclass_fields__[name].metadata["unit"] if name else "-"
    return Signature(form.kind, name, unit, limit, beside, tuple(strength * s for s in signals), columns, at_most)


def _value_of(kind: str, hypothesis: Hypothesis, n: int) -> Any:
    """Return strength -> name of the parameter that is the size, its value, those beside it [SI], and whether it is a bound."""
    fields = effect_class(kind).__dataclass_fields__

    def at(strength: float) -> tuple[str, float, dict[str, float | str]]:
        values = {k: v for k, v in hypothesis.start(strength * np.eye(n)[0]).items() if k in fields}
        values = {k: v if isinstance(v, str) else float(v) for k, v in values.items()}
        name = next(iter(values), "")
        return name, float(values.pop(name, math.inf)), values

    def value(strength: float) -> tuple[str, float, dict[str, float | str], bool]:
        name, here, others = at(strength)
        proportional = at(PROBE)[1] * strength / PROBE
        return name, here, others, not math.isclose(here, proportional, rel_tol=1.0e-6)

    return value


def _wave_value(kind: str, setting: float) -> Any:
    where = "wavelength" if "wavelength" in effect_class(kind).__dataclass_fields__ else "frequency"
    return lambda strength: ("amplitude", strength, {where: setting}, False)  # pyright: ignore[reportUnknownLambdaType]


def _scatter_signature(pool: Pool, regression: Regression, solution: Solution) -> Signature:
    """Return scatter of the force at break-away from slip to slip: a variance has no signal that another effect could imitate.

    A component that multiplies a slip's variance by 1 + r raises 2 delta log L by r - ln(1 + r) on average.
    """
    information = np.zeros(len(pool.run))
    for r in range(pool.n_runs):
        covariance = regression.covariance(r, solution.scatter)
        information[pool.run == r] = np.linalg.inv(covariance)[0, 0] * pool.normal_force[pool.run == r] ** 2
    kept = information[pool.kept]

    def lacking(log_sigma: float) -> float:
        ratio = math.exp(2.0 * log_sigma) * kept
        return float(np.sum(ratio - np.log1p(ratio))) - criteria.SCATTER_CERTAIN

    sigma = math.exp(float(brentq(lacking, -30.0, 5.0)))  # pyright: ignore[reportArgumentType]  # a number, without full_output
    kind = kind_with_signature(DRAWN_ANEW)
    return Signature(kind, "sigma_s", "-", sigma, {"process": "per_event"}, (), np.zeros((0, 0)))
