"""The unnamed term: friction that is found again along its axis without its name, and none where there is nothing."""

import pytest

from stochfric_mb import discover
from stochfric_mb.discovery.stick_slip.simulation.forecast_skill import gap_of, held_out
from stochfric_mb.discovery.stick_slip.study import slips_of_run, study
from stochfric_mb.discovery.stick_slip.validation.anonymous import anonymous, sentence_of
from stochfric_mb.discovery.stick_slip.workflow import recalibrated_model
from tests.discovery.generator.case import Case
from tests.discovery.net.rigs import belt_box
from tests.discovery.unseen_forms.records import cases, write_record

SEED = 21
"""A tuning seed."""


def term_of(case):
    dataset = belt_box(case)
    result = study(dataset)
    plain = recalibrated_model(result.model, result)
    runs = held_out([slips_of_run(r, dataset, result) for r in dataset.test], phased=False)
    return anonymous(result, plain, runs), plain.model, runs


@pytest.mark.parametrize(
    ("form", "axis"),
    [
        ("velocity_weakening.rational", "relative velocity"),
        ("frictional_lag.linear_slip_weakening", "distance slid since break-away"),
    ],
)
def test_what_has_no_name_is_found_along_its_axis_and_closes_the_gap(form, axis):
    term, plain, runs = term_of(Case(form, "one_free", 1.0, SEED))
    assert term is not None
    assert term.carries_over
    assert axis in sentence_of(term)
    gap = gap_of(plain, plain, term.fit.model, runs)
    assert gap.closed is not None
    assert gap.closed > 0.5  # what an answer without a name must close
    changes = {i: getattr(term.fit.model.effects[-1], f"change_{i}") for i in range(1, 7)}
    # both forms weaken: over the speeds of a slip, or within the first half of a table that ends where nothing changes
    assert changes[2] - changes[5] > 0.03 if axis == "relative velocity" else changes[3] < -0.15


def test_nothing_missing_brings_no_term():
    term, _, _ = term_of(Case("none.wrong_parameters", "one_free", 1.0, SEED))
    assert term is None or not term.carries_over
    assert "in augmented.toml" not in sentence_of(term)


def test_another_form_of_a_named_effect_is_a_term_beside_it(tmp_path):
    """A lag with a cosine for a kernel: the name stands, and its shape is carried along the distance slid."""
    write_record(next(c for c in cases() if c.name == "third_lag_cosine-one-1"), tmp_path, 2311)
    result = discover(tmp_path / "data").result
    assert [e.kind for e in result.effects] == ["frictional_lag"]
    assert result.unnamed is not None
    assert result.unnamed.where.axis == "distance slid since break-away"
    assert result.gap is not None
    assert result.gap.closed > 0.85  # what right names must close; an exponential alone closes 0.74
