"""What strangers' rigs brought: friction that is declared to scatter, kicks that a light rig hardly feels, a faster drive."""

import re
from pathlib import Path

import numpy as np
import pytest

from stochfric_mb.discovery import discover
from stochfric_mb.discovery.result import Result
from tests.discovery.unseen_forms.forms import FORMS, Form, each_stick
from tests.discovery.unseen_forms.friction_forms import scaled, viscous
from tests.discovery.unseen_forms.motion import State, World
from tests.discovery.unseen_forms.records import Case, write_record
from tests.discovery.unseen_forms.rigs import RIGS


def drawn_anew(world: World, weakening: float) -> None:
    """Draw both coefficients for each stick, as declared; mu_k falls with speed by a share of the gap."""
    rig, top = world.rig, 0.3 * world.nominal.peak_speed

    def draw(_: object) -> None:
        z = world.rng.standard_normal(2)
        world.memory["s"], world.memory["k"] = rig.mu_s + 0.015 * z[0], rig.mu_k + 0.015 * z[1]

    each_stick(world, draw)
    world.mu_s = lambda _: world.memory["s"]
    world.mu_k = lambda s: world.memory["k"] + weakening * rig.gap * np.exp(-abs(s.w) / top)


def linear(world: World, _: float) -> None:
    viscous(world, lambda u: u, 0.35 * world.nominal.gap * world.nominal.normal_force)


def narrow_bump(world: World, strength: float) -> None:
    """A bump of the belt of a quarter of a slip's length that comes back each nine slips."""
    turn, width = 9.1 * world.nominal.slip_length, 0.25 * world.nominal.slip_length

    def factor(s: State) -> object:
        off = (s.travel - s.x + 0.5 * turn) % turn - 0.5 * turn
        return 1.0 + 0.12 * strength * np.exp(-0.5 * (off / width) ** 2)

    scaled(world, factor)


def answered(form: Form, folder: Path, **changes: object) -> Result:
    """Return what discovery says of a record of a form at one operating point."""
    parts = {"name": form.name, "apply": form.apply, "rig": form.rig, "options": form.options} | changes
    made = Form(truth=frozenset(), truth_one=frozenset(), designs=("one",), source="", **parts)
    write_record(Case(made, "one", 1.0), folder, 3)
    return discover(folder / "data").result


def said(form: Form, folder: Path, **changes: object) -> tuple[str, ...]:
    """Return the names that discovery gives to a record of a form at one operating point."""
    result = answered(form, folder, **changes)
    return tuple(e.kind for e in result.effects) or (result.verdict,)


@pytest.mark.parametrize(("weakening", "names"), [(0.4, ("velocity_weakening",)), (0.0, ("none",))])
def test_a_declared_scatter_hides_no_effect_and_is_none(weakening, names, tmp_path):
    plain = FORMS["scatter_declared_per_stick"]
    assert said(plain, tmp_path, name="weakening", apply=lambda w, _: drawn_anew(w, weakening), rig="paper") == names


@pytest.mark.parametrize(("rig", "named"), [("paper", False), ("small", True)])
def test_a_narrow_bump_that_comes_back_each_turn_is_seen_as_what_it_is(rig, named, tmp_path):
    """It is half as wide as what a course of the belt can follow: named where the record is long, else seen by its turns."""
    result = answered(FORMS["position_bump"], tmp_path, name="narrow", apply=narrow_bump, rig=rig)
    turn = pytest.approx(9.1 * RIGS[rig].slip_length, rel=0.05)
    if named:
        assert [e.kind for e in result.effects] == ["position_dependent_friction"]
        assert result.effects[0].parameters["wavelength"].value == turn
        return
    assert (result.verdict, result.effects) == ("unknown", ())
    assert result.where is not None
    assert result.where.axis == "belt position"
    assert float(re.search(r"once in ([\d.e-]+) m of belt travel", result.where.text)[1]) == turn


def test_linear_viscous_friction_of_a_small_rig(tmp_path):
    assert said(FORMS["viscous_eyring"], tmp_path, name="linear", apply=linear, rig="small") == ("viscous_friction",)


def test_kicks_that_change_slips_by_little(tmp_path):
    assert said(FORMS["impacts_half_sine"], tmp_path, rig="small", name="light") == ("impacts",)


def test_a_ripple_that_noise_estimates_swallow(tmp_path):
    assert said(FORMS["belt_sawtooth"], tmp_path) == ("belt_speed_ripple",)


def test_readings_that_jump_in_slips_alone_are_no_outliers(tmp_path):
    assert said(FORMS["sensor_feels_acceleration"], tmp_path) == ("unknown",)


def test_a_mass_that_changes_is_no_spring(tmp_path):
    assert said(FORMS["mass_that_grows"], tmp_path) == ("unknown",)


def test_a_spring_that_softens_can_run_by_itself(tmp_path):
    assert said(FORMS["stiffness_softening"], tmp_path) == ("nonlinear_stiffness",)
