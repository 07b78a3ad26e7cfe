"""The friction coefficient of each stroke: what a model leaves of it, as a change of mu_k with its variance."""

from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.discovery.driven_joint.fit.fitting import PER_STROKE
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.simulation.scores import APART
from stochfric_mb.numerics.stretches import stretches

Array = npt.NDArray[np.float64]

STEP = 1.0e-3
"""Relative change of mu_k by which friction's dependence on it is taken."""


@dataclasses.dataclass(frozen=True)
class Stroke:
    """One stretch of sliding one way."""

    forward: bool
    """Whether it goes along +q."""
    delta: float
    """Its mu_k less the model's [-]."""
    at: tuple[int, int]
    """Its first window, and the one after its last."""
    slope: float
    """Mean square of the drive's change with mu_k [N^2 or N^2 m^2]."""
    inside: float
    """Mean square of what is left with a mu_k of its own [N^2 or N^2 m^2]."""
    half: float
    """Square of half the difference of its two halves' mu_k: their mean's variance, were they independent [-]."""

    @property
    def windows(self) -> int:
        """Its windows."""
        return self.at[1] - self.at[0]

    @property
    def square(self) -> float:
        """Mean square of what the model leaves of it [N^2 or N^2 m^2]."""
        return self.inside + self.delta**2 * self.slope

    @property
    def weight(self) -> float:
        """Inverse of the variance of its mu_k for what is left of unit variance [N^2 or N^2 m^2]."""
        return min(self.windows / APART, float(PER_STROKE)) * self.slope


def strokes_of(rest: Array, along: Array, balance: ForceBalance, shortest: int) -> list[Stroke]:
    """Return the strokes of a run that last for ``shortest`` windows at least.

    Args:
        rest: what a model leaves of the run, shape (n_centres,).
        along: change of the drive with mu_k, shape (n_centres,).
        balance: the run.
        shortest: least number of windows.
    """
    strokes: list[Stroke] = []
    forward = balance.velocity[balance.window.centres] > 0.0
    for start, end in stretches(balance.sliding):
        r, f = rest[start:end], along[start:end]
        size = float(f @ f)
        if end - start < shortest or size <= 0.0:
            continue
        delta, half = float(f @ r) / size, len(r) // 2
        first, second = (float(f[p] @ r[p]) / max(float(f[p] @ f[p]), 1.0e-300) for p in (slice(half), slice(half, None)))
        inside = float(np.mean((r - delta * f) ** 2))
        differ = 0.25 * (first - second) ** 2
        strokes.append(Stroke(bool(forward[start]), delta, (start, end), size / (end - start), inside, differ))
    return strokes


def variances(strokes: list[Stroke]) -> Array:
    """Return the variance of each stroke's mu_k, by what is left within strokes [-], shape (n,).

    Noise as slow as a stroke shows in how its halves differ.
    """
    inside = float(np.mean([s.inside for s in strokes]))
    return np.maximum(inside / np.array([s.weight for s in strokes]), float(np.mean([s.half for s in strokes])))


def dependence(model: JointModel, balance: ForceBalance) -> Array:
    """Return the change of the drive that the motion needs with mu_k at the centres [N or N m], shape (n_centres,)."""
    law = dataclasses.replace(
        model.law, mu_k=model.law.mu_k * (1.0 + STEP), mu_s=max(model.law.mu_s, model.law.mu_k * (1.0 + STEP))
    )
    moved = dataclasses.replace(model, law=law)
    return (model.remainder(balance, ()) - moved.remainder(balance, ())) / (STEP * model.law.mu_k)
