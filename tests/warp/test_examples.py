"""The examples show what they say."""

import runpy
from pathlib import Path

import numpy as np
import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_boxes_slide_at_the_angle_of_their_own_coefficient(capsys):
    angles, mu_s = runpy.run_path(str(EXAMPLES / "warp_tilting_plate.py"))["main"](32)
    # .2 degrees is the limit; the plate tilts by .025 degrees a step, and 1e-2 m/s are reached 5 ms after break-away
    assert np.abs(angles - np.degrees(np.arctan(mu_s))).max() < 0.2
    assert mu_s.std() == pytest.approx(0.06, rel=0.5)  # 4 standard errors of 32 draws
    assert "exact probability" in capsys.readouterr().out


def test_ants_stand_on_feet_that_stick():
    pytest.importorskip("gymnasium", reason="gymnasium brings the ant")
    example = runpy.run_path(str(EXAMPLES / "warp_ant.py"))
    env = example["VectorAnt"](4)
    assert env.reset().shape == (4, 27)
    for _ in range(30):
        observation, reward, ended, stick = env.step(np.zeros((4, env.model.nu)))
    assert np.isfinite(observation).all()
    assert not ended.any()
    assert stick.all()
    assert np.abs(reward).max() < 0.05
    stuck, loaded = example["main"](4, 10)
    assert 0 <= stuck <= loaded
