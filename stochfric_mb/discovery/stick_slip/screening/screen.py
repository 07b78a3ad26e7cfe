"""Screening: which effects would explain what the stated model leaves in the slips, and how much better than chance.

Score = 2 delta log L - p ln n - 2 ln(grid size); found one after the other, each with its own evidence.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.screening.competitors import SOFTENING, competitors, softening, step_times, steps
from stochfric_mb.discovery.stick_slip.screening.hypotheses import hypotheses_in, waves_in
from stochfric_mb.discovery.stick_slip.screening.regression import Baseline, Solution
from stochfric_mb.discovery.stick_slip.screening.waves import waves_of, with_harmonics
from stochfric_mb.effects import effect_class, kind_with_signature, kinds_with
from stochfric_mb.effects.marks import COURSE_OF_ANY_SHAPE, ENTRAINED, RETURNING, WAVE, Hypothesis
from stochfric_mb.effects.traits import ALONG_BELT, ANY_SHAPE, JUMP, POSITIVE, WAVES

REFITTED = 14
"""Candidates, best first at fixed variance components, whose variance components are fitted anew."""

OTHERS, APART = 3, 0.2
"""Other ways of a kind that are kept at most, and how far apart the logarithms of their first settings are [-]: about as far as
a fit finds its way by itself. They are starts alone, and decide nothing."""


@dataclasses.dataclass(frozen=True)
class Candidate:
    """The best hypothesis of one kind."""

    name: str
    """Kind of effect, or name of a competitor that names no physics."""
    axis: str
    """Axis on which a competitor's disagreement lives; empty for an effect."""
    score: float
    """Score [-]."""
    hypothesis: Hypothesis
    """Its regressors."""
    solution: Solution
    """The fit with it."""
    others: tuple[Candidate, ...] = ()
    """Other ways of the same kind that marks hardly tell from this one, far from it: where simulations may begin as well."""

    @property
    def is_effect(self) -> bool:
        """Whether it names physics."""
        return not self.axis

    @property
    def is_wave(self) -> bool:
        """Whether it is periodic in time or along the belt, with a phase of its own in each run."""
        return self.hypothesis.variant in (WAVE, RETURNING, ENTRAINED)

    @property
    def any_shape(self) -> bool:
        """Whether it can give slips nearly any shape, the same to all: friction along the stroke."""
        return self.has(ANY_SHAPE) and not self.is_wave

    @property
    def any_course(self) -> bool:
        """Whether it is a course in time that is not held to a form."""
        return self.hypothesis.variant == COURSE_OF_ANY_SHAPE

    @property
    def along_belt(self) -> bool:
        """Whether it is a wave along the belt, not in time."""
        return self.has(ALONG_BELT)

    def frequency(self, belt: float) -> float:
        """Return the frequency of a wave [Hz], of one along the belt at a belt velocity [m/s]."""
        main = float(self.hypothesis.setting[0])
        return belt / main if self.along_belt else main

    def has(self, trait: str) -> bool:
        """Return whether it is an effect with a trait."""
        return self.is_effect and trait in effect_class(self.name).traits

    @property
    def strengths(self) -> Array:
        """Coefficients of its regressors, which stand behind those of the model's terms."""
        return self.solution.coefficients[-len(self.hypothesis.columns) :]


@dataclasses.dataclass(frozen=True)
class _Kind:
    """The ways in which one effect, or a pattern without a name, may have marked the slips."""

    name: str
    """Kind of effect, or name of the pattern."""
    axis: str
    """Axis of a pattern; empty for an effect."""
    hypotheses: list[Hypothesis]
    """The ways that are looked at."""
    grid: int
    """Among how many they were chosen."""


