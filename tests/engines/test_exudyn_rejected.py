"""Steps that Exudyn takes back: friction must not advance in them, and the answer is that of small fixed steps."""

# ruff: noqa: E402  (the adapter can be imported only where exudyn is)

from __future__ import annotations

import math

import numpy as np
import pytest

exudyn = pytest.importorskip("exudyn", reason="exudyn is not installed")

from exudyn.itemInterface import Force, MarkerBodyPosition, MarkerBodyRigid, ObjectGround, PrismaticJointX
from exudyn.utilities import RigidBodyInertia

from stochfric_mb import reference
from stochfric_mb.coefficients import Knots
from stochfric_mb.exudyn import add_friction, add_joint_friction, silent_settings, solve_dynamic
from stochfric_mb.friction import Friction
from stochfric_mb.laws import make_law
from tests.engines.test_exudyn_general import ROUTES, scenario

DT = 1e-3
FRICTION = Friction(
    make_law("elastic_stick", mu_s=0.8, mu_k=0.5, decay_velocity=0.0), Knots(sigma_s=0.03, sigma_k=0.03, spacing=0.01)
)


class Watch:
    """PreStep, PostStep and PostNewton functions that look at a contact in each trial of each step."""

    def __init__(self, mbs, contact, *, reject: float = 0.0) -> None:
        """Look at ``contact``; with ``reject``, take back every second step at first, for one so many times as long."""
        self.trials: list[list[tuple]] = [[]]
        self._contact, self._reject, self._turn, self._taken_back = contact, reject, 0, -1
        mbs.SetPreStepUserFunction(self.pre_step)
        mbs.SetPostStepUserFunction(self.post_step)
        if reject:
            mbs.SetPostNewtonUserFunction(self.post_newton)

    def look(self) -> tuple:
        c = self._contact
        return (*c.state, c.mu_s, c.mu_k, c.stick, c.normal_force)

    def pre_step(self, mbs, t: float) -> bool:
        self.trials[-1].append(self.look())
        return True

    def post_step(self, mbs, t: float) -> bool:
        self.trials.append([])
        return True

    def post_newton(self, mbs, t: float) -> list[float]:
        self.trials[-1].append(self.look())
        step = len(self.trials)
        if step % 2 and step != self._taken_back:
            self._taken_back = step
            return [10.0, self._reject * DT]
        return [0.0, -1.0]

    def check(self, taken_back: int) -> None:
        """All trials of a step began with the same friction; ``taken_back``: least number of steps tried again.

        Not the first step, which is tried twice where the normal force is a reaction: before it none is known.
        """
        tried = [t for t in self.trials[2:] if t]
        assert sum(len(t) > (2 if self._reject else 1) for t in tried) >= taken_back
        assert all(len(set(t)) == 1 for t in tried)
        assert len({t[0] for t in tried}) > 0.9 * len(tried)  # and moves on from step to step


@pytest.mark.parametrize("route", ROUTES)
def test_explicit_steps_that_an_error_estimate_takes_back(route) -> None:
    s = scenario(duration=2.0)
    exact = reference.simulate(s, seed=1)
    mbs, contact = route(s, 1)
    mbs.Assemble()
    watch = Watch(mbs, contact)
    settings = silent_settings(DT, s.duration)
    integration = settings.timeIntegration
    integration.automaticStepSize = integration.adaptiveStep = True
    integration.relativeTolerance = integration.absoluteTolerance = 1e-9
    solve_dynamic(mbs, settings, solver="dopri5", locate=False)
    taken_back = mbs.sys["dynamicSolver"].it.rejectedAutomaticStepSizeSteps
    assert taken_back > 10
    watch.check(taken_back=10)
    x = mbs.systemData.GetODE2Coordinates()[0]
    # 1e-9 in each of 4000 steps at most; the error that switches leave is one such tolerance each, some 30 of them
    assert x == pytest.approx(exact.position[-1], abs=1e-6)
    assert contact.mu_s == exact.mu_s[-1]


@pytest.mark.parametrize("route", ROUTES)
def test_implicit_steps_that_a_user_takes_back(route) -> None:
    s = scenario(duration=1.5)
    exact = reference.simulate(s, seed=1)
    mbs, contact = route(s, 1)
    mbs.Assemble()
    watch = Watch(mbs, contact, reject=0.37)
    rows = contact.record(s.output_times())
    solve_dynamic(mbs, silent_settings(DT, s.duration), solver="generalized_alpha")
    watch.check(taken_back=300)
    error = s.mechanism.belt_velocity * exact.time - rows[:, 1] - exact.position
    assert np.max(np.abs(error)) < 1e-5  # as without: steps are shorter, not longer
    assert np.array_equal(rows[:, 4], exact.mu_s)


