"""Whether the named model of a place is adequate: a name stands only where its model explains more than it leaves."""

from __future__ import annotations

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.confounding import by_clock, confounded, one_curve
from stochfric_mb.discovery.driven_joint.decision.released import finding
from stochfric_mb.discovery.driven_joint.decision.smooth_dependence import SIGNED
from stochfric_mb.discovery.driven_joint.fit.beliefs import at_end, beliefs
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.discovery.driven_joint.search.candidates import stated_forms
from stochfric_mb.discovery.driven_joint.simulation.scores import closed_share
from stochfric_mb.discovery.inference.free_parameter import MECHANISM
from stochfric_mb.effects import effect_class
from stochfric_mb.effects.contract import OF_MECHANISM


def inadequate(place: PlaceOutcome) -> str:
    """Return why what was selected at a place does not stand; empty if it does, or if nothing was.

    It does not where two effects draw one curve, where it explains no more than it leaves on the held-out runs, where three
    names or more leave more than noise, where a number that is believed has to go as far as beliefs allow for it, where one
    explains nothing beside what they leave, and where more than noise is left and either mechanics gives the form of what leads
    and that leaves a good part, or the typical window errs more with it, or what is left plainly depends on conditions that are
    not its own.
    """
    kinds = ", ".join(place.selected.named)
    if why := " and ".join(drawn_by_two(place)):
        return f"{kinds} explains the record, but {why} answer to conditions that went together: one curve, and not named"
    if not kinds or place.forecasts is not None:
        return ""
    if place.random is not None and place.random.named:
        # strokes drawn anew hide how much it explains of others, but not that it explains nothing
        worse = _gain(place) <= 0.0
        return f"{kinds} explains the fit runs, and nothing of the held-out ones, and is not named" if worse else ""
    why = _lost(place)
    if why:
        return f"{kinds} explains the fit runs, but not the held-out ones ({why}), and is not named"
    checks = (endless, at_bound, _imitated, _of_another_form, _worse_at_most_times, _plainly_left)
    why = next(filter(None, (check(place) for check in checks)), "")
    return f"{kinds} explains much of the record, but {why}, and is not named" if why else ""


def drawn_by_two(place: PlaceOutcome) -> tuple[str, ...]:
    """Return the two effects of a place that answer to conditions which went together; empty: there are none."""
    return one_curve([t.candidate.kind for t in place.selected.effects], confounded(place.fit))


def drawn_by_one(place: PlaceOutcome) -> set[str]:
    """Return what is left out so that one effect draws the curve that two have drawn; empty: none was, or no one effect can.

    It is the later one, where the form of the first is right but for what no model need explain. Of two drifts it is all
    stated forms of both: neither is right, and a course of any shape is asked for in their place.
    """
    couple = drawn_by_two(place)
    if not couple:
        return set()
    later = next(s for s in place.selected.stages if s.accepted and s.trials[0].candidate.kind == couple[1])
    mended = later.before.rms**2 - later.trials[0].fit.rms ** 2
    if mended < criteria.PLAINLY_LEFT * place.selected.recalibrated.rms**2:
        return {couple[1]}
    return {stated_forms(kind) for kind in couple} if all(map(by_clock, couple)) else set()


def _lost(place: PlaceOutcome) -> str:
    """Return what held-out runs say against the selected effects; empty: nothing."""
    before, after = (place.scores[k] for k in ("recalibrated", "augmented"))
    nothing = 1.0 + criteria.CLOSES_NOTHING
    # a controller keeps the motion on its course, where without one starts and contacts decide much: it has the last word
    far = criteria.FAR_AHEAD if before.loop is not None else nothing
    pairs = ((before.forward, after.forward, far, f" {after.forward_unit}"), (before.loop, after.loop, nothing, ""))
    ahead = [(b, a, most, unit) for b, a, most, unit in pairs if a is not None and b is not None]
    lost = [f"simulated, it is off by {a:.3g}{unit} for {b:.3g}{unit}" for b, a, most, unit in ahead if not a < most * b]
    explained = _gain(place)
    if not lost and explained >= criteria.EXPLAINED_HELD_OUT:
        return ""
    return lost[0] if lost else f"it explains {max(100.0 * explained, 0.0):.0f} % of the squared error there"


