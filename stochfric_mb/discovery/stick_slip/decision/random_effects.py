"""Random friction and random kicks: looked for last, in what all other effects leave."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.inference.false_alarms import detected, likely
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.decision.decision import Finding
from stochfric_mb.discovery.stick_slip.records.pool import Pool, less_medians
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.screening.null_draws import drawn
from stochfric_mb.discovery.stick_slip.screening.regression import Baseline
from stochfric_mb.discovery.stick_slip.screening.switching import Switching
from stochfric_mb.discovery.stick_slip.screening.variance_components import Randomness, randomness
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.effects import kind_with_signature
from stochfric_mb.effects.traits import DRAWN_ANEW, KICKS, WANDER
from stochfric_mb.numerics.robust import deviation

UNSEEN = 1.5
"""Kicks from both sides, over those that are seen [-]."""
PULSE, KNOTS_APART = 0.051, 0.255
"""Duration of a kick and distance of the knots of a rough friction, as angles of the natural oscillation [rad]: too short for
the motion to show."""


def stray(pool: Pool, residuals: Array) -> np.ndarray:
    """Return which slips that count are far from all others of their run, in onset force or in the slip, however little it is.

    Args:
        pool: the slips.
        residuals: what a model leaves of their features [N], shape (n, N_FEATURES).
    """
    far = np.zeros(len(residuals), dtype=bool)
    for rows in filter(len, pool.rows):
        away = residuals[rows, :2] - np.median(residuals[rows, :2], axis=0)
        far[rows] = (np.abs(away) > criteria.KICK_STRAY * deviation(away, axis=0)).any(axis=1)
    return far


def kicked(study: Study) -> np.ndarray:
    """Return which slips stand out from all others of their run: in onset force, or in the slip."""
    forces, limit = _forces(study.pool)
    return np.asarray((np.abs(forces) > limit).any(axis=1)) & ~_sliding(study.pool)


def _forces(pool: Pool) -> tuple[Array, Array]:
    """Return onset force and mean force of the slips less their run's medians [N], shape (n, 2), and how far off stands out."""
    forces = less_medians(pool.features[:, :2], pool.run)
    least = criteria.KICK_LEAST * float(np.median(pool.static))
    return forces, np.maximum(criteria.KICK_STRAY * deviation(forces, axis=0), least)


def _held_back(study: Study) -> bool:
    """Return whether more slips stand out by a break-away at more force than by their own forces.

    A kick sets a stuck box off before its time; to hold it back, it has to come as it breaks away. Far more come in slips.
    """
    forces, limit = _forces(study.pool)
    late, in_slip = forces[:, 0] > limit[0], np.abs(forces[:, 1]) > limit[1]
    return bool(np.count_nonzero(late & ~_sliding(study.pool)) > np.count_nonzero(in_slip))


def _sliding(pool: Pool) -> np.ndarray:
    """Return which slips are none: the box, kicked loose, slides on, and swings about what kinetic friction holds.

    Where its swing comes near the belt's speed it seems to stick for a moment, and to break away at the kinetic force.
    """
    return np.asarray(np.abs(pool.features[:, 0] - pool.kinetic) < criteria.KICKED_SLIDING * (pool.static - pool.kinetic))


def _repeated(study: Study) -> bool:
    """Return whether many of the slips that stand out do so by the same share: a kick comes at any phase of the stick.

    Kicks in stick take as much off the mean force of the slip that they set off, but set it off at any force of the spring.
    Equal kicks in slip change its mean force by as much, too, but its shape by when they came; another level leaves the shape.
    """
    pool = study.pool
    levels = np.stack([pool.static, pool.kinetic, pool.kinetic, pool.kinetic], axis=1)
    shares = less_medians(pool.features[:, :4] / levels, pool.run)
    spread = deviation(shares, axis=0)
    static, kinetic = (
        (np.abs(shares[:, :2]) > np.maximum(criteria.KICK_STRAY * spread[:2], criteria.KICK_LEAST)) & ~_sliding(pool)[:, None]
    ).T
    level = kinetic & ~static & (np.abs(shares[:, 2:]) < criteria.KICK_STRAY * spread[2:]).all(axis=1)
    widths = np.maximum(3.0 * spread, criteria.KICKS_LEVEL)
    groups = (np.sort(shares[static, 0]), widths[0]), (np.sort(shares[level, 1]), widths[1])
    most = max(criteria.FEWEST_ALIKE, criteria.KICKS_ALIKE * int(np.count_nonzero(static | kinetic)))
    near = [int(np.searchsorted(far, value + width, "right")) - i for far, width in groups for i, value in enumerate(far)]
    return any(count >= most for count in near)


