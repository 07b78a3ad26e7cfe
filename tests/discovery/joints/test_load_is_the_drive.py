"""Friction in proportion to the measured drive explains any drive: one record with nothing missing, given as each mechanism.

A joint with pure Coulomb friction and no other load; the stated model is exactly right. Whatever the mechanism calls load,
nothing may be found, and nothing may be worse for it.
"""

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint import joint_outcome
from stochfric_mb.measurement import Dataset, Run
from stochfric_mb.scenario import any_scenario_from_dict
from tests.discovery.joint_generator.integrator import simulate
from tests.discovery.joint_generator.motion import MOTIONS
from tests.discovery.joint_generator.plant import plain_plant

FRICTION = 6.0
RATE, DURATION = 500.0, 10.0
NOISE = (5e-6, 0.2)
"""Of the position [m or rad] and of the drive [N or N m]."""


def record(seed: int, motion: str, inertia: float, share: float) -> dict[str, np.ndarray]:
    """Position and drive of a joint under control; `share`: part of the drive by which friction grows."""
    rng = np.random.default_rng(seed)
    times = np.arange(-500, round(DURATION * RATE) + 1) / RATE
    wanted = np.zeros((times.size, 6))
    wanted[:, 0], wanted[:, 2] = MOTIONS[motion](rng, times, 0.4, 1.2)
    gains = np.zeros((2, 5))
    gains[:] = inertia * 900.0, 2.0 * 0.8 * inertia * 30.0, 1.0, 500.0, 1.0
    body = {"kind": 0.0, "inertia": inertia}
    plant = plain_plant(body, (FRICTION, 0.0), top_speed=5.0, reach=1.6, duration=DURATION).with_extra(drive_share=share)
    states = simulate(plant, gains, wanted, wanted[0, :2], 500, 1.0 / RATE)
    noise = rng.standard_normal((2, len(states)))
    return {"position": states[:, 0] + NOISE[0] * noise[0], "drive": states[:, 4] + NOISE[1] * noise[1]}


MECHANISMS = ("prismatic_joint", "hinge_pendulum", "mjcf_slide", "mjcf_hinge")


def mechanism_table(mechanism: str, inertia: float) -> dict[str, object]:
    if mechanism == "prismatic_joint":
        return {"kind": mechanism, "mass": inertia, "normal_force": 20.0}
    if mechanism == "hinge_pendulum":
        return {"kind": mechanism, "mass": 1e-3, "length": 0.1, "inertia": inertia, "gravity": 0.0, "normal_force": 20.0}
    drive = "torque" if mechanism == "mjcf_hinge" else "force"
    maps = {"friction": {"j": 20.0}, "positions": {"j": "position"}, "drives": {"j": drive}}
    return {"kind": "mjcf", "file": "model.xml"} | maps


MODEL = """<mujoco><compiler angle="radian"/><worldbody><body><joint name="j" type="{joint}" axis="{axis}"/>
<inertial pos="0 0 0" mass="{inertia}" diaginertia="{inertia} {inertia} {inertia}"/></body></worldbody></mujoco>"""


def dataset(
    mechanism: str, motion: str, folder, *, inertia: float, uncertainty: dict[str, float], share: float = 0.0
) -> Dataset:
    joint, axis = ("hinge", "0 0 1") if "hinge" in mechanism else ("slide", "1 0 0")
    (folder / "model.xml").write_text(MODEL.format(joint=joint, axis=axis, inertia=inertia))
    own = {("inertia" if mechanism == "hinge_pendulum" and key == "mass" else key): sd for key, sd in uncertainty.items()}
    if not mechanism.startswith("mjcf"):
        own.pop("gain", None)
    tables = {
        "schema": "stochfric.scenario/1",
        "mechanism": mechanism_table(mechanism, inertia),
        "law": {"kind": "coulomb", "mu_s": 0.3, "mu_k": 0.3},
        "uncertainty": own | {"mu_s": 0.2, "mu_k": 0.2, "offset": 0.5},
        "simulation": {"duration": 10.0, "output_step": 1e-3},
    }
    drive = "torque" if joint == "hinge" else "force"
    runs = []
    for seed, role in ((1, "fit"), (2, "fit"), (3, "test")):
        columns = record(seed, motion, inertia, share)
        channels = {"position": columns["position"], drive: columns["drive"]}
        time = np.arange(len(columns["drive"])) / RATE
        runs.append(Run(name=f"run {seed}", role=role, time=time, channels=channels, sample_interval=1.0 / RATE))
    return Dataset(title="", scenario_path=None, scenario=any_scenario_from_dict(tables, folder=folder), runs=tuple(runs))


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("mechanism", MECHANISMS)
def test_nothing_is_found_where_nothing_is_missing(mechanism, motion, tmp_path):
    if mechanism.startswith("mjcf"):
        pytest.importorskip("mujoco")
    # so wide that what shrinks the needs of the motion is not held by its prior
    wide = {"mass": 0.5, "gain": 0.3}
    result = joint_outcome(dataset(mechanism, motion, tmp_path, inertia=1.0, uncertainty=wide)).result
    assert result.verdict == "none", [e.kind for e in result.effects]
    # the model is right: what it leaves is noise, within the scatter of an rms of some tens of independent windows
    assert result.gap.augmented < 1.3 * result.gap.floor
    inertia = next(v for k, v in result.parameters.items() if "mass" in k or k == "inertia")
    assert inertia.low <= 1.0 <= inertia.high


@pytest.mark.parametrize("mechanism", ["hinge_pendulum", "mjcf_hinge"])
def test_friction_that_does_grow_with_the_drive_is_still_found(mechanism, tmp_path):
    if mechanism.startswith("mjcf"):
        pytest.importorskip("mujoco")
    result = joint_outcome(dataset(mechanism, "strokes", tmp_path, inertia=10.0, uncertainty={"mass": 0.02}, share=0.3)).result
    assert [e.kind for e in result.effects] == ["load_dependence"]
    # mu N (1 + load/reference) = 6 + 0.3 load
    assert result.effects[0].parameters["reference_load"].value == pytest.approx(FRICTION / 0.3, rel=0.15)
