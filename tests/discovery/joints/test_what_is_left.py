"""What is left is held against: waves that come and go are flatter than noise, and a delay that does not explain is no name."""

import numpy as np

from stochfric_mb.discovery.driven_joint.balance.timing import Timing
from stochfric_mb.discovery.driven_joint.decision.carry_over import _waves


def test_a_sweep_is_flatter_than_noise_and_noise_is_not():
    t = np.linspace(0.0, 10.0, 2000)
    sweep = np.sin(2.0 * np.pi * (t + 0.4 * t**2))
    noise = np.random.default_rng(3).standard_normal(2000)
    assert _waves(sweep + 0.3 * noise, 200.0)
    assert not _waves(noise, 200.0)
    assert not _waves(0.5 * sweep + noise, 200.0)  # waves are the smaller part


def test_a_delay_that_shows_but_does_not_explain_is_a_puzzle():
    seen = Timing(0.005, 0.004, 0.006, 40.0, 0.1, 16)
    assert seen.beside(40.0, explains=True).named
    assert not seen.beside(40.0, explains=False).named
    assert seen.beside(40.0, explains=False).puzzling
    assert not seen.beside(5.0, explains=False).puzzling
