"""Intervals of numbers that trade off against others: how far one can be moved before the best fit of the rest is worse.

The curvature at the best fit says little where a wave is longer than the stroke: amplitude, wavelength and phase then change
friction alike, though friction without a wave fits far worse. Here the interval ends where the deviance n ln(S/S_0) of the
refitted model has risen by `CONFIDENCE`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit, fit
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel

CONFIDENCE = 3.84
"""Rise of the deviance at the ends of a 95 % interval."""
FIRST = 0.05
"""First step outwards [values]."""
GROWTH = 1.6
"""Ratio of successive steps."""
STEPS = 12
"""Most steps, to some twenty times the value."""
HALVINGS = 6
"""Bisections of the step in which the limit is passed."""

Rise = Callable[[float, JointModel], tuple[float, JointModel]]
"""Value of the number and where to start -> rise of the deviance, and the model fitted to the rest."""


def profile(
    fitted: JointFit,
    owner: int,
    name: str,
    balances: Sequence[ForceBalance],
    nuisances: Sequence[Nuisance],
    noise: float,
    low: float,
    high: float,
) -> tuple[float, float]:
    """Return the ends of the 95 % interval of a number of an effect; where nothing limits it, the last value tried.

    Args:
        fitted: the best fit.
        owner: number of the effect.
        name: its parameter.
        balances: what it was fitted to.
        nuisances: numbers of the mechanism.
        noise: as of `fit`.
        low: smallest value that is tried.
        high: largest one.
    """

    def rise(value: float, start: JointModel) -> tuple[float, JointModel]:
        effects = list(start.effects)
        effects[owner] = dataclasses.replace(effects[owner], **{name: value})
        moved = dataclasses.replace(start, effects=tuple(effects))
        seen = fit(moved, balances, nuisances, noise=noise, fixed=((owner, name),))
        return 2.0 * fitted.independent * float(np.log(seen.rms / fitted.rms)), seen.model

    value = float(getattr(fitted.model.effects[owner], name))
    step = FIRST * abs(value)
    return _end(rise, value, fitted.model, -step, low), _end(rise, value, fitted.model, step, high)


def _end(rise: Rise, value: float, model: JointModel, step: float, bound: float) -> float:
    """Return where the deviance has risen by `CONFIDENCE` on one side."""
    for _ in range(STEPS):
        trial = value + step
        if (trial - bound) * step >= 0.0:
            trial = bound
        more, there = rise(trial, model)
        if more > CONFIDENCE:
            return _between(rise, value, trial, model)
        if trial == bound:
            return bound
        value, model, step = trial, there, GROWTH * step
    return value


def _between(rise: Rise, inside: float, outside: float, model: JointModel) -> float:
    for _ in range(HALVINGS):
        middle = 0.5 * (inside + outside)
        inside, outside = (inside, middle) if rise(middle, model)[0] > CONFIDENCE else (middle, outside)
    return 0.5 * (inside + outside)
