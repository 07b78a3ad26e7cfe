"""`Contact` against the laws' own functions, its purity, its life and its refusals."""

from __future__ import annotations

import copy
import math
import pickle

import numpy as np
import pytest

from stochfric_mb.coefficients import Knots, PerEvent
from stochfric_mb.contact import Contact, PlaneContact
from stochfric_mb.errors import InputError, SimulationError
from stochfric_mb.friction import Friction
from stochfric_mb.laws import LAWS, Law, make_law

KNOTS = Knots(sigma_s=0.02, sigma_k=0.02, spacing=0.01)
MASS = 6.08


def friction(kind: str, process: object = KNOTS) -> Friction:
    return Friction(make_law(kind, mu_s=0.8, mu_k=0.46), process)


def motion(n: int = 200) -> list[tuple[float, float, float, float, float]]:
    """(t, u, v, normal force, hold) of a motion that sticks, slides both ways and turns over."""
    t = np.round(1e-3 * np.arange(n), 9)
    v = 5e-3 * np.sin(40.0 * t) * np.sin(90.0 * t)
    u = np.cumsum(v) * 1e-3
    return [tuple(map(float, row)) for row in zip(t, u, v, 13.0 + np.sin(70.0 * t), 12.0 * np.cos(55.0 * t), strict=True)]


@pytest.mark.parametrize("kind", sorted(LAWS))
def test_a_contact_is_the_law_on_the_path(kind: str) -> None:
    f = friction(kind)
    functions, p, path = f.law.functions(), f.law.parameters(), f.path(3, 1, 2)
    contact = Contact(f, effective_mass=MASS, seed=3, sample=1, contact=2, dt=1e-3)
    state = None
    for t, u, v, n, hold in motion():
        mu = path.at(t)
        if state is None:
            contact.start(t, u, v, n, hold=hold)
            state = functions.init(t, u, 0.0, v, 0.0, n, *mu, MASS, hold, 0.0, p)
        expected = functions.force(t, u, 0.0, v, 0.0, n, state, *mu, MASS, hold, 0.0, p)[0]
        assert contact.force(t, u, v, n, hold=hold) == expected  # the same arithmetic: to the bit
        contact.commit(t, u, v, n, hold=hold)
        state = functions.commit(t, u, 0.0, v, 0.0, n, state, *mu, MASS, hold, 0.0, p)
        assert list(contact.state.values()) == list(state)[: len(contact.state)]
        assert (contact.mu_s, contact.mu_k) == mu
        moded = f.law.state_names[:1] == ("mode",)
        assert contact.stick == (state[0] == 0.0 if moded else abs(v) <= f.law.stick_speed)


@pytest.mark.parametrize("kind", ["elastic_stick", "lugre", "coulomb"])
def test_asking_for_forces_changes_nothing(kind: str) -> None:
    quiet, asked = (Contact(friction(kind), effective_mass=MASS) for _ in range(2))
    rng = np.random.default_rng(1)
    for t, u, v, n, hold in motion(50):
        for _ in range(20):
            asked.force(t + rng.uniform(-0.1, 0.1), rng.normal(), rng.normal(), n, hold=hold)
        assert asked.force(t, u, v, n, hold=hold) == quiet.force(t, u, v, n, hold=hold)
        asked.commit(t, u, v, n, hold=hold)
        quiet.commit(t, u, v, n, hold=hold)
        assert asked.state == quiet.state


@pytest.mark.parametrize("kind", sorted(LAWS))
def test_a_plane_contact_turned_by_an_angle_is_the_line_turned(kind: str) -> None:
    line, plane = Contact(friction(kind, None), effective_mass=MASS), PlaneContact(friction(kind, None), effective_mass=MASS)
    c, s = math.cos(0.7), math.sin(0.7)
    for t, u, v, n, hold in motion():
        f = line.force(t, u, v, n, hold=hold)
        fx, fy = plane.force(t, (c * u, s * u), (c * v, s * v), n, hold=(c * hold, s * hold))
        assert (fx, fy) == pytest.approx((c * f, s * f), abs=1e-6)  # k_stick = 1e6 N/m times the rounding of u
        line.commit(t, u, v, n, hold=hold)
        plane.commit(t, (c * u, s * u), (c * v, s * v), n, hold=(c * hold, s * hold))


