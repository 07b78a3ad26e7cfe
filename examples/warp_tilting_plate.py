"""Boxes on a tilting plate in MuJoCo Warp, each with its own coefficients: who slides when, against the exact probability.

Run: python examples/warp_tilting_plate.py [number of worlds]   (4096 on a GPU; 64 by default)
"""

import math
import sys

import mujoco
import mujoco_warp as mjw
import numpy as np
import warp as wp

from stochfric_mb import Coulomb
from stochfric_mb.warp import Domain, add_friction

SCENE = """<mujoco><option timestep="5e-3" cone="elliptic"/><worldbody><geom name="plate" type="plane" size="50 50 .1"/>
<body pos="0 0 .0499"><freejoint/><geom name="box" type="box" size=".1 .1 .05" mass="1"/></body></worldbody></mujoco>"""
MU_S, SIGMA = 0.6, 0.06
RATE = 5.0
"""Tilting [degrees/s]."""


def angles_of_sliding(n):
    """Return the angle at which the box of each world begins to slide [degrees], and the mu_s that it drew."""
    model = mujoco.MjModel.from_xml_string(SCENE)
    m, d = mjw.put_model(model), mjw.put_data(model, mujoco.MjData(model), nworld=n)
    friction = add_friction(model, m, d, ("box", "plate"), Coulomb(MU_S, 0.3), seed=1)
    friction.randomise(Domain(sigma_s=SIGMA))
    slip_angle = np.full(n, np.nan)
    angle = 15.0
    while np.isnan(slip_angle).any() and angle < 50.0:
        angle += RATE * model.opt.timestep
        a = math.radians(angle)
        m.opt.gravity.fill_(wp.vec3(9.81 * math.sin(a), 0.0, -9.81 * math.cos(a)))
        mjw.step(m, d)
        slip_angle[np.isnan(slip_angle) & (d.qvel.numpy()[:, 0] > 1e-2)] = angle
    return slip_angle, friction.mu_s.numpy().astype(float)


def main(n):
    angles, mu_s = angles_of_sliding(n)
    print("angle  slid of", n, " exact probability")
    for angle in range(24, 40, 3):
        share = np.mean(angles < angle)
        exact = 0.5 * math.erfc((MU_S - math.tan(math.radians(angle))) / (SIGMA * math.sqrt(2.0)))
        print(f"{angle:5d}  {share:10.3f}  {exact:10.3f}  (+- {2.0 * math.sqrt(exact * (1.0 - exact) / n):.3f})")
    late = angles - np.degrees(np.arctan(mu_s))
    print(f"each box slides {late.mean():.2f} degrees after atan of its own mu_s (largest {np.abs(late).max():.2f})")
    return angles, mu_s


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 64)
