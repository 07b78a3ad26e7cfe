"""A box on a plane sticks, breaks away and stops as it should, in every one of 64 worlds at once and in float32."""

import math

import mujoco_warp as mjw
import numpy as np
import pytest

from stochfric_mb import Coulomb, ElasticStick, Friction, Knots, Stribeck
from stochfric_mb.coefficients import CoefficientPath
from stochfric_mb.laws import make_law
from stochfric_mb.warp import add_friction
from tests.warp.scenes import GRAVITY, box_on_plane, run, tilt

LAW = Coulomb(0.8, 0.46)


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast"])
def test_box_on_an_incline_holds(integrator):
    dt = 0.005
    model, m, d = box_on_plane(20.0, dt, integrator=integrator)
    friction = add_friction(model, m, d, ("box", "floor"), LAW)
    run(m, d, 0.5, dt)
    before = d.qpos.numpy()[:, 0].copy()  # numpy() shares the CPU device's memory
    run(m, d, 10.0, dt)
    assert np.abs(d.qpos.numpy()[:, 0] - before).max() < 1e-6  # the limit; Warp alone creeps by 9 mm
    friction.observe(d)
    held = [-GRAVITY * math.sin(math.radians(20.0)), 0.0, 0.0]
    assert np.abs(friction.friction_force.numpy() - held).max() < 1e-4
    assert np.abs(friction.normal_force.numpy() - GRAVITY * math.cos(math.radians(20.0))).max() < 1e-3
    assert (friction.stick.numpy() == 1).all()
    assert (friction.contacts.numpy() == 4).all()


def test_a_box_set_down_at_rest_beyond_atan_mu_k_sticks_at_once():
    dt = 0.002
    model, m, d = box_on_plane(33.0, dt)  # atan mu_k = 24.7 degrees
    friction = add_friction(model, m, d, ("box", "floor"), LAW)
    run(m, d, 0.3, dt)
    # the load comes on while the box settles by 1e-5 m on MuJoCo's soft contacts, on which it turns; MuJoCo itself: 1.7e-5 m
    assert np.abs(d.qpos.numpy()[:, 0]).max() < 3e-5
    friction.observe(d)
    assert friction.stick.numpy().all()


SHORT_SPRING = ElasticStick(0.8, 0.46, e_lim=1e-7)  # steps of 1 ms cannot follow it
HAVSIN = make_law("havsin", mu_s=0.8, mu_k=0.46)


@pytest.mark.parametrize(("law", "dt"), [(LAW, 0.002), (LAW, 0.005), (SHORT_SPRING, 0.001), (HAVSIN, 0.001), (HAVSIN, 0.005)])
def test_box_breaks_away_at_atan_mu_s(law, dt):
    model, m, d = box_on_plane(30.0, dt)  # a spring that is loaded at once overshoots, here to 1.37 tan 30 = .79 < mu_s
    friction = add_friction(model, m, d, ("box", "floor"), law)
    run(m, d, 0.3, dt)
    rate, angle = 5.0, 30.0
    broke = np.full(d.nworld, np.nan)
    while np.isnan(broke).any() and angle < 45.0:
        angle += rate * dt
        tilt(m, angle)
        mjw.step(m, d)
        broke[np.isnan(broke) & (d.qvel.numpy()[:, 0] > 1e-2)] = angle
    # the issue's .2 degrees; sliding at mu_k to 1e-2 m/s alone takes 4 ms, or .02 degrees
    assert np.abs(broke - math.degrees(math.atan(0.8))).max() < 0.2
    friction.observe(d)
    assert not friction.stick.numpy().any()


@pytest.mark.parametrize("dt", [0.001, 0.002, 0.005])
def test_box_stops_where_it_should(dt):
    model, m, d = box_on_plane(0.0, dt, velocity=2.0)
    add_friction(model, m, d, ("box", "floor"), LAW)
    run(m, d, 0.6, dt)
    exact = 2.0**2 / (2.0 * LAW.mu_k * GRAVITY)
    # semi-implicit Euler itself stops v dt/2 earlier; what remains is far below the issue's .5 %
    assert np.abs(d.qpos.numpy()[:, 0] + 2.0 * dt / 2.0 - exact).max() < 1e-3 * exact
    assert np.abs(d.qvel.numpy()[:, 0]).max() < 1e-5  # it still rocks on MuJoCo's soft contacts (time constant .02 s)


