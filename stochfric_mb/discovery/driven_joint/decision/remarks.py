"""What the reader should know beside what is found: simulations, what cannot be told apart, what is left."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.force_balance import PAYLOADS
from stochfric_mb.discovery.driven_joint.decision.estimates import against_priors, mechanism_estimates
from stochfric_mb.discovery.driven_joint.decision.findings import in_place
from stochfric_mb.discovery.driven_joint.decision.smooth_dependence import SIGNED
from stochfric_mb.discovery.driven_joint.fit.evidence import scatter, settings_of
from stochfric_mb.discovery.driven_joint.fit.gains import hidden_share
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.discovery.driven_joint.simulation.scores import AHEAD
from stochfric_mb.effects import words_of
from stochfric_mb.measurement.scales import load_in_kilograms

IMITATED = 0.99
"""Part of an effect's change of friction that other numbers imitate, from which it cannot be identified [-]."""
PLAIN = 14.0
"""Fall of the deviance from which a scatter between settings is spoken of."""


def forward_notes(place: PlaceOutcome) -> list[str]:
    """Return what forward simulation says."""
    before, after = (place.scores[k] for k in ("recalibrated", "augmented"))
    if any(e.moves_load for e in place.selected.final.model.effects):
        return [
            "the load moves by itself in the augmented model: simulations and exports of one body do not carry that, and "
            "held-out runs are scored by inverse dynamics alone; give an engine a second body with these numbers"
        ]
    if before.forward is None or after.forward is None:
        return []
    how = "with the controller in the loop" if after.loop is not None else f"{AHEAD:g} s at a time from the measured state"
    return [
        f"simulated in MuJoCo, {how}, positions of the held-out runs are off by {before.forward:.3g} {before.forward_unit} "
        f"recalibrated, by {after.forward:.3g} augmented (rms)"
    ]


def remarks(places: Sequence[PlaceOutcome]) -> list[str]:
    """Return what cannot be told apart at the places, and what scatters or is left there."""
    said: list[str] = []
    if any(number.name in PAYLOADS.values() for place in places for number in place.selected.released):
        said.append(
            "a payload is that of points in the last body of the model, at its centre of mass and at its far end: one that "
            "sits elsewhere weighs otherwise"
        )
    for place in places:
        for kind in dict.fromkeys(_imitated(place)):  # several forms of a kind are one name
            names = ", ".join(n.name for n in place.nuisances)
            said.append(
                f"{words_of(kind)} cannot be distinguished from a correction of {names} here{in_place(place)}: any of it is "
                "included in these numbers"
            )
        said += [
            f"{name}{in_place(place)} is {abs(by):.2g} stated standard deviations off from what is stated"
            for name, by in against_priors(place)[1].items()
        ]
        said += _between_settings(place)
        if place.random is not None and place.random.low > 0.0 and not place.random.accounted:
            how = "drifts at random" if place.random.wanders else "scatters"
            share, strokes = 100.0 * place.random.share, place.random.strokes
            why = "; it goes on across reversals, as slow noise of the drive does" if place.random.slow_noise else ""
            said.append(f"friction {how} by {share:.1f} % from stroke to stroke ({strokes} strokes){in_place(place)}{why}")
        if place.random is not None and place.random.named and not place.random.all_of_it:
            left = place.random.inside / place.random.floor
            said.append(f"{left:.1f} times the noise is left within strokes{in_place(place)}: more is missing")
        if place.selected.effects and place.selected.unknown:
            said.append(f"what remains depends on {place.selected.unknown}{in_place(place)}; no known effect explains it")
        said += _more_missing(place) + _in_kilograms(place) + _far_off(place)
    return said


def _far_off(place: PlaceOutcome) -> list[str]:
    """Return that the stated model errs by many times the friction, if it does: a unit or a column is wrong more often."""
    error, friction = place.scores["baseline"].sliding, place.stated.law.mu_k * place.stated.load
    if not error > criteria.FAR_OFF * friction > 0.0:
        return []
    return [
        f"the stated model errs by {error:.3g} {place.fit[0].unit}{in_place(place)} on the held-out runs, "
        f"{error / friction:.0f} times the friction: check units, scales and columns (of a pressure, too) first"
    ]


def _in_kilograms(place: PlaceOutcome) -> list[str]:
    """Return that the load of a slide is probably a mass in kg, where the coefficient of friction says so."""
    shown = mechanism_estimates(place).get("mu_k")
    if shown is None or place.place or place.fit[0].unit != "N":
        return []
    return list(filter(None, [load_in_kilograms((shown.value,), (place.stated.law.mu_k,), place.stated.load)]))


def _more_missing(place: PlaceOutcome) -> list[str]:
    """Return a remark if what is named, effects and scatter, leaves more than noise."""
    if not place.selected.effects or place.drawn or place.leaves_noise:
        return []
    axes = ", ".join(axis.removesuffix(SIGNED) for axis, _ in place.selected.left)
    times = place.selected.final.rms / place.noise
    return [
        f"{times:.1f} times the noise is left{in_place(place)} with what is named: more is missing"
        + (f"; it depends on {axes}" if axes else "")
    ]


def _between_settings(place: PlaceOutcome) -> list[str]:
    """Return a remark if what is left stays the same in a run and direction."""
    fit, settings = place.selected.final, settings_of(place.fit)
    rest, n = np.concatenate(fit.remainders), fit.n
    seen, none = scatter(rest, settings, n), scatter(rest, settings, n, ratios=np.zeros(1))
    if none.deviance - seen.deviance < PLAIN or (place.runs is not None and place.runs.accounted):
        return []
    return [
        f"{seen.between:.2g} {place.fit[0].unit} of what is left{in_place(place)} stay the same in all strokes of a run in one "
        f"direction, and differ between these {len(np.unique(settings))} settings: a zero or a law, the data do not say which"
    ]


def _imitated(place: PlaceOutcome) -> list[str]:
    """Return the one-parameter effects that corrections of the mechanism imitate, but for names and what could be instead."""
    fit = place.selected.final
    told = {t.candidate.kind for t in place.selected.effects}.union(*place.selected.equivalents)
    stage = place.selected.stages[0]
    tried = [*(t.candidate for t in stage.trials), *(c for c, _ in stage.faint)]
    return [
        c.kind
        for c in tried
        if c.parameters == 1 and c.kind not in told and place.nuisances and hidden_share(c.starts[0], place.fit, fit) > IMITATED
    ]
