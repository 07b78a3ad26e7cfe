"""The generator itself against closed forms and limits, and its files against the documented formats."""

import math
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.discovery.generator.case import Case, make, write
from tests.discovery.generator.design import DESIGNS, FREE
from tests.discovery.generator.forms import FORMS
from tests.discovery.generator.integrator import MODE, N_STATES, SLIPS, V, X, simulate
from tests.discovery.generator.machine import FORCE, SIGNAL_SPACING, plain_machine

KINDS = frozenset(
    (
        "random_coefficients",
        "correlated_coefficients",
        "velocity_weakening",
        "viscous_friction",
        "dwell_ageing",
        "frictional_lag",
        "direction_asymmetry",
        "load_dependence",
        "presliding_compliance",
        "position_dependent_friction",
        "friction_drift",
        "normal_load_ripple",
        "belt_speed_ripple",
        "nonlinear_stiffness",
        "quadratic_damping",
        "backlash",
        "second_mode",
        "harmonic_force",
        "impacts",
        "sensor_drift",
        "sensor_step",
        "sensor_clipping",
        "sensor_outliers",
        "sensor_delay",
    )
)


def nominal(**changes: float):
    parameters = {
        "mass": 6.08,
        "damping": 0.768,
        "stiffness": 3956.0,
        "normal_force": 13.0,
        "belt_velocity": 2.5e-3,
        "mu_s": 0.8,
        "mu_k": 0.46,
    }
    return plain_machine(**(parameters | changes))


def test_undamped_cycle_is_the_closed_form():
    """c = 0: slip is a circle in (x - x_k, v/omega) from (x_s, v_b); stick lasts from its mirror image back to x_s."""
    mass, stiffness, load, belt, mu_s, mu_k = 6.08, 3956.0, 13.0, 2.5e-3, 0.8, 0.46
    omega = math.sqrt(stiffness / mass)
    jump = (mu_s - mu_k) * load / stiffness
    slip = 2.0 * (math.pi - math.atan(omega * jump / belt)) / omega
    period = slip + 2.0 * jump / belt

    states, _ = simulate(nominal(damping=0.0, duration=30.0), 30001)
    steady = states[3000:]
    starts = np.flatnonzero(np.diff(steady[:, SLIPS]) > 0)
    assert np.mean(np.diff(starts)) * SIGNAL_SPACING == pytest.approx(
        period, abs=2e-3 / (starts.size - 1)
    )  # sampled: 1 ms an end
    radius = math.hypot(jump, belt / omega)
    centre = mu_k * load / stiffness
    # sampling each millisecond misses an extreme by at most radius (omega 0.5 ms)^2 / 2
    missed = radius * (omega * 0.5e-3) ** 2 / 2.0
    assert centre - radius <= steady[:, X].min() <= centre - radius + missed + 1e-12
    assert centre + radius - missed - 1e-12 <= steady[:, X].max() <= centre + radius


def test_damped_transient_matches_published_positions():
    """x(2 s) and x(10 s) of Kang's Table 1 in the Coulomb limit, from rest."""
    at_rest = np.zeros(N_STATES)
    at_rest[MODE] = 1.0
    states, _ = simulate(nominal(duration=10.0), 10001, state=at_rest)
    assert states[2000, X] == pytest.approx(2.446805516646e-3, abs=1e-11)  # RK4 at 1e-4 s: (omega h)^4 of 1e-3 m, 1e-13
    assert states[10000, X] == pytest.approx(2.046679350891e-3, abs=1e-11)


def test_energy_balance():
    """What the belt and the drive put in is what spring and mass hold and damper and friction take."""
    machine = nominal(duration=20.0, excitation_amplitude=0.2e-3, excitation_angular_frequency=9.0)
    states, friction = simulate(machine, 20001)
    force = machine.signals[: states.shape[0], FORCE]
    power = (friction + force - 0.768 * states[:, V]) * states[:, V]
    energy = 0.5 * 6.08 * states[:, V] ** 2 + 0.5 * 3956.0 * states[:, X] ** 2
    work = float(np.sum(0.5 * (power[1:] + power[:-1])) * SIGNAL_SPACING)
    # friction jumps at each of ~20 break-aways, v = v_b there: the trapezoid errs by at most jump v_b dt / 2 each
    allowed = 25 * (0.34 * 13.0) * 2.5e-3 * SIGNAL_SPACING
    assert work == pytest.approx(float(energy[-1] - energy[0]), abs=allowed)


