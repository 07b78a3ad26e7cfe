"""The elastic stand-in of laws with true stick."""

import math

import pytest

from stochfric_mb.errors import InputError
from stochfric_mb.laws import LAWS, law_class, make_law
from stochfric_mb.laws.elastic_stick import ElasticStick
from stochfric_mb.laws.substitute import MARGIN, elastic_substitute

HOLDING = [kind for kind in LAWS if law_class(kind).needs_holding_force]


@pytest.mark.parametrize("kind", HOLDING)
@pytest.mark.parametrize("dt", [1.0e-3, 1.0e-4, 2.0e-5])
def test_step_limit_is_the_margin_times_the_step(kind, dt):
    law, note = elastic_substitute(make_law(kind, mu_s=0.8, mu_k=0.46), dt, 13.0, 6.08)
    assert isinstance(law, ElasticStick)
    assert law.step_limit(13.0, 6.08) == pytest.approx(MARGIN * dt, rel=1e-12)  # exact up to rounding
    assert kind in note
    assert "e_lim" in note


@pytest.mark.parametrize("kind", sorted(set(LAWS) - set(HOLDING)))
def test_other_laws_come_back_unchanged(kind):
    law = make_law(kind, mu_s=0.8, mu_k=0.46)
    assert elastic_substitute(law, 1e-4, 13.0, 6.08) == (law, "")


def test_slip_branch_is_the_nearest():
    coulomb, _ = elastic_substitute(make_law("coulomb", mu_s=0.8, mu_k=0.46), 1e-4, 13.0, 6.08)
    karnopp, _ = elastic_substitute(make_law("karnopp", mu_s=0.8, mu_k=0.46, v_s=3e-4), 1e-4, 13.0, 6.08)
    assert isinstance(coulomb, ElasticStick)
    assert isinstance(karnopp, ElasticStick)
    assert coulomb.decay_velocity == karnopp.decay_velocity == 0.0
    assert coulomb.v_s < 0.01 * 0.8 * 13.0 / 6.08 * 1e-4  # far below the velocity that friction changes in a step
    assert karnopp.v_s == 3e-4


@pytest.mark.parametrize(
    ("form", "shape"),
    [
        ("exponential", lambda r: math.exp(-r)),
        ("gaussian", lambda r: math.exp(-r * r)),
        ("lorentzian", lambda r: 1.0 / (1.0 + r * r)),
    ],
)
def test_stribeck_fall_keeps_its_area(form, shape):
    law, _ = elastic_substitute(make_law("stribeck", mu_s=0.8, mu_k=0.46, form=form, stribeck_velocity=2e-3), 1e-4, 13.0, 6.08)
    assert isinstance(law, ElasticStick)
    angles = [(i + 0.5) / 200_000 * 0.5 * math.pi for i in range(200_000)]  # r = tan(angle), the whole half line
    area = sum(shape(math.tan(a)) / math.cos(a) ** 2 for a in angles) * 0.5 * math.pi / 200_000
    assert law.decay_velocity == pytest.approx(area * 2e-3, rel=1e-6)  # midpoint rule: error of order 1e-10


@pytest.mark.parametrize("values", [(0.0, 13.0, 6.08), (1e-4, 0.0, 6.08), (1e-4, 13.0, -1.0), (math.nan, 13.0, 6.08)])
def test_bad_numbers_are_named(values):
    with pytest.raises(InputError, match=r"dt|normal_force|effective_mass"):
        elastic_substitute(make_law("coulomb", mu_s=0.8, mu_k=0.46), *values)
