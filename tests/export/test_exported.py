"""What is exported, and what is refused: friction files, scenarios, what discovery writes, laws of one's own."""

import dataclasses
import math
import sys
import types
from typing import ClassVar

import numpy as np
import pytest
import tomli_w
from click.testing import CliRunner
from fmpy.fmi1 import FMICallException

from stochfric_mb import reference
from stochfric_mb.__main__ import main
from stochfric_mb.c import UntranslatableError
from stochfric_mb.compile import compiled
from stochfric_mb.contact import Contact
from stochfric_mb.effects.contract import MU_K, SPEED, Effect, parameter
from stochfric_mb.errors import InputError, require_number
from stochfric_mb.export import load_exported
from stochfric_mb.export.element import element
from stochfric_mb.export.exported import Exported, exported_scenario
from stochfric_mb.friction import Friction
from stochfric_mb.laws import Law, register_law
from stochfric_mb.laws import coulomb as coulomb_module

from .fmus import Driven, built, table_1

FRICTION = """
schema = "stochfric.friction/1"
[law]
kind = "havsin"
mu_s = 0.8
mu_k = 0.46
[coefficients]
process = "knots"
sigma_s = 0.015
sigma_k = 0.023
spacing = 0.01
"""
AUGMENTED = """
schema = "stochfric.scenario/1"
[mechanism]
kind = "belt_box"
mass = 6.08
damping = 0.768
stiffness = 3956.0
normal_force = 13.0
belt_velocity = 2.5e-3
[law]
kind = "elastic_stick"
mu_s = 0.8
mu_k = 0.46
[[effects]]
kind = "position_dependent_friction"
amplitude = 0.05
wavelength = 1.0e-3
phase = 0.3
[[effects]]
kind = "harmonic_force"
amplitude = 0.5
frequency = 3.0
[[effects]]
kind = "sensor_drift"
{sensor}
[simulation]
duration = 1.0
output_step = 1.0e-3
"""
JOINT = """
schema = "stochfric.scenario/1"
[mechanism]
kind = "prismatic_joint"
mass = 95.0
normal_force = 20.0
[law]
kind = "coulomb"
mu_s = 1.1
mu_k = 1.0
[[effects]]
kind = "{effect}"
{parameters}
[simulation]
duration = 1.0
output_step = 1.0e-3
"""


def toml(tmp_path, text):
    file = tmp_path / "file.toml"
    file.write_text(text, encoding="utf-8")
    return file


def typical(kind):
    """Return the TOML lines of an effect's typical parameters."""
    from .test_translation import example

    values = example(kind).to_dict()
    plain = {k: v if isinstance(v, str) else float(v) for k, v in values.items() if k != "kind"}
    return tomli_w.dumps({k: v for k, v in plain.items() if isinstance(v, str) or np.isfinite(v)})


def test_a_friction_file(tmp_path):
    exported = load_exported(toml(tmp_path, FRICTION))
    assert (exported.law.kind, exported.process.kind, exported.mechanism) == ("havsin", "knots", None)


def test_what_discovery_writes_runs_as_in_this_process(tmp_path):
    """The friction element of an augmented scenario gives the forces of the law with effects in this process."""
    exported = load_exported(toml(tmp_path, AUGMENTED.format(sensor=typical("sensor_drift"))))
    assert any("sensor_drift" in note for note in exported.notes)
    contact = Contact(Friction(exported.law, None), effective_mass=6.08)
    fmu = Driven(built(exported, 2, False), normal_force=13.0, effective_mass=6.08, relative_velocity=(2.5e-3, 0.0))
    contact.start(0.0, 0.0, 2.5e-3, 13.0)
    rng = np.random.default_rng(1)
    u, seen = 0.0, []
    for i in range(1, 400):
        v = 2.5e-3 + 2.0e-3 * np.sin(0.05 * i) + 1e-4 * rng.standard_normal()
        u += 1.0e-3 * v
        fmu.step(1.0e-3, relative_displacement=(u, 0.0), relative_velocity=(v, 0.0))
        contact.commit(fmu.t, u, v, 13.0)
        seen.append(fmu.get("friction_force[1]"))
        assert seen[-1] == pytest.approx(contact.force(fmu.t, u, v, 13.0), rel=1e-12, abs=1e-12)
    assert np.ptp(seen) > 0.5
    fmu.end()


@pytest.mark.parametrize("kind", ["viscous_friction", "velocity_weakening", "position_dependent_friction", "friction_drift"])
def test_friction_found_at_a_joint_is_exported(tmp_path, kind):
    exported = load_exported(toml(tmp_path, JOINT.format(effect=kind, parameters=typical(kind))))
    assert any("prismatic_joint" in note for note in exported.notes)
    assert any("elastic_stick" in note for note in exported.notes)
    contact = Contact(exported.law, effective_mass=95.0)
    fmu = Driven(built(exported, 3, False), normal_force=20.0, effective_mass=95.0, relative_velocity=(0.02, 0.0))
    contact.start(0.0, 0.0, 0.02, 20.0)
    for i in range(1, 50):
        fmu.step(1.0e-3, relative_displacement=(2.0e-5 * i, 0.0))
        contact.commit(fmu.t, 2.0e-5 * i, 0.02, 20.0)
        assert fmu.get("friction_force[1]") == pytest.approx(contact.force(fmu.t, 2.0e-5 * i, 0.02, 20.0), rel=1e-12)
    fmu.end()


@pytest.mark.parametrize("kind", ["second_mode", "harmonic_force", "direction_asymmetry"])
def test_effects_on_more_than_the_friction_of_a_joint_are_refused(tmp_path, kind):
    with pytest.raises(InputError, match=kind):
        load_exported(toml(tmp_path, JOINT.format(effect=kind, parameters=typical(kind))))


