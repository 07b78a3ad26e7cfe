"""Joints and tendons stick, break away and stop in every world."""

import mujoco
import mujoco_warp as mjw
import numpy as np
import pytest

from stochfric_mb import Coulomb
from stochfric_mb.errors import InputError
from stochfric_mb.mujoco import Joint, Tendon
from stochfric_mb.warp import add_friction
from tests.warp.scenes import on_device

LAW = Coulomb(1.0, 0.6)
LOAD = 10.0
SLIDER = """<mujoco><option cone="elliptic" timestep="{dt}" gravity="0 0 0"/><worldbody><body>
<joint name="x" type="slide" axis="1 0 0" frictionloss="{loss}"/><geom size=".1" mass="1"/></body>
<body><freejoint name="free"/><geom size=".1" pos="0 0 3" mass="1"/></body></worldbody>
<tendon><fixed name="cable" frictionloss="{loss}"><joint joint="x" coef="1"/></fixed></tendon></mujoco>"""


def slider(dt, *, joint=1.0, tendon=0.0, nworld=64, velocity=0.0):
    spec = mujoco.MjSpec.from_string(SLIDER.format(dt=dt, loss=1.0))
    spec.joint("x").frictionloss = joint
    spec.tendon("cable").frictionloss = tendon
    model = spec.compile()
    return model, *on_device(model, nworld, qvel=[velocity])


@pytest.mark.parametrize("place", [Joint("x"), Tendon("cable")], ids=["joint", "tendon"])
@pytest.mark.parametrize("dt", [0.001, 0.005])
def test_holds_breaks_away_and_stops(place, dt):
    tendon = float(isinstance(place, Tendon))
    model, m, d = slider(dt, joint=1.0 - tendon, tendon=tendon)
    friction = add_friction(model, m, d, place, LAW, normal_force=LOAD)
    push = np.zeros((64, model.nv), dtype=np.float32)
    push[:, 0] = 9.0
    d.qfrc_applied.assign(push)
    for _ in range(round(0.5 / dt)):
        mjw.step(m, d)
    before = d.qpos.numpy()[:, 0].copy()
    for _ in range(round(2.0 / dt)):
        mjw.step(m, d)
    assert np.abs(d.qpos.numpy()[:, 0] - before).max() < 1e-7  # MuJoCo's own frictionloss creeps 19 mm
    friction.observe(d)
    assert friction.friction_force.numpy() == pytest.approx([-9.0] * 64, rel=1e-4)
    assert friction.stick.numpy().all()

    force, broke = 9.0, np.full(64, np.nan)
    while np.isnan(broke).any() and force < 12.0:
        force += 2.0 * dt
        push[:, 0] = force
        d.qfrc_applied.assign(push)
        mjw.step(m, d)
        broke[np.isnan(broke) & (d.qvel.numpy()[:, 0] > 1e-2)] = force
    # 1 kg under an excess of 2 N/s: sqrt(2 v/2) at the stick speed of 1e-5 m/s or less, then 4 N to 1e-2 m/s: a few steps
    assert np.abs(broke - LOAD).max() < 2.0 * (0.01 + 4.0 * dt)


def test_stops_where_it_should():
    dt = 0.002
    model, m, d = slider(dt, velocity=1.0)
    friction = add_friction(model, m, d, Joint("x"), LAW, normal_force=LOAD)
    for _ in range(round(0.4 / dt)):
        mjw.step(m, d)
    exact = 1.0 / (2.0 * LAW.mu_k * LOAD)
    assert np.abs(d.qpos.numpy()[:, 0] + dt / 2.0 - exact).max() < 1e-3 * exact  # semi-implicit Euler's own v dt/2
    friction.observe(d)
    assert friction.stick.numpy().all()


def test_what_cannot_work_is_refused():
    scene = slider(0.002, joint=0.0, nworld=1)
    with pytest.raises(InputError, match=r"'x' has no friction row; give it frictionloss > 0"):
        add_friction(*scene, Joint("x"), LAW, normal_force=LOAD)
    with pytest.raises(InputError, match="one coordinate"):
        add_friction(*scene, Joint("free"), LAW, normal_force=LOAD)
    with pytest.raises(InputError, match="unknown joint 'y'"):
        add_friction(*scene, Joint("y"), LAW, normal_force=LOAD)
    scene = slider(0.002, nworld=1)
    with pytest.raises(InputError, match="normal_force = None is not a number"):
        add_friction(*scene, Joint("x"), LAW)
    with pytest.raises(InputError, match=r"'reaction': .* stochfric_mb.mujoco.add_friction"):
        add_friction(*scene, Joint("x"), LAW, normal_force="reaction")
    with pytest.raises(InputError, match="out of range"):
        add_friction(*scene, Joint("x"), LAW, normal_force=-1.0)
