"""Scenes that the tests of MuJoCo Warp share; each gives (model, m, d)."""

import math

import mujoco
import mujoco_warp as mjw
import numpy as np
import warp as wp

GRAVITY = 9.81
PLANE = """<mujoco><option timestep="{dt}" cone="elliptic" integrator="{integrator}" gravity="{gx} 0 {gz}"/><worldbody>
<geom name="floor" type="plane" size="50 50 .1" condim="{condim}"/>
<body pos="0 0 .0499"><freejoint/>
<geom name="box" type="box" size=".1 .1 .05" mass="1" condim="{condim}"/></body>
</worldbody></mujoco>"""


def on_device(model, nworld, **state):
    """Return m and d of a compiled model, all worlds in the state given by arrays of ``MjData``."""
    data = mujoco.MjData(model)
    for name, value in state.items():
        getattr(data, name)[: len(value)] = value
    mujoco.mj_forward(model, data)
    return mjw.put_model(model), mjw.put_data(model, data, nworld=nworld)


def box_on_plane(degrees=0.0, dt=0.002, nworld=64, velocity=0.0, integrator="Euler", condim=3):
    """Return a box of 1 kg on a plane that gravity makes an incline, moving along x."""
    a = math.radians(degrees)
    text = PLANE.format(dt=dt, integrator=integrator, gx=GRAVITY * math.sin(a), gz=-GRAVITY * math.cos(a), condim=condim)
    model = mujoco.MjModel.from_xml_string(text)
    return model, *on_device(model, nworld, qvel=[velocity])


def same(there, here):
    """Whether two runs went the same way: to the bit on the CPU device, which goes through contacts in order.

    On a GPU the order of a world's constraint rows is left to chance, and with it the last bits of a float32 (1.2e-7), which
    sums over a hundred steps let grow: 1e-5 is a hundred of them.
    """
    if wp.get_preferred_device().is_cuda:
        return bool(np.allclose(there, here, rtol=1e-5, atol=1e-5))
    return bool(np.array_equal(there, here))


def tilt(m, degrees):
    """Turn gravity, in place, as a captured graph needs it."""
    a = math.radians(degrees)
    m.opt.gravity.fill_(wp.vec3(GRAVITY * math.sin(a), 0.0, -GRAVITY * math.cos(a)))


def run(m, d, seconds, dt):
    """Step for so many seconds."""
    for _ in range(round(seconds / dt)):
        mjw.step(m, d)
