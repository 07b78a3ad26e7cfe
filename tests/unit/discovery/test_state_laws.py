"""Laws of the state at velocity steps, and which runs are one record."""

import numpy as np
import pytest

from stochfric_mb.discovery.velocity_step.laws import Track, records
from stochfric_mb.discovery.velocity_step.rate_and_state import AGEING, QUADRATIC, SLIP, friction_path
from stochfric_mb.measurement.run import Run

DIRECT, EVOLUTION, DISTANCE, RIGID = 0.01, 0.015, 1.0e-5, 1.0e8


@pytest.mark.parametrize("state", [AGEING, SLIP, QUADRATIC])
def test_after_a_step_friction_settles_at_a_minus_b_times_the_logarithm(state):
    """Closed form for all three: the state goes to D/v, or 2 D/v; a change of speed by e changes friction by a - b."""
    speed = np.r_[np.full(200, 1.0e-6), np.full(2000, np.e * 1.0e-6)]
    mu = np.empty(len(speed))
    friction_path(speed, 0.1, DIRECT, EVOLUTION, DISTANCE, RIGID, 1.0, 1.0e-6, state, mu)
    assert np.ptp(mu[:200]) < 1.0e-9
    # 200 s at 2.7 um/s are 54 distances D: what is left of the state is e^-54
    assert mu[-1] - mu[0] == pytest.approx(DIRECT - EVOLUTION, abs=1.0e-8)


def test_the_slip_law_forgets_exponentially_in_the_distance():
    """At constant speed ln(v theta/D) falls as exp(-v t/D): Ruina 1983, eq. 8."""
    speed = np.r_[np.full(10, 1.0e-6), np.full(200, 2.0e-6)]
    mu = np.empty(len(speed))
    friction_path(speed, 0.1, DIRECT, EVOLUTION, DISTANCE, RIGID, 1.0, 1.0e-6, SLIP, mu)
    rest = (mu[11:] - mu[-1] + EVOLUTION * np.log(2.0) * np.exp(-2.0e-6 * 19.9 / DISTANCE)) / (EVOLUTION * np.log(2.0))
    gone = 0.1 * (np.arange(len(rest)) + 1.0) * 2.0e-6 / DISTANCE
    # the spring takes up the step within one of eight parts of an interval, 0.0025 D
    assert rest[:100] == pytest.approx(np.exp(-gone[:100]), abs=0.02)


def test_runs_that_begin_at_the_same_time_are_tests_of_their_own():
    def track(name, start):
        time = start + 0.1 * np.arange(50)
        run = Run(name=name, role="fit", time=time, channels={}, sample_interval=0.1, source=name[0])
        return Track(run, np.zeros(50), np.ones(50), np.ones(50), np.zeros(50))

    first, piece, second, last = track("a", 0.0), track("a2", 5.0), track("b", 0.0), track("b2", 5.0)
    assert [[t.run.name for t in r] for r in records([first, piece])] == [["a", "a2"]]
    assert [[t.run.name for t in r] for r in records([first, second])] == [["a"], ["b"]]
    assert [[t.run.name for t in r] for r in records([first, second, piece, last])] == [["a", "a2"], ["b", "b2"]]
