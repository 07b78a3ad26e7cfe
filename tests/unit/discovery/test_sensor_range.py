"""A sensor's end is where a record is level, or bends over while the belt goes on; the top of a smooth motion is none."""

import dataclasses
import math
from types import SimpleNamespace

import numpy as np
import pytest

from stochfric_mb.discovery.stick_slip.belt_speed import belt_speed
from stochfric_mb.discovery.stick_slip.decision.kinematics import bent
from stochfric_mb.discovery.stick_slip.records.record import make_record
from stochfric_mb.discovery.stick_slip.records.sensor_range import reading_curve, sensor_range
from stochfric_mb.discovery.stick_slip.records.slips import extract
from stochfric_mb.discovery.stick_slip.records.stick_phases import analyse
from stochfric_mb.effects import make_effect
from stochfric_mb.laws import make_law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.reference.augmented import Start, augmented_system

BOX = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
LAW = make_law("coulomb", mu_s=0.8, mu_k=0.46)
NOISE = 5e-6


def slips(low: float, high: float, *, box: BeltBox = BOX, effects=(), seed: int = 1, sensor=lambda x: x, step: float = 0.0):
    """Slips of 40 s as a sensor with this range shows them; its noise comes after the range's ends."""
    motion = augmented_system(box, LAW, effects).march(Start(velocity=box.belt_velocity, stick=True), 1e-3, 40_000)
    shown = np.clip(sensor(motion.position), low, high) + NOISE * np.random.default_rng(seed).standard_normal(40_000)
    written = step * np.round(shown / step) if step else shown
    return extract(make_record("run", motion.time, written, box))


def test_both_ends_are_found():
    result = sensor_range([slips(0.7e-3, 2.3e-3)])
    assert result.clipped
    assert result.low == pytest.approx(0.7e-3, abs=2.0 * NOISE)
    assert result.high == pytest.approx(2.3e-3, abs=2.0 * NOISE)


def test_a_mirrored_run_tells_the_lower_end():
    back = dataclasses.replace(BOX, belt_velocity=-BOX.belt_velocity)
    result = sensor_range([slips(-2.3e-3, 2.3e-3), slips(-2.3e-3, 2.3e-3, box=back)])
    assert (result.low, result.high) == pytest.approx((-2.3e-3, 2.3e-3), abs=2.0 * NOISE)


def test_a_whole_motion_has_no_end():
    result = sensor_range([slips(-math.inf, math.inf)])
    assert not result.clipped
    assert (result.low, result.high) == (-math.inf, math.inf)


def test_a_smooth_top_is_no_end():
    """Friction that falls over 0.4 mm lets the box turn round slowly."""
    slow = slips(-math.inf, math.inf, effects=[make_effect("frictional_lag", distance=3e-4)])
    assert not sensor_range([slow]).clipped


def test_a_run_that_goes_on_beyond_refutes_the_end():
    assert not sensor_range([slips(-math.inf, 2.3e-3), slips(-math.inf, math.inf, seed=2)]).clipped


def core(x, begins=1.9e-3, most=0.25e-3):
    """A core that saturates above a place: a hyperbola (O. Froelich 1881)."""
    beyond = np.maximum(x - begins, 0.0) / most
    return np.minimum(x, begins) + most * beyond / (1.0 + beyond)


def whole(**more):
    return slips(-math.inf, math.inf, **more)


def test_a_reading_that_bends_over_is_followed():
    curve = reading_curve([whole(sensor=core)])
    assert curve.bends
    assert curve.share > 0.95
    lower, upper = curve.slopes
    assert lower == pytest.approx(1.0, abs=0.02)
    assert upper == pytest.approx(1.0 / (1.0 + (curve.position[-1] - 1.9e-3) / 0.25e-3) ** 2, abs=0.1)  # its derivative
    # positions are known but for where the belt began, which a sensor never shows
    away = core(curve.position) - curve.reading
    assert np.ptp(away) < 2.0 * NOISE


def test_a_mirrored_run_bends_over_at_the_lower_end():
    back = dataclasses.replace(BOX, belt_velocity=-BOX.belt_velocity)
    curve = reading_curve([whole(box=back, sensor=lambda x: -core(-x))])
    assert curve.bends
    lower, upper = curve.slopes
    assert lower < 0.3
    assert upper == pytest.approx(1.0, abs=0.02)
    both = reading_curve([whole(sensor=lambda x: -core(-x)), whole(box=back, sensor=lambda x: -core(-x))])
    np.testing.assert_allclose(both.slopes, curve.slopes, atol=0.05)


@pytest.mark.parametrize("effects", [
    [], [("presliding_compliance", {"elastic_limit": 3e-5})], [("frictional_lag", {"distance": 3e-4})],
    [("belt_speed_ripple", {"amplitude": 0.3, "frequency": 0.9})], [("dwell_ageing", {"rate": 0.05})],
])  # fmt: skip
def test_what_moves_the_box_bends_no_reading(effects):
    made = [make_effect(kind, **values) for kind, values in effects]
    assert not reading_curve([whole(effects=made)]).bends


@pytest.mark.parametrize("step", [0.02e-3, 0.2e-3])
def test_coarse_readings_bend_nowhere(step):
    curve = reading_curve([whole(step=step)])
    assert not curve.bends


@pytest.mark.parametrize("gain", [0.7, 1.3])
def test_another_gain_is_no_bend(gain):
    assert not reading_curve([whole(sensor=lambda x: gain * x)]).bends


def test_a_sensor_that_hides_a_quarter_is_not_clipped():
    mild = reading_curve([whole(sensor=lambda x: x - 0.25 * np.maximum(x - 1.8e-3, 0.0))])
    assert mild.share > 0.9
    assert mild.slopes[1] == pytest.approx(0.75, abs=0.03)
    assert not mild.bends


def test_hardly_any_stick_tells_nothing():
    few = whole()
    few = dataclasses.replace(few, record=make_record("run", few.record.time[:4000], few.record.position[:4000], BOX))
    assert reading_curve([few]) is None


def test_the_effect_shows_what_the_sensor_shows():
    curve = reading_curve([whole(sensor=core)])
    effect = make_effect("sensor_clipping", **bent(curve))
    assert effect.any_shape
    assert "bends over" in effect.appears()[1]
    true = np.linspace(curve.position[0], curve.position[-1], 400)
    shown = effect.measure(np.zeros(400), true, np.random.default_rng(0))
    assert np.ptp(shown - core(true)) < 3.0 * NOISE  # sixteen pieces round off where it begins to bend
    beyond = effect.measure(np.zeros(1), true[-1:] + 1e-3, np.random.default_rng(0))
    assert beyond[0] == pytest.approx(shown[-1], abs=NOISE)  # the reading has come to its end


@pytest.mark.parametrize(("sensor", "told"), [(core, False), (lambda x: 0.9 * x, True)])
def test_a_reading_that_bends_over_says_nothing_of_the_belt(sensor, told):
    seen = whole(sensor=sensor)
    study = SimpleNamespace(sticking=analyse([seen]), curve=reading_curve([seen]))
    assert (belt_speed(study) is not None) == told
