"""What effects must and must not do to the motion, on the fast simulator and on the law with effects."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stochfric_mb.contact import Contact
from stochfric_mb.effects import EFFECTS, Effect, effect_class, make_effect
from stochfric_mb.effects.augmented_law import augmented_law
from stochfric_mb.errors import SimulationError
from stochfric_mb.laws import make_law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.reference.augmented import Motion, Start, augmented_system
from stochfric_mb.reference.augmented_model import TEMPERATURES
from tests.unit.effects.examples import NOTHING, example

BOX = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
COULOMB = make_law("coulomb", mu_s=0.8, mu_k=0.46)
WARM = np.linspace(0.0, 5.0, TEMPERATURES), np.full(TEMPERATURES, 30.0)
"""A measured temperature [s, degC]."""
MOVING = [k for k in EFFECTS if effect_class(k).group not in ("sensor", "randomness")]


def _motion(*effects: Effect, box: BeltBox = BOX, count: int = 5000, start: Start | None = None) -> Motion:
    return augmented_system(box, COULOMB, effects, temperature=WARM).march(start or Start(), 1.0e-3, count)


def _break_aways(motion: Motion) -> np.ndarray:
    return motion.events[motion.events[:, 1] == 1.0, 0]


def _at(motion: Motion, times: np.ndarray, values: np.ndarray) -> np.ndarray:
    return np.interp(times, motion.time, values)


@pytest.mark.parametrize("kind", MOVING)
def test_nothing_changes_nothing(kind: str) -> None:
    plain = _motion()
    same = _motion(example(kind, **NOTHING[kind]))
    # Steps differ where an effect brings in a time scale, so the two agree to the simulator's own error, 0.02 um. A lag
    # of 1e-12 m is not quite nothing: a slip grows out of balance at the rate sqrt((mu_s - mu_k) N/(m distance)) =
    # 8.5e5/s and takes some 25 e-folds, 30 us, so that five slips at up to 0.04 m/s are late by up to 6 um.
    assert np.abs(same.position - plain.position).max() < (6.0e-6 if kind == "frictional_lag" else 2.0e-8)


UNSEEN_HERE = {"direction_asymmetry"} | {
    k for k in MOVING if set(effect_class(k).reads) & {"drive", "pressure"} or example(k).moves_load
}
"""One direction only, neither drive nor pressure, and no motor."""


@pytest.mark.parametrize("kind", [k for k in MOVING if k not in UNSEEN_HERE])
def test_something_changes_the_motion(kind: str) -> None:
    assert np.abs(_motion(example(kind)).position - _motion().position).max() > 1.0e-6


def _last_onset(*effects: Effect, box: BeltBox = BOX) -> float:
    """Return the position at the last break-away [m]."""
    motion = _motion(*effects, box=box)
    return float(_at(motion, _break_aways(motion), motion.position)[-1])


def test_documented_senses() -> None:
    plain = _last_onset()
    assert _last_onset(example("dwell_ageing")) > plain  # stronger after a stick
    assert _last_onset(example("load_dependence")) < plain  # 13 N is above the reference load, exponent negative
    assert _last_onset(example("nonlinear_stiffness")) < plain  # a stiffer spring gives the same force earlier
    assert _last_onset(example("backlash")) > plain  # the gap adds to the stretch
    assert _last_onset(example("friction_drift")) > plain
    assert _last_onset(example("direction_asymmetry")) == plain  # the belt runs forwards
    backwards = dataclasses.replace(BOX, belt_velocity=-2.5e-3)
    assert _last_onset(example("direction_asymmetry"), box=backwards) < -plain  # 10 % more, negative


def _travel_of_slips(*effects: Effect) -> float:
    """Return the mean distance on which the box slides back [m]."""
    motion = _motion(*effects)
    samples = (_break_aways(motion)[1:] * 1.0e3).astype(int)
    x = motion.position
    return float(np.median([x[i - 5 : i + 5].max() - x[i : i + 200].min() for i in samples if i + 200 < len(x)]))


def test_friction_while_sliding_shortens_the_slip() -> None:
    plain = _travel_of_slips()
    for kind in ("viscous_friction", "velocity_weakening", "quadratic_damping"):
        assert _travel_of_slips(example(kind)) < plain, kind


def test_ripple_of_the_belt_shows_in_stick() -> None:
    motion = _motion(example("belt_speed_ripple"))
    stuck = motion.stick == 1.0
    v_b = 2.5e-3 * (1.0 + 0.03 * np.cos(2.0 * math.pi * 5.0 * motion.time + 1.0))
    np.testing.assert_allclose(motion.velocity[stuck], v_b[stuck], rtol=1.0e-12)


def test_ripple_of_the_load_shows_in_the_normal_force() -> None:
    motion = _motion(example("normal_load_ripple"))
    expected = 13.0 * (1.0 + 0.03 * np.cos(2.0 * math.pi * 5.0 * motion.time + 1.0))
    np.testing.assert_allclose(motion.normal_force, expected, rtol=1.0e-12)


def test_second_mode_rings_at_its_frequency_when_nothing_else_moves() -> None:
    """A box held by friction on a belt at rest; the oscillator's memory starts displaced, its damping is as stated."""
    box = dataclasses.replace(BOX, belt_velocity=0.0)
    system = augmented_system(box, COULOMB, [example("second_mode", damping_ratio=0.05)])
    start = Start(stick=True, memory=(1.0e-4, 0.0))
    motion = system.march(start, 1.0e-4, 5000)
    assert np.all(motion.stick == 1.0)
    w, zeta = 2.0 * math.pi * 20.0, 0.05
    wd = w * math.sqrt(1.0 - zeta**2)
    q = 1.0e-4 * np.exp(-zeta * w * motion.time) * (np.cos(wd * motion.time) + zeta * w / wd * np.sin(wd * motion.time))
    dq = np.gradient(q, motion.time)
    held = -0.05 * 6.08 * (w * w * q + 2.0 * zeta * w * dq)  # friction holds the box against the oscillator
    # central differences: (w dt)^2/6 of a small part of the force
    assert np.abs(motion.friction_force - held)[1:-1].max() < 1.0e-5 * np.abs(held).max()