# --- joints and rolling, against small fixed steps --------------------------------------------------------------------


def slide():
    """A body on a prismatic joint that a spring and a load in time push to and fro; the joint's reaction is N."""
    mbs = exudyn.SystemContainer().AddSystem()
    ground = mbs.AddObject(ObjectGround())
    inertia = RigidBodyInertia(mass=2.0, inertiaTensor=np.eye(3) * 0.02)
    body = mbs.CreateRigidBody(inertia=inertia, gravity=[0.0, -10.0, 0.0])
    markers = [mbs.AddMarker(MarkerBodyRigid(bodyNumber=b)) for b in (ground, body)]
    joint = mbs.AddObject(PrismaticJointX(markerNumbers=markers))
    mbs.CreateCartesianSpringDamper(itemNumbers=[ground, body], stiffness=[800.0, 0.0, 0.0], damping=[2.0, 0.0, 0.0])
    push = {"loadVectorUserFunction": lambda mbs, t, f: [30.0 * math.sin(15.0 * t), -6.0 * math.sin(20.0 * t), 0.0]}
    mbs.AddLoad(Force(markerNumber=markers[1], loadVector=[0.0] * 3, **push))
    return mbs, add_joint_friction(mbs, joint, FRICTION, effective_mass=2.0, seed=1), body


def ball():
    """A ball that spins on a turntable while its load changes."""
    mbs = exudyn.SystemContainer().AddSystem()
    spin = {"initialAngularVelocity": [0.0, 2.0, 0.0]}
    table = mbs.CreateRigidBody(inertia=RigidBodyInertia(mass=9.0, inertiaTensor=np.eye(3)), **spin)
    inertia = RigidBodyInertia(mass=1.0, inertiaTensor=np.eye(3) * 0.4 * 0.05**2)
    place = {"referencePosition": [0.2, 0.05, 0.0], "initialAngularVelocity": [20.0, 3.0, -30.0]}
    body = mbs.CreateRigidBody(inertia=inertia, **place)
    ground = mbs.AddObject(ObjectGround())
    mbs.CreateCartesianSpringDamper(itemNumbers=[ground, table], stiffness=[1e4] * 3, damping=[1e2] * 3)
    markers = [mbs.AddMarker(MarkerBodyPosition(bodyNumber=b)) for b in (table, body)]
    plane = {"normal": (0, 1, 0), "radius": 0.05, "effective_mass": 1.0 / 3.5}
    press = {"normal_force": lambda t: 5.0 * (1.0 + 0.3 * math.sin(20.0 * t))}
    return mbs, add_friction(mbs, *markers, FRICTION, **plane, **press, seed=1), body


@pytest.mark.parametrize(
    ("build", "tolerance"),
    [
        # breaking away passes v_s = 0.1 mm/s in 30 us, within a step: each time the velocity is off by as much, with or
        # without steps taken back (measured 0.10 and 0.11 mm/s), and the place by that for 0.2 s
        (slide, (2e-5, 2e-4)),
        (ball, (1e-6, 1e-5)),  # second order: measured 2e-7 m and 5e-6 m/s
    ],
)
def test_joints_and_rolling_with_steps_taken_back(build, tolerance: tuple[float, float]) -> None:
    ends = []
    for dt, reject in ((DT, 0.37), (0.2 * DT, 0.0)):
        mbs, contact, body = build()
        mbs.Assemble()
        watch = Watch(mbs, contact, reject=reject)
        solve_dynamic(mbs, silent_settings(dt, 0.3), solver="generalized_alpha")
        watch.check(taken_back=100 if reject else 0)
        output = exudyn.OutputVariableType
        ends.append([mbs.GetObjectOutputBody(body, variable) for variable in (output.Position, output.Velocity)])
        assert contact.mu_s == FRICTION.path(1, 0, 0).at(0.3)[0]
    for taken_back, fine, bound in zip(*ends, tolerance, strict=True):
        np.testing.assert_allclose(taken_back, fine, rtol=0.0, atol=bound)