def test_a_contact_ends_without_normal_force_and_begins_anew() -> None:
    contact = Contact(friction("elastic_stick", None), effective_mass=MASS)
    assert contact.state == {}
    contact.commit(0.0, 0.0, 0.0, 13.0)
    assert contact.stick
    assert contact.force(0.1, 4e-6, 0.0, 13.0) == pytest.approx(0.4 * 0.8 * 13.0, rel=1e-12)  # 0.4 e_lim
    assert contact.force(0.1, 4e-6, 0.0, 0.0) == 0.0
    contact.commit(0.1, 4e-6, 0.0, 0.0)
    assert contact.state == {}
    assert not contact.stick
    contact.commit(0.2, 4e-6, 0.0, 13.0)
    assert contact.force(0.2, 4e-6, 0.0, 13.0) == 0.0  # a new spring, unloaded here


def test_draws_by_event_move_on_when_the_contact_comes_to_stick() -> None:
    f = friction("elastic_stick", PerEvent(sigma_s=0.02, sigma_k=0.02))
    contact, pairs = Contact(f, effective_mass=MASS, seed=4), f.path(4).pairs(3)
    contact.start(0.0, 0.0, 0.1, 13.0)
    u = 0.0
    for i, v in enumerate((0.1, 0.0, 0.0, 0.1, 0.1, -0.1, 0.0, 0.0), start=1):
        u += 0.1 * v
        contact.commit(0.1 * i, u, v, 13.0)
    assert contact.stick
    assert (contact.mu_s, contact.mu_k) == tuple(pairs[2])


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda c: pickle.loads(pickle.dumps(c))], ids=["deepcopy", "pickle"])
def test_a_copy_goes_its_own_way(copied) -> None:
    contact = Contact(friction("elastic_stick"), effective_mass=MASS, seed=2)
    for t, u, v, n, _ in motion(60):
        contact.commit(t, u, v, n)
    twin, state = copied(contact), contact.state
    rest = [row[:4] for row in motion()[60:]]
    first = [(twin.force(*row), twin.commit(*row), twin.mu_s) for row in rest]
    assert contact.state == state != twin.state
    assert [(contact.force(*row), contact.commit(*row), contact.mu_s) for row in rest] == first
    assert contact.state == twin.state


def test_summed_time_gives_the_same_coefficients() -> None:
    f = friction("havsin", Knots(sigma_s=0.02, sigma_k=0.02, spacing=0.001))
    contact, path, t = Contact(f, seed=1, dt=1e-4), f.path(1), 0.0
    unequal = 0
    for n in range(1, 2001):
        t += 1e-4
        unequal += t != n * 1e-4
        contact.commit(t, 0.0, 0.0, 13.0)
        assert contact.mu_s == path.at(round(n * 1e-4, 9))[0]
    assert unequal > 100  # summing does round


def test_refusals() -> None:
    with pytest.raises(InputError, match="elastic_stick needs effective_mass"):
        Contact(make_law("elastic_stick", mu_s=0.8, mu_k=0.46))
    with pytest.raises(InputError, match="effective_mass = 0"):
        Contact(make_law("havsin", mu_s=0.8, mu_k=0.46), effective_mass=0.0)
    with pytest.raises(InputError, match="dt = -1"):
        Contact(make_law("havsin", mu_s=0.8, mu_k=0.46), dt=-1.0)
    with pytest.raises(InputError, match="seed = -1"):
        Contact(make_law("havsin", mu_s=0.8, mu_k=0.46), seed=-1)
    with pytest.raises(InputError, match="neither a law nor a Friction"):
        Contact(Law)  # type: ignore[arg-type]
    contact = Contact(make_law("havsin", mu_s=0.8, mu_k=0.46))
    for call in (contact.start, contact.force, contact.commit):
        with pytest.raises(SimulationError, match=r"not finite: .*nan.*smaller step"):
            call(0.0, 0.0, math.nan, 13.0)