DISSIPATIVE = [
    "viscous_friction", "velocity_weakening", "dwell_ageing", "frictional_lag", "direction_asymmetry", "load_dependence",
    "presliding_compliance", "position_dependent_friction", "friction_drift", "normal_load_ripple",
]  # fmt: skip


@pytest.mark.parametrize("kind", DISSIPATIVE)
@given(
    speed=st.floats(1.0e-6, 1.0).flatmap(lambda v: st.sampled_from([v, -v])),
    position=st.floats(-0.1, 0.1),
    time=st.floats(0.0, 10.0),
)
@settings(max_examples=30, deadline=None)
def test_friction_with_an_effect_never_drives(kind: str, speed: float, position: float, time: float) -> None:
    """While sliding, the friction force is along v_rel: F v_rel > 0."""
    system = augmented_system(BOX, COULOMB, [example(kind)], temperature=WARM)
    start = Start(time=time, position=position, velocity=BOX.belt_velocity - speed)
    force = system.at(start).friction_force[0]
    assert force * speed > 0.0


@pytest.mark.parametrize("kind", ["quadratic_damping", "backlash", "second_mode", "nonlinear_stiffness", "viscous_friction"])
def test_free_motion_gains_no_energy(kind: str) -> None:
    """On a belt at rest, next to no friction: spring and kinetic energy (with the oscillator's) never rises."""
    box = dataclasses.replace(BOX, belt_velocity=0.0)
    weak = make_law("coulomb", mu_s=1.0e-3, mu_k=1.0e-3)
    effect = example(kind)
    system = augmented_system(box, weak, [effect])
    energies = []
    state = Start(position=3.0e-3)
    for _ in range(100):
        motion = system.march(state, 1.0e-3, 10)
        state = motion.end
        energies.append(_energy(box, effect, state))
    assert np.all(np.diff(energies) < 1.0e-9 * energies[0])


def _energy(box: BeltBox, effect: Effect, state: Start) -> float:
    x, v = state.position, state.velocity
    energy = 0.5 * box.mass * v * v + 0.5 * box.stiffness * x * x
    values = effect.to_dict()
    if effect.kind == "nonlinear_stiffness":
        energy += 0.25 * values["cubic"] * x**4
    if effect.kind == "backlash":
        over, gap = x - values["position"], values["gap"]
        energy -= box.stiffness * (0.0 if over < 0.0 else 0.5 * over**2 if over < gap else gap * over - 0.5 * gap**2)
    if effect.kind == "second_mode":
        q, w = state.memory or (0.0, 0.0)
        mass = values["mass_ratio"] * box.mass
        energy += 0.5 * mass * w * w + 0.5 * mass * (2.0 * math.pi * values["frequency"]) ** 2 * (q - x) ** 2
    return energy


@pytest.mark.parametrize("kind", MOVING)
def test_restart_goes_on_as_before(kind: str) -> None:
    system = augmented_system(BOX, COULOMB, [example(kind)], temperature=WARM)
    whole = system.march(Start(), 1.0e-3, 3000)
    first = system.march(Start(), 1.0e-3, 1500)
    second = system.march(first.end, 1.0e-3, 1500)
    both = np.concatenate([first.position, second.position])
    assert np.abs(both - whole.position).max() < 1.0e-7  # the steps differ after the restart


