"""Find friction that hides in one joint of a MuJoCo arm, from simulated measurements of angles and torques.

The arm follows two sines under a controller. Both joints have Coulomb friction, which is known; the elbow has something
else, which is not. Run it as ``python examples/discover_in_an_arm.py``; it takes a few seconds.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np

from stochfric_mb.discovery.driven_joint import JointOutcome, joint_outcome
from stochfric_mb.measurement import Dataset, Run
from stochfric_mb.scenario import load_any_scenario

MODEL = Path(__file__).parents[1] / "models" / "two_joint_arm"
COULOMB = np.array([1.0, 0.5])
"""Friction of the joints [N m]."""
SAMPLE = 0.002
"""Distance between samples [s]."""
NOISE = (2.0e-5, 0.02)
"""Noise of the angles [rad] and of the torques [N m]."""


def nothing(angle: float, rate: float) -> float:
    """Return no further friction [N m]."""
    return 0.0


def grease(angle: float, rate: float) -> float:
    """Return the friction of grease that somebody forgot [N m]."""
    return 0.15 * rate


def wave(angle: float, rate: float) -> float:
    """Return friction that waves with the angle, as that of a strain-wave gear does [N m]."""
    return 0.2 * math.cos(2.0 * math.pi * angle / 0.5) * math.tanh(rate / 0.01)


def measured(hidden: Callable[[float, float], float], *, seed: int, role: str, duration: float = 12.0) -> Run:
    """Return a simulated record; ``hidden`` is the elbow's further friction against its motion: angle, rate -> N m."""
    spec = mujoco.MjSpec.from_file(str(MODEL / "two_joint_arm.xml"))
    for joint, friction in zip(spec.joints, COULOMB, strict=True):
        joint.frictionloss = friction
    model = spec.compile()
    data = mujoco.MjData(model)
    rng = np.random.default_rng(seed)
    phase, stride = rng.uniform(0.0, 2.0 * math.pi, 4), round(SAMPLE / model.opt.timestep)
    rows: list[np.ndarray] = []
    for step in range(round(duration / model.opt.timestep)):
        t = data.time
        target = np.array(
            [
                0.5 * math.sin(2.3 * t + phase[0]) + 0.2 * math.sin(5.1 * t + phase[1]),
                0.8 * math.sin(3.1 * t + phase[2]) + 0.2 * math.sin(6.7 * t + phase[3]),
            ]
        )
        if step % stride == 0:
            data.ctrl[:] = np.array([120.0, 60.0]) * (target - data.qpos) - np.array([8.0, 4.0]) * data.qvel
            rows.append(np.r_[t, data.qpos, data.ctrl, target])
        data.qfrc_applied[1] = -hidden(float(data.qpos[1]), float(data.qvel[1]))
        mujoco.mj_step(model, data)
    table = np.array(rows)
    table[:, 1:3] += NOISE[0] * rng.standard_normal((len(table), 2))
    table[:, 3:5] += NOISE[1] * rng.standard_normal((len(table), 2))
    names = ("shoulder_angle", "elbow_angle", "shoulder_torque", "elbow_torque", "shoulder_target", "elbow_target")
    return Run(
        name=f"{role} {seed}",
        role="fit" if role == "fit" else "test",
        time=table[:, 0],
        channels={},
        covariates=dict(zip(names, table[:, 1:].T, strict=True)),
        sample_interval=SAMPLE,
    )


def discovered(hidden: Callable[[float, float], float], seed: int = 1) -> JointOutcome:
    """Return what the workflow finds in two runs, one of them held out."""
    scenario = load_any_scenario(MODEL / "scenario.toml")
    runs = (measured(hidden, seed=seed, role="fit"), measured(hidden, seed=seed + 1000, role="test"))
    return joint_outcome(Dataset(title="simulated arm", scenario_path=None, scenario=scenario, runs=runs))


def main() -> None:
    """Print the verdict for each hidden friction."""
    for hidden in (nothing, grease, wave):
        outcome = discovered(hidden)
        result = outcome.result
        print(f"hidden: {hidden.__name__}; verdict: {result.verdict}")
        for effect in result.effects:
            numbers = ", ".join(f"{k} = {v.value:.3g} {v.unit}" for k, v in effect.parameters.items())
            print(f"  {effect.kind} ({numbers}): {effect.where.text}")
        before, after = (outcome.places[0].scores[k] for k in ("recalibrated", "augmented"))
        print(f"  held out, inverse dynamics: {before.sliding:.4f} -> {after.sliding:.4f} N m")
        print(f"  held out, arm and controller simulated again: angles {1e3 * (before.forward or 0.0):.3f} -> "
              f"{1e3 * (after.forward or 0.0):.3f} mrad, torques {100.0 * (before.loop or 0.0):.2f} -> "
              f"{100.0 * (after.loop or 0.0):.2f} %")  # fmt: skip


if __name__ == "__main__":
    main()
