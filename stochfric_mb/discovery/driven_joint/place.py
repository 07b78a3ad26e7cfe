"""One place: timing, effects one by one, errors on held-out runs, and what scatters from stroke to stroke and run to run."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt
from scipy.optimize import fminbound

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.balances import Balances
from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.balance.timing import LEAST_SAMPLES, MATERIAL, NAMED, Mask, Timing, shared, timing
from stochfric_mb.discovery.driven_joint.decision.selection import Selected, Selector
from stochfric_mb.discovery.driven_joint.decision.signs import sign_notes
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit, fit, prior_weight
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.fit.wave_scan import with_phases
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.discovery.driven_joint.scatter.run_scatter import crps_of, run_scatter
from stochfric_mb.discovery.driven_joint.scatter.stroke_coefficients import dependence
from stochfric_mb.discovery.driven_joint.scatter.stroke_scatter import stroke_scatter
from stochfric_mb.discovery.driven_joint.simulation.augmented import stated_scatter
from stochfric_mb.discovery.driven_joint.simulation.scores import closed_share, noise_floor, rms, score
from stochfric_mb.discovery.inference.noise import independent_count
from stochfric_mb.discovery.result import Gap
from stochfric_mb.effects import kind_with_signature
from stochfric_mb.effects.traits import LATE
from stochfric_mb.mechanisms import PrismaticJoint
from stochfric_mb.numerics.robust import deviation

Array = npt.NDArray[np.float64]
Progress = Callable[[str], None]
HELD = 4
"""Delays from none to that of sampling and holding that are tried."""
HELD_TOLERANCE = 0.02
"""Error of a delay of sampling and holding, over the longest of them [-]."""


@dataclasses.dataclass(frozen=True)
class _Asked:
    """A place, and how it is seen."""

    source: Balances
    name: str
    tell: Progress
    timing: Timing | None
    selectors: dict[float, Selector] = dataclasses.field(default_factory=dict[float, Selector])
    """Delay that is compensated [s] -> selection with it: answers share what they begin with."""

    def selector(self, delay: float, start: JointModel, how: str) -> Selector:
        """Return the selection with a delay compensated."""
        if delay not in self.selectors:
            balances, nuisances = self.source.balances(self.name, "fit", delay), self.source.nuisances(self.name)
            self.selectors[delay] = Selector(balances, nuisances, start, lambda text: self.say(text + how))
        return self.selectors[delay]

    def say(self, text: str) -> None:
        """Say what is being done at the place."""
        self.tell(f"{self.name}: {text}" if self.name else text)


def place_outcome(source: Balances, tell: Progress, name: str, notes: list[str], *, timed: bool = True) -> PlaceOutcome:
    """Return the outcome at a place.

    Args:
        source: balances of the dataset.
        tell: called with what is being done.
        name: the place.
        notes: what the reader should know is added to these.
        timed: whether a delay is looked for.
    """
    balances = source.balances(name, "fit", source.stated_delay)
    notes += sign_notes(source.dataset, name, balances)
    late = _timing(source, tell, name, balances) if timed else None
    return _answered(_Asked(source, name, tell, late), frozenset())


def _answered(asked: _Asked, without: frozenset[str]) -> PlaceOutcome:
    """Return the outcome at a place, without some kinds and numbers."""
    source, name, base = asked.source, asked.name, asked.source.stated_delay
    timing = None if kind_with_signature(LATE) in without else asked.timing
    dataset, scenario, nuisances = source.dataset, source.dataset.scenario, source.nuisances(name)
    stated = source.stated(name)
    undelayed = None
    shortest = LEAST_SAMPLES * dataset.fit[0].sample_interval
    if timing is not None and abs(timing.seconds) <= shortest:  # how signals are sampled and held
        base, timing = base + timing.seconds, None
    fit_balances = source.balances(name, "fit", base)
    plain = asked.selector(base, stated, "")
    selected = plain.run(without)
    if timing is not None:
        balances = source.balances(name, "fit", base + timing.seconds)
        late = asked.selector(base + timing.seconds, stated, ", a delay compensated").run(without)
        early = base + np.linspace(0.0, np.copysign(shortest, timing.seconds), HELD)
        narrow = [source.balances(name, "fit", d, timing.half_width) for d in (*early, base + timing.seconds)]
        timing = timing.beside(*_better(selected, late, narrow, nuisances))
        if timing.named:  # the stated model knows nothing of the identified delay
            undelayed, selected, fit_balances = selected.recalibrated.model, late, balances
    if timing is None or not timing.named:
        base, selected = _held(asked, base, selected, without)
        fit_balances = source.balances(name, "fit", base)
    nuisances = [*nuisances, *(n for n in selected.nuisances if all(n.name != known.name for known in nuisances))]
    delay = base + (timing.seconds if timing is not None and timing.named else 0.0)
    test_balances = source.balances(name, "test", delay)
    asked.say("held-out runs")
    scores = {
        label: score(model, test_balances, nuisances, dataset.test, scenario)
        for label, model in _models(stated, selected).items()
    }
    if undelayed is not None:
        early = source.balances(name, "test", base)
        scores["baseline"] = score(stated, early, nuisances, dataset.test, scenario)
        scores["recalibrated"] = score(undelayed, early, nuisances, dataset.test, scenario)
    final = with_phases(selected.final.model, test_balances, selected.nuisances)
    # where something without a name is missing from the mean, strokes differ for that
    random = None if selected.unknown else stroke_scatter(final, fit_balances, nuisances, stated_scatter(scenario, "per_event"))
    noise = floor = noise_floor(final, test_balances, nuisances)
    if random is not None and random.accounted:
        along = np.concatenate([dependence(final, s)[s.sliding] for s in test_balances])
        floor = float(np.hypot(floor, random.sigma * rms(along)))
    kinds = {"tendon": getattr(scenario.mechanism, "tendons", ()), "pair": getattr(scenario.mechanism, "pairs", ())}
    thing = next((kind for kind, names in kinds.items() if name in names), "joint")
    runs = None if selected.unknown else run_scatter(final, fit_balances, nuisances, stated_scatter(scenario, "per_run"))
    forecasts = None
    if runs is not None and runs.accounted:
        models = (stated, runs.believed), (selected.recalibrated.model, runs.believed), (final, runs.foreseen)
        each = [crps_of(m, test_balances, nuisances, noise, sigma) for m, sigma in models]
        how = "the same forecasts of data that the model gives itself; its noise from differences between neighbouring windows"
        unit, crps = fit_balances[0].unit, (score for score, _ in each)
        forecasts = Gap("crps_friction", unit, True, *crps, floor=each[-1][1], floor_from=how)
    return PlaceOutcome(
        place=name,
        selected=selected,
        nuisances=tuple(nuisances),
        stated=stated,
        fit=tuple(fit_balances),
        test=tuple(test_balances),
        scores=scores,
        floor=floor,
        thing=thing,
        random=random,
        runs=runs,
        forecasts=forecasts,
        undelayed=undelayed,
        timing=timing,
        again=lambda more: _answered(asked, without | more),
    )


def _held(asked: _Asked, base: float, selected: Selected, without: frozenset[str]) -> tuple[float, Selected]:
    """Return the delay to compensate and what is selected with it, where sampling and holding show beside what was selected.

    Beside friction alone they may be a small part of what an effect leaves, and yet most of what is left beside the effect.
    Further effects can stand in for them, so that each step of the selection is asked, the first one first.

    Args:
        asked: the place.
        base: delay that is compensated already [s].
        selected: what was selected with that.
        without: kinds and numbers that are left out.
    """
    source, name = asked.source, asked.name
    if not _has_inertia(source):
        return base, selected
    interval = source.dataset.fit[0].sample_interval
    longest, width = LEAST_SAMPLES * interval, round(_half_width(source.balances(name, "fit", base)) / interval)
    see = functools.cache(lambda delay: source.balances(name, "fit", base + delay, width))
    same = shared([see(d) for d in (-longest, 0.0, longest)])
    for step in (*(t.fit for t in selected.effects), selected.final):
        seen = functools.cache(lambda d, s=step: _refitted(s, selected.nuisances, see(d), same))
        found = float(
            np.asarray(fminbound(lambda d, f=seen: f(float(d)).rms, -longest, longest, xtol=HELD_TOLERANCE * longest))
        )
        material = seen(found).rms < min(seen(-longest).rms, (1.0 - MATERIAL) * seen(0.0).rms, seen(longest).rms)
        if material:
            anew = asked.selector(base + found, source.stated(name), ", sampling and holding compensated").run(without)
            better, _ = _better(selected, anew, [see(0.0), see(found)], selected.nuisances)
            return (base + found, anew) if better > NAMED else (base, selected)
    return base, selected


def _has_inertia(source: Balances) -> bool:
    """Return whether a motion could be late: a slow prescribed one has no inertia by which that would show."""
    mechanism = source.dataset.scenario.mechanism
    return not (isinstance(mechanism, PrismaticJoint) and mechanism.mass <= 0.0)


def _timing(source: Balances, tell: Progress, name: str, balances: Sequence[ForceBalance]) -> Timing | None:
    """Return by how much the motion at a place may come late; None: it does not, or nothing could be late."""
    base = source.stated_delay
    if not _has_inertia(source):
        return None
    tell("timing")
    return timing(
        lambda d, w: source.balances(name, "fit", base + d, w),
        source.nuisances(name),
        source.dataset.fit[0].sample_interval,
        _half_width(balances),
    )


def _half_width(balances: Sequence[ForceBalance]) -> float:
    """Return the typical half width of the windows of balances [s]."""
    return float(np.median([s.window.half_width for s in balances]))


def _better(
    plain: Selected, late: Selected, balances: Sequence[Sequence[ForceBalance]], nuisances: Sequence[Nuisance]
) -> tuple[float, bool]:
    """Return the evidence for a delay, and whether it explains more than it leaves, in loud windows and in typical ones.

    The evidence is by how much the record is explained better with it, numbers counted. Of as good an explanation with more
    numbers it need not explain what is left: that is noise.

    Args:
        plain: what was selected without it.
        late: the same with it compensated.
        balances: without and with it, through the window that shows it: friction may need a wider one. The last are with it;
            those before are without, for all that sampling and holding may be late by.
        nuisances: numbers of the mechanism.
    """
    same = shared(balances)
    without = [_refitted(plain.final, plain.nuisances, seen, same) for seen in balances[:-1]]
    before = min(without, key=lambda f: f.rms)
    after = _refitted(late.final, late.nuisances, balances[-1], same)
    n = max(sum(map(independent_count, after.remainders)), 4.0)  # timing shows within strokes, too
    more = len(after.free) + len(late.released) - len(before.free) - len(plain.released) + 1
    gain = float(np.log(before.rms / after.rms))
    alike = abs(gain) < -np.log(1.0 - criteria.MATERIAL)
    if more < 0 and alike:
        gain = max(gain, 0.0)  # effects that leave less by no material part explain no more than the delay, which is simpler
    sizes = rms, lambda rest: deviation(rest, about=0.0)
    shares = [share_by_delay(without[0], after, balances[-1], nuisances, size) for size in sizes]
    evidence = 2.0 * n * gain + before.strain - after.strain - more * np.log(n)
    return float(evidence), (more < 0 and alike) or min(shares) >= criteria.EXPLAINED_BY_DELAY


def _refitted(
    fitted: JointFit, nuisances: Sequence[Nuisance], balances: Sequence[ForceBalance], windows: Sequence[Mask]
) -> JointFit:
    """Return a model of the selection through other windows, some of them; what it released stays free.

    Beliefs weigh as they did in the selection: through narrow windows what is left is mostly the noise of acceleration times
    mass, and a belief that weighs by it gives way to less mass, which is less noise.
    """
    return fit(fitted.model, balances, nuisances, noise=prior_weight(fitted), masks=windows)


def share_by_delay(
    plain: JointFit,
    late: JointFit,
    balances: Sequence[ForceBalance],
    nuisances: Sequence[Nuisance],
    size: Callable[[Array], float] = rms,
) -> float:
    """Return the share of what stands above the noise that a delay, with what was selected beside it, closes [-].

    Args:
        plain: without the delay.
        late: with it.
        balances: with it.
        nuisances: numbers of the mechanism.
        size: size of what is left, in the unit of the balance.
    """
    before, after = (size(np.concatenate(fitted.remainders)) for fitted in (plain, late))
    floor = min(noise_floor(late.model, balances, nuisances), after)
    return closed_share(before, after, floor)


def _models(stated: JointModel, selected: Selected) -> dict[str, JointModel]:
    models = {"baseline": stated, "recalibrated": selected.recalibrated.model}
    models |= {f"with {t.candidate.kind}": t.fit.model for t in selected.effects}
    return models | {"augmented": selected.final.model}
