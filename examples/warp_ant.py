"""A vectorised ant in MuJoCo Warp, in the manner of gymnasium's vector environments, whose feet stick to the ground.

Each world draws its own coefficients when an episode begins; worlds are reset one by one. It trains nothing.

Run: python examples/warp_ant.py [number of worlds] [number of steps]
"""

import importlib.util
import sys
from pathlib import Path

import mujoco
import mujoco_warp as mjw
import numpy as np
import warp as wp

from stochfric_mb import Stribeck
from stochfric_mb.warp import Domain, add_friction

FRAMES = 5
"""Simulation steps for each action."""


def ant_file():
    """Return gymnasium's ant; gymnasium itself is not imported."""
    package = importlib.util.find_spec("gymnasium")
    assert package is not None, "pip install gymnasium"
    assert package.origin is not None
    return Path(package.origin).parent / "envs" / "mujoco" / "assets" / "ant.xml"


class VectorAnt:
    """``reset()`` and ``step(actions)`` over all worlds at once; an ant that falls begins anew."""

    def __init__(self, n, seed=0):
        spec = mujoco.MjSpec.from_file(str(ant_file()))
        spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        spec.option.integrator = mujoco.mjtIntegrator.mjINT_EULER
        self.model = spec.compile()
        self.model.geom_condim[:] = 3
        self.m = mjw.put_model(self.model)
        self.d = mjw.put_data(self.model, mujoco.MjData(self.model), nworld=n)
        law = Stribeck(1.0, 0.7, stribeck_velocity=0.05)
        self.friction = add_friction(self.model, self.m, self.d, ("*", "floor"), law, seed=seed)
        self.friction.randomise(Domain(sigma_s=0.1, sigma_k=0.1))
        self.fallen = wp.zeros(n, dtype=bool)
        self.n = n

    def reset(self):
        """Begin an episode in all worlds; return the observations, shape (n, nq + nv - 2)."""
        mjw.reset_data(self.m, self.d)
        self.friction.restart()
        return self.observation()

    def observation(self):
        """Return positions (without x and y) and velocities."""
        return np.concatenate([self.d.qpos.numpy()[:, 2:], self.d.qvel.numpy()], axis=1)

    def step(self, actions):
        """Return observations, rewards (forward velocity), which episodes ended, and which worlds' contacts all stick."""
        self.d.ctrl.assign(np.clip(actions, -1.0, 1.0))
        before = self.d.qpos.numpy()[:, 0].copy()
        for _ in range(FRAMES):
            mjw.step(self.m, self.d)
        self.friction.observe(self.d)
        x, z = self.d.qpos.numpy()[:, 0], self.d.qpos.numpy()[:, 2]
        reward = (x - before) / (FRAMES * self.model.opt.timestep)
        ended = (z < 0.2) | (z > 1.0) | ~np.isfinite(z)
        stick = self.friction.stick.numpy().copy()
        if ended.any():
            self.fallen.assign(ended)
            mjw.reset_data(self.m, self.d, self.fallen)
            self.friction.restart(self.fallen)
        return self.observation(), reward, ended, stick


def main(n=16, steps=40):
    env = VectorAnt(n)
    env.reset()
    rng = np.random.default_rng(0)
    stuck, loaded, ended = 0, 0, 0
    for _ in range(steps):
        observation, reward, done, stick = env.step(rng.uniform(-0.2, 0.2, (n, env.model.nu)))
        stuck, loaded, ended = stuck + stick.sum(), loaded + (env.friction.contacts.numpy() > 0).sum(), ended + done.sum()
    assert np.isfinite(observation).all()
    print(f"{n} ants, {steps} actions: mean velocity {reward.mean():.2f} m/s at the end, {ended} episodes ended")
    print(f"of {loaded} ants on the ground, {stuck} had every foot stuck")
    mu_s = env.friction.mu_s.numpy()
    print(f"mu_s over the worlds: {mu_s.min():.2f} .. {mu_s.max():.2f}")
    return stuck, loaded


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:3]))