def screen(baseline: Baseline, *, held: Sequence[str] = ()) -> list[Candidate]:
    """Return the best hypothesis of each kind, and of each variant of a kind, best first.

    Args:
        baseline: what the model so far leaves of the slips.
        held: kinds that the model holds already, of which waves alone may have further tones.
    """
    without = [kind for kind in held if kind not in kinds_with(WAVES)]
    kinds = (*_effects(baseline, without, held), *_patterns(baseline.pool), *_steps(baseline, without))
    rough = sorted((_best(kind, baseline, baseline.solution.scatter) for kind in kinds), key=lambda r: -r[0])
    items = [
        _refitted(kind, hypothesis, baseline)
        if i < REFITTED
        else Candidate(kind.name, kind.axis, score, hypothesis, baseline.solved(hypothesis.columns))
        for i, (score, kind, hypothesis, _) in enumerate(rough)
    ]
    return sorted((c for c in items if _sign_possible(c.name, c.solution, baseline)), key=lambda c: -c.score)


def with_overtones(candidate: Candidate, baseline: Baseline) -> Candidate:
    """Return a wave with its harmonics, and any other candidate as it is."""
    wave = effect_class(candidate.name).wave(baseline.pool) if candidate.hypothesis.variant == WAVE else None
    if wave is None or candidate.hypothesis.setting[-1] > 1.0:
        return candidate
    frequency = candidate.frequency(float(baseline.pool.belt_velocity.min()))
    fuller = with_harmonics(baseline.pool, candidate.name, wave, frequency)
    return dataclasses.replace(candidate, hypothesis=fuller, solution=baseline.solved(fuller.columns))


def _refitted(kind: _Kind, hypothesis: Hypothesis, baseline: Baseline) -> Candidate:
    """Return the best way of a kind with the variance components fitted anew.

    The ways of a kind are distinguished at the scatter that one of them leaves, not at that without any.
    """
    fitted = baseline.fitted(hypothesis.columns)
    _, _, best, penalty = _best(kind, baseline, fitted.scatter)
    if best is not hypothesis:
        fitted = baseline.regression.fit(baseline.terms.plus(best.columns), fitted.scatter)
    score = 2.0 * (baseline.solution.cost - fitted.cost) - penalty
    return Candidate(kind.name, kind.axis, score, best, fitted, tuple(_others(kind, best, baseline, fitted.scatter)))


def _others(kind: _Kind, best: Hypothesis, baseline: Baseline, scatter: Array) -> Iterator[Candidate]:
    """Yield ways of a kind whose first setting, on a logarithmic scale, is far from that of the better ones."""
    if kind.axis or not best.setting or best.variant in (WAVE, RETURNING, ENTRAINED) or kind.name == kind_with_signature(JUMP):
        return
    gains = baseline.regression.gains(baseline.terms, scatter, [h.columns for h in kind.hypotheses])
    taken = [best.setting[0]]
    for place in np.argsort(-gains, kind="stable"):
        way = kind.hypotheses[place]
        if len(taken) > OTHERS:
            return
        if all(way.setting[0] * other > 0.0 and abs(np.log(way.setting[0] / other)) > APART for other in taken):
            taken.append(way.setting[0])
            yield Candidate(kind.name, "", 2.0 * float(gains[place]), way, baseline.solved(way.columns))


def _effects(baseline: Baseline, without: Sequence[str], held: Sequence[str]) -> Iterator[_Kind]:
    """Yield the effects by their variants, then those that are waves."""
    for kind, ways in hypotheses_in(baseline.pool, without=without).items():
        for variant in dict.fromkeys(h.variant for h in ways):
            yield _Kind(kind, "", [h for h in ways if h.variant == variant], len(ways))
    for kind, wave in waves_in(baseline.pool, without=without).items():
        for best_one, looked_at in waves_of(kind, wave, baseline, held=kind in held):
            yield _Kind(kind, "", [best_one], looked_at)


def _patterns(pool: Pool) -> Iterator[_Kind]:
    """Yield what names no physics."""
    for name, (axis, columns) in competitors(pool).items():
        yield _Kind(name, axis, [Hypothesis(name, list(columns))], 1)
    softer = softening(pool)
    yield _Kind(SOFTENING, "stiffness, time within the run", softer, len(softer))


STEP_SWEEPS = 5
"""Times that the steps of all runs are looked for anew beside those of the others; two mostly do."""