def test_stick_follows_the_belt_and_never_exceeds_the_limit():
    states, friction = simulate(nominal(duration=10.0), 10001)
    stuck = states[:, MODE] == 0.0
    assert 0.8 < np.mean(stuck) < 0.9
    np.testing.assert_allclose(states[stuck, V], 2.5e-3, atol=1e-15)
    assert np.max(np.abs(friction[stuck])) <= 0.8 * 13.0 * (1.0 + 1e-12)
    np.testing.assert_allclose(np.abs(friction[~stuck]), 0.46 * 13.0)


def test_half_the_step_gives_the_same_motion():
    coarse, _ = simulate(nominal(duration=10.0), 10001, step=1e-4)
    fine, _ = simulate(nominal(duration=10.0), 10001, step=5e-5)
    np.testing.assert_allclose(coarse[:, X], fine[:, X], atol=1e-11)


def test_reversed_belt_mirrors_the_motion():
    forward, _ = simulate(nominal(duration=10.0), 10001)
    backward, _ = simulate(nominal(duration=10.0, belt_velocity=-2.5e-3), 10001)
    np.testing.assert_allclose(backward[:, X], -forward[:, X], atol=1e-15)


def test_compliant_contact_tends_to_rigid_stick():
    rigid, _ = simulate(nominal(duration=3.0), 3001)
    distances = []
    for length in (20e-6, 5e-6):
        stiffness = 0.8 * 13.0 / length
        soft = nominal(duration=3.0)._replace(contact_length=length, contact_damping=0.6 * math.sqrt(stiffness * 6.08))
        states, _ = simulate(soft, 3001)
        distances.append(np.max(np.abs(states[:900, X] - rigid[:900, X])))  # the first stick, from the same start
    assert distances[0] < 20e-6
    assert distances[1] == pytest.approx(distances[0] / 4.0, rel=0.05)  # linear in the length


def test_vocabulary_is_covered():
    kinds = {form.kind for form in FORMS.values()}
    assert kinds == KINDS | {"unknown", "none"}
    assert sum(form.kind == "unknown" for form in FORMS.values()) >= 8


def _design_that_shows(kind: str) -> str:
    return {
        "load_dependence": "normal_loads",
        "direction_asymmetry": "reversed_belt",
        "dwell_ageing": "belt_speeds",
        "sensor_delay": "one_forced",
    }.get(kind, "one_free")


@pytest.mark.parametrize("name", [name for name, form in FORMS.items() if form.kind != "none"])
def test_each_effect_changes_the_record(name, monkeypatch):
    """By more than the noise, against the same rig without it."""
    design = DESIGNS[_design_that_shows(FORMS[name].kind)]
    short = replace(design, runs=tuple(replace(run, duration=5.0) for run in design.runs))
    monkeypatch.setitem(DESIGNS, design.name, short)
    monkeypatch.setattr("tests.discovery.generator.case._BURN_IN", (1.0, 2.0))
    made = make(Case(name, design.name, 0.5, 3))
    changed = made.record(0)
    plain = replace(made, effects=tuple(replace(e, alter=_keep, measure=_keep) for e in made.effects)).record(0)
    difference = changed["position [m]"] - plain["position [m]"]
    assert np.all(np.isfinite(changed["position [m]"]))
    assert np.max(np.abs(difference)) > 10e-6


def _keep(what, rng):
    del rng
    return what


