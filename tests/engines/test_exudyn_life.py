"""What scripts do with systems beside solving them: deleting, resetting, solver objects, statics, several contacts."""

# ruff: noqa: E402  (the adapter can be imported only where exudyn is)

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

exudyn = pytest.importorskip("exudyn", reason="exudyn is not installed")

from exudyn.itemInterface import CoordinateSpringDamper, LoadCoordinate, MarkerNodeCoordinate, Mass1D, Node1D

from stochfric_mb.coefficients import Knots
from stochfric_mb.errors import InputError, SimulationError, StabilityError
from stochfric_mb.exudyn import add_bristle, add_friction, add_friction_load, silent_settings, solve_dynamic
from stochfric_mb.friction import Friction
from stochfric_mb.laws import make_law
from tests.engines.exudyn_systems import block

LAW = make_law("elastic_stick", mu_s=0.4, mu_k=0.3)
RANDOM = Friction(LAW, Knots(sigma_s=0.02, sigma_k=0.02, spacing=0.01))
PULL: dict[str, Any] = {"normal_force": 10.0, "effective_mass": 1.0}
TYPES = {"rk44": exudyn.DynamicSolverType.RK44, "generalized_alpha": exudyn.DynamicSolverType.GeneralizedAlpha}


def run(mbs: Any, by: str, *, dt: float = 1e-3, solver: str = "rk44") -> float:
    """Return the first coordinate [m] after 0.1 s, by one of the ways to solve."""
    settings = silent_settings(dt, 0.1)
    if by == "solve_dynamic":
        solve_dynamic(mbs, settings, solver=solver, locate=False)
    elif by == "SolveDynamic":
        mbs.SolveDynamic(settings, solverType=TYPES[solver])
    else:
        settings.timeIntegration.solverType = TYPES[solver]
        kind = exudyn.MainSolverExplicit if solver == "rk44" else exudyn.MainSolverImplicitSecondOrder
        solver_object = kind()
        if by == "SolveSystem":
            assert solver_object.SolveSystem(mbs, settings)
        else:
            solver_object.InitializeSolver(mbs, settings)
            solver_object.SolveSteps(mbs, settings)
            solver_object.FinalizeSolver(mbs, settings)
    return float(mbs.systemData.GetODE2Coordinates()[0])


SLID, FREE = 1.0 * 0.1 - 0.5 * 3.0 * 0.1**2, 0.1


@pytest.mark.parametrize("add", [add_friction, add_friction_load])
@pytest.mark.parametrize("by", ["solve_dynamic", "SolveDynamic", "SolveSystem"])
def test_friction_that_is_deleted_is_gone(by: str, add: Any) -> None:
    mbs, _, ground, slide = block(1.0)
    contact = add(mbs, ground, slide, LAW, **PULL) if add is add_friction else add(mbs, slide, LAW, **PULL)
    mbs.Assemble()
    assert run(mbs, by) == pytest.approx(SLID, abs=1e-9)
    if add is add_friction:
        mbs.DeleteObject(contact.object, deleteDependentItems=False)
    else:
        mbs.DeleteLoad(contact.object, deleteDependentMarkers=False)
    mbs.Assemble()
    assert run(mbs, by) == pytest.approx(FREE, abs=1e-12)


@pytest.mark.parametrize("by", ["solve_dynamic", "SolveDynamic"])
def test_friction_is_found_again_when_others_are_deleted(by: str) -> None:
    mbs, _, ground, slide = block(1.0)
    spring = mbs.AddObject(CoordinateSpringDamper(markerNumbers=[ground, slide], stiffness=1000.0))
    contact = add_friction(mbs, ground, slide, LAW, **PULL)
    mbs.DeleteObject(spring, deleteDependentItems=False)
    mbs.Assemble()
    rows = contact.record([0.05])
    assert run(mbs, by) == pytest.approx(SLID, abs=1e-9)
    assert rows[0, 3] == pytest.approx(-3.0, rel=1e-12)
    assert contact.force == pytest.approx(-3.0, rel=1e-12)


@pytest.mark.parametrize("by", ["solve_dynamic", "SolveDynamic", "SolveSystem"])
def test_a_system_that_is_reset_has_no_friction(by: str) -> None:
    mbs, _, ground, slide = block(1.0)
    add_friction(mbs, ground, slide, LAW, **PULL)
    mbs.Assemble()
    run(mbs, by)
    mbs.Reset()
    node = mbs.AddNode(Node1D(referenceCoordinates=[0.0], initialCoordinates=[0.0], initialVelocities=[1.0]))
    mbs.AddObject(Mass1D(nodeNumber=node, mass=1.0))
    mbs.Assemble()
    assert run(mbs, by) == pytest.approx(FREE, abs=1e-12)


@pytest.mark.parametrize("solver", ["rk44", "generalized_alpha"])
@pytest.mark.parametrize("by", ["SolveSystem", "SolveSteps"])
def test_solver_objects_start_the_contacts(by: str, solver: str) -> None:
    """A contact left stuck elsewhere starts afresh, with its coefficients at t = 0 and its first step with friction."""
    mbs, _, ground, slide = block(1.0)
    add_friction(mbs, ground, slide, RANDOM, **PULL, seed=1)
    mbs.Assemble()
    expected = run(mbs, "SolveDynamic", solver=solver)
    assert [run(mbs, by, solver=solver) for _ in range(2)] == [expected, expected]


def test_solver_objects_refuse_a_step_beyond_the_limit() -> None:
    mbs, _, ground, slide = block(1.0)
    add_friction(mbs, ground, slide, LAW, **PULL)
    mbs.Assemble()
    with pytest.raises(StabilityError, match="beyond the stability limit"):
        run(mbs, "SolveSystem", dt=5e-3)


