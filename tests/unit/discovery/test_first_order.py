"""Candidates that are not worth a fit: what they might be worth to first order, against what fits of them are worth."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.decision.selection import Selector
from stochfric_mb.discovery.driven_joint.fit.fitting import fit
from stochfric_mb.discovery.driven_joint.search import candidate_fits
from stochfric_mb.discovery.driven_joint.search.candidate_fits import CandidateFits
from stochfric_mb.discovery.driven_joint.search.candidates import candidates, span_of
from stochfric_mb.discovery.driven_joint.search.first_order import FEWEST, prospect, prospects
from stochfric_mb.discovery.driven_joint.source import source_of
from tests.discovery.joints.test_parts import coulomb, grease, pair

RECORDS = {
    "nothing": coulomb,
    "grease": grease,
    "weakening": lambda q, v: coulomb(q, v) * (1.0 + 0.4 * np.exp(-np.abs(v) / 0.1)),
    "by place": lambda q, v: coulomb(q, v) * (1.0 + 0.5 * np.sin(40.0 * q)),
    "spring": lambda q, v: coulomb(q, v) + 8.0 * q,
}


def seen(friction):
    """Return selector, fit without effects, and the candidates beside it but loads that move by themselves."""
    source = source_of(pair(friction))
    selector = Selector(source.balances("", "fit", 0.0), source.nuisances(""), source.stated(""))
    return selector, selector.begin, selector._candidates.others(selector.begin)


@pytest.mark.parametrize("name", RECORDS)
def test_what_is_not_worth_a_fit_has_no_name_when_it_is_fitted(name):
    selector, beside, found = seen(RECORDS[name])
    best = max(t.score for t in selector._scored(beside.current, found))
    assert len(found.faint) > len(found.fits)  # most are saved
    everything = CandidateFits(selector._balances, lambda _: None)
    for candidate, score in found.faint:
        one = everything._once(beside, everything._seen(beside, candidate))
        if one is None:
            continue
        (trial,) = selector._scored(beside.current, found._replace(fits=[(candidate, one)], faint=found.faint))
        assert trial.score < max(criteria.NAMED, 0.5 * best)
        assert trial.score < score + criteria.NAMED  # to first order is about what it is


def test_a_number_in_which_friction_is_linear_is_worth_what_its_fit_is():
    selector, beside, found = seen(grease)
    current = beside.current
    span = span_of(selector._balances, current.model.law.mu_k * current.model.load, current.model.load)
    viscous = next(c for c in candidates(span, ()) if c.kind == "viscous_friction" and c.parameters == 1)
    expected = prospect(viscous, (), current, selector._balances)
    fitted = next(f for c, f in found.fits if c == viscous)
    loose = [dataclasses.replace(n, deviation=1.0e3 * n.deviation) for n in beside.nuisances]
    free = dataclasses.replace(fitted.model, level=(fitted.model.level[0], np.inf))
    rest = np.concatenate(fit(free, selector._balances, loose, noise=beside.noise).remainders)
    assert np.sqrt(np.mean(expected.left**2)) == pytest.approx(np.sqrt(np.mean(rest**2)), rel=1.0e-3)


def test_where_nothing_is_missing_a_few_are_fitted_nevertheless():
    _, _, found = seen(coulomb)
    assert len(found.fits) >= FEWEST - 1  # one may be none of its kind
    assert max(score for _, score in found.faint) < 0.0


def test_where_those_that_are_worth_a_fit_are_none_of_their_kind_others_are_fitted(monkeypatch):
    asked = []

    def none_at_first(fitted, owner):
        asked.append(owner)
        return len(asked) <= FEWEST

    monkeypatch.setattr(candidate_fits, "is_none", none_at_first)
    selector, beside, found = seen(coulomb)
    assert len(asked) > FEWEST
    assert found.fits
    assert selector._scored(beside.current, found)  # a stage has something to compare with


def test_few_candidates_are_all_fitted():
    selector, beside, _ = seen(grease)
    span = span_of(selector._balances, 2.0, 20.0)
    some = [prospect(c, (), beside.current, selector._balances) for c in candidates(span, ())[:FEWEST] if c.starts]
    assert prospects(some, beside.current, selector._candidates._settings).worth == tuple(some)
