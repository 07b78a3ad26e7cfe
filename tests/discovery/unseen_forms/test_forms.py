"""The records load, repeat, are sane physics, and their truths are in the vocabulary. Nothing here asks discovery."""

import dataclasses
import re
import sys
from pathlib import Path

import numpy as np
import pytest

from stochfric_mb import load_dataset
from tests.discovery.unseen_forms.__main__ import main
from tests.discovery.unseen_forms.forms import AT_JOINTS, FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import Case, cases, make_runs, write_record
from tests.discovery.unseen_forms.rigs import PAPER
from tests.discovery.unseen_forms.tables import judged, table

SHARE = 0.12  # of the usual length: 7 cycles at one operating point, 3 at each of several
QUICK = ("stribeck_gaussian", "mode_heavy", "sensor_play", "delay_bessel", "samples_missing", "clock_jitters", "plain_small")
ALL = [
    # a second each, and what they say changes with the forms alone
    pytest.param(name, marks=() if name in QUICK else pytest.mark.long)
    for name in FORMS
]


def case_of(name: str, *, last: bool = False) -> Case:
    return Case(FORMS[name], FORMS[name].designs[-1 if last else 0], 1.0)


def test_the_vocabulary_is_that_of_the_page_of_effects():
    page = (Path(__file__).parents[3] / "docs" / "effects.md").read_text(encoding="utf-8")
    listed = page.split("<!-- effects -->")[1].split("<!-- end of effects -->")[0]
    rows = {kind: group for group, kind in re.findall(r"^\| ([a-z ]+) \| `(\w+)` \|", listed, re.MULTILINE)}
    assert (KINDS | AT_JOINTS).items() <= rows.items()


def test_each_kind_has_a_form_and_truths_are_names():
    named = [form for form in FORMS.values() if not form.truth & {NONE, UNKNOWN}]
    assert {kind for form in named for kind in form.truth} == set(KINDS)
    assert all(form.truth_one <= {*KINDS, *AT_JOINTS, UNKNOWN, NONE} and form.source for form in FORMS.values())
    assert len(named) >= 45
    assert sum(UNKNOWN in form.truth for form in FORMS.values()) >= 15
    assert sum(NONE in form.truth for form in FORMS.values()) >= 10
    names = [case.name for case in cases()]
    assert len(set(names)) == len(names)


def test_the_plain_rig_has_the_limit_cycle_of_coulomb_friction_with_true_stick():
    world = World(PAPER, PAPER, PAPER.belt_velocity, PAPER.normal_force, 10.0, np.random.default_rng(0))
    motion = simulate(world, np.arange(10001) * 1e-3)
    # closed form: break-away at (mu_s N - c v_b)/k; the others from phases of free damped vibration, as published
    np.testing.assert_allclose(motion.breaks[2:, 1], (0.8 * 13.0 - 0.768 * 2.5e-3) / 3956.0, atol=1e-12)
    np.testing.assert_allclose(np.diff(motion.breaks[2:, 0]), 1.020006308, atol=2e-9)
    np.testing.assert_allclose(motion.sticks[2:, 1], 0.403545958e-3, atol=1e-12)
    np.testing.assert_allclose(motion.position[[2000, 10000]], [2.446805516646e-3, 2.046679350891e-3], atol=1e-11)


def test_energy_is_balanced_over_a_slip():
    world = World(PAPER, PAPER, PAPER.belt_velocity, PAPER.normal_force, 4.0, np.random.default_rng(0))
    motion = simulate(world, np.arange(400001) * 1e-5)
    i, j = np.searchsorted(motion.time, [motion.breaks[1, 0] + 1e-5, motion.sticks[2, 0] - 1e-5])
    x, v, t = motion.position[i:j], motion.velocity[i:j], motion.time[i:j]
    energy = 0.5 * PAPER.mass * v**2 + 0.5 * PAPER.stiffness * x**2
    work = PAPER.mu_k * PAPER.normal_force * (x[-1] - x[0]) - np.trapezoid(PAPER.damping * v**2, t)
    assert energy[-1] - energy[0] == pytest.approx(work, rel=1e-6)  # samples of 10 us: (1e-5 * 25.5)^2/12 and less
    assert motion.friction_work < 0.0  # friction dissipates