def test_restart_within_a_slip_keeps_the_time_since_break_away() -> None:
    system = augmented_system(BOX, COULOMB, [make_effect("frictional_lag", time_constant=0.05)])
    whole = system.march(Start(), 1.0e-3, 3000)
    slipping = int(np.flatnonzero((whole.time > 1.0) & (whole.stick == 0.0))[20])
    first = system.march(Start(), 1.0e-3, slipping)
    assert 0.015 < first.end.slip_time < 0.025
    second = system.march(first.end, 1.0e-3, 3000 - slipping)
    assert np.abs(second.position - whole.position[slipping:]).max() < 1.0e-7  # the steps differ after the restart


def test_forecasts_are_marches() -> None:
    system = augmented_system(BOX, COULOMB, [example("dwell_ageing"), example("friction_drift")])
    motion = system.march(Start(), 1.0e-3, 4000)
    states = [system.march(Start(), 1.0e-3, n).end for n in (1500, 2700)]
    starts = [(s.time, s.position, s.velocity, float(s.stick), s.dwell) for s in states]
    paths = system.forecasts(starts, 1.0e-3, 1000)
    for path, n in zip(paths, (1500, 2700), strict=True):
        np.testing.assert_allclose(path, motion.position[n : n + 1000], atol=1.0e-9)


@pytest.mark.parametrize("inner", ["elastic_stick", "havsin"])
def test_law_with_nothing_is_the_law_inside(inner: str) -> None:
    law = make_law(inner, mu_s=0.8, mu_k=0.46)
    nothing = [example(k, **NOTHING[k]) for k in MOVING if k not in ("frictional_lag", "presliding_compliance")]
    with_nothing = augmented_law(law, BOX, nothing)
    contacts = [Contact(each, effective_mass=6.08, dt=1.0e-3) for each in (law, with_nothing)]
    for contact in contacts:
        contact.start(0.0, 0.0, 2.5e-3, 13.0)
    for i in range(1, 200):
        t, u, v = i * 1.0e-3, 1.0e-5 * math.sin(0.1 * i), 1.0e-3 * math.cos(0.1 * i)
        forces = [contact.force(t, u, v, 13.0) for contact in contacts]
        # x and x' are found from u and v and back, which costs rounding on the stiff spring
        assert forces[1] == pytest.approx(forces[0], abs=1.0e-8)
        for contact in contacts:
            contact.commit(t, u, v, 13.0)


def test_a_box_thrown_out_by_its_spring_is_an_error() -> None:
    softening = make_effect("nonlinear_stiffness", cubic=-6.0e9)
    system = augmented_system(BOX, COULOMB, [softening])
    with pytest.raises(SimulationError, match="not finite"):
        system.march(Start(position=-3.0e-3, velocity=-0.1), 1.0e-3, 3000)
    # up to here its stiffness is positive, and beyond it stays so
    held = make_effect("nonlinear_stiffness", cubic=-6.0e9, reach=4.0e-4)
    motion = augmented_system(BOX, COULOMB, [held]).march(Start(position=-3.0e-3, velocity=-0.1), 1.0e-3, 3000)
    assert np.isfinite(motion.position).all()


@pytest.mark.parametrize(
    ("kind", "numbers"),
    [
        ("friction_drift", {"rate": -0.5}),
        ("position_dependent_friction", {"amplitude": 1.6, "wavelength": 1.0e-3}),
        (
            "load_dependence",
            {"exponent": 0.0, "reference_load": 13.0, "course": -1.5, "course_1": 1.0, "at_begin": 2.0, "span": 100.0},
        ),
    ],
)
def test_coefficients_that_would_turn_friction_round_are_none(kind: str, numbers: dict[str, float]) -> None:
    """A drift of -1.5 drove the box with 4 W."""
    motion = _motion(make_effect(kind, **numbers))
    relative = BOX.belt_velocity - motion.velocity
    assert (motion.friction_force * relative).min() >= -1.0e-12  # rounding of a speed in stick
    assert np.abs(motion.friction_force).min() < 1.0e-9  # for some of the time there is none


def test_nor_does_a_law_in_an_engine_drive() -> None:
    law = augmented_law(make_law("elastic_stick", mu_s=0.8, mu_k=0.46), BOX, [make_effect("friction_drift", rate=-0.5)])
    contact = Contact(law, effective_mass=6.08, dt=1.0e-3)
    contact.start(0.0, 0.0, 0.1, 13.0)
    assert contact.force(0.0, 0.0, 0.1, 13.0) > 1.0
    assert contact.force(4.0, 0.4, 0.1, 13.0) == pytest.approx(0.0, abs=1.0e-12)
