"""One place: timing, effects one by one, errors on held-out runs, and what scatters from stroke to stroke and run to run."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.balances import Balances
from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.discovery.driven_joint.balance.timing import Timing, timing
from stochfric_mb.discovery.driven_joint.decision.selection import Selected, Selector
from stochfric_mb.discovery.driven_joint.decision.signs import sign_notes
from stochfric_mb.discovery.driven_joint.delay import Delayed, DelaySearch, half_width
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.fit.wave_scan import with_phases
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.discovery.driven_joint.scatter.run_scatter import crps_of, run_scatter
from stochfric_mb.discovery.driven_joint.scatter.stroke_coefficients import dependence
from stochfric_mb.discovery.driven_joint.scatter.stroke_scatter import stroke_scatter
from stochfric_mb.discovery.driven_joint.simulation.augmented import stated_scatter
from stochfric_mb.discovery.driven_joint.simulation.scores import noise_floor, rms, score
from stochfric_mb.discovery.result import Gap
from stochfric_mb.effects import kind_with_signature
from stochfric_mb.effects.traits import LATE
from stochfric_mb.mechanisms import PrismaticJoint

Array = npt.NDArray[np.float64]
Progress = Callable[[str], None]


@dataclasses.dataclass(frozen=True)
class _Asked:
    """A place, and how it is seen."""

    source: Balances
    name: str
    tell: Progress
    timed: bool
    """Whether a delay is looked for."""
    timing: Timing | None
    """Delay that shows beside friction."""
    selectors: dict[float, Selector] = dataclasses.field(default_factory=dict[float, Selector])
    """Delay that is compensated [s] -> selection with it: answers share what they begin with."""

    def selector(self, delay: float, start: JointModel, how: str) -> Selector:
        """Return the selection with a delay compensated."""
        if delay not in self.selectors:
            balances, nuisances = self.source.balances(self.name, "fit", delay), self.source.nuisances(self.name)
            self.selectors[delay] = Selector(balances, nuisances, start, lambda text: self.say(text + how))
        return self.selectors[delay]

    def delayed(self, start: JointModel, without: frozenset[str]) -> Delayed:
        """Return what is selected without some kinds and numbers, and with which delay."""
        source, known = self.source, self.source.stated_delay
        if not self.timed or kind_with_signature(LATE) in without:
            selected = self.selector(known, start, "").run(without)
            return Delayed(known, known, None, selected, selected)
        search = DelaySearch(
            lambda delay, width: source.balances(self.name, "fit", delay, width),
            lambda delay: self.selector(delay, start, "" if delay == known else ", a delay compensated").run(without),
            source.nuisances(self.name),
            source.dataset.fit[0].sample_interval,
        )
        return search.run(known, self.timing)

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
    timed = timed and _has_inertia(source)
    late = _timing(source, tell, name, balances) if timed else None
    return _answered(_Asked(source, name, tell, timed, late), frozenset())


def _answered(asked: _Asked, without: frozenset[str]) -> PlaceOutcome:
    """Return the outcome at a place, without some kinds and numbers."""
    source, name = asked.source, asked.name
    dataset, scenario, nuisances = source.dataset, source.dataset.scenario, source.nuisances(name)
    stated = source.stated(name)
    found = asked.delayed(stated, without)
    selected, timing, undelayed = found.selected, found.timing, None
    if timing is not None and timing.named:  # the stated model knows nothing of the identified delay
        undelayed = found.undelayed.recalibrated.model
    fit_balances, test_balances = (source.balances(name, role, found.delay) for role in ("fit", "test"))
    nuisances = [*nuisances, *(n for n in selected.nuisances if all(n.name != known.name for known in nuisances))]
    asked.say("held-out runs")
    scores = {
        label: score(model, test_balances, nuisances, dataset.test, scenario)
        for label, model in _models(stated, selected).items()
    }
    if undelayed is not None:
        early = source.balances(name, "test", found.held)
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


def _timing(source: Balances, tell: Progress, name: str, balances: Sequence[ForceBalance]) -> Timing | None:
    """Return by how much the motion at a place may come late beside friction; None: it does not."""
    tell("timing")
    return timing(
        lambda d, w: source.balances(name, "fit", source.stated_delay + d, w),
        source.nuisances(name),
        source.dataset.fit[0].sample_interval,
        half_width(balances),
    )


def _has_inertia(source: Balances) -> bool:
    """Return whether a motion could be late: a slow prescribed one has no inertia by which that would show."""
    mechanism = source.dataset.scenario.mechanism
    return not (isinstance(mechanism, PrismaticJoint) and mechanism.mass <= 0.0)


def _models(stated: JointModel, selected: Selected) -> dict[str, JointModel]:
    models = {"baseline": stated, "recalibrated": selected.recalibrated.model}
    models |= {f"with {t.candidate.kind}": t.fit.model for t in selected.effects}
    return models | {"augmented": selected.final.model}
