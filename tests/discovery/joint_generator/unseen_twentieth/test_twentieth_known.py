"""The known forms of the twentieth set at driven joints are finite and seen; nulls move nothing but noise."""

from dataclasses import replace

import numpy as np
import pytest

from tests.discovery.joint_generator import series_checks
from tests.discovery.joint_generator.case import Made
from tests.discovery.joint_generator.forms.form import NONE
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, FORCE_AT, FORCE_OF_TIME

from . import PAIRS
from .null import flicker
from .sensor import lost_in_bursts

SERIES = series_checks.Series(20)
OWN = [n for n, f in SERIES.forms.items() if f.draw.__module__.rsplit(".", 1)[1] in ("law", "mechanism", "sensor", "null")]
JOINTS = [name for name in SERIES.joints if name in (*OWN, *PAIRS)]
NOT_ONE_BODY_ON_A_LINE = ("load_dependence", "effective_area", "joint_compliance", "backlash")
UNDRIVEN, NULLS = ([name for name in names if name in OWN] for names in (SERIES.undriven, SERIES.nulls))


def lasting(made: Made, duration: float) -> Made:
    return replace(made, nominal=replace(made.nominal, duration=duration), true=replace(made.true, duration=duration))


def sliding(name: str, design: str = "slide") -> tuple[Made, np.ndarray, np.ndarray, np.ndarray]:
    made = lasting(SERIES.short(name, design=design), 12.0)
    states, _ = made.states(0)
    return made, states, np.abs(states[:, 6]) / made.true.level, np.abs(states[:, 2]) > 0.2 * made.nominal.speed


def test_the_set_is_as_wide_as_asked_for():
    kinds = [SERIES.kinds[name] for name in OWN]
    fourteenth = [kind for kind in series_checks.Series(14).kinds.values() if kind not in ("unknown", NONE)]
    assert sorted(kind for kind in kinds if kind != NONE) == sorted(fourteenth)
    assert (len(fourteenth), kinds.count(NONE), len(set(PAIRS))) == (27, 10, 10)
    assert not (SERIES.misplaced() | set(SERIES.unsourced())) & set(OWN)
    assert not SERIES.repeated_names() & {name.split(".")[1] for name in OWN}


@pytest.mark.parametrize("name", JOINTS)
def test_a_record_is_finite_and_moved_at_half_strength(name):
    made = lasting(SERIES.short(name, strength=0.5), 8.0)
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
    made = lasting(SERIES.short(name), 1.5)
    series_checks.assert_same(made.record(0), replace(made, effects=SERIES.short(name).effects).record(0))
    if name not in NULLS:
        made = lasting(SERIES.short(name, strength=0.0), 1.5)
        shown, plain = made.record(0), replace(made, effects=()).record(0)
        series_checks.assert_same({column: shown[column] for column in plain}, plain)


@pytest.mark.parametrize("name", [n for n in JOINTS if "+" not in n and SERIES.kinds[n] not in NOT_ONE_BODY_ON_A_LINE])
def test_energy_is_kept_and_friction_takes_it_alone(name):
    made = SERIES.short(name, design="slide")
    plant, (states, _) = made.plant(0), made.states(0)
    q, v, t, step = states[:, 0], states[:, 2], np.arange(len(states)) / made.nominal.rate, 1.0 / made.nominal.rate
    pulls = np.interp(q, plant.places, plant.by_place[FORCE_AT]) - np.interp(t, plant.times, plant.by_time[FORCE_OF_TIME])
    lost = (states[:, 6] + pulls + plant.body["damping"] * v + plant.body["offset"]) * v
    fed = np.cumsum(states[1:, 7] * 0.5 * (v[1:] + v[:-1]) * step - 0.5 * (lost[1:] + lost[:-1]) * step)
    energy = 0.5 * plant.body["inertia"] * v**2
    assert np.abs(energy[1:] - energy[0] - fed).max() < 0.02 * np.ptp(energy)
    assert np.all((states[:, 6] * v)[np.abs(v) > 0.05 * made.nominal.speed] > 0.0)


