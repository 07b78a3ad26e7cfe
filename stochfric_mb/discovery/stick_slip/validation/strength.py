"""Whether an effect's strength differs from zero: by the likelihood ratio of a fit without it, where its interval says no.

The interval of a strength that trades off against another number, or has a phase, is not that of a linear fit: it may hold
zero although a fit at zero is far worse. Its end towards zero is then where fits with the strength held there are worse by
chi^2 of one degree. Reference: O. E. Barndorff-Nielsen, D. R. Cox, Inference and Asymptotics, Chapman and Hall 1994, section
3.4.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

from stochfric_mb.discovery.stick_slip.simulation.model import STRENGTHS, Model
from stochfric_mb.discovery.stick_slip.simulation.refit import Fit

NORMAL = 1.96
"""Standard deviations of a 95 % interval [-]."""
PROFILE_STEPS, CLOSE = 6, 1.5
"""Fits that are made at most to find the end of an interval, and the root over `NORMAL` from which on it is straight [-]."""


def undecided(fit: Fit, model: Model) -> list[str]:
    """Return the kinds of which every fitted strength's interval holds zero; of several effects of a kind the first one counts.

    Args:
        fit: the fit of the model's effects that are not random.
        model: the model.
    """
    owners = model.mean.effects
    first = {e.kind: i for i, e in reversed(list(enumerate(owners)))}
    decided: dict[str, bool] = {}
    for i in _strengths(fit):
        kind = owners[fit.free[i].owner].kind
        if fit.free[i].owner == first[kind]:
            decided[kind] = decided.get(kind, False) or abs(fit.values[i]) > NORMAL * fit.deviations[i]
    return [kind for kind, yes in decided.items() if not yes]


def decided_by_ratio(fit: Fit, model: Model, kind: str, ratio: float, held_at: Callable[[float], float]) -> Fit:
    """Return the fit with the interval of a kind's strength that ends where the likelihood ratio says.

    Where it has several, the ratio says that they are not all zero, and nothing of each: their intervals stay.

    Args:
        fit: the fit.
        model: its model.
        kind: an effect of it.
        ratio: twice the log likelihood ratio to a fit without the effect [-].
        held_at: from a strength to the same of a fit in which it is held there.
    """
    owners = model.mean.effects
    strengths = [i for i in _strengths(fit) if owners[fit.free[i].owner].kind == kind]
    if len(strengths) != 1:
        return fit
    (i,) = strengths
    value = float(fit.values[i])
    # share of the strength and signed root there: `NORMAL` lies between those of the fit and of zero, and straight between them
    near, far = (1.0, 0.0), (0.0, float(np.sqrt(ratio)))

    def between(root: float) -> float:
        return near[0] + (far[0] - near[0]) * (root - near[1]) / (far[1] - near[1])

    for step in range(PROFILE_STEPS):
        if far[1] < CLOSE * NORMAL:
            break
        # a little beyond; every other time in the middle, where the root is not straight
        part = min(between(0.5 * (1.0 + CLOSE) * NORMAL), 1.0 if step % 2 == 0 else 0.5 * (near[0] + far[0]))
        root = float(np.sqrt(max(held_at(part * value), 0.0)))
        if root < NORMAL:
            near = (part, root)
        else:
            far = (part, root)
    deviations = fit.deviations.copy()
    deviations[i] = min(deviations[i], abs(value) * (1.0 - between(NORMAL)) / NORMAL)
    return dataclasses.replace(fit, deviations=deviations)


def _strengths(fit: Fit) -> list[int]:
    return [i for i, k in enumerate(fit.free) if k.owner >= 0 and not k.run and k.name in STRENGTHS]
