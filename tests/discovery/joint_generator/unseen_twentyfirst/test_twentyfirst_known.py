"""The known forms of the twenty-first set at driven joints are finite and seen; nulls move nothing but noise."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from tests.discovery.joint_generator import series_checks, thrown
from tests.discovery.joint_generator.bench import nominal_bench
from tests.discovery.joint_generator.case import Made
from tests.discovery.joint_generator.forms.form import NONE
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, FORCE_AT, FORCE_OF_TIME

from . import PAIRS
from .null import beside

SERIES = series_checks.Series(21)
OWN = [n for n, f in SERIES.forms.items() if f.draw.__module__.rsplit(".", 1)[1] in ("law", "mechanism", "sensor", "null")]
JOINTS = [name for name in SERIES.joints if name in (*OWN, *PAIRS)]
NOT_ONE_BODY_ON_A_LINE = ("load_dependence", "effective_area", "joint_compliance", "backlash", "payload")
UNDRIVEN, NULLS = ([name for name in names if name in OWN] for names in (SERIES.undriven, SERIES.nulls))


def lasting(name: str, duration: float = 12.0, *, strength: float = 1.0, design: str | None = None) -> Made:
    made = SERIES.short(name, strength=strength, design=design)
    return replace(made, nominal=replace(made.nominal, duration=duration), true=replace(made.true, duration=duration))


def test_the_set_is_as_wide_as_asked_for():
    kinds = [SERIES.kinds[name] for name in OWN]
    fourteenth = [kind for kind in series_checks.Series(14).kinds.values() if kind not in ("unknown", NONE)]
    assert sorted(kind for kind in kinds if kind != NONE) == sorted(fourteenth)
    assert (len(fourteenth), kinds.count(NONE), len(set(PAIRS))) == (27, 10, 10)
    assert not (SERIES.misplaced() | set(SERIES.unsourced())) & set(OWN)
    assert not SERIES.repeated_names() & {name.split(".")[1] for name in OWN}


@pytest.mark.parametrize("name", JOINTS)
def test_a_record_is_finite_and_moved_at_half_strength(name):
    made = lasting(name, 8.0, strength=0.5)
    series_checks.assert_finite(made.record(0))
    assert series_checks.columns_moved(made) > 5.0


@pytest.mark.parametrize("name", UNDRIVEN)
def test_undriven_ones_are_finite_long_enough_and_moved_at_half_strength(name):
    record = SERIES.shown(name, strength=0.5)
    series_checks.assert_finite(record)
    assert record["time [s]"].size > 50
    assert SERIES.kinds[name] == NONE or series_checks.undriven_moved(SERIES, name, strength=0.5) > 5.0


@pytest.mark.parametrize("name", NULLS)
def test_a_null_moves_as_believed_and_is_off_by_no_more_than_is_stated(name):
    made = SERIES.short(name, design="slide")
    series_checks.assert_finite(made.record(0))
    series_checks.assert_nothing_is_missing(made)
    assert 200.0 <= made.nominal.rate <= 5000.0


@pytest.mark.parametrize("name", [*OWN, *PAIRS])
def test_the_same_seed_gives_the_same_record_and_no_strength_is_no_effect(name):
    if name in UNDRIVEN:
        series_checks.assert_same(SERIES.shown(name), SERIES.shown(name))
        return
    made = lasting(name, 1.5)
    series_checks.assert_same(made.record(0), replace(made, effects=SERIES.short(name).effects).record(0))
    if name not in NULLS:
        made = lasting(name, 1.5, strength=0.0)
        shown, plain = made.record(0), replace(made, effects=()).record(0)
        series_checks.assert_same({column: shown[column] for column in plain}, plain)


@pytest.mark.parametrize("name", [n for n in JOINTS if "+" not in n and SERIES.kinds[n] not in NOT_ONE_BODY_ON_A_LINE])
def test_energy_is_kept_and_friction_takes_it_alone(name):
    made = SERIES.short(name, design="slide")
    plant, (states, _), step = made.plant(0), made.states(0), 1.0 / made.nominal.rate
    q, v, t = states[:, 0], states[:, 2], np.arange(len(states)) * step
    pulls = np.interp(q, plant.places, plant.by_place[FORCE_AT]) - np.interp(t, plant.times, plant.by_time[FORCE_OF_TIME])
    lost = (states[:, 6] + pulls + plant.body["damping"] * v + plant.body["offset"]) * v
    fed = np.cumsum(0.5 * step * (states[1:, 7] * (v[1:] + v[:-1]) - lost[1:] - lost[:-1]))
    energy = 0.5 * plant.body["inertia"] * v**2
    assert np.abs(energy[1:] - energy[0] - fed).max() < 0.02 * np.ptp(energy)
    assert np.all((states[:, 6] * v)[np.abs(v) > 0.05 * made.nominal.speed] > 0.0)


def test_friction_that_slides_follows_way_turn_and_torque():
    for name, design in (("wear", "slide"), ("static_level", "slide"), ("reducer", "hinge")):
        made = lasting(next(n for n in JOINTS if f".{name}" in n), design=design)
        (states, _), p, level, step = made.states(0), made.effects[0].parameters, made.true.level, 1.0 / made.nominal.rate
        v, since = states[:, 2], np.zeros(len(states))
        for i in range(1, v.size):
            since[i] = 0.0 if v[i] * v[i - 1] <= 0.0 else since[i - 1] + abs(v[i]) * step
        if name == "wear":
            wanted = p["more"] * (1.0 - np.exp(-np.cumsum(np.abs(v)) * step / p["way"]))
        else:
            wanted = p["share"] * np.abs(states[:, 7]) / level if name == "reducer" else p["more"] * np.exp(-since / p["way"])
        seen = (np.abs(v) > 0.2 * made.nominal.speed) & (np.cumsum(v[0] * v < 0.0) > 0)
        assert np.median(np.abs(np.abs(states[:, 6]) / level - 1.0 - wanted)[seen]) < 0.01


def test_friction_follows_the_recorded_temperature_and_a_film_forgets():
    made = lasting("temperature_drift.joint_is_heated_and_aired")
    record, plant = made.record(0), made.plant(0)
    factor = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME])
    np.testing.assert_allclose(factor, 1.9 - 0.03 * record["temperature [degC]"], atol=0.01)
    made = lasting("correlated_coefficients.film_comes_and_goes", 600.0)
    course, lag = made.plant(0).by_time[FACTOR_OF_TIME] - 1.0, round(1e3 * made.effects[0].parameters["time"])
    assert (course.std(), np.corrcoef(course[lag:], course[:-lag])[0, 1]) == pytest.approx((0.3, np.exp(-1.0)), abs=0.1)


def test_a_workpiece_has_the_kinetic_energy_of_a_point_at_the_end():
    made, angles, rates = SERIES.short("payload.workpiece_in_the_gripper"), (0.4, -1.1), np.array([0.7, -1.9])
    n, (one, two), mass = made.nominal.numbers, np.cumsum(angles), made.effects[0].parameters["mass"]
    speed = n["l1"] * rates[0] * np.exp(1j * one) + n["l2"] * rates.sum() * np.exp(1j * two)
    loaded, plain = made.plant(0).body, made.plant(0, with_effects=False).body
    upper, fore, both = (loaded[key] - plain[key] for key in ("inertia", "inertia_2", "coupling"))
    twice = upper * rates[0] ** 2 + fore * rates.sum() ** 2 + 2.0 * both * np.cos(angles[1]) * rates[0] * rates.sum()
    assert twice == pytest.approx(mass * abs(speed) ** 2)


def test_teeth_meet_on_both_flanks():
    made = lasting("backlash.play_of_a_spur_gear")
    between = np.subtract(*made.states(0)[0][:, :2].T) / made.effects[0].parameters["half_gap"]
    assert between.min() < -1.0 < 1.0 < between.max()
    assert np.mean(np.abs(between) > 2.0) < 0.2


def test_a_block_slides_as_far_over_the_oil_as_its_energy_lasts():
    form, rngs = SERIES.forms["position_dependent_friction.oiled_part_of_the_table"], map(np.random.default_rng, (1, 2, 3, 3))
    throw = form.draw(next(rngs), 1.0, nominal_bench("slide", np.random.default_rng(0))).law(next(rngs))
    start, end = next(rngs).uniform(*throw.starts), thrown.record(throw, next(rngs))["position [m]"][-1]
    taken = 9.81 * quad(lambda y: throw.mu(0.0, y), 0.0, end, points=[0.08, 0.2])[0]
    assert np.sqrt(start**2 - 2.0 * taken) == pytest.approx(0.05, abs=0.02)


def test_records_show_what_sensors_are_said_to_do():
    t, rng = np.arange(600_001) / 1e3, np.random.default_rng(4)
    given = {"time [s]": t, "position [m]": t.copy()}
    names = (name for name in JOINTS if "+" not in name and SERIES.forms[name].draw.__module__.endswith("sensor"))
    made = [SERIES.short(name, design="slide") for name in sorted(names)]
    late, off, stale = (m.effects[0].measure(given, rng)["position [m]"] for m in made)
    assert (t - late)[100:] == pytest.approx(made[0].effects[0].parameters["delay"])
    far = (off - t)[off != t] / made[1].nominal.reach
    assert (far.size / t.size, far.std()) == pytest.approx((1.0 / 250.0, 0.07), rel=0.1)
    assert np.mean(np.diff(stale) == 0.0) == pytest.approx(1.0 - np.exp(-5.0 * 0.03), rel=0.1)
    noise = beside({"x": 0.0 * t}, ["x"], 2.0, 0.8, rng)["x"]
    assert (noise.std(), np.corrcoef(noise[1:], noise[:-1])[0, 1]) == pytest.approx((2.0, 0.8), rel=0.03)
