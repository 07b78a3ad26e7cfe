"""A slow course differs from a random drift by its length scale, and comes back in the next run."""

import numpy as np
import pytest

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.screening.screen import screen
from stochfric_mb.discovery.stick_slip.screening.variance_components import randomness
from stochfric_mb.discovery.stick_slip.simulation.prior_model import assumed
from stochfric_mb.discovery.stick_slip.study import Study, study
from stochfric_mb.effects import contract, make_effect
from stochfric_mb.effects.kinds.friction_drift import friction
from stochfric_mb.measurement.dataset import load_dataset
from tests.discovery.unseen_forms import eighth  # noqa: F401  enters its forms
from tests.discovery.unseen_forms.forms import FORMS
from tests.discovery.unseen_forms.records import Case, write_record

pytestmark = pytest.mark.slow


def studied(form: str, design: str, folder) -> Study:
    write_record(Case(FORMS[form], design, 1.0), folder, 0)
    dataset = load_dataset(folder / "data")
    return study(assumed(dataset))


@pytest.mark.parametrize(
    ("form", "design", "kind"),
    [
        ("drift_logistic", "one", "friction_drift"),
        ("drift_rise_and_fall", "several", "friction_drift"),
        ("drift_warming_up", "several", "sensor_drift"),
        ("eighth_distance_laid_on_and_rubbed_off", "several", "distance_drift"),
    ],
)
def test_a_course_of_no_usual_shape_is_seen_as_what_it_is(form, design, kind, tmp_path):
    result = studied(form, design, tmp_path)
    best = screen(result.baseline)[0]
    assert best.name == kind
    assert best.any_course
    drift = randomness(result.baseline).wander
    assert best.score - drift > criteria.NAMED


def test_a_random_wander_is_no_course(tmp_path):
    result = studied("correlated_smooth", "several", tmp_path)
    courses = [c for c in screen(result.baseline) if c.any_course]
    drift = randomness(result.baseline).wander
    assert max(c.score for c in courses) - drift < criteria.NAMED


def test_the_course_found_is_the_one_that_was_there(tmp_path):
    result = studied("drift_logistic", "one", tmp_path)
    best = screen(result.baseline)[0]
    effect = make_effect(best.name, **best.hypothesis.start(best.strengths))
    span = result.pool.duration
    world = np.zeros(30)
    shown = []
    times = np.linspace(0.1, 0.95, 50) * span
    for t in times:
        world[contract.TIME], world[contract.MU_S], world[contract.MU_K] = t, 1.0, 1.0
        friction(world, np.zeros(1), np.zeros(1), effect.parameters())
        shown.append(world[contract.MU_K])
    true = 1.0 + 0.10 / (1.0 + np.exp(-(times / span - 0.45) * 10.0))
    # relative to the mean, which the coefficients take; the record is not quite 60 nominal cycles long
    np.testing.assert_allclose(np.array(shown) / np.mean(shown), true / true.mean(), atol=0.005)
