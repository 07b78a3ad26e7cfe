"""Friction in the words of other codes: equations, fits, losses, and the way back."""

import json
import math
import tomllib

import numpy as np
import pytest
from click.testing import CliRunner

from stochfric_mb.__main__ import main
from stochfric_mb.dialects import DIALECTS
from stochfric_mb.dialects.bam import Bam
from stochfric_mb.dialects.curve import coefficient, curve_of, speeds
from stochfric_mb.dialects.simscape import Simscape
from stochfric_mb.dialects.thresholds import Adams, Recurdyn
from stochfric_mb.dialects.translation import from_dialect, to_dialect
from stochfric_mb.laws import LAWS, make_law
from stochfric_mb.scenario import load_any_scenario

V = speeds(1.0e-5, 0.1)
N = 13.0
KINDS = [k for k in LAWS if k != "augmented"]


@pytest.mark.parametrize("kind", KINDS)
def test_the_curve_of_a_law_is_that_of_its_equation(kind):
    law = make_law(kind, mu_s=0.8, mu_k=0.46)
    p = law.to_dict()
    v = np.array([2.0e-5, 3.0e-4, 1.0e-3, 5.0e-2])
    expected = {
        "coulomb": 0.46 + 0.0 * v,
        "karnopp": np.where(v > 1e-4, 0.46, 0.8),
        "dahl": 0.46 + 0.0 * v,
        "tanh": 0.46 * np.tanh(v / 1e-4),
        "stribeck": 0.46 + 0.34 * np.exp(-v / 1e-3),
        "lugre": 0.46 + 0.34 * np.exp(-((v / 1e-3) ** 2)),
        "elastic_stick": np.where(v <= 1e-4, 0.8, 0.46 + 0.34 * np.exp(-(v - 1e-4) / 1e-3)),
        "piecewise_linear": np.interp(v, [0.0, p.get("v_s", 1.0), p.get("v_d", 2.0)], [0.0, 0.8, 0.46]),
    }
    if kind in expected:
        np.testing.assert_allclose(coefficient(law, v), expected[kind], rtol=1e-9)  # sums of displacements of 3000 m
    curve = curve_of(law, V, normal_force=N)
    assert curve.break_away <= 0.8 + 1e-12


def test_equations_of_the_dialects():
    """At points where each equation can be read off."""
    for cls in (Adams, Recurdyn):
        d = cls(static_coefficient=0.6, dynamic_coefficient=0.4, static_threshold_velocity=0.01, dynamic_threshold_velocity=0.1)
        assert d.coefficient(np.array([0.01, 0.055, 0.1, 1.0]), 1.0) == pytest.approx([0.6, 0.5, 0.4, 0.4])
        assert d.coefficient(np.array([1e-12]), 1.0) == pytest.approx(0.0, abs=1e-9)
    s = Simscape(breakaway_friction_force=25.0, breakaway_friction_velocity=0.1, coulomb_friction_force=20.0,
                 viscous_friction_coefficient=100.0)  # fmt: skip
    # at v_brk: sqrt(2 e) 5 exp(-1/2)/sqrt(2) + 20 tanh(10) + 10 = 5 + 20 + 10
    assert s.coefficient(np.array([0.1]), 1.0)[0] == pytest.approx(35.0, rel=1e-8)
    m6 = Bam(model="m6", friction_base=1.0, friction_viscous=2.0, friction_stribeck=0.5, dtheta_stribeck=1.0, alpha=1.0,
             load_friction_motor=0.1, load_friction_external=0.2, load_friction_motor_quad=0.01, motor_force=-3.0,
             external_force=10.0)  # fmt: skip
    # |10*0.2 + 3*0.1| = 2.3 always; at rest 0.5 + 0.01*9 (outside stronger, signs differ)
    assert m6.break_away(1.0) == pytest.approx(1.0 + 2.3 + 0.5 + 0.09)
    assert m6.coefficient(np.array([1.0]), 1.0)[0] == pytest.approx(3.3 + 0.59 * math.exp(-1.0) + 2.0)