@pytest.mark.parametrize("name", ALL)
def test_a_record_loads(name, tmp_path):
    case = case_of(name)
    truth = write_record(case, tmp_path, 3, share=SHARE / float(case.form.options.get("length", 1.0)))
    dataset = load_dataset(tmp_path / "data")
    assert {run.role for run in dataset.runs} == {"fit", "test"}
    assert set(truth["truth"]) == case.form.right(case.design)
    assert all(np.isfinite(run.channels["position"]).all() for run in dataset.runs)


@pytest.mark.parametrize("name", ALL)
def test_same_seed_same_bits(name):
    case = case_of(name, last=True)
    first, second = (make_runs(case, 5, share=0.05) for _ in range(2))
    for one, other in zip(first, second, strict=True):
        np.testing.assert_array_equal(one.reading, other.reading)


@pytest.mark.parametrize("name", [param for param, form in zip(ALL, FORMS.values(), strict=True) if NONE not in form.truth])
def test_at_strength_zero_the_rig_is_as_believed(name):
    case = case_of(name)
    plain = dataclasses.replace(case, form=dataclasses.replace(case.form, apply=lambda world, strength: None))
    zero, null = (make_runs(one, 5, strength=0.0, share=SHARE) for one in (case, plain))
    for one, other in zip(zero, null, strict=True):
        floor = one.world.nominal.noise
        # tabulated belts and further unknowns cost 1e-9 m at most; a hundredth of the noise is not seen
        np.testing.assert_allclose(one.reading, other.reading, rtol=0.0, atol=0.01 * floor)


@pytest.mark.long
@pytest.mark.parametrize("name", [name for name, form in FORMS.items() if NONE not in form.truth])
def test_at_full_strength_the_stated_feature_is_above_the_floor(name, tmp_path):
    case = case_of(name)
    truth = write_record(case, tmp_path, 3, share=0.5)
    assert truth["size"] > 3.0  # floors of one reading, a standard deviation each
    assert min(truth["slips"]) > 5  # it is still stick-slip


def test_the_table_counts():
    truth = {
        "form": "a", "truth": ["backlash"], "classes": ["mechanism"], "family": "named", "design": "one", "strength": 1.0,
        "rig": "paper", "feature": "period_mean", "size": 9.0, "seed": 0,
    }  # fmt: skip
    null = truth | {"form": "b", "truth": ["none"], "classes": ["none"], "family": "none", "design": "several"}
    strange = truth | {"form": "c", "truth": ["unknown"], "classes": ["unknown"], "family": "unknown"}
    lines = [
        judged(truth, {"verdict": "effect", "first": "second_mode", "closed": 0.5, "seconds": 10.0}),
        judged(null, {"verdict": "none", "first": None, "closed": None, "seconds": 20.0}),
        judged(strange, {"verdict": "effect", "first": "unnamed", "closed": None, "seconds": 30.0}),
    ]
    assert [(line["right"], line["class_right"]) for line in lines] == [(False, True), (True, True), (True, True)]
    text = table(lines)
    assert re.search(r"class right\s+1/1 \(100 %\)\s+-\s+1/1", text)
    assert re.search(r"false alarms\s+-\s+0/1", text)
    assert "a-one-1: backlash -> second_mode" in text


@pytest.mark.parametrize("series", sorted({form.series for form in FORMS.values()} - {1}))
def test_the_command_of_each_set_makes_its_records(series, tmp_path, monkeypatch, capsys):
    plain = next(case for case in cases() if case.form.series == series and case.family == NONE)
    arguments = f"--series {series} --only {plain.name} --plan all --here --records-only --out {tmp_path}".split()
    monkeypatch.setattr(sys, "argv", ["unseen_forms", *arguments])
    main()
    assert plain.name in capsys.readouterr().out
