"""Worlds are each their own: paths, laws, resets, and world k alone as among many."""

import math

import mujoco_warp as mjw
import numpy as np
import pytest
import warp as wp

from stochfric_mb import Coulomb, ElasticStick, Friction, Knots, Stribeck
from stochfric_mb.coefficients import Lognormal, Uniform
from stochfric_mb.errors import InputError
from stochfric_mb.mujoco import Joint
from stochfric_mb.warp import Domain, Spread, add_friction
from tests.warp.scenes import GRAVITY, box_on_plane, run, same
from tests.warp.test_joints import slider

LAW = Coulomb(0.8, 0.46)
RANDOM = Friction(LAW, Knots(sigma_s=0.015, sigma_k=0.023, spacing=0.01))
DT = 0.002


def test_world_k_alone_is_world_k_among_many():
    final = []
    for nworld, first in ((4096, 0), (1, 37)):
        model, m, d = box_on_plane(0.0, DT, nworld=nworld, velocity=1.0)
        add_friction(model, m, d, ("box", "floor"), RANDOM, seed=3, first_sample=first)
        run(m, d, 0.1, DT)
        final.append((d.qpos.numpy(), d.qvel.numpy()))
    for many, alone in zip(*final, strict=True):
        assert same(many[37], alone[0])
        assert not same(many[36], alone[0])


def test_a_reset_world_begins_anew_and_disturbs_no_other():
    trajectories = []
    for reset in (False, True):
        model, m, d = box_on_plane(0.0, DT, nworld=4, velocity=1.0)
        friction = add_friction(model, m, d, ("box", "floor"), RANDOM, seed=3)
        start = d.qpos.numpy().copy(), d.qvel.numpy().copy()
        rows = []
        for n in range(120):
            if reset and n == 60:
                mask = wp.array([False, True, False, False], dtype=bool)
                mjw.reset_data(m, d, mask)
                d.qvel.assign(np.where(np.arange(4)[:, None] == 1, start[1], d.qvel.numpy()))
                d.qpos.assign(np.where(np.arange(4)[:, None] == 1, start[0], d.qpos.numpy()))
            mjw.step(m, d)
            rows.append(np.column_stack([d.qpos.numpy()[:, 0], friction.mu_s.numpy()]))
        trajectories.append(np.array(rows))
    plain, reset = trajectories
    assert same(plain[:, [0, 2, 3]], reset[:, [0, 2, 3]])
    assert same(reset[60:, 1], plain[:60, 1])  # the same path and the same motion
    assert not same(reset[60:, 2], plain[:60, 2])


def test_an_episode_of_its_own_path():
    model, m, d = box_on_plane(10.0, DT, nworld=2)
    friction = add_friction(model, m, d, ("box", "floor"), RANDOM, seed=3, new_paths=True)
    first = []
    for _ in range(2):
        mjw.step(m, d)
        first.append(friction.mu_s.numpy().copy())
        mjw.step(m, d)
        mjw.reset_data(m, d)
    expected = [RANDOM.path(3, sample, 0).at(0.0)[0] for sample in (0, 1, 2, 3)]
    assert np.concatenate(first) == pytest.approx(expected, rel=1e-6)  # float32


def test_laws_are_drawn_for_each_world_and_episode():
    law = Stribeck(0.8, 0.6, stribeck_velocity=0.01)
    domain = Domain(
        sigma_s=0.06, sigma_k=0.06, distribution_s=Uniform(), parameters={"stribeck_velocity": Spread(0.003, Lognormal())}
    )
    n = 2000
    model, m, d = box_on_plane(0.0, DT, nworld=n)
    friction = add_friction(model, m, d, ("box", "floor"), law, seed=11)
    friction.randomise(domain)
    drawn = []
    for _ in range(2):
        friction.steer(m, d)
        drawn.append(friction.worlds.parameters.numpy().copy())
        friction.restart()
    assert (drawn[0] != drawn[1])[:, :3].all()
    for mu_s, mu_k, velocity, _ in (rows.T for rows in drawn):
        assert (mu_s > mu_k).all()
        assert (mu_k >= 0.0).all()
        # 4 standard errors; 1 % of the pairs are redrawn, which moves the means by less than half of one
        assert abs(velocity.mean() - 0.01) < 4.0 * 0.003 / math.sqrt(n)
        assert abs(mu_s.mean() - 0.8) < 5.0 * 0.06 / math.sqrt(n)
        assert abs(mu_s.std() - 0.06) < 5.0 * 0.06 / math.sqrt(2 * n)
    friction.restart(wp.array(np.arange(n) == 5, dtype=bool))
    friction.steer(m, d)
    third = friction.worlds.parameters.numpy().copy()
    # the episode that followed `drawn[1]` was asked for by restart() in all worlds
    assert (third[:, 0] != drawn[1][:, 0]).all()
    friction.restart(wp.array(np.arange(n) == 5, dtype=bool))
    friction.steer(m, d)
    assert np.flatnonzero(friction.worlds.parameters.numpy()[:, 0] != third[:, 0]).tolist() == [5]