@pytest.mark.parametrize("name", DIALECTS)
@pytest.mark.parametrize("kind", KINDS)
def test_every_law_goes_to_every_dialect(kind, name):
    law = make_law(kind, mu_s=0.8, mu_k=0.46)
    translation = to_dialect(law, DIALECTS[name], V, normal_force=N, mass=6.08)
    mu = translation.dialect.coefficient(V, N)
    assert translation.max_error == pytest.approx(np.max(np.abs(mu - coefficient(law, V))), abs=1e-12)
    assert translation.rms_error <= translation.max_error
    curve = curve_of(law, V, normal_force=N)
    if name in ("mujoco", "physx"):  # one level over the speeds, and for MuJoCo a slope: the mean can be had
        assert translation.rms_error <= np.std(curve.coefficient) * (1.0 + 1e-9) + 1e-12
    else:  # a constant coefficient can be had, break-away included, which counts as four speeds
        values = np.concatenate([curve.coefficient, np.full(4, curve.break_away)])
        ours = np.concatenate([mu, np.full(4, translation.dialect.break_away(N))])
        assert np.sqrt(np.mean((ours - values) ** 2)) <= np.std(values) * (1.0 + 1e-3) + 1e-9
    assert type(translation.dialect).from_dict(translation.dialect.to_dict()) == translation.dialect


@pytest.mark.parametrize("name", DIALECTS)
def test_what_a_dialect_can_say_comes_back(name):
    """Parameters planted in a dialect's own nearest law are met, where that law has the same curve."""
    planted = {
        "adams": (make_law("coulomb", mu_s=0.8, mu_k=0.46), 1e-9),
        "recurdyn": (make_law("coulomb", mu_s=0.8, mu_k=0.46), 1e-9),
        "simscape": (make_law("coulomb", mu_s=0.5, mu_k=0.5), 1e-6),
        "modelica": (make_law("stribeck", mu_s=0.8, mu_k=0.46), 4e-3),  # rows on the curve, linear between: 12 of them
        "exudyn": (make_law("elastic_stick", mu_s=0.8, mu_k=0.46, v_s=1e-9), 1e-5),
        "mujoco": (make_law("coulomb", mu_s=0.5, mu_k=0.5), 1e-12),
        "physx": (make_law("coulomb", mu_s=0.8, mu_k=0.46), 1e-12),
        "bam": (make_law("stribeck", mu_s=0.8, mu_k=0.46, form="gaussian"), 1e-5),
    }
    law, tolerance = planted[name]
    translation = to_dialect(law, DIALECTS[name], V, normal_force=N, mass=6.08)
    assert translation.max_error <= tolerance
    assert abs(translation.break_away_error) <= tolerance


def test_losses_are_named():
    law = make_law("elastic_stick", mu_s=0.8, mu_k=0.46)
    lost = " ".join(to_dialect(law, DIALECTS["mujoco"], V, normal_force=N).lost)
    assert "true stick" in lost
    assert "static and kinetic" in lost
    assert "load" in lost
    assert to_dialect(law, DIALECTS["exudyn"], V, normal_force=N).lost == ()


def test_exudyns_bristle_there_and_back():
    law = make_law("elastic_stick", mu_s=0.8, mu_k=0.46, v_s=1e-9, e_lim=2e-5)
    there = to_dialect(law, DIALECTS["exudyn"], V, normal_force=N, mass=6.08)
    back = from_dialect(there.dialect, "elastic_stick", V, normal_force=N)
    assert back.law.e_lim == pytest.approx(2e-5, rel=1e-4)
    assert (back.law.mu_s, back.law.mu_k) == pytest.approx((0.8, 0.46), abs=2e-3)
    assert back.max_error <= 2e-3


