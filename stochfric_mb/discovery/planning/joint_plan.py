"""Planned runs of a driven joint, also one of a MuJoCo model: driven to and fro, in weak form, and screened for effects.

The motion is harmonic and the drive what the stated model needs for it, each with its sensor's noise. What an effect does
to the force balance is linearised about the fitted model, as the search for effects does it.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from stochfric_mb.discovery.driven_joint.balance.balances import Balances
from stochfric_mb.discovery.driven_joint.decision.selection import Selector
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit, prior_rows, prior_weight
from stochfric_mb.discovery.driven_joint.fit.gains import effect_columns
from stochfric_mb.discovery.driven_joint.fit.wave_scan import Start
from stochfric_mb.discovery.driven_joint.search.candidate_fits import SIZES
from stochfric_mb.discovery.driven_joint.search.candidates import Candidate, candidates, span_of
from stochfric_mb.discovery.driven_joint.source import source_of
from stochfric_mb.discovery.inference.least_squares import beyond
from stochfric_mb.discovery.planning.joint_motion import measured_at_joint, measured_in_model
from stochfric_mb.discovery.planning.planned_run import PlannedRun
from stochfric_mb.discovery.planning.rig_plan import Further, Part, RigPlan
from stochfric_mb.discovery.planning.signature import BEYOND, Signature, needed_for_a_name
from stochfric_mb.effects import Effect, effect_class, effect_kinds
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import Mjcf

SHARE_OF_STROKE, SHARE_OF_FRICTION = 1.0e-4, 0.01
"""Noise of sensors of which nobody said how good they are, over the stroke and over the friction [-]."""
RICHER = {"direction": "strokes both ways", "load": "a measured load that varies", "temperature": "a measured temperature"}
"""Condition that effects answer to -> what a run must have to show them."""
FEWEST_CYCLES = 3.0
"""Strokes there and back below which a run says too little [-]."""


@dataclasses.dataclass(frozen=True)
class JointPlan(RigPlan):
    """Planned runs of a driven joint."""

    shown = ("force_noise", "stroke", "period")
    place: str = ""
    """Joint of a MuJoCo model; empty: the mechanism is one joint."""

    def part(self, run: PlannedRun, seed: int) -> Part:
        """Return a planned run, simulated.

        Raises:
            InputError: no motion is planned, or the mechanism needs a channel that is not planned.
        """
        joint = self.scenario.mechanism
        if run.stroke is None or run.period is None:
            raise InputError(
                f"{run.name}: a driven joint needs its motion; plan stroke and period, such as --run stroke=0.1,period=2"
            )
        if run.duration < FEWEST_CYCLES * run.period:
            raise InputError(
                f"{run.name}: {run.duration:g} s are {run.duration / run.period:.3g} periods; plan "
                f"{FEWEST_CYCLES * run.period:g} s or more"
            )
        if run.settings:
            raise InputError(f"{run.name}: set = {dict(run.settings)!r}; at a joint plan stroke, period, duration and noise")
        if getattr(joint, "piston_area", 0.0):
            raise InputError(f"{run.name}: a pressure cannot be planned; leave piston_area out of the scenario for the plan")
        source = self._source()
        friction = self.scenario.law.mu_k * source.places[self.place]
        stated = run.with_noise(SHARE_OF_STROKE * run.stroke, SHARE_OF_FRICTION * friction)
        if isinstance(joint, Mjcf):
            return Part(stated, measured_in_model(stated, source, self.place, self.scenario.law.mu_k, seed))
        return Part(stated, measured_at_joint(stated, joint, friction, seed))

    def signatures(self, parts: Sequence[Part]) -> tuple[list[Signature], dict[str, str]]:
        """Return what effects would leave in some runs, and effect -> what would show it, for those that leave nothing."""
        source, name = self._source(*(p.measured for p in parts)), self.place
        balances, load = source.balances(name, "fit", 0.0), source.places[name]
        fitted = Selector(balances, source.nuisances(name), source.stated(name)).recalibrated
        span = span_of(balances, fitted.model.law.mu_k * load, load)
        tried = candidates(span, fitted.model.effects)
        sizes: dict[str, set[str]] = {}
        straight = [c for c in tried if not c.any_shape]  # of a course of any shape one would have to say which
        for candidate in straight:
            sizes.setdefault(candidate.kind, set()).update(_size_of(effect) for effect in candidate.starts)
        every = (
            form
            for candidate in straight
            for effect in candidate.starts
            if (form := _form(candidate, effect, balances, fitted, len(tried))) is not None
        )
        # a form that changes two sizes of its kind at once has no limit in one of them: each alone has its own
        forms = [f for f in every if not (sizes[f.kind] - {f.parameter}) & set(f.beside)]
        richer = dataclasses.replace(span, both_ways=True, load=load, temperature=(20.0, 10.0))
        missing = {c.kind for c in candidates(richer, fitted.model.effects)} - {c.kind for c in tried}
        return forms, {k: RICHER.get(effect_class(k).answers_to, "another motion") for k in effect_kinds() if k in missing}

    @property
    def rotational(self) -> bool:
        """Whether friction acts about an axis."""
        return self._source().rotates(self.place)

    @property
    def notes(self) -> list[str]:
        """What a reader should know of this mechanism."""
        others = [name for name in getattr(self.scenario.mechanism, "friction", ()) if name != self.place]
        return [f"the limits are those of joint {self.place}; --joint plans {' or '.join(others)}"] if others else []

    def _source(self, *runs: Run) -> Balances:
        """Return the force balances of runs; a controller would ask for columns that are not planned."""
        scenario = dataclasses.replace(self.scenario, controller=None)
        return source_of(dataclasses.replace(self.records(*runs), scenario=scenario))

    @property
    def no_limit(self) -> tuple[str, ...]:
        """The effects that a joint may have."""
        return tuple(k for k in effect_kinds() if effect_class(k).searched_at_joints())

    def further(self, first: PlannedRun) -> list[Further]:
        """Return runs that may be added: faster, slower, longer strokes, a quieter force sensor."""
        stroke, period = first.stroke or 1.0, first.period or 1.0
        slower = {"period": 5.0 * period, "duration": 5.0 * first.duration}
        runs: list[Further] = [
            (f"a run twice as fast, period = {0.5 * period:.3g} s", {"period": 0.5 * period}),
            (f"a run five times as slow, period = {5.0 * period:.3g} s, for {5.0 * first.duration:g} s", slower),
            (f"a run with twice the stroke, {2.0 * stroke:.3g}", {"stroke": 2.0 * stroke}),
        ]
        if first.force_noise is not None:
            quiet = 0.5 * first.force_noise
            runs.append((f"a run with a force sensor of noise {quiet:.3g}", {"force_noise": quiet}))
        return runs


def _form(candidate: Candidate, effect: Effect, balances: Any, fitted: JointFit, kinds: int) -> Signature | None:
    """Return one start of a candidate at its limit (infinite: no number is its size).

    None: the numbers of the stated model imitate it.
    Its score is n ln(1 + x) less its cost, x the share of the mean square that it takes away over what stays; it must also
    lower the error by `MATERIAL`.
    """
    name = _size_of(effect)
    if not getattr(effect, name):
        effect = dataclasses.replace(effect, **{name: effect.__dataclass_fields__[name].metadata["scale"]})
    columns = effect_columns(fitted.model, Start(effect), balances)
    rows, _ = prior_rows(fitted, prior_weight(fitted))
    known = np.vstack([fitted.jacobian, rows])
    left = beyond(known, np.vstack([columns, np.zeros((len(rows), columns.shape[1]))]))
    change = left[:, 0]
    size = float(change @ change)
    if size <= 1.0e-9 * float(np.sum(columns**2)):
        return None
    n = fitted.n
    needed = needed_for_a_name(candidate.parameters, n, len(candidate.starts) * kinds)
    share = max(math.expm1(needed / n), BEYOND)
    strength = math.sqrt(share * len(columns) * fitted.rms**2 / size)
    numbers = {f.name: getattr(effect, f.name) for f in dataclasses.fields(effect)}
    # overtones are in proportion to it
    numbers = {k: strength * v if k.startswith(name) and k != name else v for k, v in numbers.items()}
    of_size = numbers.pop(name)
    # a form that is distinguished by its shape alone, such as friction in proportion to what a joint transmits, has no size
    limit = math.inf if name in effect.kept_at_joints(fitted.model.contact) else abs(strength * of_size)
    beside = {k: v for k, v in numbers.items() if v != effect.__dataclass_fields__[k].default and k not in effect.own_to_run}
    signal = change * math.sqrt(needed / size)
    return Signature(candidate.kind, name, effect.unit_of(name), limit, beside, (signal,), left)


def _size_of(effect: Effect) -> str:
    """Return the parameter that is the size of one form of an effect."""
    own = [f.name for f in dataclasses.fields(effect) if getattr(effect, f.name) != f.default]
    sizes = [name for name in SIZES if hasattr(effect, name)]
    moved = [name for name in (*sizes, *own) if getattr(effect, name)]
    return next(iter(moved or sizes or own))