def kicks(study: Study) -> Finding | None:
    """Return impacts if a few slips, and only a few, stand out, each by its own amount, and not at a regular count.

    A kick that is too weak to set off a slip moves the stuck box a little: a jump within a stick phase counts as well.
    """
    far = kicked(study)
    pool = study.pool
    jumps = study.sticking.jumps if study.sticking is not None else 0
    share = (int(far.sum()) + jumps) / len(far)
    if far.sum() < criteria.FEWEST_KICKS or share >= criteria.MOST_KICKED or _repeated(study) or _held_back(study):
        return None
    gaps = np.concatenate([np.diff(np.flatnonzero(far[pool.run == r])) for r in range(pool.n_runs)])
    if len(gaps) >= 4 and np.mean(gaps == np.median(gaps)) > 0.8:
        return None
    impulses = _impulses(study, far)
    mean, deviation = float(impulses.mean()), float(impulses.std(ddof=1))
    if abs(mean) < criteria.KICKS_ONE_SIDED * deviation:
        mean, deviation = 0.0, float(np.sqrt(np.mean(impulses**2)))
    # of kicks from both sides those that push the stuck box on with the belt set off no slip
    unseen = UNSEEN if mean == 0.0 else 1.0
    return Finding(
        kind_with_signature(KICKS),
        detected("kicks", share),
        {
            "rate": unseen * share / pool.cycle,
            "impulse": deviation,
            "mean": mean,
            "duration": PULSE / pool.angular_frequency,
        },
    )


def _impulses(study: Study, far: np.ndarray) -> Array:
    """Return the impulses of kicks [N s]: in slip they change the mean force by the impulse over the slip's duration."""
    pool = study.pool
    kinetic = less_medians(pool.features[:, 1], pool.run)
    direction = pool.per_run(lambda s: float(s.record.direction))
    return np.asarray((direction * kinetic * (pool.restick_time - pool.onset_time))[far], dtype=np.float64)


def random_effects(
    study: Study, baseline: Baseline, scatter: Randomness, levels: Switching, named: Sequence[str]
) -> Finding | Where | None:
    """Return random friction, or where a scatter of no known kind lives, or None."""
    sigma_s, sigma_k, _ = np.exp(baseline.solution.scatter)
    mu_s, mu_k = study.baseline.solution.coefficients[:2]
    # how large a scatter is says nothing where that it is there at all is in doubt
    certain = scatter.static > criteria.SCATTER_CERTAIN, scatter.kinetic > criteria.SCATTER_CERTAIN
    share = max(certain[0] * sigma_s, certain[1] * sigma_k) / mu_s
    if not _scatters(study, baseline, scatter, named, float(share)):
        return None
    if levels.where is not None or (scatter.wander > criteria.NAMED and scatter.wander_of == "offset"):
        return levels.where or _offset(study, scatter)
    declared = study.model.process is not None
    if not declared or scatter.correlation > _declared(study).correlation + criteria.SCATTER_MORE_MEMORY:
        memory = _memory(scatter, mu_s, mu_k, _cross(study, scatter))
        if memory is not None or declared:
            return memory
    else:
        return None
    spacing = KNOTS_APART / study.pool.angular_frequency
    return _drawn_anew(scatter, sigma_s, sigma_k, mu_k / mu_s, spacing, _cross(study, scatter))


def _cross(study: Study, scatter: Randomness) -> dict[str, float]:
    """Return the correlation of the two coefficients as a parameter, where both scatter beyond doubt and chance."""
    certain = min(scatter.static, scatter.kinetic) > criteria.SCATTER_CERTAIN
    shown = abs(scatter.together) * np.sqrt(len(study.pool.run)) > criteria.SCATTER_ALIKE
    return {"cross_correlation": scatter.cross} if certain and shown else {}


