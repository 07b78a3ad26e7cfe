"""What is left is held against: waves that come and go are flatter than noise, and a delay that does not explain is no name."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint import joint_outcome
from stochfric_mb.discovery.driven_joint.balance.timing import Timing
from stochfric_mb.discovery.driven_joint.decision import carry_over
from stochfric_mb.discovery.driven_joint.decision.adequacy import at_bound
from stochfric_mb.discovery.driven_joint.decision.carry_over import _waves
from stochfric_mb.discovery.driven_joint.decision.selection import Selector
from stochfric_mb.discovery.driven_joint.place import place_outcome
from stochfric_mb.discovery.driven_joint.source import source_of
from stochfric_mb.effects import make_effect
from stochfric_mb.measurement import Dataset
from stochfric_mb.scenario import any_scenario_from_dict
from tests.discovery.joints.test_parts import coulomb, grease, pair, scenario, sine_run


def test_a_sweep_is_flatter_than_noise_and_noise_is_not():
    t = np.linspace(0.0, 10.0, 2000)
    sweep = np.sin(2.0 * np.pi * (t + 0.4 * t**2))
    noise = np.random.default_rng(3).standard_normal(2000)
    assert _waves(sweep + 0.3 * noise, 200.0)
    assert not _waves(noise, 200.0)
    assert not _waves(0.5 * sweep + noise, 200.0)  # waves are the smaller part


def test_a_delay_that_shows_but_does_not_explain_is_a_puzzle():
    seen = Timing(0.005, 0.004, 0.006, 40.0, 0.1, 16)
    assert seen.beside(40.0, explains=True).named
    assert not seen.beside(40.0, explains=False).named
    assert seen.beside(40.0, explains=False).puzzling
    assert not seen.beside(5.0, explains=False).puzzling


def test_speed_and_place_together_are_no_dependence_on_either():
    # grease at one end of the stroke: 1.9 N at 0.67 m/s and 0.13 m, none at the middle
    result = joint_outcome(pair(lambda q, v: coulomb(q, v) + 22.0 * v * q)).result
    assert result.verdict == "unknown"
    assert any("position times speed and direction" in note for note in result.notes) or "position" in result.where.axis


@pytest.mark.parametrize(("held_out", "verdict"), [(12.0, "none"), (2.0, "unknown")])
def test_a_model_that_leaves_more_than_the_drive_holds_is_not_the_whole_truth(held_out, verdict):
    # the fit runs are explained to the noise either way; inertia alone moves the drive by 4 N (rms)
    runs = [sine_run(lambda q, v: 12.0 * np.sign(v), seed=i) for i in (1, 2)]
    runs.append(sine_run(lambda q, v: held_out * np.sign(v), seed=3, role="test", start=20.0))
    result = joint_outcome(Dataset(title="", scenario_path=None, scenario=scenario(), runs=tuple(runs))).result
    assert result.verdict == verdict
    assert verdict == "none" or result.where.axis == "run"


def test_each_by_itself_is_no_interaction():
    result = joint_outcome(pair(grease)).result
    assert [e.kind for e in result.effects] == ["viscous_friction"]
    assert not any(" times speed" in note for note in result.notes)


BELIEVED = {"mass": 0.05, "offset": 0.1, "mu_k": 0.05}
"""Stated standard deviations: of mass [-], offset [N] and mu_k [-]."""


def off_by(deviations):
    """Coulomb friction whose mu_k is off by so many of its stated standard deviations."""
    measured = pair(lambda q, v: (1.0 + BELIEVED["mu_k"] * deviations) * coulomb(q, v))
    scenario = dataclasses.replace(measured.scenario, uncertainty=BELIEVED)
    return dataclasses.replace(measured, scenario=scenario)


@pytest.mark.parametrize("deviations", [5.0, 10.0])
def test_friction_beyond_its_belief_is_a_finding(deviations):
    measured = off_by(deviations)
    (named,) = joint_outcome(measured).result.effects
    assert named.kind == "friction_level"
    assert named.parameters["mu_k"].value == pytest.approx(0.1 * (1.0 + BELIEVED["mu_k"] * deviations), rel=0.01)


@pytest.mark.parametrize(("factor", "said"), [(9.81, True), (5.0, False)])
def test_a_load_in_kilograms_is_told(factor, said):
    notes = joint_outcome(off_by((factor - 1.0) / BELIEVED["mu_k"])).result.notes
    assert any("is probably a mass in kg" in note for note in notes) == said


def test_friction_of_which_nothing_is_believed_may_be_anything():
    measured = off_by(10.0)
    scenario = dataclasses.replace(measured.scenario, uncertainty={"mass": 0.05, "offset": 0.1})
    assert joint_outcome(dataclasses.replace(measured, scenario=scenario)).result.verdict == "none"


@pytest.mark.parametrize("deviations", [-3.8, 3.0, 3.8])
def test_friction_near_the_end_of_its_belief_makes_no_effect_of_what_is_left(deviations):
    # against a belief that weighs too much, any effect that imitates its share of friction explains what it holds back
    place = joint_outcome(off_by(deviations)).places[0]
    assert not place.selected.named
    mu_k = place.selected.final.model.law.mu_k
    assert mu_k == pytest.approx(0.1 * (1.0 + BELIEVED["mu_k"] * deviations), abs=0.1 * BELIEVED["mu_k"] * 0.1)


def test_a_gain_that_waves_along_the_stroke_has_its_name():
    def waving(run):
        """The drive that is recorded where the amplifier gives 1 + 0.2 cos(2 pi q/0.15) of it."""
        force = run.channels["force"] / (1.0 + 0.2 * np.cos(2.0 * np.pi * run.channels["position"] / 0.15))
        return dataclasses.replace(run, channels=run.channels | {"force": force})

    measured = pair(coulomb)
    measured = dataclasses.replace(measured, runs=tuple(map(waving, measured.runs)))
    (named,) = joint_outcome(measured).result.effects
    assert named.kind == "drive_gain_change"
    assert abs(named.parameters["ripple"].value) == pytest.approx(0.2, rel=0.05)
    assert named.parameters["pitch"].value == pytest.approx(0.15, rel=0.02)


@pytest.mark.parametrize("loss", [0.2, 0.45])
@pytest.mark.parametrize("believed", [{"mass": 0.05, "offset": 0.1}, {"mass": 0.02, "offset": 0.1, "mu_k": 0.1}])
def test_a_gain_that_falls_to_both_ends_is_neither_a_payload_nor_a_spring(loss, believed):
    def leaving(run):
        """The drive that is recorded where a coil leaves its magnet: 1 - loss (q/0.13)^2 of it act, no less at the ends."""
        fallen = np.minimum((run.channels["position"] / 0.13) ** 2, 1.2)
        return dataclasses.replace(run, channels=run.channels | {"force": run.channels["force"] / (1.0 - loss * fallen)})

    measured = pair(coulomb)
    scenario = dataclasses.replace(measured.scenario, uncertainty=believed)
    measured = dataclasses.replace(measured, scenario=scenario, runs=tuple(map(leaving, measured.runs)))
    result = joint_outcome(measured).result
    (named,) = result.effects
    assert named.kind == "drive_gain_change"
    assert named.parameters["curvature"].value == pytest.approx(-loss / 0.13**2, rel=0.03)
    assert abs(named.parameters["change"].value) < 0.01
    assert result.gap.closed > 0.98


@pytest.mark.parametrize(("masses", "foretold"), [((4.0, 4.0, 4.0, 4.0), True), ((2.0, 4.0, 2.0, 4.0), False)])
def test_a_mass_beyond_its_belief_has_to_hold_in_runs_that_were_left_out(masses, foretold):
    runs = [sine_run(coulomb, mass=m, seed=i) for i, m in enumerate(masses)]
    source = source_of(Dataset(title="", scenario_path=None, scenario=scenario(), runs=tuple(runs)))
    balances, nuisances = source.balances("", "fit", 0.0), source.nuisances("")
    selector = Selector(balances, nuisances, source.stated(""))
    freed = next(f for f in selector._freed(selector.begin) if f.name == "mass")
    assert freed.score > criteria.NAMED
    assert selector._foretells(selector.begin, freed) == foretold


def test_a_number_at_the_end_of_its_range_stands_for_something_else():
    # inertia that is not there at all: a mass of 0 explains it best, and is no payload
    measured = pair(coulomb, mass=-0.5)
    source = source_of(measured)
    balances, nuisances = source.balances("", "fit", 0.0), source.nuisances("")
    selector = Selector(balances, nuisances, source.stated(""))
    assert "mass" not in [f.name for f in selector._freed(selector.begin)]


@pytest.mark.parametrize(
    ("heavier", "louder", "known", "kind", "same"),
    [
        (1.0, 1.4, 0.3, "drive_gain", ("payload",)),
        (1.0, 1.4, 0.02, "drive_gain", ()),
        (1.4, 1.0, 0.02, "payload", ()),
    ],
)
def test_a_drive_that_is_larger_by_a_factor_is_no_mass_where_friction_is_known(heavier, louder, known, kind, same):
    """Friction as stated tells a mass, which leaves it, from the factor of a drive that was stated as exact, which does not."""

    def recorded(run):
        return dataclasses.replace(run, channels=run.channels | {"force": louder * run.channels["force"]})

    measured = pair(coulomb, mass=2.0 * heavier)
    stated = dataclasses.replace(measured.scenario, uncertainty={"mass": 0.05, "mu_k": known})
    measured = dataclasses.replace(measured, scenario=stated, runs=tuple(map(recorded, measured.runs)))
    outcome = joint_outcome(measured)
    (named,) = outcome.result.effects
    assert named.kind == kind
    assert named.equivalent_to == same
    assert ("force gauge" in outcome.result.next_experiment) == bool(same)
    if kind == "drive_gain":
        number = named.parameters["drive_factor"]
        assert number.low < 1.0 / louder < number.high
        assert "for which no doubt is stated" in named.where.text
        assert "a gear, a unit or a scale" not in named.where.text
        # the augmented scenario is that drive: asked again, nothing is missing
        assert outcome.scenario.mechanism.drive_factor == pytest.approx(number.value)
        again = joint_outcome(dataclasses.replace(measured, scenario=outcome.scenario)).result
        assert again.verdict == "none"
        # errors were those of the recorded drive; now they are those of the true one
        assert again.gap.baseline == pytest.approx(number.value * outcome.result.gap.augmented, rel=1e-6)


def test_a_gear_that_was_left_out_is_a_factor_of_the_drive():
    """No motion needs 1/30 of the stated mass: what is beyond any belief is looked for as far as the data take it."""

    def at_the_motor(run):
        return dataclasses.replace(run, channels=run.channels | {"force": run.channels["force"] / 30.0})

    measured = pair(grease)
    stated = dataclasses.replace(measured.scenario, uncertainty={"mass": 0.05, "mu_k": 0.1, "offset": 0.1})
    result = joint_outcome(dataclasses.replace(measured, scenario=stated, runs=tuple(map(at_the_motor, measured.runs)))).result
    assert [e.kind for e in result.effects] == ["drive_gain", "viscous_friction"]
    number = result.effects[0].parameters["drive_factor"]
    assert number.low < 30.0 < number.high
    assert "a gear, a unit or a scale" in result.effects[0].where.text


def test_a_mass_that_nobody_doubts_is_no_surer_than_the_drive():
    """Nothing is stated of how sure the numbers are: a heavier mass and a weaker drive are one motion."""
    measured = pair(coulomb, mass=2.4)
    stated = dataclasses.replace(measured.scenario, uncertainty={})
    result = joint_outcome(dataclasses.replace(measured, scenario=stated)).result
    (named,) = result.effects
    assert {named.kind, *named.equivalent_to} == {"drive_gain", "payload"}
    assert "force gauge" in result.next_experiment


@pytest.mark.slow
def test_a_factor_of_the_drive_that_is_not_named_is_exact_again(monkeypatch):
    """Held-out runs do not bear it out: the answer is the stated drive's, and whatever is asked of it is asked with that."""

    def recorded(run):
        return dataclasses.replace(run, channels=run.channels | {"force": 1.4 * run.channels["force"]})

    measured = pair(coulomb)
    stated = dataclasses.replace(measured.scenario, uncertainty={"mass": 0.05, "mu_k": 0.02})
    measured = dataclasses.replace(measured, scenario=stated, runs=tuple(map(recorded, measured.runs)))
    place = place_outcome(source_of(measured), lambda _: None, "", [])
    assert place.selected.named == ("drive_factor",)
    monkeypatch.setattr(carry_over, "inadequate", lambda _: "it is not named")
    idle = carry_over.with_idle(place)
    assert {n.name for n in place.nuisances} - {n.name for n in idle.nuisances} == {"drive_factor"}
    assert idle.selected.nuisances == idle.nuisances
    assert at_bound(idle).startswith("needs mass")  # what believed numbers make of it


