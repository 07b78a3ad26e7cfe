"""Scenario files: what is read, and what is refused with which words."""

import dataclasses
import re

import numpy as np
import pytest
import tomli_w

from stochfric_mb import Havsin, InputError, Knots, SimulationError, StabilityError, load_scenario
from stochfric_mb.coefficients import Empirical, TruncatedNormal
from stochfric_mb.scenario import any_scenario_from_dict, bundled_scenarios, fitting_step, scenario_from_dict

NAMES = ("kang2015_table1", "kang2015_table2_13_8", "kang2015_table2_18_7")


@pytest.mark.parametrize("name", NAMES)
def test_bundled_scenarios_round_trip(name):
    scenario = load_scenario(name)
    assert scenario_from_dict(scenario.to_dict()) == scenario
    assert bundled_scenarios().keys() >= set(NAMES)


def test_table_1_is_the_papers():
    scenario = load_scenario("kang2015_table1")
    m = scenario.mechanism
    assert (m.mass, m.damping, m.stiffness, m.normal_force, m.belt_velocity) == (6.08, 0.768, 3956.0, 13.0, 2.5e-3)
    assert scenario.process == Knots(sigma_s=0.015, sigma_k=0.023, spacing=0.01)
    assert scenario.n_outputs == 10_001


@pytest.mark.parametrize("step", [1.0e-6, 2.5e-5, 1.0e-3, 0.02])
def test_output_times_are_the_decimal_numbers(step):
    scenario = dataclasses.replace(load_scenario("kang2015_table1", law="coulomb"), duration=1.0, output_step=step)
    assert scenario.output_times().tolist() == [round(i * step, 9) for i in range(scenario.n_outputs)]


def test_law_and_settings_override_the_file():
    scenario = load_scenario(
        "kang2015_table1", law="havsin", overrides=["law.mu_s=.7", "law.v_s=2e-4", "simulation.duration=1"]
    )
    assert scenario.law == Havsin(mu_s=0.7, mu_k=0.46, v_s=2e-4)
    assert scenario.duration == 1.0


def test_the_default_step_is_half_the_limit_and_divides_the_output_step():
    scenario = load_scenario("kang2015_table1", law="havsin")
    dt = scenario.default_dt()
    # 4 v_s m/(pi mu_s N), engines.md: 7.4e-5 s
    assert scenario.step_limit() == pytest.approx(7.44e-5, rel=1e-3)
    assert dt <= 0.5 * scenario.step_limit()
    assert scenario.output_step / dt == pytest.approx(round(scenario.output_step / dt), abs=1e-9)
    assert fitting_step(6e-5, 1e-3) == pytest.approx(1e-3 / 17)


def tables(**changes):
    content = load_scenario("kang2015_table1").to_dict()
    for key, value in changes.items():
        table, _, name = key.partition("__")
        if name:
            content[table] = {**content[table], name: value}
        else:
            content[table] = value
    return content


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"mechanism__masss": 1.0}, "did you mean 'mass'"),
        ({"mechanism__mass": -1.0}, "mass = -1 kg is out of range: mass must be > 0"),
        ({"mechanism__mass": "heavy"}, "not a number"),
        ({"mechanism__kind": "belt_bax"}, "did you mean 'belt_box'"),
        ({"law__mu_k": 0.9}, "mu_k = 0.9 is above mu_s = 0.8"),
        ({"law__form": "x"}, "unknown parameter of law elastic_stick"),
        ({"coefficients__process": "knot"}, "did you mean 'knots'"),
        ({"coefficients": {"process": "knots", "sigma_s": 0.1, "sigma_k": 0.1}}, "coefficients.spacing is missing"),
        ({"coefficients__kind": "knots"}, r"unknown key of process knots in \[coefficients\]: 'kind'. Known: "),
        ({"simulation__output_step": 0.003}, "does not divide duration"),
        ({"simulation__duration": -1.0}, "simulation.duration must be > 0"),
        ({"schema": "stochfric.scenario/2"}, "this version reads"),
        ({"law": None}, r"write \[law\]"),
        ({"extra": {}}, "unknown key"),
        ({"effects": [{"kind": "x"}]}, "unknown effect 'x'"),
    ],
)
def test_bad_content(changes, words):
    with pytest.raises(InputError, match=words):
        scenario_from_dict(tables(**changes))


def test_bad_files(tmp_path):
    with pytest.raises(InputError, match=r"bundled: .*kang2015_table1"):
        load_scenario("kang2015_table3")
    with pytest.raises(InputError, match="is a folder"):
        load_scenario(tmp_path)
    broken = tmp_path / "broken.toml"
    broken.write_text("a = [")
    with pytest.raises(InputError, match=re.escape(str(broken)) + ".*not a TOML file"):
        load_scenario(broken)
    with pytest.raises(InputError, match=r"table\.key=value"):
        load_scenario("kang2015_table1", overrides=["mass=3"])


def test_distributions_from_a_file(tmp_path):
    data = np.linspace(0.75, 0.85, 40)
    (tmp_path / "mu.csv").write_text("id,mu_s\n" + "\n".join(f"{i},{x}" for i, x in enumerate(data)))
    content = tables(coefficients__distribution_s={"kind": "empirical", "file": "mu.csv", "column": "mu_s"})
    content["coefficients"]["distribution_k"] = {"kind": "truncated_normal", "lower": 0.4, "upper": 0.5}
    (tmp_path / "s.toml").write_bytes(tomli_w.dumps(content).encode())
    process = load_scenario(tmp_path / "s.toml").process
    assert process.distribution_s == Empirical(tuple(data))
    assert process.distribution_k == TruncatedNormal(0.4, 0.5)
    content["coefficients"]["distribution_s"]["column"] = "mu"
    (tmp_path / "s.toml").write_bytes(tomli_w.dumps(content).encode())
    with pytest.raises(InputError, match="did you mean 'mu_s'"):
        load_scenario(tmp_path / "s.toml")
    (tmp_path / "mu.csv").write_text("mu\n0.1\nnone\n")
    with pytest.raises(InputError, match="row 3: 'none'"):
        load_scenario(tmp_path / "s.toml")


