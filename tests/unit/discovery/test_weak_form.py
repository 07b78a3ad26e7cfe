"""Means over windows: of some of the samples where windows are wide."""

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint.balance.weak_form import Window


@pytest.mark.parametrize("samples", [8, 23.4, 49, 200, 411.3])
def test_means_of_some_samples_are_those_of_all(samples):
    window = Window(samples * 1e-3, 1e-3, 5000)
    t = np.arange(5000) * 1e-3
    signal = np.sin(2.0 * np.pi * t / (1.5 * window.half_width)) + t  # varies by all of itself within a window
    fine, coarse = window.at_centres(signal), window.means @ signal[:: window.stride]
    # as derived beside FINE; the samples themselves are exact where none is left out
    assert np.abs(coarse - fine).max() < (1e-12 if window.stride == 1 else 1e-6)
    assert window.means @ np.ones(window.means.shape[1]) == pytest.approx(np.ones(len(window.centres)))


@pytest.mark.parametrize("shift", [0.0, 0.0113, 0.03, -0.03])
def test_a_delayed_signal_is_used_where_it_is_known(shift):
    window = Window(8e-3, 1e-3, 600)
    t = np.arange(600) * 1e-3
    seen, used = window.through(1.0 + t, shift=shift)[window.centres], window.covered(shift)
    # a straight line is its own mean; beyond the record's ends it would go on at the other end
    np.testing.assert_allclose(seen[used], 1.0 + t[window.centres][used] - shift, rtol=1e-8)  # of taps between samples
    assert used.all() == (abs(shift) < 7e-3)
    assert used[10:-10].all()
