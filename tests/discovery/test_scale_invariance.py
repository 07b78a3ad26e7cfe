"""The same record in other units of force, length and time: the same answer, in those units.

No number of the method has a dimension, so that a change of units is a change of rounding, 1e-16. The simulator's
adaptive steps turn it into 1e-12 of a path and a fit's least squares into about 1e-9 of a number; a fit that ends one step
sooner moves its numbers by the fall of the cost at which it ends, a share of 1e-4. No grid, order or choice may move.
"""

import math

import pytest

from stochfric_mb.discovery import discover
from stochfric_mb.discovery.stick_slip.simulation.deviations import ALIKE
from stochfric_mb.discovery.stick_slip.simulation.natural_units import exponents
from stochfric_mb.discovery.stick_slip.simulation.refit import MOST_WINDOWS
from tests.discovery.generator.case import Case
from tests.discovery.net.rigs import Size, belt_box, grown

UNITS = Size(force=3.7, length=0.013, time=41.0)
TERMINATION = 1.0e-4
"""Relative fall of the cost at which a fit ends: the most by which a number may move [-]."""
RUNS, INDEPENDENT = 2, 6
"""Fit runs of the cases, and as how many numbers a forecast counts in an interval."""
END = math.sqrt(TERMINATION * INDEPENDENT * MOST_WINDOWS * RUNS)
"""Standard deviations within which a fit to rough errors ends: a share of the cost is that share of all numbers in chi^2."""


def unit_of(name: str) -> float:
    force, length, time = exponents(name)
    return UNITS.force**force * UNITS.length**length * UNITS.time**time


def numbers(result, unit):
    """Return what a result says in numbers, each over ``unit`` of its own."""
    table = {f"score {name}": score for name, score in result.ranking}
    estimates = {e.kind: e.parameters for e in result.effects} | {"model": result.parameters}
    if result.unnamed is not None:
        estimates["unnamed"] = result.unnamed.parameters
    for owner, parameters in estimates.items():
        for name, interval in parameters.items():
            of = unit(interval.unit)
            table |= {f"{owner}.{name}.{end}": getattr(interval, end) / of for end in ("value", "low", "high")}
    if result.gap is not None:
        table |= {f"gap.{n}": getattr(result.gap, n) / unit("m") for n in ("baseline", "recalibrated", "augmented", "floor")}
    return table


def words(result):
    where = None if result.where is None else result.where.axis
    named = [(e.kind, e.equivalent_to, list(e.parameters)) for e in result.effects]
    return result.verdict, named, where, [name for name, _ in result.ranking], result.not_identifiable, list(result.power)


@pytest.mark.parametrize(
    ("form", "design"),
    [
        ("none.wrong_parameters", "one_free"),
        ("velocity_weakening.rational", "one_free"),
        ("sensor_step.one_step", "one_free"),
        pytest.param("dwell_ageing.log_of_dwell", "belt_speeds", marks=pytest.mark.slow),
        pytest.param("impacts.random_kicks", "one_free", marks=pytest.mark.slow),
        pytest.param("random_coefficients.knots", "normal_loads", marks=pytest.mark.slow),
    ],
)
def test_other_units_give_the_same_answer(form, design):
    usual, other = answers(form, design)
    assert words(other) == words(usual)
    assert numbers(other, unit_of) == pytest.approx(numbers(usual, lambda _: 1.0), rel=TERMINATION, abs=1.0e-12, nan_ok=True)


def answers(form, design):
    data = belt_box(Case(form, design, 1.0, 17))
    assert len(data.fit) == RUNS or design != "one_free"
    return discover(data).result, discover(grown(data, UNITS)).result


ENDS_ELSEWHERE = pytest.mark.xfail(
    strict=True,
    reason="a soft contact's fit ends elsewhere in other units, by more than its cost tells: "
    "mass 6.128 for 6.122 kg, 0.4 of its deviations, floor of the gap 4.20 for 4.23 um; the answer is the same",
)


@pytest.mark.slow
@pytest.mark.parametrize(
    "form", [pytest.param("presliding_compliance.linear", marks=ENDS_ELSEWHERE), "unknown.stiffness_steps"]
)
def test_where_errors_jump_fits_end_within_what_their_cost_tells(form):
    """Errors that jump, at a slip missed or a soft contact's edge, stop a fit a step sooner or later."""
    usual, other = answers(form, "one_free")
    assert words(other) == words(usual)
    here, there = numbers(usual, lambda _: 1.0), numbers(other, unit_of)
    assert set(here) == set(there)
    for name in here:
        if name.startswith("score"):  # twice a log likelihood: the square of a distance in standard deviations
            assert there[name] == pytest.approx(here[name], abs=2.0 * END * (1.0 + math.sqrt(abs(here[name])))), name
        if name.startswith("gap"):  # to first order a number that is off by END moves one of all the squares
            assert there[name] == pytest.approx(here[name], rel=2.0 * END / (INDEPENDENT * MOST_WINDOWS * RUNS)), name
        if name.endswith(".value") and f"{name[:-6]}.high" in here:
            stated, found = (n[f"{name[:-6]}.high"] - n[name] for n in (here, there))
            if math.isfinite(stated):
                assert 1.0 / ALIKE <= found / stated <= ALIKE, name  # slopes over wide steps are known to this factor
                assert there[name] == pytest.approx(here[name], abs=END * stated / 1.96), name