def test_output_step_process_takes_the_output_step():
    scenario = load_scenario("kang2015_table1", overrides=["coefficients.process=output_step", "simulation.output_step=0.01"])
    assert scenario.process.kind == "output_step"
    content = scenario.to_dict()
    del content["coefficients"]["spacing"]
    assert scenario_from_dict(content).process.knot_spacing == 0.01


def test_checked_step():
    s = load_scenario("kang2015_table1", law="elastic_stick")
    assert s.checked_step(None) == s.default_dt()
    assert s.checked_step(1.0000000001e-4) == s.output_step / 10
    with pytest.raises(StabilityError, match=r"dt = 0\.01 s is beyond the stability limit .*omega.*; use dt <= "):
        s.checked_step(0.01)
    with pytest.raises(InputError, match=r"dt = 0\.0003 s does not divide .*; try 0\.00025 s"):
        s.checked_step(3e-4)
    for wrong in (0.0, -1e-4, float("nan")):
        with pytest.raises(InputError, match="dt = "):
            s.checked_step(wrong)


def test_require_sane():
    s = load_scenario("kang2015_table1", law="elastic_stick")
    s.require_sane("engine", 1.0, 2.7, 1e-4)  # 1000 times a static deflection of 2.63 mm and a swing v_b/omega of 0.10 mm
    for broken in (2.8, -2.8, float("nan"), float("inf")):
        with pytest.raises(SimulationError, match=r"engine: the box is at x = .*lower dt = 0\.0001 s"):
            s.require_sane("engine", 1.0, broken, 1e-4)


BELT_NUMBERS = {"mass": 1.0, "damping": 1.0, "stiffness": 100.0, "normal_force": 10.0, "belt_velocity": 1.0e-3}
ELBOW = {"file": "model.xml", "friction": {"elbow": 1.0}, "positions": {"elbow": "position"}}


def doubted(mechanism, uncertainty, law="coulomb"):
    """Return the content of a scenario file that states how sure it is of its numbers."""
    return {
        "schema": "stochfric.scenario/1",
        "mechanism": mechanism,
        "law": {"kind": law, "mu_s": 0.5, "mu_k": 0.4},
        "uncertainty": uncertainty,
        "simulation": {"duration": 1.0, "output_step": 1.0e-3},
    }


@pytest.mark.parametrize(
    ("uncertainty", "words"),
    [
        ({"dampening": 0.4}, "unknown key of uncertainty 'dampening'; did you mean 'damping'?"),
        ({"mas": 0.03}, "did you mean 'mass'?"),
        ({"stribeck_velocity": 0.1}, "unknown key of uncertainty 'stribeck_velocity'"),
        ({"stiffness": 5.0}, "over 100 %: uncertainties are relative standard deviations; write 0.05 for 5 %"),
        ({"damping": 30.0}, "write 0.3 for 30 %"),
    ],
)
def test_an_uncertainty_that_no_number_has_or_in_percent_is_refused(uncertainty, words):
    with pytest.raises(InputError, match=re.escape(words)):
        scenario_from_dict(doubted({"kind": "belt_box", **BELT_NUMBERS}, uncertainty))


@pytest.mark.parametrize(
    ("mechanism", "law", "uncertainty"),
    [
        ({"kind": "belt_box", **BELT_NUMBERS}, "stribeck", {"belt_velocity": 0.1, "damping": 1.5, "stribeck_velocity": 0.3}),
        ({"kind": "hinge_pendulum", "mass": 1.0, "length": 0.2, "normal_force": 1.0}, "coulomb", {"inertia": 3.0}),
        ({"kind": "spring_slider", "stiffness": 2000.0}, "coulomb", {"stiffness": 3.0, "mu_s": 0.1}),
        ({"kind": "mjcf", **ELBOW}, "coulomb", {"mass": 0.1, "armature": 1.0, "gain": 0.1, "damping": 0.5, "offset": 30.0}),
    ],
)
def test_uncertainties_of_numbers_that_there_are_stay(mechanism, law, uncertainty):
    assert any_scenario_from_dict(doubted(mechanism, uncertainty, law)).uncertainty == uncertainty


def test_an_uncertainty_of_a_joint_is_asked_by_number():
    with pytest.raises(InputError, match=r"unknown key of uncertainty 'elbow'\. Known: armature, damping, gain, mass"):
        any_scenario_from_dict(doubted({"kind": "mjcf", **ELBOW}, {"elbow": 0.1}))


def test_a_law_that_replaces_the_files_leaves_out_what_only_that_one_has(tmp_path):
    content = doubted({"kind": "belt_box", **BELT_NUMBERS}, {"stribeck_velocity": 0.3, "mass": 0.1}, "stribeck")
    content["law"]["stribeck_velocity"] = 2.0e-3
    (tmp_path / "rig.toml").write_text(tomli_w.dumps(content))
    assert load_scenario(tmp_path / "rig.toml", law="coulomb").uncertainty == {"mass": 0.1}
