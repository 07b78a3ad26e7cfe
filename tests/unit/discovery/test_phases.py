"""A pattern is found again in a run that begins anywhere in it, its harmonics with it."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.stick_slip.records.record import Noise, make_record
from stochfric_mb.discovery.stick_slip.records.slips import extract
from stochfric_mb.discovery.stick_slip.simulation.forecast import windows_of
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.phases import in_phase
from stochfric_mb.discovery.stick_slip.simulation.scatter import shown_by
from stochfric_mb.effects import make_effect
from stochfric_mb.laws import make_law
from stochfric_mb.mechanisms import BeltBox

BOX = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
PLAIN = Model(make_law("coulomb", mu_s=0.8, mu_k=0.46), {})
RIPPLES = PLAIN.plus(
    make_effect("normal_load_ripple", amplitude=0.06, frequency=0.31),
    make_effect("normal_load_ripple", amplitude=0.03, frequency=0.93),
)
BELT = PLAIN.plus(make_effect("position_dependent_friction", amplitude=0.05, wavelength=0.011, amplitude_2=0.03, phase_2=0.4))
NOISE = 5e-6


def starting_at(model: Model, phases: tuple[dict[str, float], ...]):
    """Forecasts of 25 s of the model with these phases."""
    time = np.arange(25001) * 1e-3
    blank = extract(make_record("new", time, BOX.belt_velocity * time, BOX), noise=Noise(NOISE))
    true = dataclasses.replace(model, own={"new": phases})
    shown = shown_by(true, blank, np.random.default_rng(0))
    noisy = shown + NOISE * np.random.default_rng(1).standard_normal(time.size)
    return windows_of(extract(make_record("new", time, noisy, BOX)))


@pytest.mark.parametrize("angle", [0.9, 2.8, 5.1])
def test_a_pattern_is_found_with_its_harmonics(angle):
    """The fit run knew them at 0.3 and -0.5; this one has them shifted, the third harmonic three times as far."""
    known = dataclasses.replace(RIPPLES, own={"old": ({"phase": 0.3}, {"phase": -0.5})})
    windows = starting_at(RIPPLES, ({"phase": 0.3 + angle}, {"phase": -0.5 + 3.0 * angle}))
    result = in_phase(known, windows).own["new"]
    away = [result[0]["phase"] - 0.3 - angle, result[1]["phase"] + 0.5 - 3.0 * angle]
    # ten forecasts of a cycle know a ripple of 6 % of the load to about 0.01 rad, one of 3 % to twice that
    np.testing.assert_allclose(np.exp(1j * np.array(away)), 1.0, atol=0.06)


def test_harmonics_of_one_effect_are_shifted_alike():
    windows = starting_at(BELT, ({"phase": 2.0, "phase_2": 4.4},))
    result = in_phase(BELT, windows).own["new"][0]
    away = [result["phase"] - 2.0, result["phase_2"] - 4.4]
    np.testing.assert_allclose(np.exp(1j * np.array(away)), 1.0, atol=0.06)
