"""Whether an effect's strength differs from zero: by the likelihood ratio of a fit without it, where its interval says no.

The interval of a strength that trades off against another number, or has a phase, is not that of a linear fit: it may hold
zero although a fit at zero is far worse. Its end towards zero is then where the signed root of the likelihood ratio, taken as
straight between zero and the fitted value, is 1.96. Reference: O. E. Barndorff-Nielsen, D. R. Cox, Inference and Asymptotics,
Chapman and Hall 1994, section 3.2.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from stochfric_mb.discovery.stick_slip.simulation.forecast_skill import deterministic
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.refit import Fit

STRENGTHS = (
    "amplitude", "coefficient", "distance", "cubic", "gap", "mass_ratio", "rate", "exponent", "asymmetry", "time_constant",
    "quadratic", "change",
)  # fmt: skip
"""Parameters that measure how strong an effect is."""
NORMAL = 1.96
"""Standard deviations of a 95 % interval [-]."""


def undecided(fit: Fit, model: Model) -> list[str]:
    """Return the kinds of which every fitted strength's interval holds zero; of several effects of a kind the first one counts.

    Args:
        fit: the fit of the model's effects that are not random.
        model: the model.
    """
    owners = deterministic(model).effects
    first = {e.kind: i for i, e in reversed(list(enumerate(owners)))}
    decided: dict[str, bool] = {}
    for i in _strengths(fit):
        kind = owners[fit.free[i].owner].kind
        if fit.free[i].owner == first[kind]:
            decided[kind] = decided.get(kind, False) or abs(fit.values[i]) > NORMAL * fit.deviations[i]
    return [kind for kind, yes in decided.items() if not yes]


def decided_by_ratio(fit: Fit, model: Model, kind: str, ratio: float) -> Fit:
    """Return the fit with intervals of a kind's strengths that end where the likelihood ratio says.

    Args:
        fit: the fit.
        model: its model.
        kind: an effect of it.
        ratio: twice the log likelihood ratio to a fit without the effect [-].
    """
    owners = deterministic(model).effects
    deviations = fit.deviations.copy()
    for i in _strengths(fit):
        if owners[fit.free[i].owner].kind == kind:
            deviations[i] = min(deviations[i], abs(fit.values[i]) / np.sqrt(ratio))
    return dataclasses.replace(fit, deviations=deviations)


def _strengths(fit: Fit) -> list[int]:
    return [i for i, k in enumerate(fit.free) if k.owner >= 0 and not k.run and k.name in STRENGTHS]