FASTEST = 10.0


@dataclasses.dataclass(frozen=True, kw_only=True)
class PowerLaw(Effect):  # an effect of one's own as its page shows it, with no docstrings under its fields
    exponent: float = parameter("-", "exponent of the speed", scale=0.1)
    reference_speed: float = parameter("m/s", "speed at which it sets in", scale=1e-3, low=0.0, strict=True, default=1e-3)
    kind: ClassVar[str] = "power_law_of_a_test"
    equation: ClassVar[str] = "mu_k times (1 + abs(v)/reference_speed)^exponent"
    source: ClassVar[str] = "a test"
    group: ClassVar[str] = "friction law"
    order: ClassVar[int] = 3

    def __post_init__(self):
        super().__post_init__()
        require_number("reference_speed", self.reference_speed, above=0.0, high=FASTEST, unit="m/s")


def friction(world, memory, rates, p):
    world[MU_K] *= math.exp(p[0] * math.log(1.0 + world[SPEED] / p[1]))


def test_an_effect_of_ones_own_is_exported():
    scenario = dataclasses.replace(table_1(), effects=(PowerLaw(exponent=0.2),), duration=1.2)
    run = reference.simulate(scenario, seed=1)
    fmu = Driven(built(exported_scenario(scenario), 3, True), seed=1, effects__power_law_of_a_test__exponent=0.2)
    about = fmu.variables["effects.power_law_of_a_test.reference_speed"]
    assert (about.unit, about.description) == ("m/s", "speed at which it sets in")
    for _ in range(1200):
        fmu.step(1.0e-3)
    assert fmu.get("position") == pytest.approx(run.position[1200], abs=1e-8)
    assert abs(run.position[1200] - reference.simulate(dataclasses.replace(scenario, effects=()), seed=1).position[1200]) > 1e-6
    fmu.end()
    with pytest.raises(FMICallException):
        Driven(built(exported_scenario(scenario), 3, True), effects__power_law_of_a_test__reference_speed=2.0 * FASTEST)


def own_law():
    """Return a law of one's own whose force sorts a list, which has no translation."""
    module = types.ModuleType("my_laws")
    sys.modules["my_laws"] = module

    @dataclasses.dataclass(frozen=True)
    class Mine(Law):
        kind = "mine"
        equation = "sorted"
        source = "a test"
        state_names = ("mode", "dx", "dy")

    Mine.__module__ = "my_laws"
    vars(module).update({name: getattr(coulomb_module, name) for name in ("init", "commit", "guards")})
    module.force = compiled(sorting_force)
    return register_law(Mine)(0.8, 0.46)


def sorting_force(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    values = sorted([vx, vy])
    return values[0], values[1]


def test_a_law_that_cannot_be_translated_is_refused_by_name(monkeypatch):
    from stochfric_mb import laws

    monkeypatch.setattr(laws, "LAWS", dict(laws.LAWS))
    with pytest.raises(UntranslatableError, match=r"sorting_force, line \d+: no translation of \[vx, vy\]"):
        element(Exported(own_law()))


def invoke(*words):
    return CliRunner().invoke(main, [str(w) for w in words])


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("fmu", "kang2015_table1", "--out", "x.zip"), "does not end in .fmu"),
        (("fmu", "kang2015_table1", "--out", "x.fmu", "--platforms", "amiga"), "unknown platform"),
        (("fmu", "no_such_scenario", "--out", "x.fmu"), "no bundled scenario"),
        (("c", "kang2015_table1", "--out", "here.txt"), "is not a folder"),
        (("fmu", "friction.toml", "--part", "belt_box", "--out", "x.fmu"), "there is no belt-box"),
        (("c", "bad.toml", "--out", "c"), "schema"),
        (("c", "typo.toml", "--out", "c"), "did you mean 'coefficients'"),
    ],
)
def test_bad_input_is_refused_and_leaves_nothing(tmp_path, monkeypatch, words, message):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "friction.toml").write_text(FRICTION, encoding="utf-8")
    (tmp_path / "here.txt").write_text("", encoding="utf-8")
    (tmp_path / "bad.toml").write_text('schema = "other/1"\n', encoding="utf-8")
    (tmp_path / "typo.toml").write_text(FRICTION.replace("[coefficients]", "[coefficient]"), encoding="utf-8")
    before = sorted(tmp_path.iterdir())
    done = invoke("export", *words)
    assert done.exit_code == 2, done.output
    assert message in done.output
    assert sorted(tmp_path.iterdir()) == before


def test_without_the_extra_the_command_says_what_to_install(tmp_path, monkeypatch):
    import importlib.util

    result = importlib.util.find_spec
    monkeypatch.setattr("importlib.util.find_spec", lambda name, *a: None if name == "ziglang" else result(name, *a))
    done = invoke("export", "fmu", "kang2015_table1", "--platforms", "x86_64-linux", "--out", tmp_path / "x.fmu")
    assert done.exit_code == 2
    assert "pip install '.[fmi]'" in done.output
    assert list(tmp_path.iterdir()) == []


def test_equal_exports_are_equal_to_the_byte(tmp_path):
    from .fmus import host

    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        done = invoke("export", "fmu", "kang2015_table1", "--platforms", host().name, "--out", tmp_path / name / "friction.fmu")
        assert done.exit_code == 0, done.output
    assert (tmp_path / "one/friction.fmu").read_bytes() == (tmp_path / "two/friction.fmu").read_bytes()


def test_a_scenario_of_a_belt_box_keeps_its_parts():
    from .fmus import table_1

    exported = exported_scenario(table_1())
    assert exported.mechanism == table_1().mechanism
    assert exported.notes == ()
