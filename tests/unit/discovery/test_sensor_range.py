"""A sensor's end is where a record is level; the top of a smooth motion is none."""

import dataclasses
import math

import numpy as np
import pytest

from stochfric_mb.discovery.stick_slip.records.record import make_record
from stochfric_mb.discovery.stick_slip.records.sensor_range import sensor_range
from stochfric_mb.discovery.stick_slip.records.slips import extract
from stochfric_mb.effects import make_effect
from stochfric_mb.laws import make_law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.reference.augmented import Start, augmented_system

BOX = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
LAW = make_law("coulomb", mu_s=0.8, mu_k=0.46)
NOISE = 5e-6


def slips(low: float, high: float, *, box: BeltBox = BOX, effects=(), seed: int = 1):
    """Slips of 40 s as a sensor with this range shows them; its noise comes after the range's ends."""
    motion = augmented_system(box, LAW, effects).march(Start(velocity=box.belt_velocity, stick=True), 1e-3, 40_000)
    shown = np.clip(motion.position, low, high) + NOISE * np.random.default_rng(seed).standard_normal(40_000)
    return extract(make_record("run", motion.time, shown, box))


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