def test_each_world_stops_by_its_own_law():
    nworld = 8
    mu_k = np.linspace(0.3, 0.7, nworld)
    model, m, d = box_on_plane(0.0, DT, nworld=nworld, velocity=1.0)
    friction = add_friction(model, m, d, ("box", "floor"), LAW)
    friction.set_parameters(mu_k=mu_k)
    run(m, d, 0.5, DT)
    exact = 1.0 / (2.0 * mu_k * GRAVITY) - 1.0 * DT / 2.0
    assert np.abs(d.qpos.numpy()[:, 0] / exact - 1.0).max() < 2e-3  # half a step of what decelerates, .9 m/s^2 apart


def test_parameters_that_make_no_law_are_refused():
    model, m, d = box_on_plane(nworld=2)
    friction = add_friction(model, m, d, ("box", "floor"), ElasticStick(0.8, 0.46))
    with pytest.raises(InputError, match=r"world 1: mu_k = 0\.9 is above mu_s"):
        friction.set_parameters(mu_k=[0.5, 0.9])
    with pytest.raises(InputError, match="unknown parameter of law elastic_stick 'mu_d'"):
        friction.set_parameters(mu_d=0.5)
    with pytest.raises(InputError, match=r"shape \(3,\); give a number or one for each of 2 worlds"):
        friction.set_parameters(mu_s=[0.5, 0.9, 1.0])
    with pytest.raises(InputError, match="cannot scatter by itself"):
        friction.randomise(Domain(parameters={"mu_s": Spread(0.1)}))
    with pytest.raises(InputError, match="sigma of v_s"):
        friction.randomise(Domain(parameters={"v_s": Spread(-0.1)}))


@pytest.mark.skipif(wp.get_preferred_device().is_cuda, reason="NumPy reads no memory of a GPU")
def test_readings_are_arrays_on_the_device_that_others_read_without_a_copy():
    model, m, d = box_on_plane(20.0, DT, nworld=4)
    friction = add_friction(model, m, d, ("box", "floor"), LAW)
    shared = np.from_dlpack(friction.normal_force)
    run(m, d, 0.3, DT)
    friction.observe(d)
    assert shared == pytest.approx([GRAVITY * math.cos(math.radians(20.0))] * 4, rel=1e-3)  # it still settles


@pytest.mark.parametrize("bridge", ["torch", "jax"])
def test_readings_go_to_other_libraries(bridge):
    pytest.importorskip(bridge, reason=f"{bridge} is not installed")
    model, m, d = box_on_plane(20.0, DT, nworld=2)
    friction = add_friction(model, m, d, ("box", "floor"), LAW)
    mjw.step(m, d)
    friction.observe(d)
    there = getattr(wp, f"to_{bridge}")(friction.normal_force)
    assert np.asarray(there.cpu() if bridge == "torch" else there) == pytest.approx(friction.normal_force.numpy())


def test_a_step_copies_nothing_to_the_host(monkeypatch):
    model, m, d = box_on_plane(20.0, DT, nworld=2)
    friction = add_friction(model, m, d, ("box", "floor"), RANDOM)
    joint, (m_2, d_2) = slider_friction()
    mjw.step(m, d)
    mjw.step(m_2, d_2)

    def refuse(*_args, **_kwargs):
        raise AssertionError("copied to the host")

    for name in ("numpy", "list", "__array__"):
        monkeypatch.setattr(wp.array, name, refuse, raising=False)
    monkeypatch.setattr(wp, "copy", refuse)
    monkeypatch.setattr(wp, "synchronize", refuse)
    friction.steer(m, d)
    friction.observe(d)
    joint.steer(m_2, d_2)
    joint.observe(d_2)


def slider_friction():
    model, m, d = slider(DT, nworld=2)
    return add_friction(model, m, d, Joint("x"), RANDOM, normal_force=10.0), (m, d)


def test_a_captured_graph_does_what_single_calls_do():
    final = []
    for captured in (False, True):
        model, m, d = box_on_plane(0.0, DT, nworld=2, velocity=1.0)
        add_friction(model, m, d, ("box", "floor"), RANDOM, seed=3)
        mjw.step(m, d)
        if captured:
            with wp.ScopedCapture() as capture:
                mjw.step(m, d)
        for _ in range(100):
            if captured:
                wp.capture_launch(capture.graph)
            else:
                mjw.step(m, d)
        final.append((d.time.numpy()[0], d.qpos.numpy()[:, 0].copy()))
    (plain_time, plain), (graph_time, graph) = final
    assert graph_time == pytest.approx(plain_time, abs=1.5 * DT)  # capturing runs the step, or does not, with the device
    assert graph == pytest.approx(plain, abs=1.5 * DT)
    assert (plain > 0.05).all()