def test_a_stribeck_box_stops_later_than_its_mu_s_says():
    law = Stribeck(0.8, 0.4, stribeck_velocity=0.5)
    dt = 0.002
    model, m, d = box_on_plane(0.0, dt, velocity=1.0)
    add_friction(model, m, d, ("box", "floor"), law)
    run(m, d, 0.6, dt)
    v = np.linspace(0.0, 1.0, 100_001)
    mu = 0.4 + 0.4 * np.exp(-v / 0.5)
    exact = np.trapezoid(v / (mu * GRAVITY), v)
    # mu is that of the step's start, where the box is faster by half a step's loss, dt/2 g mu, than in its middle
    late = 0.5 * dt * np.trapezoid(v * (mu - 0.4) / 0.5 / mu, v)
    assert np.abs(d.qpos.numpy()[:, 0] + 1.0 * dt / 2.0 - exact - late).max() < 5e-4 * exact  # second order, settling


def test_coefficients_are_the_cpus_in_every_world():
    process = Knots(sigma_s=0.015, sigma_k=0.023, spacing=0.01)
    dt = 0.002
    model, m, d = box_on_plane(10.0, dt)
    friction = add_friction(model, m, d, ("box", "floor"), Friction(LAW, process), seed=5, contact=2, first_sample=100)
    for n in range(40):
        mjw.step(m, d)
        if n % 13 == 0:
            for world in (0, 63):
                path = CoefficientPath(process, LAW, seed=5, sample=100 + world, contact=2)
                mu_s, mu_k = path.at(n * dt)
                assert friction.mu_s.numpy()[world] == np.float32(mu_s)
                assert friction.mu_k.numpy()[world] == np.float32(mu_k)


def test_a_repeated_forward_changes_nothing():
    dt = 0.002
    final = []
    for repeats in (0, 3):
        model, m, d = box_on_plane(0.0, dt, nworld=2, velocity=1.0)
        add_friction(model, m, d, ("box", "floor"), LAW)
        for _ in range(200):
            for _ in range(repeats):
                mjw.forward(m, d)
            mjw.step(m, d)
        final.append(d.qpos.numpy()[:, 0])
    # the warm start of the solver differs, so that its iterations end elsewhere within its tolerance
    assert np.abs(final[0] - final[1]).max() < 1e-5


@pytest.mark.parametrize("kind", ["coulomb", "elastic_stick", "havsin"])
def test_a_thrown_box_gains_no_energy(kind):
    n, rng = 16, np.random.default_rng(1)
    model, m, d = box_on_plane(0.0, 0.002, nworld=n)
    q, v = np.zeros((n, 7)), rng.normal(size=(n, 6)) * [2.0, 2.0, 1.0, 5.0, 5.0, 5.0]
    q[:, 2], q[:, 3:] = 0.25, rng.normal(size=(n, 4))
    q[:, 3:] /= np.linalg.norm(q[:, 3:], axis=1)[:, None]
    d.qpos.assign(q)
    d.qvel.assign(v)
    add_friction(model, m, d, ("box", "floor"), make_law(kind, mu_s=0.8, mu_k=0.46))

    def energy():
        v = d.qvel.numpy().astype(float)
        turning = (model.body_inertia[1] * v[:, 3:] ** 2).sum(axis=1)
        return 0.5 * ((v[:, :3] ** 2).sum(axis=1) + turning) + GRAVITY * d.qpos.numpy()[:, 2]

    last = energy()
    for _ in range(400):
        mjw.step(m, d)
        now = energy()
        assert (now - last).max() < 0.0173  # what MuJoCo's own soft contacts give back in a step, of 7 J; ours: .0089
        last = now