def _drawn_anew(
    scatter: Randomness, sigma_s: float, sigma_k: float, ratio: float, spacing: float, cross: Mapping[str, float]
) -> Finding | Where:
    """Return coefficients that are drawn anew, or where a force is.

    Args:
        scatter: what the scatter tells.
        sigma_s: standard deviation of mu_s [-].
        sigma_k: that of mu_k [-].
        ratio: mu_k over mu_s [-].
        spacing: distance of knots [s].
        cross: correlation of the coefficients, if it is told: within a slip no pair is one that both levels have.
    """
    # in stick and slip alike, a factor of both coefficients goes with them, a force does not
    if scatter.together > criteria.SCATTER_TOGETHER and sigma_k > sigma_s * np.sqrt(ratio):
        return Where("scatter, in stick and slip alike", "a force of irregular course acts in stick and slip alike")
    strongest = max(scatter.static, scatter.kinetic)
    within = scatter.within > criteria.SCATTER_CERTAIN and scatter.within > 0.05 * strongest
    values: dict[str, float | str] = {
        "process": "knots" if within else "per_event", "sigma_s": float(sigma_s), "sigma_k": float(sigma_k), "spacing": spacing
    }  # fmt: skip
    values |= {} if within else cross
    return Finding(kind_with_signature(DRAWN_ANEW), likely("scatter", strongest), values)


def _memory(scatter: Randomness, mu_s: float, mu_k: float, cross: Mapping[str, float]) -> Finding | Where | None:
    """Return what a scatter with a memory is; None where it has none."""
    if (
        scatter.wander > criteria.NAMED and scatter.correlation > criteria.SCATTER_MEMORY
    ) or scatter.wander > 5.0 * criteria.NAMED:
        share = max(scatter.wander_share, 1.0e-3)
        return Finding(
            kind_with_signature(WANDER),
            likely("wander", scatter.wander),
            {"sigma_s": share * mu_s, "sigma_k": share * mu_k, "correlation_time": float(scatter.wander_time), **cross},
        )
    if scatter.correlation > 2.0 * criteria.SCATTER_MEMORY:
        return Where("scatter, time", "friction varies from slip to slip with a memory that no known random process has")
    return None


def _declared(study: Study) -> Randomness:
    """Return what the scatter would tell if the declared process were all that is random."""
    return randomness(drawn(study, 0))


def _offset(study: Study, scatter: Randomness) -> Where | None:
    """Return where a force wanders that is the same in stick and slip; None where it is a sensor's zero, within its noise."""
    pool = study.pool
    away = scatter.wander_share * float(np.median(pool.static)) / study.records[0].mechanism.stiffness
    if away < criteria.STICK_DEPARTS * max(s.noise.deviation for s in pool.slips):
        return None
    return Where("time", f"the same in stick and slip, a force or the sensor's zero drifts by {away:.2g} m")


def _scatters(study: Study, baseline: Baseline, scatter: Randomness, named: Sequence[str], share: float) -> bool:
    """Return whether friction scatters beyond doubt, and by more than what the form of a named effect may leave."""
    if max(scatter.static, scatter.kinetic) <= criteria.SCATTER_CERTAIN and scatter.wander <= criteria.NAMED:
        return False
    # of noise slower than a stick phase the record says nothing but where the box breaks away: where noise is coloured, or
    # stick and slip scatter alike, as a zero that moves makes them, it may be as much as a reading errs
    alike = scatter.together * np.sqrt(len(study.pool.run)) > criteria.SCATTER_ALIKE
    slow = alike or any(s.noise.coloured > 0.0 for s in study.pool.slips)
    level = float(np.median(study.pool.static))
    wander = scatter.wander_share if scatter.wander > criteria.NAMED else 0.0
    away = max(share, wander) * level / study.records[0].mechanism.stiffness
    if slow and away < criteria.STICK_DEPARTS * max(s.noise.deviation for s in study.pool.slips):
        return False
    remaining = baseline.variance / study.baseline.variance
    return not named or (remaining >= criteria.SCATTER_REMAINING and share >= criteria.SCATTER_LEAST_SHARE)