def invoke(*words):
    return CliRunner().invoke(main, [str(w) for w in words])


def test_the_command_goes_there_and_back(tmp_path):
    there = invoke("translate", "kang2015_table1", "--to", "physx", "--out", tmp_path / "physx.toml")
    assert there.exit_code == 0, there.output
    assert "Lost: random coefficients" in there.output
    table = tomllib.loads((tmp_path / "physx.toml").read_text(encoding="utf-8"))
    assert table["parameters"]["staticFriction"] == pytest.approx(0.8)
    back = invoke("translate", tmp_path / "physx.toml", "--out", tmp_path / "friction.toml")
    assert back.exit_code == 0, back.output
    friction = tomllib.loads((tmp_path / "friction.toml").read_text(encoding="utf-8"))
    assert friction["law"]["kind"] == "coulomb"
    exported = invoke("export", "c", tmp_path / "friction.toml", "--out", tmp_path / "c")
    assert exported.exit_code == 0, exported.output


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("kang2015_table1",), "--to is missing"),
        (("kang2015_table1", "--to", "adamz"), "did you mean 'adams'"),
        (("kang2015_table1", "--to", "adams", "--speeds", "fast"), "LOW,HIGH"),
        (("kang2015_table1", "--to", "adams", "--speeds", "1,0.1"), "do not rise"),
        (("kang2015_table1", "--to", "adams", "--normal-force", "-1"), "normal-force"),
    ],
)
def test_bad_input_is_refused(words, message):
    done = invoke("translate", *words)
    assert done.exit_code == 2
    assert message in done.output


@pytest.mark.parametrize(
    ("words", "loss"),
    [
        (("emps",), 0.03 * 932.0),
        (("emps", "--normal-force", "10"), 0.3),
        (("swing_up_ddp",), None),
        (("two_joint_arm",), None),
    ],
)
def test_the_load_is_the_scenarios(words, loss):
    scenario = load_any_scenario(words[0])
    done = invoke("translate", *words, "--to", "mujoco", "--json")
    if loss is None:
        of = getattr(scenario.mechanism, "normal_force", 1.0)
        loss = of * scenario.law.mu_k
    assert json.loads(done.stdout)["dialect"]["frictionloss"] == pytest.approx(loss)


@pytest.mark.parametrize(
    ("dialect", "parameters", "words", "message"),
    [
        ("physx", "parameters = 3", (), "is not a table"),
        ("physx", '[parameters]\nstaticFriction = "high"\ndynamicFriction = 0.4', (), "'high' is not a number"),
        ("modelica", "[parameters]\nspeed = 0.1\nmu = [0.4]\npeak = 0.5", (), "speed"),
        ("modelica", '[parameters]\nspeed = ["a"]\nmu = [0.4]\npeak = 0.5', (), "speed"),
        ("bam", "[parameters]\nmodel = 3\nfriction_base = 1\nfriction_viscous = 0", (), "model = 3 is not a text"),
        ("physx", "[parameters]\nstaticFriction = 0.5\ndynamicFriction = 0.4", ("--to", "mujoco"), "leave --to out"),
    ],
)
def test_a_dialects_file_that_cannot_be_read_says_why(tmp_path, dialect, parameters, words, message):
    file = tmp_path / "theirs.toml"
    file.write_text(f'schema = "stochfric.dialect/1"\ndialect = "{dialect}"\n{parameters}\n', encoding="utf-8")
    done = invoke("translate", file, *words)
    assert done.exit_code == 2, done.exception
    assert message in done.output


def test_a_dialects_file_with_a_missing_parameter_is_refused(tmp_path):
    file = tmp_path / "physx.toml"
    file.write_text('schema = "stochfric.dialect/1"\ndialect = "physx"\n[parameters]\nstaticFriction = 0.5\n', encoding="utf-8")
    done = invoke("translate", file)
    assert done.exit_code == 2
    assert "lacks dynamicFriction" in done.output
