"""Free parameters of a model: their values give the model back, and bounds hold."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.inference.free_parameter import LAW, MECHANISM
from stochfric_mb.discovery.stick_slip.records.record import make_record
from stochfric_mb.discovery.stick_slip.simulation.model import Model, adjusted, free_parameters
from stochfric_mb.discovery.stick_slip.simulation.natural_units import NaturalUnits
from stochfric_mb.discovery.stick_slip.simulation.prior_model import prior_model
from stochfric_mb.effects import make_effect
from stochfric_mb.errors import SimulationError
from stochfric_mb.laws import make_law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.scenario import Scenario

UNCERTAINTY = {"stiffness": 0.02, "mass": 0.02, "damping": 0.3}
RUNS = ("run_1.csv", "run_2.csv")
BOX = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
RIG = NaturalUnits(force=13.0, length=3.3e-3, time=0.04)


@pytest.fixture
def model() -> Model:
    force = make_effect("harmonic_force", amplitude=0.3, frequency=1.7)
    drag = make_effect("quadratic_damping", coefficient=40.0)
    own = {"run_1.csv": ({}, {"phase": 0.4}), "run_2.csv": ({}, {"phase": -2.0})}
    corrections = {"stiffness": 0.01, "mass": -0.005, "damping": 0.0}
    return Model(make_law("coulomb", mu_s=0.8, mu_k=0.46), corrections, (drag, force), None, own)


def test_free_parameters_at_their_values_give_the_model_back(model):
    free = free_parameters(model, UNCERTAINTY, RIG, RUNS)
    assert adjusted(model, free, [one.value for one in free]) == model


def test_free_parameters_are_what_may_be_adjusted(model):
    names = [(one.name, one.owner, one.run) for one in free_parameters(model, UNCERTAINTY, RIG, RUNS)]
    stated = [(n, LAW, "") for n in ("mu_s", "mu_k")] + [(n, MECHANISM, "") for n in ("stiffness", "mass", "damping")]
    phases = [("phase", 1, run) for run in RUNS]
    assert names == [*stated, ("coefficient", 0, ""), ("amplitude", 1, ""), ("frequency", 1, ""), *phases]


def test_what_is_certain_is_not_free(model):
    names = {one.name for one in free_parameters(model, {"stiffness": 0.0, "damping": 0.3}, RIG)}
    assert not {"stiffness", "mass"} & names
    assert "damping" in names


def test_moved_numbers_are_found_again(model):
    free = free_parameters(model, UNCERTAINTY, RIG, RUNS)
    moved = [one.value + 0.1 * one.scale for one in free]
    again = free_parameters(adjusted(model, free, moved), UNCERTAINTY, RIG, RUNS)
    assert [one.value for one in again] == pytest.approx(moved, rel=1e-12)


def test_values_beyond_the_bounds_are_held(model):
    free = free_parameters(model, UNCERTAINTY, RIG, RUNS)
    low = adjusted(model, free, [-1e9] * len(free))
    assert low.law.mu_s == pytest.approx(0.75 * model.law.mu_s)
    assert low.corrections["stiffness"] == pytest.approx(-3.0 * UNCERTAINTY["stiffness"])
    assert low.effects[1].frequency > 0.0


def test_kinetic_friction_never_exceeds_static(model):
    free = free_parameters(model, UNCERTAINTY, RIG)
    values = [{"mu_s": 0.65, "mu_k": 0.7}.get(one.name, one.value) for one in free]
    assert adjusted(model, free, values).law.mu_k == 0.65


def test_added_effect_starts_without_values_of_its_own(model):
    more = model.plus(make_effect("quadratic_damping", coefficient=1.0))
    assert [values[-1] for values in more.own.values()] == [{}, {}]
    assert more.effects_in("run_2.csv")[1] == dataclasses.replace(model.effects[1], phase=-2.0)
    assert more.effects_in("unheard_of.csv") == more.effects


def test_phases_along_the_belt_are_each_runs_own_those_along_the_stroke_are_not():
    law = make_law("coulomb", mu_s=0.8, mu_k=0.46)
    for axis, runs in (("belt", RUNS), ("position", ("",))):
        pattern = make_effect("position_dependent_friction", amplitude=0.1, wavelength=2e-3, axis=axis)
        phases = [one.run for one in free_parameters(Model(law, {}, (pattern,)), UNCERTAINTY, RIG, RUNS) if one.name == "phase"]
        assert phases == list(runs)


def test_a_number_that_begins_at_zero_has_a_step_in_the_rigs_own_units():
    spring = make_effect("nonlinear_stiffness", cubic=0.0, quadratic=0.0)
    free = free_parameters(Model(make_law("coulomb", mu_s=0.8, mu_k=0.46), {}, (spring,)), UNCERTAINTY, RIG)
    scales = {one.name: one.scale for one in free if one.owner == 0}
    assert scales["cubic"] == pytest.approx(0.01 * RIG.force / RIG.length**3)
    assert "quadratic" not in scales  # a spring without a square is another form


def test_a_model_whose_scatter_has_no_room_cannot_be_simulated(model):
    """A fit may bring mu_s and mu_k together: the answer is that this model does not run, not an error of the data."""
    scattering = dataclasses.replace(model.with_law(0.26, 0.26), effects=(), own={}).plus(
        make_effect("random_coefficients", sigma_s=0.01, sigma_k=0.01)
    )
    with pytest.raises(SimulationError, match=r"mu_s = 0\.26 and mu_k = 0\.26 are 0\.00 joint standard deviations apart"):
        scattering.system(make_record("run", np.arange(400) * 1e-3, np.zeros(400), BOX))


def test_waves_are_left_out_with_their_phases_and_what_is_along_the_stroke_is_none(model):
    along_belt = make_effect("position_dependent_friction", amplitude=0.1, wavelength=0.02)
    along_stroke = make_effect("position_dependent_friction", amplitude=0.1, wavelength=0.02, axis="position")
    own = {run: (*values, {"phase": 0.1}, {}) for run, values in model.own.items()}
    fuller = dataclasses.replace(model, effects=(*model.effects, along_belt, along_stroke), own=own)
    assert fuller.waves() == [1, 2]
    assert fuller.waves(("position_dependent_friction",)) == [2]
    left = fuller.without_waves(("position_dependent_friction",))
    assert left.effects == (*model.effects, along_stroke)
    assert left.own == {run: (*values, {}) for run, values in model.own.items()}
    assert fuller.without_waves(()) == fuller


def test_a_mean_that_is_fitted_leaves_what_is_random_in_its_place(model):
    """Phases of single runs were those of a model without the kick: asking again ended in a traceback."""
    kicks = make_effect("impacts", rate=2.0, impulse=0.01)
    drag, force = model.effects
    whole = dataclasses.replace(
        model, effects=(drag, kicks, force), own={run: (values[0], {}, values[1]) for run, values in model.own.items()}
    )
    assert whole.mean == model
    louder = dataclasses.replace(
        model, effects=(drag, dataclasses.replace(force, amplitude=0.5)), own={RUNS[0]: ({}, {"phase": 1.0})}
    )
    joined = whole.with_mean(louder)
    assert joined.mean == louder
    assert joined.effects_in(RUNS[0]) == (drag, kicks, dataclasses.replace(force, amplitude=0.5, phase=1.0))


def test_an_effect_that_draws_coefficients_declares_their_process():
    """The scenario that discovery writes states it so: it was a second process beside the one that is looked for."""
    drag = make_effect("quadratic_damping", coefficient=40.0)
    drawn = make_effect("random_coefficients", process="per_event", sigma_s=0.02, sigma_k=0.01, spacing=0.1)
    law = make_law("coulomb", mu_s=0.8, mu_k=0.46)
    stated = prior_model(Scenario(mechanism=BOX, law=law, duration=1.0, output_step=1e-3, effects=(drawn, drag)))
    assert stated.effects == (drag,)
    assert stated.process == drawn.coefficient_process()
    assert not stated.mean.random