def test_a_wave_that_may_as_well_not_be_there_is_dropped():
    """Pure Coulomb friction: how large the ripple of a gain is along a thousand strokes, no record tells."""
    measured = pair(coulomb)
    source = source_of(measured)
    selector = Selector(source.balances("", "fit", 0.0), source.nuisances(""), source.stated(""))
    ripple = make_effect("drive_gain_change", ripple=1.0e-4, pitch=0.05, phase=0.3)
    final = selector._refitted(selector.begin, dataclasses.replace(selector.recalibrated.model, effects=(ripple,)))
    kept, effects = selector._without_zero(final, [None])
    assert effects == []
    assert kept.current.model.effects == ()


@pytest.mark.parametrize("off", [0.1, -0.1])
def test_the_length_of_a_pendulum_is_corrected_as_surely_as_it_is_stated(off):
    """Taken as exact, a length that is a tenth off is a spring, or a load that friction grows with."""
    mass, length, gravity = 2.0, 0.3, 9.81
    measured = pair(coulomb, mass=mass * length**2 * (1.0 + off) ** 2, gain=8.0)

    def about_an_axis(run):
        weight = mass * gravity * length * (1.0 + off) * np.sin(run.channels["position"])
        return dataclasses.replace(
            run, channels={"position": run.channels["position"], "torque": run.channels["force"] + weight}
        )

    def asked(**uncertainty):
        tables = {
            "schema": "stochfric.scenario/1",
            "mechanism": {"kind": "hinge_pendulum", "mass": mass, "length": length, "normal_force": 20.0},
            "law": {"kind": "coulomb", "mu_s": 0.1, "mu_k": 0.1},
            "uncertainty": uncertainty,
            "simulation": {"duration": 8.0, "output_step": 1.0e-3},
        }
        known = any_scenario_from_dict(tables)
        return joint_outcome(
            dataclasses.replace(measured, scenario=known, runs=tuple(map(about_an_axis, measured.runs)))
        ).result

    result = asked(length=0.1)
    assert result.verdict == "none"
    # a change of it by a tenth changes its square by a hundredth more than the slope there says
    assert result.parameters["length"].value == pytest.approx(length * (1.0 + off), rel=0.005)
    assert asked(inertia=0.1, normal_force=0.1).verdict != "none"


def test_an_uncertainty_of_what_no_data_correct_is_told():
    stated = dataclasses.replace(pair(coulomb).scenario, uncertainty={"mass": 0.05, "normal_force": 0.3, "mu_k": 0.1})
    result = joint_outcome(dataclasses.replace(pair(coulomb), scenario=stated)).result
    (note,) = (n for n in result.notes if "is not used" in n)
    assert "normal_force" in note
    assert "records correct mass here" in note
    assert not any("is not used" in n for n in joint_outcome(pair(coulomb)).result.notes)


@pytest.mark.parametrize(("white", "missing"), [(1.1, False), (0.9, True)])
def test_what_is_less_than_the_noise_of_the_channels_is_not_missing(white, missing, monkeypatch):
    """Counts of a clean encoder at constant speed are rounded alike in neighbouring windows, which then differ by less."""
    place = joint_outcome(pair(coulomb)).places[0]
    left = float(np.std(np.concatenate(place.selected.final.remainders)))
    monkeypatch.setattr(carry_over, "noise_floor", lambda *_: 0.1 * left)
    monkeypatch.setattr(carry_over, "white_floor", lambda *_: white * left)
    assert carry_over.above_floor(place) is missing