def _gain(place: PlaceOutcome) -> float:
    """Return the share of the squared error of the balance on held-out runs that the selected effects explain, noise apart.

    Simulations do not say it: where a run starts and which contacts hold decides more of them than friction does.
    """
    before, after = (place.scores[k].sliding for k in ("recalibrated", "augmented"))
    return closed_share(before, after, place.floor)


def at_bound(place: PlaceOutcome) -> str:
    """Return which believed number the model needs at the end of what is believed; empty: none."""
    model, released = place.selected.final.model, {r.name for r in place.selected.released}
    belief = at_end(model, [b for b in beliefs(place.stated, place.nuisances) if b.name not in released])
    if belief is None:
        return ""
    off = belief.off(model)
    return f"needs {belief.name} off by {off:.1f} of its stated standard deviations, as far as a belief gives way"


def endless(place: PlaceOutcome) -> str:
    """Return what many names together leave; empty: they are few, or leave noise.

    They draw what is there as terms of a series would.
    """
    selected = place.selected
    names = len(selected.effects) + len({finding(number.name) for number in selected.released})
    if names < criteria.SERIES or place.leaves_noise:
        return ""
    return f"{names} names together leave {selected.final.rms / place.noise:.1f} times the noise"


def _of_another_form(place: PlaceOutcome) -> str:
    """Return what the leading effect leaves on held-out runs, where mechanics gives its form; empty: little, or no such form.

    Laws of friction are empirical, and real friction departs from them. A mass, a spring, a gap or a factor of the drive has
    one form: what that leaves of the error is not its own, and where it is much, the form is wrong.
    """
    selected = place.selected
    found = [(t.score, effect_class(t.candidate.kind).group == OF_MECHANISM, t.candidate.kind) for t in selected.effects]
    found += [(r.score, r.belief.owner == MECHANISM, finding(r.name)) for r in selected.released]
    _, of_mechanism, kind = max(found)
    explained = _gain(place)
    if not of_mechanism or place.leaves_noise or explained >= criteria.EXPLAINED_BY_MECHANICS:
        return ""
    return f"{kind} leaves {100.0 * (1.0 - explained):.0f} % of the squared error on the held-out runs, and its form is exact"


def _worse_at_most_times(place: PlaceOutcome) -> str:
    """Return by how much the typical window errs more with the selected effects than without; empty: it does not.

    What is right is right at most times. Effects that trade what was explained for what comes in bursts stand for something
    else, however much of the square they take away; within noise there is nothing to trade.
    """
    if place.leaves_noise:
        return ""
    fits = place.selected.recalibrated, place.selected.final
    typical = [float(np.median(np.abs(np.concatenate(f.remainders)))) for f in fits]
    if typical[1] < (1.0 + criteria.MATERIAL) * typical[0]:
        return ""
    return f"the median error rises from {typical[0]:.3g} to {typical[1]:.3g} {place.fit[0].unit} with it"


def _imitated(place: PlaceOutcome) -> str:
    """Return what takes the place of what an effect explains, and explains more; empty: nothing does."""
    axis = place.selected.imitated
    return f"beside a dependence on {axis}, which it leaves, it explains nothing" if axis else ""


def _plainly_left(place: PlaceOutcome) -> str:
    """Return on what that is not its own the error plainly depends which the selected effects leave; empty: on nothing."""
    if place.leaves_noise:
        return ""
    selected = place.selected
    own = {t.candidate.where for t in selected.effects}
    remains = (selected.final.rms / selected.recalibrated.rms) ** 2
    others = [
        (axis, remains * (1.0 - (1.0 - gain) ** 2)) for axis, gain in selected.left if axis.removesuffix(SIGNED) not in own
    ]
    axis, share = max(others, key=lambda o: o[1], default=("", 0.0))
    if share < criteria.PLAINLY_LEFT:
        return ""
    how = f"{selected.final.rms / place.noise:.1f} times the noise is left, {100.0 * share:.0f} % of the squared error"
    return f"{how} depends on {axis}"
