"""Exudyn calls compiled code by its address where it can; elsewhere Python calls it and gives the same."""

# ruff: noqa: E402  (the adapter can be imported only where exudyn is)

from __future__ import annotations

import dataclasses
import gc
import platform
import sys
from typing import Any

import numpy as np
import pytest

exudyn = pytest.importorskip("exudyn", reason="exudyn is not installed")

from exudyn.itemInterface import MarkerBodyPosition, ObjectGround

from stochfric_mb.exudyn import add_friction, add_friction_load, commits, pointers, silent_settings, solve_dynamic
from stochfric_mb.exudyn.belt_box import simulate
from stochfric_mb.laws import make_law
from stochfric_mb.scenario import load_scenario
from tests.engines.exudyn_systems import block, four_bar

LAW = make_law("elastic_stick", mu_s=0.4, mu_k=0.3)
EXACT = 1e-12
"""m: two ways of adding up the same terms, over 1000 steps at 1e-3 m."""


@pytest.fixture
def without_addresses(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let Exudyn be a build that calls no compiled functions."""
    monkeypatch.setattr(pointers, "calls_addresses", lambda: False)
    monkeypatch.setattr(commits, "_function", lambda: None)


@pytest.mark.skipif(
    not sys.platform.startswith("linux") or platform.machine() != "x86_64", reason="looked for on Linux and x86-64 alone"
)
def test_this_build_calls_addresses() -> None:
    assert pointers.calls_addresses()
    assert simulate(belt_box()).attributes["hook"].startswith("compiled")


def belt_box(**changes: Any) -> Any:
    return dataclasses.replace(load_scenario("kang2015_table2_13_8", law="elastic_stick"), duration=0.5, **changes)


@pytest.mark.parametrize("solver", ["rk44", "generalized_alpha"])
def test_python_gives_the_same(solver: str, request: pytest.FixtureRequest) -> None:
    compiled = simulate(belt_box(), seed=3, dt=1e-3, solver=solver)
    request.getfixturevalue("without_addresses")
    python = simulate(belt_box(), seed=3, dt=1e-3, solver=solver)
    assert python.attributes["hook"].startswith("Python")
    # the trapezoidal rule is solved to 1e-8 of the step's velocities
    assert np.max(np.abs(compiled.position - python.position)) < (EXACT if solver == "rk44" else 1e-9)


@pytest.mark.usefixtures("without_addresses")
def test_without_addresses_loads_run_in_python() -> None:
    mbs, _, _, slide = block(0.5, 2.0)
    contact = add_friction_load(mbs, slide, LAW, normal_force=20.0)
    mbs.Assemble()
    solve_dynamic(mbs, silent_settings(1e-3, 0.1), solver="rk44")
    # v0 - mu_k g t with the rise to mu_s below some mm/s out of reach here
    assert mbs.systemData.GetODE2Coordinates_t()[0] == pytest.approx(0.5 - 0.3 * 10.0 * 0.1, abs=1e-9)
    assert contact.force == pytest.approx(-6.0)


def test_the_functions_answer_python_too() -> None:
    mbs, _, ground, slide = block(0.5, 2.0)
    contact = add_friction(mbs, ground, slide, LAW, normal_force=20.0)
    mbs.Assemble()
    contact.prepare(1e-3, 0.0)
    item = mbs.GetObject(contact.object)
    assert item["springForceUserFunction"]["function"](mbs, 0.0, 0, 0.0, 0.5, item["stiffness"], 0.0, 0.0) == pytest.approx(6.0)
    assert mbs.GetPostStepUserFunction()["function"](mbs, 1e-3) is True


def test_an_unknown_build_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pointers, "_KNOWN_TYPE", b"PFvdE")
    assert pointers._own_record() is None
    monkeypatch.setattr(pointers, "_TYPE", 11)  # no address: reading there fails, and nothing else happens
    assert pointers._own_record() is None


def test_an_error_after_a_step_ends_the_run_and_comes_out() -> None:
    mbs, _, ground, slide = block(0.5, 2.0)
    add_friction(mbs, ground, slide, LAW, normal_force=20.0)
    seen: list[float] = []

    def fail(mbs: Any, t: float) -> bool:
        seen.append(t)
        raise LookupError("mine")

    mbs.SetPostStepUserFunction(fail)
    mbs.Assemble()
    for run in (
        lambda: solve_dynamic(mbs, silent_settings(1e-3, 0.1)),
        lambda: mbs.SolveDynamic(silent_settings(1e-3, 0.1), solverType=exudyn.DynamicSolverType.RK44, showHints=False),
    ):
        seen.clear()
        with pytest.raises(LookupError, match="mine"):
            run()
        assert len(seen) == 1


def test_systems_by_turns_and_systems_that_are_gone() -> None:
    systems = []
    for speed in (0.5, 0.8):
        mbs, _, ground, slide = block(speed, 2.0)
        systems.append((mbs, add_friction(mbs, ground, slide, LAW, normal_force=20.0)))
        mbs.Assemble()
    for mbs, _ in [*systems, *systems]:
        solve_dynamic(mbs, silent_settings(1e-3, 0.1))
    speeds = [mbs.systemData.GetODE2Coordinates_t()[0] for mbs, _ in systems]
    assert speeds == pytest.approx([0.2, 0.5], abs=1e-9)
    addresses = {pointers.system_address(mbs) for mbs, _ in systems}
    assert addresses <= set(commits._register()._rows[:, 0].tolist())
    for mbs, _ in systems:  # as the belt-box is closed
        mbs.variables.clear()
        mbs.sys.clear()
        mbs.Reset()
    systems.clear()
    del mbs, _
    gc.collect()
    assert not addresses & set(commits._register()._rows[:, 0].tolist())


def test_a_four_bar_without_addresses(request: pytest.FixtureRequest) -> None:
    angles = []
    for _ in range(2):
        system = four_bar(LAW, speed=4.0, radius=0.02)
        system.mbs.Assemble()
        solve_dynamic(system.mbs, silent_settings(1e-3, 0.1), solver="generalized_alpha")
        angles.append(np.array(system.mbs.systemData.GetODE2Coordinates()))
        request.getfixturevalue("without_addresses")
    assert np.max(np.abs(angles[0] - angles[1])) < 1e-9  # Newton's tolerance


@pytest.mark.parametrize("solver", ["rk44", "generalized_alpha"])
@pytest.mark.parametrize("pressed", [True, False])
def test_a_point_on_a_plane_without_addresses(solver: str, pressed: bool, request: pytest.FixtureRequest) -> None:
    """Thrown obliquely on a moving surface, pressed by a number or by a unilateral contact."""
    ends, routes = [], []
    for _ in range(2):
        mbs, contact = thrown(pressed=pressed)
        solve_dynamic(mbs, silent_settings(2.5e-4, 0.1), solver=solver)
        ends.append(np.array(mbs.systemData.GetODE2Coordinates()))
        routes.append(contact.route)
        request.getfixturevalue("without_addresses")
    assert routes == ["compiled", "Python"]
    assert np.max(np.abs(ends[0] - ends[1])) < (EXACT if solver == "rk44" else 1e-9)  # Newton's tolerance


def thrown(*, pressed: bool) -> tuple[Any, Any]:
    mbs = exudyn.SystemContainer().AddSystem()
    ground = mbs.AddMarker(MarkerBodyPosition(bodyNumber=mbs.AddObject(ObjectGround())))
    point = mbs.CreateMassPoint(mass=2.0, initialVelocity=[0.6, 0.3, 0.0], gravity=[0.0, 0.0, -9.81])
    press: dict[str, Any] = {"normal_force": 20.0} if pressed else {"contact_stiffness": 1e5, "contact_damping": 400.0}
    contact = add_friction(
        mbs, ground, mbs.AddMarker(MarkerBodyPosition(bodyNumber=point)), LAW,
        normal=(0.0, 0.0, 1.0), surface_velocity=(0.05, -0.02, 0.0), **press,
    )  # fmt: skip
    mbs.Assemble()
    return mbs, contact
