"""What candidates are worth to first order about a fit: those that cannot pay for their own numbers are not fitted."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.discovery.driven_joint.fit.evidence import Labels, scatter
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit
from stochfric_mb.discovery.driven_joint.fit.gains import predicted_left
from stochfric_mb.discovery.driven_joint.fit.wave_scan import Start, begun
from stochfric_mb.discovery.driven_joint.search.candidates import Candidate
from stochfric_mb.effects.traits import ROUGH

Array = npt.NDArray[np.float64]

FEWEST = 3
"""Candidates that are fitted, whatever they are worth: what shows in no mean may show on strokes left out."""


@dataclasses.dataclass(frozen=True)
class Prospect:
    """A candidate before it is fitted."""

    candidate: Candidate
    """The candidate."""
    starts: tuple[Start, ...]
    """Where fits of its own forms begin, best first."""
    waves: tuple[Start, ...]
    """Where fits of its waves begin, best first."""
    left: Array | None
    """What it would leave [N or N m], window by window; None: it is too far from linear for that to say anything."""
    numbers: int
    """How many numbers it adds to a fit, phases that each run has for itself among them."""

    @property
    def rough(self) -> bool:
        """Whether fits of it end in one of many valleys."""
        return any(ROUGH in s.effect.traits for s in self.starts)


@dataclasses.dataclass(frozen=True)
class Prospects:
    """The candidates beside a fit, by what they are worth to first order."""

    worth: tuple[Prospect, ...]
    """Those to be fitted, in the order in which they were given."""
    faint: tuple[tuple[Prospect, float], ...]
    """The others, with the score that a fit might give them at best [-], best first."""


def prospect(candidate: Candidate, waves: Sequence[Start], current: JointFit, balances: Sequence[ForceBalance]) -> Prospect:
    """Return a candidate with what it would leave from the best of its starts.

    Args:
        candidate: the candidate.
        waves: where fits of its waves begin.
        current: the fit beside which it is asked for.
        balances: the runs of that.
    """
    starts = [begun(e, balances) for e in candidate.starts]
    each = [predicted_left(current.model, s, balances, current) for s in (*starts, *waves)]
    size = [float(np.mean(left**2)) for left in each]
    order = sorted(range(len(starts)), key=lambda i: size[i])
    far = candidate.moves_load or any(ROUGH in s.effect.traits for s in starts) or not (each and np.isfinite(size).all())
    best = int(np.argmin(size)) if size else -1
    own = len((*starts, *waves)[best].own) if size else 0
    numbers = candidate.parameters + max(own - 1, 0)
    return Prospect(candidate, tuple(starts[i] for i in order), tuple(waves), None if far else each[best], numbers)


def prospects(each: Sequence[Prospect], current: JointFit, settings: Labels) -> Prospects:
    """Return which candidates are to be fitted.

    To first order a fit is as good as linear least squares of all numbers about its start. That is optimistic: beliefs do not
    hold numbers there.

    Args:
        each: the candidates.
        current: the fit beside which they are asked for.
        settings: as of `scatter`.
    """
    known = [p for p in each if p.left is not None]
    if len(known) <= FEWEST:
        return Prospects(tuple(each), ())
    left = [p.left for p in known if p.left is not None]
    best = min(left, key=lambda x: float(np.mean(x**2)))
    n = max(current.independent_in(current.split(best)), 4.0)
    rest = np.concatenate(current.remainders)
    evidence = np.zeros(len(known))
    for ratio in {0.0, scatter(best, settings, n).ratio}:
        before, *after = (scatter(x, settings, n, ratios=np.array([ratio])).deviance for x in (rest, *left))
        evidence = np.maximum(evidence, before - np.array(after))
    own = evidence - np.array([p.numbers for p in known]) * np.log(n)
    tried = np.array([max(len(p.starts) + len(p.waves), 1) for p in known])
    scores = own - 2.0 * np.log(tried * len(each))
    fitted = (own >= 0.0) & (evidence >= criteria.FAINT * evidence.max())
    fitted[np.argsort(-scores)[:FEWEST]] = True
    faint = [(p, float(score)) for p, score, is_fitted in zip(known, scores, fitted, strict=True) if not is_fitted]
    left_out = {id(p) for p, _ in faint}
    return Prospects(tuple(p for p in each if id(p) not in left_out), tuple(sorted(faint, key=lambda f: -f[1])))
