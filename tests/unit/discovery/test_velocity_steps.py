"""Velocity steps: the laws that are fitted, and what they say of friction that remembers and friction that does not."""

import numpy as np

from stochfric_mb.discovery.velocity_step.laws import Track, laws, memory_start
from stochfric_mb.discovery.velocity_step.velocity_steps import spring_slider_outcome, track_of
from tests.discovery.net.joints import slider


def test_constant_friction_and_drift_are_what_they_say():
    data = slider(0.01, 0.015, 2)
    tracks = [track_of(r, data) for r in data.runs]
    assert all(isinstance(t, Track) and np.all(t.speed > 0.0) for t in tracks)
    constant, drift, *_ = laws(1e-5, 1e4, 0.6)
    np.testing.assert_array_equal(constant.predict(tracks, np.array([0.6]))[0], 0.6)
    shown = drift.predict(tracks, np.array([0.6, 2.0]))[0]
    np.testing.assert_allclose(shown, 0.6 + 2.0 * tracks[0].slid)
    assert len(memory_start(0.6, 1e4, 0.01, 1.0, 1.0)) == 6


def test_a_law_is_named_without_a_chance_that_nobody_counted():
    result = spring_slider_outcome(slider(0.01, 0.015, 2), lambda _: None).result
    assert [e.kind for e in result.effects] == ["frictional_lag"]
    assert result.effects[0].p_value is None
