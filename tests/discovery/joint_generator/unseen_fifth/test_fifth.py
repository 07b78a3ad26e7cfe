"""The forms of the fifth set at driven joints give finite records that they move, and two bodies that move as they should."""

from dataclasses import replace

import numpy as np
import pytest

from tests.discovery import joint_plan
from tests.discovery.joint_generator import slider, thrown
from tests.discovery.joint_generator.bench import DESIGNS, nominal_bench
from tests.discovery.joint_generator.case import Case, Made, acceptable, expected, make
from tests.discovery.joint_generator.forms import Record
from tests.discovery.joint_generator.integrator import simulate
from tests.discovery.joint_generator.plant import plain_plant

from . import PAIRS, UNSEEN_FIFTH
from .link import linked

KINDS = {
    name: [expected(form) for form in (UNSEEN_FIFTH[part] for part in name.split("+"))] for name in (*UNSEEN_FIFTH, *PAIRS)
}


def shown(case: Case, *, strength: float) -> Record:
    """The first run of a slider, or of a thrown block."""
    form = case.parts[0]
    law = form.draw(case.rng(1, 0), strength, nominal_bench("slide", case.rng(0))).law
    assert law is not None
    drawn = law(case.rng(2, 0))
    if isinstance(drawn, thrown.Throw):
        return thrown.record(drawn, case.rng(4, 0))
    assert isinstance(drawn, slider.RateAndState)
    return slider.record(drawn, 3000.0, np.array([1e-6, 1e-5, 1e-6]), 2e-4, case.rng(4, 0))


def moved(made: Made) -> tuple[bool, float]:
    """Whether a record is finite, and how far its columns are, at most, from those without its effects, in their noise."""
    record, plain = made.record(0), replace(made, effects=()).record(0)
    sensor, far = made.nominal.sensor, 0.0
    for name in set(record) & set(plain):
        noise = sensor.position if "position" in name or "angle" in name else sensor.drive / made.nominal.gain
        if record[name].size == plain[name].size and "target" not in name and noise:
            far = max(far, float(np.sqrt(np.mean((record[name] - plain[name]) ** 2))) / noise)
    return all(np.all(np.isfinite(x)) for x in record.values()), far


def test_the_set_is_as_wide_as_asked_for():
    singles = [kinds[0] for kinds in KINDS.values() if len(kinds) == 1]
    known = [kind for kind in singles if kind not in ("none", "unknown")]
    assert (len(known), singles.count("unknown"), singles.count("none"), len(PAIRS)) == (26, 8, 8, 8)
    assert (known.count("joint_compliance"), known.count("backlash")) == (3, 3)
    links = [form for form in UNSEEN_FIFTH.values() if expected(form) in ("joint_compliance", "backlash")]
    assert not any("unknown" in acceptable(form) for form in links)
    cases = list(joint_plan.unseen_cases([51], 5))
    assert {case.design for case in cases} == set(DESIGNS)
    assert {case.strength for case in cases} == {0.5, 1.0}


@pytest.mark.parametrize(
    "name", [name for name in KINDS if not {"slider", "thrown"} & set(UNSEEN_FIFTH[name.split("+")[0]].designs)]
)
def test_a_record_is_finite_and_moved_by_its_effects(name):
    parts = [UNSEEN_FIFTH[part] for part in name.split("+")]
    design = next(d for d in parts[0].designs if all(d in part.designs for part in parts))
    made = make(Case(name, design, 1.0, 7))
    if "motion" not in made.case.forms:
        made = replace(made, nominal=replace(made.nominal, duration=4.0), true=replace(made.true, duration=4.0))
    finite, far = moved(made)
    assert finite
    if KINDS[name] != ["none"]:
        # a constant force or gain that the controller makes up for is seen against what is believed
        balance = {"constant_force.guide_is_not_level": made.effects[0].parameters.get("size", 0.0) / made.nominal.sensor.drive}
        assert max(far, abs(balance.get(name, 0.0))) > 5.0
    else:
        assert far < 10.0


@pytest.mark.parametrize(
    "name", [name for name in KINDS if {"slider", "thrown"} & set(UNSEEN_FIFTH[name.split("+")[0]].designs)]
)
def test_sliders_and_throws_are_finite_and_moved_by_their_effects(name):
    case = Case(name, UNSEEN_FIFTH[name].designs[0], 1.0, 7)
    record = shown(case, strength=1.0)
    assert all(np.all(np.isfinite(x)) for x in record.values())
    if KINDS[name] == ["none"]:
        return
    plain = shown(case, strength=0.0)
    column = "friction_coefficient" if case.design == "slider" else "position [m]"
    n = min(record[column].size, plain[column].size)
    noise = 2e-4 if case.design == "slider" else thrown.NOISE
    assert np.sqrt(np.mean((record[column][:n] - plain[column][:n]) ** 2)) > 5.0 * noise


@pytest.mark.parametrize(("half_gap", "cubic"), [(0.0, 0.0), (0.01, 0.0), (0.0, 0.05)])
def test_a_load_behind_a_link_swings_as_its_spring_says(half_gap, cubic):
    plain = plain_plant({"kind": 0.0, "inertia": 2.0}, (0.0, 0.0), top_speed=10.0, reach=1.0, duration=2.0)
    plant = linked(plain, load=0.25, frequency=3.0, damping=0.0, held=0.0, half_gap=half_gap, cubic=cubic)
    start, interval = np.array([0.0, 0.08]), 1e-3
    states = simulate(plant, np.array([[0.0, 0.0, 0.0, 0.0, 1.0]] * 2), np.zeros((2001, 6)), start, 0, interval)
    stretch = states[:, 1] - states[:, 0]
    momentum = 1.5 * states[:, 2] + 0.5 * states[:, 3]
    assert np.abs(momentum).max() < 1e-6 * np.abs(states[:, 3]).max()  # no friction holds it
    stiffness = (2 * np.pi * 3.0) ** 2 * 0.5
    beyond = np.sign(stretch) * np.maximum(np.abs(stretch) - half_gap, 0.0)
    energy = 0.75 * states[:, 2] ** 2 + 0.25 * states[:, 3] ** 2 + 0.5 * stiffness * beyond**2
    energy += 0.25 * stiffness / cubic**2 * beyond**4 if cubic else 0.0
    assert np.ptp(energy) < 1e-3 * energy[0]
    turns = np.flatnonzero((stretch[:-1] < 0.0) & (stretch[1:] >= 0.0))
    usual = 1.0 / (3.0 * np.sqrt(0.5 / (0.5 * 1.5 / 2.0)))  # of both bodies about their common centre [s]
    period = np.mean(np.diff(turns)) * interval
    if cubic:
        assert period < 0.9 * usual
    else:  # the gap is crossed twice a period, at the highest speed
        assert period == pytest.approx(usual * (1.0 + 2.0 * half_gap / (np.pi * (0.08 - half_gap))), abs=2e-3)


def test_least_friction_lies_below_the_stated_load():
    case = Case("load_dependence.least_friction", "slide", 1.0, 5)
    made = make(case)
    plant, load = made.plant(0), made.record(0)["normal_force [N]"]
    t = made.record(0)["time [s]"]
    coefficient = np.interp(t, plant.times, plant.by_time[0]) / (load / (9.81 * made.nominal.numbers["inertia"]))
    share = load / load.mean()
    low, middle, high = (coefficient[np.abs(share - at) < 0.03].mean() for at in (0.3, 0.9, 1.6))
    assert low < middle < high
