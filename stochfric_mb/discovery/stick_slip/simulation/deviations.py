"""Standard deviations of numbers that were fitted to forecasts, by differences as wide as what the forecasts leave open."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from stochfric_mb.discovery.inference.free_parameter import LAW, MECHANISM, Steps
from stochfric_mb.discovery.inference.threads import in_threads
from stochfric_mb.discovery.stick_slip.records.record import CORRECTED, Array
from stochfric_mb.discovery.stick_slip.simulation.forecast import Windows
from stochfric_mb.discovery.stick_slip.simulation.refit import (
    DIFFERENCE,
    MOST_WINDOWS,
    TELLING,
    TYPICAL,
    WIDEST,
    Fit,
    Further,
    Misfit,
    left_open,
)  # fmt: skip

LEAST_STEP = 1.0e-6
"""Shortest step of the slopes that intervals come from, over a natural step of each number; `WIDEST` is the widest [-]."""
ALIKE = 3.0
"""Factor within which two slopes, or a change of the errors and `TELLING`, count as alike [-]."""
MOST_STEPS = 10
"""Steps that are tried for such a slope."""
SHARE = 0.01
"""Share by which all forces are larger where it is asked which numbers of an effect go along [-]."""


def with_deviations(
    fit: Fit,
    windows: Sequence[Windows],
    uncertainty: Mapping[str, float],
    *,
    most: int = MOST_WINDOWS,
    further: Further | None = None,
) -> Fit:
    """Return the fit with standard deviations from differences as wide as what the forecasts leave open.

    A fit's own differences are small. Where errors jump as a number is changed, a slip missed or a gap's edge passed, or do
    not change at all until it is changed by more, their slopes say nothing of how far off the number may be. They are taken
    along the principal axes of what the forecasts tell: of numbers that make up for each other, as a spring's stiffness and its
    cube do, wide differences of each would be bent otherwise, and that would pass for information on both.

    Args:
        fit: a fit of all free parameters.
        windows: the forecasts it was made to.
        uncertainty: relative standard deviations of the stated numbers.
        most: forecasts used in each run.
        further: errors of what else the runs show, as in the fit.
    """
    misfit = Misfit(fit.model, windows, uncertainty, None, most)
    misfit.beside(further, fit.model)
    here = misfit.errors(np.zeros(len(misfit.free)))
    weight = (1.0 + (here / TYPICAL) ** 2) ** -0.75  # of the loss: SciPy scales its Jacobian so
    spread = misfit.spread(2.0 * fit.cost)

    def change(at: Array) -> Array:
        return weight * (misfit.errors(at) - here) / np.sqrt(spread)

    axes, firsts = _principal(change, misfit.steps.low, misfit.steps.high)

    def slope(k: int) -> Array:
        axis = axes[:, k]
        rooms = min(WIDEST, _room(-axis, misfit.steps)), min(WIDEST, _room(axis, misfit.steps))
        return _slope(lambda h: change(h * axis), firsts[k], rooms)

    slopes = np.stack(in_threads(slope, range(len(misfit.free))), axis=1) @ axes.T
    steps, rows = misfit.steps, len(here) - len(misfit.free)
    data = _blind_to_scale(slopes[:rows], misfit)
    believed = misfit.priors @ np.diag(steps.scale / steps.prior)
    data_share, posterior = _with_priors(data, steps.scale / steps.prior)
    return dataclasses.replace(
        fit, free=misfit.free, values=steps.start, deviations=steps.scale * left_open(np.r_[data, believed], 1.0),
        data_share=data_share, posterior=steps.scale * posterior,
    )  # fmt: skip


def _principal(change: Callable[[Array], Array], low: Array, high: Array) -> tuple[Array, Array]:
    """Return the principal axes of what small differences tell, shape (p, p), and a standard deviation along each, shape (p,).

    A number at its bound has an axis of its own.

    Args:
        change: from numbers to the change of the errors, in their standard deviations.
        low: lower bounds, shape (p,).
        high: upper bounds, shape (p,).
    """
    units = np.eye(len(low))
    slopes, size = np.zeros((0, 0)), np.full(len(low), np.inf)
    for _ in range(2):  # the second time as wide as a number has to be changed to tell
        wide = np.clip(TELLING / size, DIFFERENCE, 1.0)
        steps = np.where(high >= wide, wide, np.where(low <= -wide, -wide, np.where(high >= -low, high, low)))
        steps = np.where(steps == 0.0, DIFFERENCE, steps)
        slopes = np.stack(in_threads(lambda j, h=steps: change(h[j] * units[j]) / h[j], range(len(low))), axis=1)
        size = np.maximum(np.linalg.norm(slopes, axis=0), TELLING / WIDEST)
    inside = (low <= -DIFFERENCE) & (high >= DIFFERENCE)
    information = slopes.T @ slopes
    axes = units.copy()
    if inside.any():
        axes[np.ix_(inside, inside)] = np.linalg.eigh(information[np.ix_(inside, inside)])[1]
    told = np.sum((slopes @ axes) ** 2, axis=0)
    return axes, 1.0 / np.sqrt(np.maximum(told, WIDEST**-2.0))


def _room(axis: Array, steps: Steps) -> float:
    """Return how far an axis may be followed between the bounds [natural steps]."""
    ends = np.where(axis > 0.0, steps.high, steps.low)
    moved = np.abs(axis) > 1.0e-12
    return float(np.min(np.abs(ends[moved]) / np.abs(axis[moved])))


def _blind_to_scale(slopes: Array, misfit: Misfit) -> Array:
    """Return slopes that tell nothing of the scale of all forces, shape (n, p): no motion shows it, and differences err.

    A rig with stiffness, mass, damping and friction larger by one share moves as it did, where the numbers of effects that are
    forces or coefficients are as well. Of each number as large a share of its slope is taken away as brings that about.

    Args:
        slopes: of the forecasts, in their standard deviations over natural steps, shape (n, p).
        misfit: the forecasts' errors.
    """
    free, steps = misfit.free, misfit.steps
    if not {*CORRECTED, "mu_s", "mu_k"} <= {k.name for k in free if k.owner in (LAW, MECHANISM)}:
        return slopes  # one that is exact says how large all are
    here = misfit.errors(np.zeros(len(free)))[: len(slopes)]

    def away(along: Array) -> float:
        return float(np.linalg.norm(misfit.errors(SHARE * along)[: len(slopes)] - here))

    rig = np.array([k.owner in (LAW, MECHANISM) for k in free])
    sizes = (np.array([k.name in CORRECTED and k.owner == MECHANISM for k in free]) + steps.start) / steps.scale
    along = np.where(rig, sizes, 0.0)
    least = away(along)
    asked = ~rig & (sizes != 0.0) & np.array([not k.run for k in free])  # a phase of a run is no force
    for j in np.flatnonzero(asked):  # which numbers have to go along, the motion says
        with_ = along + np.where(np.arange(len(free)) == j, sizes, 0.0)
        if (left := away(with_)) < least:
            along, least = with_, left
    weight = np.sum(slopes**2, axis=0) * along
    total = float(weight @ along)
    return np.asarray(slopes - np.outer(slopes @ along, weight / max(total, 1.0e-300)), dtype=np.float64)


def _with_priors(slopes: Array, prior: Array) -> tuple[Array, Array]:
    """Return what data tell of each number, over all that is known of it, and its standard deviation [natural steps].

    Args:
        slopes: of the data, in their standard deviations over natural steps, shape (n, p).
        prior: natural steps over prior standard deviations, 0 where there is no prior, shape (p,).
    """
    information = slopes.T @ slopes + np.diag(prior**2)
    least = np.diag(np.full(len(prior), WIDEST**-2.0))  # what nothing tells is left open, not singular
    variance = np.array(np.diag(np.linalg.inv(information + least)), dtype=np.float64)
    data_share = 1.0 - np.clip(variance * np.maximum(prior**2, WIDEST**-2.0), 0.0, 1.0)
    return data_share, np.sqrt(variance)


def _slope(change: Callable[[float], Array], first: float, rooms: tuple[float, float]) -> Array:
    """Return the slope of errors along an axis, in standard deviations, by differences at which their change tells.

    Both sides go equally far where both tell: what bends the same way on either is no slope.

    Args:
        change: change of the errors over a step, shape (n,).
        first: step to begin with.
        rooms: widest steps down and up.
    """
    down, up = (
        _wide(lambda h, sign=sign: change(sign * h), first, most) for sign, most in zip((-1.0, 1.0), rooms, strict=True)
    )
    if min(down.size, up.size) == 0.0:  # a bound, or nothing to be seen there
        return up.slope - down.slope
    if max(down.size, up.size) > ALIKE * min(down.size, up.size):
        # a jump on one side says nothing of the other
        return -down.slope if down.size < up.size else up.slope
    step = min(down.step, up.step)
    return _over(0.5 * (change(step) - change(-step)), step)


@dataclasses.dataclass(frozen=True)
class _Wide:
    """A one-sided difference."""

    step: float
    """Step at which it was taken, >= 0."""
    slope: Array
    """Change over it, shape (n,)."""

    @property
    def size(self) -> float:
        """How much a step changes."""
        return float(np.linalg.norm(self.slope))


def _wide(change: Callable[[float], Array], first: float, most: float) -> _Wide:
    """Return the slope to one side over the step at which the change is about `TELLING`, or over the widest.

    Args:
        change: change of the errors over a step, shape (n,).
        first: step to begin with.
        most: widest step.
    """
    if most <= LEAST_STEP:
        return _Wide(0.0, np.zeros_like(change(0.0)))
    below, above = 0.0, most
    step = float(np.clip(first, LEAST_STEP, most))
    moved = change(step)
    for _ in range(MOST_STEPS):
        size = float(np.linalg.norm(moved)) / TELLING
        if 1.0 / ALIKE <= size <= ALIKE or (size < 1.0 and step >= most):
            break
        if size < 1.0:
            below = step
        else:
            above = step
        guess = step / size if size > 0.0 else most
        if below < guess < above or (guess >= most and above == most):
            step = min(guess, most)
        else:
            step = float(np.sqrt(max(below, LEAST_STEP) * above))
        moved = change(step)
    return _Wide(step, _over(moved, step))


def _over(moved: Array, step: float) -> Array:
    """Return a change over its step; where errors jump a number can be off no farther than that, but no nearer is it known."""
    size = float(np.linalg.norm(moved)) / TELLING
    return moved / (step * (size if size > ALIKE else 1.0))
