"""The fast simulator against a second, slow one that shares no code with it."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from stochfric_mb.effects import make_effect
from stochfric_mb.laws import make_law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.reference.augmented import Start, augmented_system
from tests.physics.independent_belt_box import Box, simulate
from tests.unit.effects.examples import example

CASES = {
    "velocity_weakening": {"amplitude": 0.05, "decay_velocity": 5.0e-3},
    "viscous_friction": {"coefficient": 8.0},
    "dwell_ageing": {"rate": 0.02, "time_constant": 0.1},
    "frictional_lag": {"distance": 1.0e-4},
    "direction_asymmetry": {"asymmetry": -0.1, "viscous_difference": -3.0},
    "load_dependence": {"exponent": -0.2, "reference_load": 10.0, "adhesion": 4.0},
    "position_dependent_friction": {
        "amplitude": 0.04, "wavelength": 0.01, "phase": 0.7, "axis": "belt", "amplitude_2": 0.01, "phase_2": 1.0,
        "amplitude_3": 0.005, "phase_3": -0.5,
    },
    "position_dependent_force": {
        "stiffness": 200.0, "cubic": 3.0e7, "zero": 1.0e-3, "amplitude": 0.3, "wavelength": 2.0e-3, "phase": 0.4,
        "amplitude_2": 0.1, "phase_2": 1.0,
    },
    "friction_drift": {"rate": 0.01, "time_constant": 4.0},
    "distance_drift": {"rate": 5.0, "settling_distance": 0.02},
    "normal_load_ripple": {"amplitude": 0.05, "frequency": 3.3, "phase": 0.3},
    "belt_speed_ripple": {"amplitude": 0.1, "frequency": 1.7, "phase": -0.4},
    "nonlinear_stiffness": {"cubic": 1.0e8, "quadratic": -3.0e5, "reach": 2.0e-3},
    "quadratic_damping": {"coefficient": 60.0},
    "backlash": {"gap": 2.0e-4, "position": 1.0e-3, "share_below": 0.3},
    "second_mode": {"mass_ratio": 0.05, "frequency": 12.0, "damping_ratio": 0.02},
    "harmonic_force": {"amplitude": 0.4, "frequency": 2.3, "phase": 0.2},
    "unnamed": {
        "axis": "position", "low": 1.5e-3, "high": 2.9e-3, "static_share": 0.6, "change_1": 0.01, "change_2": 0.03,
        "change_3": 0.02, "change_4": 0.04, "change_5": 0.05, "change_6": 0.02,
    },
}  # fmt: skip
TIMES = np.arange(1, 4001) * 1.0e-3
TOLERANCE = 2.0e-8
"""[m]. The second simulator finds events to about 1e-10 s at 0.04 m/s and integrates to 1e-10 of 3 mm; the fast one
works to 1e-8 of the static deflection, 2.6e-11 m a step, some hundred steps."""
KINKED = 1.0e-7
"""[m]. Where a force has a kink (the edges of a gap, the knots of a table) the order falls, so that an error estimate is
itself rougher; still below the 0.1 um that any use of the fast simulator asks for."""


def _both(terms: dict[str, dict[str, float]], belt: float = 2.5e-3) -> tuple[np.ndarray, np.ndarray]:
    box = Box(terms=terms, vb=belt)
    mechanism = BeltBox(mass=box.m, damping=box.c, stiffness=box.k, normal_force=box.N, belt_velocity=box.vb)
    effects = [make_effect(kind, **values) for kind, values in terms.items()]
    system = augmented_system(mechanism, make_law("coulomb", mu_s=box.mu_s, mu_k=box.mu_k), effects)
    fast = system.march(Start(), 1.0e-3, len(TIMES))
    return fast.position, simulate(box, TIMES)


@pytest.mark.parametrize("kind", CASES)
def test_one_effect(kind: str) -> None:
    fast, slow = _both({kind: CASES[kind]})
    assert np.abs(fast - slow).max() < (KINKED if kind in ("backlash", "unnamed") else TOLERANCE)


@pytest.mark.parametrize("values", [{"time_constant": 0.02}, {"distance": 2.0e-4, "time_constant": 0.02}])
def test_lag_in_time(values: dict[str, float]) -> None:
    fast, slow = _both({"frictional_lag": values})
    assert np.abs(fast - slow).max() < TOLERANCE


@pytest.mark.parametrize("form", [{"tail": 1.0}, {"tail": 0.5, "shape_exponent": 2.0}, {"shape_exponent": 0.7}])
def test_a_fall_with_speed_of_other_forms(form: dict[str, float]) -> None:
    fast, slow = _both({"velocity_weakening": CASES["velocity_weakening"] | form})
    assert np.abs(fast - slow).max() < TOLERANCE


@pytest.mark.parametrize("kind", ["direction_asymmetry", "position_dependent_friction", "dwell_ageing"])
def test_reversed_belt(kind: str) -> None:
    fast, slow = _both({kind: CASES[kind]}, belt=-2.5e-3)
    assert np.abs(fast - slow).max() < TOLERANCE


def test_many_effects_at_once() -> None:
    fast, slow = _both(CASES)
    assert np.abs(fast - slow).max() < KINKED


def test_position_axis() -> None:
    values = {**CASES["position_dependent_friction"], "axis": "position", "wavelength": 2.0e-3}
    fast, slow = _both({"position_dependent_friction": values})
    assert np.abs(fast - slow).max() < TOLERANCE


def test_cases_cover_the_effects_that_move_the_box() -> None:
    from stochfric_mb.effects import EFFECTS, effect_class

    # what reads a temperature, a pressure or a drive needs a record of it; a load that moves behind its motor needs one
    of_joints = {k for k in EFFECTS if effect_class(k).reads or example(k).moves_load}
    covered_elsewhere = {"impacts", "presliding_compliance"} | of_joints
    moving = {k for k in EFFECTS if effect_class(k).group not in ("sensor", "randomness")}
    assert moving == set(CASES) | covered_elsewhere
    for kind, values in CASES.items():
        assert {f.name for f in dataclasses.fields(effect_class(kind))} >= set(values)


def test_a_table_that_is_a_force_is_half_a_coefficient_under_twice_the_load() -> None:
    box = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=26.0, belt_velocity=2.5e-3)
    law = make_law("coulomb", mu_s=0.8, mu_k=0.46)
    changes = {"change_1": 0.02, "change_2": 0.03, "change_3": -0.01, "change_6": 0.04}
    table = {"axis": "speed", "low": 0.0, "high": 0.1}
    force = make_effect("unnamed", **table, **changes, reference_load=13.0)
    half = make_effect("unnamed", **table, **{name: 0.5 * value for name, value in changes.items()})
    paths = [augmented_system(box, law, [e]).march(Start(), 1.0e-3, len(TIMES)).position for e in (force, half)]
    assert np.ptp(paths[0]) > 1.0e-3
    np.testing.assert_allclose(*paths, rtol=0.0, atol=TOLERANCE)