def _steps(baseline: Baseline, without: Sequence[str]) -> Iterator[_Kind]:
    """Yield steps of the friction, which have no name, and of the sensor."""
    for kind, axis, multiplied in (
        ("friction_step", "abrupt change of the friction", True),
        (kind_with_signature(JUMP), "", False),
    ):
        if kind not in without:
            step = _step(baseline, kind, multiplied=multiplied)
            yield _Kind(kind, axis, [step], len(step_times(baseline.pool)) ** baseline.pool.n_runs)


def _best(kind: _Kind, baseline: Baseline, scatter: Array) -> tuple[float, _Kind, Hypothesis, float]:
    """Return score, kind, hypothesis and cost of the best way of a kind at fixed variance components."""
    gains = baseline.regression.gains(baseline.terms, scatter, [h.columns for h in kind.hypotheses])
    cost = np.array([len(h.columns) for h in kind.hypotheses]) * baseline.price
    order = np.argsort(cost - 2.0 * gains, kind="stable")
    # a curved hypothesis whose strength comes out negative must not stand before a straight one that is possible
    possible = (int(j) for j in order if _can_be(kind.name, kind.hypotheses[j], baseline))
    best = next(possible, int(order[0]))
    penalty = float(cost[best]) + 2.0 * np.log(kind.grid)
    return 2.0 * float(gains[best]) - penalty, kind, kind.hypotheses[best], penalty


def _positive(kind: str) -> bool:
    """Return whether a name is that of an effect whose strength cannot be negative."""
    return kind in kinds_with(POSITIVE)


def _can_be(kind: str, hypothesis: Hypothesis, baseline: Baseline) -> bool:
    return not _positive(kind) or _sign_possible(kind, baseline.solved(hypothesis.columns), baseline)


def _sign_possible(kind: str, fitted: Solution, baseline: Baseline) -> bool:
    """Return whether the fitted strength has a sign that the effect can have, within two standard deviations."""
    place = baseline.n_terms
    return not _positive(kind) or bool(fitted.coefficients[place] > -2.0 * fitted.deviations[place])


def _step(baseline: Baseline, kind: str, *, multiplied: bool) -> Hypothesis:
    """Return one step a run, each where it explains most; two of a sensor where the second one explains enough more."""
    pool, place = baseline.pool, step_times(baseline.pool)
    trials = [steps(pool, run, multiplied=multiplied) for run in range(pool.n_runs)]
    firsts, _ = _best_steps(trials, baseline)
    columns = [mine[best] for mine, best in zip(trials, firsts, strict=True)]
    if not multiplied:
        # what one step leaves of two is no scatter any more: its components are fitted anew
        seconds, gain = _best_steps(trials, baseline.plus(columns))
        if 2.0 * gain - pool.n_runs * (baseline.price + 2.0 * np.log(len(place))) >= criteria.SECOND_STEP:
            pairs = list(zip(trials, firsts, seconds, strict=True))
            both = [mine[i] for mine, *pair in pairs for i in pair]
            return Hypothesis(kind, both, tuple(float(place[i]) for _, *pair in pairs for i in pair))
    return Hypothesis(kind, columns, tuple(float(place[best]) for best in firsts))


def _best_steps(trials: Sequence[Sequence[Array]], baseline: Baseline) -> tuple[list[int], float]:
    """Return the number of the best step of each run beside those of the others, and by how much they lower the cost together.

    Coefficients are those of all runs: where the steps of the others are not in, they lie between the levels of these.
    """
    best = [int(np.argmax(baseline.gains([[t] for t in mine]))) for mine in trials]
    for _ in range(STEP_SWEEPS if len(trials) > 1 else 0):
        before = list(best)
        for run, mine in enumerate(trials):
            others = [trials[r][i] for r, i in enumerate(best) if r != run]
            beside = dataclasses.replace(baseline, terms=baseline.terms.plus(others))
            best[run] = int(np.argmax(beside.gains([[t] for t in mine])))
        if best == before:
            break
    return best, float(baseline.gains([[mine[i] for mine, i in zip(trials, best, strict=True)]])[0])
