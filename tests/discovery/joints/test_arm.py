"""Friction hidden in one joint of a simulated two-joint arm: which joint, which effect, how much."""

import importlib.util
from pathlib import Path

import pytest

pytest.importorskip("mujoco", reason="the arm is a MuJoCo model")


def example():
    file = Path(__file__).parents[3] / "examples" / "discover_in_an_arm.py"
    spec = importlib.util.spec_from_file_location("discover_in_an_arm", file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


ARM = example()


@pytest.mark.parametrize("seed", [11, 12])
@pytest.mark.parametrize(
    ("hidden", "kind", "name", "truth", "tolerance"),
    [
        (ARM.grease, "viscous_friction", "coefficient", 0.15, 0.01),
        (ARM.wave, "position_dependent_friction", "wavelength", 0.5, 0.01),
    ],
)
def test_the_joint_the_effect_and_its_size(hidden, kind, name, truth, tolerance, seed):
    found = ARM.discovered(hidden, seed)
    effects = found.result.effects
    assert [e.kind for e in effects] == [kind]
    assert "elbow" in effects[0].where.text
    assert found.places[0].place == "elbow"
    assert found.places[1].selected.found == ()
    assert effects[0].parameters[name].value == pytest.approx(truth, abs=tolerance)
    gap = found.result.gap
    assert gap is not None
    assert gap.closed is not None
    assert gap.closed > 0.85


@pytest.mark.parametrize("seed", [11, 12, 13])
def test_nothing_hidden_nothing_found(seed):
    assert ARM.discovered(ARM.nothing, seed).result.verdict == "none"
