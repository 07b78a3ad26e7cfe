"""An unnamed term: a smooth change of friction along an axis, kept if held-out runs bear it out.

Beside a named effect, what another form of it would add is such a term, too (`working_model`).
"""

from __future__ import annotations

import dataclasses

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.decision.decision import Named, term_of
from stochfric_mb.discovery.stick_slip.screening.smooth_term import axes_of, smooth_term
from stochfric_mb.discovery.stick_slip.simulation.deviations import with_deviations
from stochfric_mb.discovery.stick_slip.simulation.forecast_skill import HeldOut
from stochfric_mb.discovery.stick_slip.simulation.refit import Fit, refit
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.discovery.stick_slip.validation.held_out_check import Comparison, compared
from stochfric_mb.errors import SimulationError


@dataclasses.dataclass(frozen=True)
class Anonymous:
    """An unnamed term beside the recalibrated model."""

    named: Named
    """The term, as an effect of the result."""
    fit: Fit
    """The model with it."""
    seen: Comparison | None
    """Forecasts of the held-out runs without it and with it; None where there are too few."""

    @property
    def carries_over(self) -> bool:
        """Whether held-out runs are forecast better with it, by more than chance and by enough to be worth a term."""
        seen = self.seen
        return seen is not None and seen.better and seen.without - seen.with_ > criteria.CLOSES_NOTHING * seen.without


def anonymous(study: Study, recalibrated: Fit, runs: HeldOut) -> Anonymous | None:
    """Return the unnamed term along the axis with most evidence; None where no axis has any.

    Args:
        study: what the fit runs show.
        recalibrated: the model without it.
        runs: held-out runs; no phase is to be found in them, since the term has none.
    """
    axes = axes_of(study.pool)[:-1]
    tried = [smooth_term(study.baseline, recalibrated.model, axis, len(axes)) for axis in axes]
    best = max(tried, key=lambda t: t.score)
    if best.score <= criteria.UNNAMED_LEAST:
        return None
    fit = refit(best.model, study.windows, study.uncertainty)
    fit = with_deviations(fit, study.windows, study.uncertainty)
    try:
        seen = compared(recalibrated.model, fit.model, runs)
    except SimulationError:  # a model that cannot run by itself does not carry over
        seen = None
    return Anonymous(term_of(fit.model, best.score), fit, seen)


def sentence_of(term: Anonymous | None) -> str:
    """Return the sentence about it for a reader."""
    if term is None:
        return (
            "no smooth change of friction along speed, slip, position, time or temperature explains what is missing: "
            "it may be random"
        )
    axis = term.named.where.axis
    if term.carries_over:
        return f"an unnamed term along the {axis} makes forecasts of the held-out runs better; it is in the augmented model"
    return f"an unnamed term along the {axis} explains the fit runs, but does not carry over to the held-out ones"
