"""The pymunk examples run, and show the physics that they claim."""

from __future__ import annotations

import math
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("pymunk", reason="pymunk is not installed")

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_parts_on_the_conveyor_slide_as_long_as_their_friction_tells() -> None:
    conveyor = runpy.run_path(str(EXAMPLES / "pymunk_conveyor.py"))
    parts = conveyor["run"](duration=4.0)
    assert len(parts) > 3
    gravity, fall = conveyor["GRAVITY"], math.sqrt(2.0 * conveyor["GRAVITY"] * conveyor["DROP"])
    coefficients = [p["mu_k"] for p in parts]
    assert len(set(coefficients)) == len(parts)  # each part has a path of its own
    for part in parts:
        # the impact brings mu times the falling velocity, sliding the rest: v_b = mu (v_fall + g t), mu varies on the way
        expected = (conveyor["BELT_VELOCITY"] - part["mu_k"] * fall) / (part["mu_k"] * gravity)
        assert part["slid"] == pytest.approx(expected, abs=0.05)
    longest, shortest = (f(parts, key=lambda p: p["slid"]) for f in (max, min))
    assert longest["mu_k"] < shortest["mu_k"]


@pytest.mark.parametrize(("share", "locked"), [(0.5, True), (0.99, True), (1.01, False)])
def test_the_wedge_locks_itself_up_to_twice_the_friction_angle(share: float, locked: bool) -> None:
    wedge = runpy.run_path(str(EXAMPLES / "pymunk_wedge.py"))
    path = wedge["run"](share * wedge["CRITICAL"])
    moved = path[-1][1]
    # locked: the contact solver settles by 0.05 um; 1 % beyond: 0.1 m/s^2 for half a second at least
    assert moved < 1e-6 if locked else moved > 1e-2


@pytest.mark.parametrize("name", ["pymunk_conveyor.py", "pymunk_wedge.py"])
def test_the_scripts_print_and_plot(name: str, tmp_path: Path) -> None:
    picture = tmp_path / "figure.png"
    command = [sys.executable, str(EXAMPLES / name), "--plot", str(picture)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=300)
    assert len(done.stdout.splitlines()) > 3
    assert picture.stat().st_size > 1000