@pytest.mark.parametrize("kind", ["havsin", "tanh", "smooth", "piecewise_linear"])
def test_a_static_solution_without_friction_is_refused(kind: str) -> None:
    mbs, _, ground, slide = block(0.0)
    mbs.AddObject(CoordinateSpringDamper(markerNumbers=[ground, slide], stiffness=1000.0))
    mbs.AddLoad(LoadCoordinate(markerNumber=slide, load=2.0))
    add_friction(mbs, ground, slide, make_law(kind, mu_s=0.4, mu_k=0.3), **PULL)
    mbs.Assemble()
    printed, exudyn.config.printToConsole = exudyn.config.printToConsole, False
    try:
        with pytest.raises(InputError, match=rf"law {kind} gives friction to a moving contact alone"):
            mbs.SolveStatic(silent_settings(1.0, 1.0))
    finally:
        exudyn.config.printToConsole = printed


def test_a_static_solution_has_the_spring_of_elastic_stick() -> None:
    mbs, _, ground, slide = block(0.0)
    mbs.AddObject(CoordinateSpringDamper(markerNumbers=[ground, slide], stiffness=1000.0))
    mbs.AddLoad(LoadCoordinate(markerNumber=slide, load=2.0))
    add_friction(mbs, ground, slide, LAW, **PULL)
    mbs.Assemble()
    mbs.SolveStatic(silent_settings(1.0, 1.0))
    stiffness = 1000.0 + 0.4 * 10.0 / 1e-5  # and mu_s N/e_lim
    assert float(mbs.systemData.GetODE2Coordinates()[0]) == pytest.approx(2.0 / stiffness, rel=1e-6)


def test_contacts_are_numbered_as_they_are_added() -> None:
    mbs, node, ground, slide = block(0.0)
    other = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
    contacts = [add_friction(mbs, ground, m, RANDOM, **PULL, seed=3) for m in (slide, other)]
    bristle = add_bristle(mbs, ground, slide, RANDOM, **PULL, seed=3)
    contacts.append(add_friction_load(mbs, slide, RANDOM, **PULL, seed=3))
    contacts.append(add_friction(mbs, ground, slide, RANDOM, **PULL, seed=3, contact=1))
    assert [c.address for c in contacts] == [(3, 0, 0), (3, 0, 1), (3, 0, 3), (3, 0, 1)]
    own = [RANDOM.path(3, 0, c.address[2]).at(0.0) for c in contacts]
    assert [(c.mu_s, c.mu_k) for c in contacts] == own
    assert len(set(own)) == 3
    assert bristle._path.contact == 2


def test_the_outcome_of_solver_objects_is_checked() -> None:
    mbs, _, ground, slide = block(1.0)
    add_friction(mbs, ground, slide, LAW, **PULL)
    mbs.AddLoad(LoadCoordinate(markerNumber=slide, load=0.0, loadUserFunction=lambda mbs, t, load: np.nan if t > 0.05 else 0.0))
    mbs.Assemble()
    with pytest.raises(SimulationError, match="not finite"):
        run(mbs, "SolveSystem")


@pytest.mark.parametrize(("solver", "locate"), [("rk44", True), ("rk44", False), ("generalized_alpha", False)])
def test_a_run_goes_on_with_its_friction(solver: str, locate: bool) -> None:
    """In the middle of a stick phase of elastic stick, with random coefficients: as one run."""
    ends = []
    for parts in ((0.3,), (0.17, 0.13)):
        mbs, _, ground, slide = block(0.05)
        mbs.AddObject(CoordinateSpringDamper(markerNumbers=[ground, slide], stiffness=1000.0))
        contact = add_friction(mbs, ground, slide, RANDOM, **PULL, seed=1, surface_velocity=0.02)
        mbs.Assemble()
        start = 0.0
        for i, duration in enumerate(parts):
            solve_dynamic(mbs, silent_settings(1e-3, duration, start), solver=solver, locate=locate, resume=i > 0)
            start += duration
        ends.append([*mbs.systemData.GetODE2Coordinates(), *mbs.systemData.GetODE2Coordinates_t(), *contact.state])
    # sums of steps are rounded otherwise; a located step ends up to 1e-3 of a step beyond its switch
    assert ends[0] == pytest.approx(ends[1], rel=1e-9, abs=1e-9 if locate else 1e-12)


def test_a_run_goes_on_only_where_it_stopped() -> None:
    mbs, _, ground, slide = block(1.0)
    add_friction(mbs, ground, slide, LAW, **PULL)
    mbs.Assemble()
    with pytest.raises(InputError, match=r"resume: startTime = 0.1 s, but the last run stopped at t = nan s"):
        solve_dynamic(mbs, silent_settings(1e-3, 0.1, 0.1), resume=True)
    solve_dynamic(mbs, silent_settings(1e-3, 0.1))
    with pytest.raises(InputError, match=r"resume: startTime = 0.2 s, but the last run stopped at t = 0.1 s"):
        solve_dynamic(mbs, silent_settings(1e-3, 0.1, 0.2), resume=True)


def test_a_system_with_friction_of_velocity_can_be_linearised() -> None:
    mbs, _, ground, slide = block(0.0, 2.0)
    add_friction(mbs, ground, slide, make_law("havsin", mu_s=0.4, mu_k=0.3), **PULL)
    mbs.Assemble()
    assert mbs.ComputeLinearizedSystem()[0] == pytest.approx(2.0)