def test_same_seed_same_bytes_other_seed_other_bytes(tmp_path, monkeypatch):
    _shorten("one_free", monkeypatch)
    for folder, seed in (("a", 5), ("b", 5), ("c", 6)):
        write(Case("random_coefficients.knots", "one_free", 0.5, seed), tmp_path / folder, tmp_path / f"{folder}.json")
    for file in ("run_1.csv", "run_3.csv", "scenario.toml", "dataset.toml"):
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes()
    assert (tmp_path / "a" / "run_1.csv").read_bytes() != (tmp_path / "c" / "run_1.csv").read_bytes()
    assert (tmp_path / "a" / "run_1.csv").read_bytes() != (tmp_path / "a" / "run_2.csv").read_bytes()


def _shorten(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    design = DESIGNS[name]
    monkeypatch.setitem(DESIGNS, name, replace(design, runs=tuple(replace(run, duration=2.0) for run in design.runs)))
    monkeypatch.setattr("tests.discovery.generator.case._BURN_IN", (1.0, 2.0))


@pytest.mark.parametrize(
    ("forms", "design"),
    [("sensor_delay.pure_delay", "several"), ("none.declared_scatter", "one_forced"), ("backlash.dead_zone", "one_free")],
)
def test_dataset_obeys_the_documented_format(forms, design, tmp_path, monkeypatch):
    _shorten(design, monkeypatch)
    folder = tmp_path / "dataset"
    write(Case(forms, design, 1.0, 0), folder, tmp_path / "truth.json")
    dataset = tomllib.loads((folder / "dataset.toml").read_text())
    assert dataset["schema"] == "stochfric.dataset/1"
    assert {run["role"] for run in dataset["runs"]} == {"fit", "test"}
    assert sorted(path.name for path in folder.iterdir()) == sorted(
        ["dataset.toml", dataset["scenario"], *(run["file"] for run in dataset["runs"])]
    )
    scenario = tomllib.loads((folder / dataset["scenario"]).read_text())
    assert scenario["schema"] == "stochfric.scenario/1"
    assert "effects" not in scenario
    assert scenario["law"]["kind"] == "coulomb"
    assert ("coefficients" in scenario) == (forms == "none.declared_scatter")
    for run in dataset["runs"]:
        assert set(run.get("set", {})) <= set(scenario["mechanism"])
        header = (folder / run["file"]).read_text().partition("\n")[0].split(",")
        assert header[:2] == ["time [s]", "position [m]"]
        table = np.loadtxt(folder / run["file"], delimiter=",", skiprows=1)
        np.testing.assert_allclose(table[:, 0], 1e-3 * np.arange(2001), atol=1e-12)
        assert np.all(np.isfinite(table))


def test_true_parameters_differ_from_the_believed_within_their_uncertainty():
    made = [make(Case("none", "one_free", 1.0, seed)) for seed in range(40)]
    relative = np.array([m.true.mu_s / FREE.mu_s - 1.0 for m in made])
    assert np.all(np.abs(relative) <= 0.1 + 1e-12)  # 2 standard deviations of 5 %
    assert 0.025 < np.std(relative) < 0.07  # 0.044 expected of the cut normal, +- 4 standard errors of 0.005
    assert all(m.true.belt_velocity == FREE.belt_velocity for m in made)


def test_forced_run_keeps_the_known_phase():
    """The excitation is k u_0 cos(W t) in record time, whatever the burn-in."""
    machine = make(Case("none", "one_forced", 1.0, 0)).machine(0)
    rig = DESIGNS["one_forced"].rig
    true = make(Case("none", "one_forced", 1.0, 0)).true
    expected = true.stiffness * rig.excitation_amplitude * np.cos(rig.excitation_angular_frequency * machine.time)
    np.testing.assert_allclose(machine.signals[:, FORCE], expected, atol=1e-12)


def test_truth_stays_outside_the_dataset(tmp_path, monkeypatch):
    _shorten("one_free", monkeypatch)
    folder = Path(tmp_path / "dataset")
    write(Case("position_dependent_friction.seam", "one_free", 1.0, 0), folder, tmp_path / "truth.json")
    for file in folder.iterdir():
        text = file.read_text()
        assert "seam" not in text
        assert "position_dependent" not in text
