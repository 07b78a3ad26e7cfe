"""Laws that creep at rest, elastic ones, and coefficients along a contact's own path, in every one of 64 worlds."""

import math

import mujoco_warp as mjw
import numpy as np
import pytest
from scipy.optimize import brentq

from stochfric_mb import Coulomb, ElasticStick, Friction
from stochfric_mb.coefficients import PerEvent, Spatial
from stochfric_mb.laws import make_law
from stochfric_mb.mujoco import Joint
from stochfric_mb.warp import add_friction
from tests.warp.scenes import GRAVITY, box_on_plane, run, tilt
from tests.warp.test_joints import slider

CREEPING = ["havsin", "piecewise_linear", "smooth", "tanh"]


def creep_of(law, ratio):
    """Return the speed at which a law has a given share of the normal force [m/s]."""
    functions, p = law.functions(), law.parameters()
    return brentq(lambda v: functions.sliding_coefficient(v, law.mu_s, law.mu_k, p) - ratio, 0.0, law.peak_speed, xtol=1e-14)


@pytest.mark.parametrize("kind", CREEPING)
def test_a_box_creeps_at_the_speed_at_which_its_law_holds_it(kind):
    law, dt = make_law(kind, mu_s=0.8, mu_k=0.46), 0.002
    model, m, d = box_on_plane(15.0, dt)
    friction = add_friction(model, m, d, ("box", "floor"), law)
    run(m, d, 0.5, dt)
    before = d.qpos.numpy()[:, 0].copy()
    run(m, d, 0.5, dt)
    creep = creep_of(law, math.tan(math.radians(15.0)))
    # the contacts' force to 1e-6 of it, which moves the speed by up to ten times that; the box still rocks by a nm
    assert np.abs(d.qpos.numpy()[:, 0] - before - 0.5 * creep).max() < 1e-4 * 0.5 * creep + 1e-9
    friction.observe(d)
    assert friction.friction_force.numpy()[:, 0] == pytest.approx([-GRAVITY * math.sin(math.radians(15.0))] * 64, rel=1e-4)
    assert friction.stick.numpy().all()


def test_a_joint_creeps_at_the_speed_of_its_law():
    law, dt = make_law("havsin", mu_s=1.0, mu_k=0.6), 0.002
    model, m, d = slider(dt)
    add_friction(model, m, d, Joint("x"), law, normal_force=10.0)
    push = np.zeros((64, model.nv), dtype=np.float32)
    push[:, 0] = 5.0
    d.qfrc_applied.assign(push)
    run(m, d, 0.2, dt)
    before = d.qpos.numpy()[:, 0].copy()
    run(m, d, 0.5, dt)
    assert np.abs((d.qpos.numpy()[:, 0] - before) / (0.5 * creep_of(law, 0.5)) - 1.0).max() < 1e-4  # as above


def test_an_elastic_contact_yields_by_its_own_stiffness():
    dt, e_lim = 0.001, 1e-4
    moved = []
    for law in (Coulomb(0.8, 0.46), ElasticStick(0.8, 0.46, e_lim=e_lim)):
        model, m, d = box_on_plane(0.0, dt)
        add_friction(model, m, d, ("box", "floor"), law)
        for degrees in np.linspace(0.0, 20.0, 400):  # slowly: a sudden load would swing it
            tilt(m, degrees)
            mjw.step(m, d)
        run(m, d, 0.3, dt)
        moved.append(d.qpos.numpy()[:, 0].copy())
    yielded = e_lim * math.tan(math.radians(20.0)) / 0.8
    assert (moved[1] - moved[0]) == pytest.approx([yielded] * 64, rel=0.02)  # a rigid contact, too, yields by some 2 um


def test_a_spring_that_a_step_cannot_follow_holds_as_a_rigid_law_does():
    dt = 0.001
    model, m, d = box_on_plane(0.0, dt)
    add_friction(model, m, d, ("box", "floor"), ElasticStick(0.8, 0.46, e_lim=1e-8))
    for degrees in np.linspace(0.0, 20.0, 400):
        tilt(m, degrees)
        mjw.step(m, d)
    run(m, d, 0.2, dt)
    before = d.qpos.numpy()[:, 0].copy()
    run(m, d, 0.3, dt)
    assert np.abs(d.qpos.numpy()[:, 0] - before).max() < 1e-6  # float32 of a position of micrometres; unclipped it shakes


@pytest.mark.parametrize("law", [Coulomb(0.8, 0.46), make_law("havsin", mu_s=0.8, mu_k=0.46)], ids=lambda law: law.kind)
def test_coefficients_along_the_path_of_a_contact(law):
    process = Spatial(sigma_s=0.03, sigma_k=0.03, spacing=0.02)
    dt = 0.002
    model, m, d = box_on_plane(0.0, dt, nworld=8, velocity=1.0)
    friction = add_friction(model, m, d, ("box", "floor"), Friction(law, process), seed=5, contact=2, first_sample=100)
    start = d.qpos.numpy()[:, 0].copy()
    for n in range(60):
        before = d.qpos.numpy()[:, 0].copy()
        mjw.step(m, d)
        friction.observe(d)
        for world in (0, 7):
            path = Friction(law, process).path(5, 100 + world, 2)
            # the floor moves backwards relative to the box; a corner rocks by less than 1e-5 m, float32 holds 1e-7
            mu_s, mu_k = path.at(n * dt, position=-(before[world] - start[world]))
            assert friction.mu_s.numpy()[world] == pytest.approx(mu_s, abs=0.1 / 0.02 * 1e-5)
            assert friction.mu_k.numpy()[world] == pytest.approx(mu_k, abs=0.1 / 0.02 * 1e-5)
    assert (d.qpos.numpy()[:, 0] > 3 * 0.02).all()


def test_coefficients_of_each_stick_phase():
    law, process = Coulomb(0.8, 0.46), PerEvent(sigma_s=0.03, sigma_k=0.03)
    dt = 0.002
    model, m, d = slider(dt, nworld=4)
    friction = add_friction(model, m, d, Joint("x"), Friction(law, process), normal_force=10.0, seed=5)
    push = np.zeros((4, model.nv), dtype=np.float32)
    seen = []
    for force in (0.0, 12.0, 0.0, 12.0, 0.0):  # it sticks, slides, sticks again: 12 N for .1 s are gone after .2 s of 4.6 N
        push[:, 0] = force
        d.qfrc_applied.assign(push)
        run(m, d, 0.1 if force else 0.3, dt)
        seen.append(friction.mu_s.numpy().copy())
    for world in range(4):
        path = Friction(law, process).path(5, world, 0)
        expected = [path.at(0.0, events=n)[0] for n in (0, 0, 1, 1, 2)]
        assert [row[world] for row in seen] == pytest.approx(expected, abs=1e-6)  # float32


def test_each_world_creeps_by_its_own_law():
    dt, v_s = 0.002, 1e-4 * np.array([1.0, 2.0, 3.0, 4.0])
    model, m, d = box_on_plane(15.0, dt, nworld=4)
    law = make_law("havsin", mu_s=0.8, mu_k=0.46)
    friction = add_friction(model, m, d, ("box", "floor"), law)
    friction.set_parameters(v_s=v_s)
    run(m, d, 0.5, dt)
    before = d.qpos.numpy()[:, 0].copy()
    run(m, d, 0.3, dt)
    creep = creep_of(law, math.tan(math.radians(15.0))) * v_s / law.v_s  # the rising branch scales with v_s
    assert (d.qpos.numpy()[:, 0] - before) == pytest.approx(0.3 * creep, rel=1e-4, abs=1e-9)  # as above
