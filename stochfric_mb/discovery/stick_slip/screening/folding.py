"""Slips that stand out, folded by the travel of the belt: a joint or a bump of the belt comes back each turn, kicks do not."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from scipy.stats import gamma

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.study import Study

Array = npt.NDArray[np.float64]

TURN = "belt_turn"
"""Name under which the details hold the belt travel after which slips that stand out come back [m]."""
FINENESS = 4.0
"""Waves over the record that are looked at are 1/this apart [-]."""
LEAST_SLIPS = 2.0
"""Slips in a turn below which all of them meet the bump [-]."""


def turn(places: Sequence[Array], travels: Sequence[float], spacing: float) -> tuple[float, float] | None:
    """Return the travel after which places come back [m], and the chance of that where they are random.

    For n random places the resultant R = |sum exp(2 pi i s/L)| exceeds a value with a chance of about exp(-P),
    P = 1 + 2n - sqrt(1 + 4n + 4(n^2 - R^2)), which is R^2/n where n is large. Each run has its own phase, so that the P of runs
    add up. Only turns in which about one place stands out are looked at.

    Args:
        places: belt travel at what stands out, run by run [m].
        travels: travel of the belt in each run [m].
        spacing: belt travel from slip to slip [m].

    Reference: K. V. Mardia, P. E. Jupp, Directional Statistics, Wiley 2000, section 6.3.1 (Rayleigh's test); J. A. Greenwood,
    D. Durand, Ann. Math. Stat. 26, 1955, 233-246, doi 10.1214/aoms/1177728540, as in J. H. Zar, Biostatistical Analysis, 1999,
    p. 617 (few places).
    """
    runs = [(s, length) for s, length in zip(places, travels, strict=True) if len(s) >= 2]
    if not runs:
        return None
    gap = sum(length for _, length in runs) / sum(len(s) for s, _ in runs)
    shortest, longest = max(criteria.ONCE_A_TURN * gap, LEAST_SLIPS * spacing), gap / criteria.ONCE_A_TURN
    if shortest >= longest:
        return None
    waves = np.arange(1.0 / longest, 1.0 / shortest, 1.0 / (FINENESS * max(length for _, length in runs)))
    power = np.sum([_rarity(np.abs(np.exp(2.0j * np.pi * waves[:, None] * s).sum(axis=1)), len(s)) for s, _ in runs], axis=0)
    best = int(np.argmax(power))
    chance = float(gamma.sf(power[best], len(runs))) * len(waves)
    return 1.0 / float(waves[best]), min(chance, 1.0)


def _rarity(resultant: Array, n: int) -> Array:
    """Return -log of the chance that n unit vectors of random directions have as long a resultant [-]."""
    return 1.0 + 2.0 * n - np.sqrt(1.0 + 4.0 * n + 4.0 * (n**2 - resultant**2))


def met(travel: Array, far: npt.NDArray[np.bool_]) -> Array:
    """Return the places at which slips stand out [m]: of neighbours, which one bump touches, their middle.

    Args:
        travel: belt travel at each slip of a run [m], shape (n,).
        far: which of them stand out, shape (n,).
    """
    places = np.flatnonzero(far)
    groups = np.split(places, np.flatnonzero(np.diff(places) > 1) + 1) if len(places) else []
    return np.array([float(travel[group].mean()) for group in groups])


def comes_back(study: Study, far: npt.NDArray[np.bool_], details: dict[str, object]) -> Where | None:
    """Return where slips that stand out come back with the belt; None where they come at random.

    Args:
        study: what the fit runs show.
        far: which slips stand out, shape (n,).
        details: numbers behind the answer, which get the belt travel of a turn [m].
    """
    pool = study.pool
    onset = np.concatenate([s.onset_position for s in pool.slips])
    travel = pool.belt_velocity * pool.onset_time - onset
    rows = [np.flatnonzero(pool.run == r) for r in range(pool.n_runs)]
    spacing = float(np.median(np.concatenate([np.diff(travel[mine]) for mine in rows])))
    result = turn([met(travel[mine], far[mine]) for mine in rows], [float(np.ptp(travel[mine])) for mine in rows], spacing)
    if result is None or result[1] > criteria.FOLDED_BY_CHANCE:
        return None
    details[TURN] = length = result[0]
    return Where(
        "belt position",
        f"slips stand out once in {length:.3g} m of belt travel, turn after turn: a joint or a bump of the belt, not kicks",
    )
