"""Extraction on the closed form of undamped stick-slip, and Legendre coefficients of polynomials."""

import dataclasses
import math

import numpy as np
import pytest
from numpy.polynomial import legendre

from stochfric_mb.discovery.stick_slip.records.edges import IF_BETTER, locate_edge
from stochfric_mb.discovery.stick_slip.records.record import make_record
from stochfric_mb.discovery.stick_slip.records.slips import N_MOMENTS, NODES, extract, features_near, legendre_coefficients
from stochfric_mb.effects import make_effect
from stochfric_mb.laws import make_law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.reference.augmented import Start, augmented_system

BOX = BeltBox(mass=6.08, damping=0.0, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
MU_S, MU_K = 0.8, 0.46
OMEGA = math.sqrt(BOX.stiffness / BOX.mass)
JUMP = (MU_S - MU_K) * BOX.normal_force / BOX.stiffness
SLIP = 2.0 * (math.pi - math.atan(OMEGA * JUMP / BOX.belt_velocity)) / OMEGA
PERIOD = SLIP + 2.0 * JUMP / BOX.belt_velocity
NOISE = 5e-6


def stick_slip(time: np.ndarray, first_onset: float) -> np.ndarray:
    """Position [m]: a circle in (x - x_k, v/omega) while slipping, the belt's line while sticking."""
    since = np.mod(time - first_onset, PERIOD)
    centre = MU_K * BOX.normal_force / BOX.stiffness
    slip = centre + JUMP * np.cos(OMEGA * since) + BOX.belt_velocity / OMEGA * np.sin(OMEGA * since)
    return np.where(since < SLIP, slip, centre - JUMP + BOX.belt_velocity * (since - SLIP))


@pytest.fixture(scope="module")
def slips():
    time = np.arange(60001) * 1e-3
    position = stick_slip(time, 0.6543) + NOISE * np.random.default_rng(5).standard_normal(time.size)
    return extract(make_record("run", time, position, BOX))


def test_every_slip_is_found_where_it_is(slips):
    numbers = np.round((slips.onset_time - 0.6543) / PERIOD)
    assert np.all(np.diff(numbers) == 1)
    assert len(slips) >= 60.0 / PERIOD - 2  # those at the ends may be cut
    # a time is uncertain by what a take-off needs to leave the noise: J (w t)^2/2 = 5 um after 4 ms
    np.testing.assert_allclose(slips.onset_time, 0.6543 + PERIOD * numbers, atol=4e-3)
    np.testing.assert_allclose(slips.restick_time - slips.onset_time, SLIP, atol=8e-3)


def test_onset_force_is_the_static_friction(slips):
    scatter = np.std(slips.onset_force)
    assert scatter < BOX.stiffness * NOISE  # better than a single sample
    assert np.mean(slips.onset_force) == pytest.approx(MU_S * BOX.normal_force, abs=4.0 * scatter / len(slips) ** 0.5)


def quadrature_error(order: int) -> float:
    """What the trapezoidal rule adds to a coefficient [N]: h^2/12 times the rise of the integrand's slope."""
    rate = 2.0 / SLIP
    polynomial = np.eye(N_MOMENTS)[order]
    kernel = BOX.mass * rate**2 * np.pad(legendre.legder(polynomial, 2), (0, 2))[:N_MOMENTS] + BOX.stiffness * polynomial
    ends = (-1.0, stick_slip(np.zeros(1), 0.0)[0]), (1.0, stick_slip(np.array([SLIP]), 0.0)[0])
    slopes = [
        rate * legendre.legval(u, legendre.legder(kernel)) * x + legendre.legval(u, kernel) * BOX.belt_velocity for u, x in ends
    ]
    return 1e-6 / 12.0 * (slopes[1] - slopes[0]) * (2 * order + 1) / SLIP


def test_slip_force_is_the_kinetic_friction_and_constant(slips):
    """Apart from the quadrature, which calibration takes out: nothing in the mean force, 0.7 N in the sixth order."""
    errors = 4.0 * np.std(slips.moments, axis=0) / len(slips) ** 0.5
    quadrature = np.array([quadrature_error(q) for q in range(N_MOMENTS)])
    expected = np.r_[MU_K * BOX.normal_force, np.zeros(N_MOMENTS - 1)] + quadrature
    # the first and the last interval are shorter than h, and over h/2 the integrand's slope changes by up to
    # (h/2) (2/T) 3.75 = 3 % at each end
    allowed = errors + 0.06 * np.abs(quadrature)
    assert np.all(np.abs(np.mean(slips.moments, axis=0) - expected) < allowed), np.mean(slips.moments, axis=0) - expected
    assert allowed[0] < 0.01  # the mean slip force of a minute is known to a fifth of a per cent


def test_noise_of_the_stick_phases_is_seen(slips):
    assert slips.noise.deviation == pytest.approx(NOISE, rel=4.0 / (2.0 * 40000) ** 0.5 + 0.01)
    assert slips.noise.coloured == 0.0


@pytest.mark.parametrize("off", [-0.02, 0.0, 0.02])
@pytest.mark.parametrize("side", [1, -1], ids=["break-away", "re-stick"])
def test_an_edge_is_found_from_further_off_than_the_first_places_reach(side: int, off: float):
    """They reach 16 ms into the stick and 10 ms into the slip."""
    time = np.arange(2001) * 1e-3
    true = 0.6543 if side > 0 else 0.6543 + SLIP
    index = round((true + off) / 1e-3)
    firm = 0.1  # as extraction has it where the force is constant
    edge, position, _, _, far = locate_edge(
        stick_slip(time, 0.6543),
        time,
        BOX.belt_velocity,
        index,
        side,
        OMEGA,
        round(3.06e3 / OMEGA),
        round(1.07e3 / OMEGA),
        firm,
        0.0,
        0.0,
        IF_BETTER,
    )
    assert far == (off != 0.0)
    assert edge == pytest.approx(true, abs=1e-4)  # a tenth of a sample
    assert position == pytest.approx(stick_slip(np.array([true + 1e-9]), 0.6543)[0], abs=BOX.belt_velocity * 1e-4)


@pytest.mark.parametrize("angle", [2.0, 3.0])
def test_what_is_beyond_a_short_stick_moves_no_edge(angle: float):
    """Sticks shorter than half a period, undamped: forces at break-away were off by 0.6 % where the stick turns by 2 rad."""
    belt = 2.0 * JUMP * OMEGA / angle  # the stick lasts 2 jump/v_b
    box = dataclasses.replace(BOX, belt_velocity=belt)
    system = augmented_system(box, make_law("coulomb", mu_s=MU_S, mu_k=MU_K))
    step = 2.0 * math.pi / OMEGA / 120
    motion = system.march(Start(0.0, 0.0, belt, stick=True), step, 60 * 200)
    half = 0.5 * np.ptp(motion.position)
    noisy = motion.position + half / 300 * np.random.default_rng(1).standard_normal(len(motion.time))
    result = extract(make_record("run", motion.time, noisy, box))
    assert len(result) > 50
    # a quarter of a sample is what noise leaves of an edge; the force at break-away is then off by 0.4 % at most
    true = motion.events[motion.events[:, 1] == 1.0, 0]
    away = result.onset_time - true[np.argmin(np.abs(result.onset_time[:, None] - true), axis=1)]
    assert abs(away.mean()) < 0.25 * step
    assert np.mean(result.onset_force) == pytest.approx(MU_S * box.normal_force, rel=4e-3)


def test_edges_of_a_simulated_slip_are_where_those_of_the_measured_ones_are():
    """Friction that falls from mu_s without a step, on a rig 6 % softer than believed: edges were sought earlier."""
    box = BeltBox(mass=0.01, stiffness=3950.0, damping=0.08, normal_force=1.5, belt_velocity=0.05)
    fall = make_effect("velocity_weakening", amplitude=0.5, decay_velocity=0.1, tail=1.0)
    system = augmented_system(box, make_law("coulomb", mu_s=0.8, mu_k=0.3), [fall])
    step, phases, noise = 5e-5, 5, 1e-6
    motion = system.march(Start(0.0, 0.0, box.belt_velocity, stick=True), step / phases, phases * 20000)
    time, position = motion.time[::phases], motion.position[::phases]
    believed = dataclasses.replace(box, stiffness=3723.0, mass=0.01028, damping=0.005)
    measured = make_record("run", time, position + noise * np.random.default_rng(2).standard_normal(len(time)), believed)
    slips = extract(measured)
    typical, middle = np.median(slips.features, axis=0), slips.onset_time[len(slips) // 2]
    for phase in range(phases):
        time, position = motion.time[phase::phases], motion.position[phase::phases]
        part = (time > middle - 0.01) & (time < middle + 0.02)
        simulated = dataclasses.replace(
            measured, time=time[part], position=position[part], raw=position[part], outlier=np.zeros(part.sum(), dtype=bool)
        )
        features = features_near(simulated, middle, slips.search)
        # samples fall elsewhere: forces differ by a part in a hundred; edges sought elsewhere made it a sixth
        assert np.abs(features - typical)[:3].max() < 0.02 * box.normal_force, (phase, features - typical)


def test_motion_without_slip_gives_no_slips():
    time = np.arange(5001) * 1e-3
    position = BOX.belt_velocity * time + NOISE * np.random.default_rng(6).standard_normal(time.size)
    assert len(extract(make_record("run", time, position, BOX))) == 0


@pytest.mark.parametrize("order", range(N_MOMENTS + 1))
def test_coefficients_of_a_polynomial(order):
    """Of degree up to 7 + 6 = 13 under the integral: exact with 32 Gauss nodes."""
    coefficients = legendre_coefficients(legendre.legval(NODES, np.eye(N_MOMENTS + 1)[order]))
    np.testing.assert_allclose(coefficients, np.eye(N_MOMENTS + 1)[order, :N_MOMENTS], atol=1e-13)


def test_coefficients_of_many_functions_at_once():
    functions = np.random.default_rng(7).standard_normal((3, 2, NODES.size))
    together = legendre_coefficients(functions)
    assert together.shape == (3, 2, N_MOMENTS)
    np.testing.assert_allclose(together[2, 1], legendre_coefficients(functions[2, 1]), atol=1e-13)


@pytest.mark.parametrize("frequency", [13.8, 18.7, 1.0001 * math.sqrt(5610.0 / 5.632)])
def test_an_excitation_does_not_move_the_edges(frequency):
    """Kang 2015, Table 2, undamped, once near resonance: unbiased, though the force changes quickly at both edges."""
    box = BeltBox(
        mass=5.632, damping=0.0, stiffness=5610.0, normal_force=14.0, belt_velocity=1e-3, excitation_amplitude=0.5e-3,
        excitation_angular_frequency=frequency,
    )  # fmt: skip
    system = augmented_system(box, make_law("coulomb", mu_s=0.8, mu_k=0.55))
    motion = system.march(Start(0.0, 0.0, box.belt_velocity, stick=True), 1e-3, 60000)
    position = motion.position + NOISE * np.random.default_rng(5).standard_normal(len(motion.time))
    result = extract(make_record("run", motion.time, position, box))
    assert len(result) > 20
    for times, switch in ((result.onset_time, 1.0), (result.restick_time, 0.0)):
        true = motion.events[motion.events[:, 1] == switch, 0]
        error = times - true[np.argmin(np.abs(times[:, None] - true), axis=1)]
        assert abs(error.mean()) < 4.0 * error.std() / len(error) ** 0.5
    # the quadrature, which calibration takes out, shows in the higher orders
    low = result.moments[:, :4]
    away = np.abs(low.mean(axis=0) - 0.55 * box.normal_force * np.eye(4)[0])
    assert np.all(away < 4.0 * np.std(low, axis=0) / len(result) ** 0.5), away


def test_the_features_of_one_slip_are_those_of_the_extraction(slips):
    result = features_near(slips.record, slips.onset_time[3] + 0.1, slips.search)
    np.testing.assert_array_equal(result, slips.features[3])
    quiet = make_record("still", slips.record.time[:500], np.zeros(500), BOX)
    assert features_near(quiet, 0.2, slips.search) is None
