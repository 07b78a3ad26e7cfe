"""The belt-box oscillator: its stick-slip cycle in closed form, and random friction against the reference."""

from __future__ import annotations

import numpy as np
import pytest

from stochfric_mb import metrics, reference
from stochfric_mb.coefficients import Knots
from stochfric_mb.testing.candidates import Candidate
from stochfric_mb.testing.cases import STEP, natural_rate, stands_in, static_deflection, table_1
from stochfric_mb.testing.closed_form import coulomb_cycle

KNOTS = Knots(sigma_s=0.015, sigma_k=0.023, spacing=0.01)


def test_stick_slip_cycle_of_coulomb_friction(engine: Candidate) -> None:
    s = table_1("coulomb", 3.3)
    run = engine.simulate(s, dt=STEP)
    period, highest, lowest = coulomb_cycle(s.mechanism, s.law.mu_s, s.law.mu_k)
    assert period == pytest.approx(1.020006308, abs=5e-10)  # the cycle as published, to its last digit
    tolerance = engine.accuracy.tolerance(
        static_deflection(s), natural_rate(s), STEP, switches=True, stand_in=stands_in(run, s)
    )
    times = metrics.break_aways(run, s.law, s.mechanism)
    assert len(times) == 3
    # each break-away is late by a step to see it and one to commit it; an elastic stand-in adds the lag of its contact,
    # 2 zeta/omega_stick = 0.8 dt at a step limit of 2 dt; metrics locate it to 1e-8 s
    late = 0.0 if engine.accuracy.stepless else 3.0 * STEP
    assert (times[2] - times[0]) / 2.0 == pytest.approx(period, abs=late + 1e-8)
    cycle = run.position[run.time > times[0] - 0.1]
    # highest and lowest of samples 1 ms apart: the parabola at the turn, a (h/2)^2/2
    turn = 0.34 * s.mechanism.normal_force / s.mechanism.mass * (0.5 * s.output_step) ** 2 / 2.0
    assert np.max(cycle) == pytest.approx(highest, abs=tolerance + turn)
    assert np.min(cycle) == pytest.approx(lowest, abs=tolerance + turn)


@pytest.mark.parametrize("law", ["elastic_stick", "havsin"])
@pytest.mark.parametrize("seed", [1, 2])
def test_random_friction_follows_the_reference(engine: Candidate, law: str, seed: int) -> None:
    s = table_1(law, 1.2, process=KNOTS)
    dt = min(s.default_dt(), STEP)
    run, exact = engine.simulate(s, seed=seed, dt=dt), reference.simulate(s, seed=seed)
    assert len(metrics.break_aways(exact, s.law, s.mechanism)) == 1  # there is a slip to disagree about
    # havsin has no switches: its force is a function of velocity alone
    tolerance = engine.accuracy.tolerance(static_deflection(s), natural_rate(s), dt, switches=law == "elastic_stick")
    assert metrics.max_abs_difference(run.position, exact.position) <= tolerance
    assert run.attributes["law"] == law


def test_smaller_steps_are_better(engine: Candidate) -> None:
    if engine.accuracy.stepless:
        pytest.skip(f"{engine.name} has no step")
    s = table_1("elastic_stick", 1.2)
    exact = reference.simulate(s)
    coarse, fine = (metrics.rms_difference(engine.simulate(s, dt=dt).position, exact.position) for dt in (5e-4, 5e-5))
    # ten times finer: at least half an order better (where a switch falls within a step scatters by that much)
    assert fine <= coarse / np.sqrt(10.0) + engine.accuracy.floor * static_deflection(s)


@pytest.mark.parametrize("law", ["elastic_stick", "havsin"])
def test_the_force_reported_is_the_one_that_moves_the_box(engine: Candidate, law: str) -> None:
    s = table_1(law, 0.2, process=KNOTS, output_step=2.0e-5)
    run = engine.simulate(s, seed=1, dt=2.0e-5)
    m, h = s.mechanism, s.output_step
    total = run.friction_force - m.damping * run.velocity - m.stiffness * run.position
    impulse = np.cumsum(0.5 * h * (total[1:] + total[:-1]))
    gained = m.mass * (run.velocity[1:] - run.velocity[0])
    # trapezoidal rule over a force that is smooth between switches; at each switch it jumps by at most 2 mu_s N
    switches = 1 + int(np.count_nonzero(np.diff(run.stick)))
    jumps = switches * 0.5 * h * 2.0 * s.law.mu_s * m.normal_force
    assert np.max(np.abs(gained - impulse)) <= jumps + engine.accuracy.tolerance(np.max(np.abs(gained)), natural_rate(s), h)