def test_friction_over_the_speed_is_what_the_literature_says():
    u = np.array([0.0, 0.1, 0.5, 1.0])
    shapes = {
        "viscous_friction.full_film_of_a_bush": lambda p, b: p["size"] * u,
        "viscous_friction.grease_that_yields": lambda p, b: p["size"] * u ** p["power"],
        "velocity_weakening.mixed_film_at_low_speed": lambda p, b: p["size"] * np.exp(-u * b.speed / p["knee"]),
        "direction_asymmetry.wiper_leans_one_way": lambda p, b: p["size"] + 0.0 * u,
        "quadratic_damping.paddle_in_a_tank": lambda p, b: p["size"] * u * u,
    }
    for name, shape in shapes.items():
        made = SERIES.short(name)
        plant, wanted = made.plant(0), shape(made.effects[0].parameters, made.nominal)
        ways = [np.interp(u * made.nominal.speed, plant.speeds, row) for row in plant.by_speed]
        back = -1.0 if name.startswith("direction") else 1.0
        np.testing.assert_allclose(ways, [wanted, back * wanted], atol=2e-3 * made.nominal.level)


def test_a_liner_runs_in_by_the_way_and_junctions_are_renewed_at_turns():
    made, states, level, quick = sliding("distance_drift.asperities_run_in")
    gone, p = np.cumsum(np.abs(states[:, 2])) / made.nominal.rate, made.effects[0].parameters
    np.testing.assert_allclose(level[quick], 1.0 - 0.5 * (1.0 - np.exp(-gone / p["way"]))[quick], atol=0.01)
    made, states, level, quick = sliding("frictional_lag.junctions_renew_at_a_turn")
    v, p, since = states[:, 2], made.effects[0].parameters, np.zeros(len(states))
    for i in range(1, v.size):
        since[i] = 0.0 if v[i] * v[i - 1] <= 0.0 else since[i - 1] + abs(v[i]) / made.nominal.rate
    quick &= np.cumsum(v[0] * v < 0.0) > 0
    np.testing.assert_allclose(level[quick], 1.0 + 0.9 * np.exp(-since / p["way"])[quick], atol=0.03)


def test_teeth_rub_by_the_torque_that_they_carry():
    made, states, level, quick = sliding("load_dependence.teeth_bear_the_torque", "hinge")
    more = (level - 1.0) * made.true.level / np.maximum(np.abs(states[:, 7]), 0.1 * made.true.level)
    quick &= np.abs(states[:, 7]) > made.true.level
    assert more[quick] == pytest.approx(made.effects[0].parameters["share"], abs=0.02)


def test_friction_follows_what_is_recorded_of_the_oil_and_debris_forgets():
    made = lasting(SERIES.short("temperature_drift.oil_thins_as_reynolds_said", design="slide"), 12.0)
    record, plant = made.record(0), made.plant(0)
    factor = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME])
    np.testing.assert_allclose(np.log(factor), -0.04 * (record["temperature [degC]"] - 34.0), atol=0.012)
    made = lasting(SERIES.short("correlated_coefficients.third_body_comes_and_goes"), 400.0)
    course, lag = made.plant(0).by_time[FACTOR_OF_TIME] - 1.0, round(made.effects[0].parameters["time"] * 1e3)
    assert course.std() == pytest.approx(0.25, rel=0.1)
    assert np.corrcoef(course[lag:], course[:-lag])[0, 1] == pytest.approx(np.exp(-1.0), abs=0.1)


def test_records_show_what_sensors_are_said_to_do():
    made = lasting(SERIES.short("sensor_outliers.one_bit_of_a_word_flips"), 12.0)
    shown, plain = (next(x for n, x in m.record(0).items() if "position" in n) for m in (made, replace(made, effects=())))
    off = np.abs((shown - plain)[shown != plain]) / made.effects[0].parameters["least"]
    assert off == pytest.approx(2.0 ** np.round(np.log2(off)))
    assert (off.size / plain.size, off.max(), off.min()) == pytest.approx((1.0 / 300.0, 8.0, 1.0), rel=0.4)
    lost = lost_in_bursts(np.random.default_rng(5), 400_000, 0.004, 1.0 / 30.0)
    assert lost.mean() == pytest.approx(30.0 / 280.0, rel=0.1)
    assert np.sum(np.diff(lost.astype(int)) == 1) == pytest.approx(400_000 / 280.0, rel=0.1)
    power = np.abs(np.fft.rfft(flicker(np.random.default_rng(6), 100_000))) ** 2
    assert power[10:100].mean() / power[1000:10_000].mean() == pytest.approx(100.0, rel=0.3)
