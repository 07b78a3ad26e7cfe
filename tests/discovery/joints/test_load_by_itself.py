"""A load that moves by itself behind the motor: compliance and backlash have their names, and nothing else has theirs."""

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint.decision.selection import Selector
from stochfric_mb.discovery.driven_joint.fit.fitting import fit
from stochfric_mb.discovery.driven_joint.fit.wave_scan import begun
from stochfric_mb.discovery.driven_joint.joint_workflow import joint_outcome
from stochfric_mb.discovery.driven_joint.simulation.friction_function import joint_friction
from stochfric_mb.discovery.driven_joint.source import source_of
from stochfric_mb.discovery.export import files, scenario_toml
from stochfric_mb.effects import make_effect
from stochfric_mb.errors import InputError
from stochfric_mb.measurement import Dataset, Run, load_dataset
from stochfric_mb.scenario import any_scenario_from_dict
from tests.discovery.joint_generator.case import Case, write

MASS, SHARE, FREQUENCY, RATIO = 2.0, 0.4, 8.0, 0.05
LINES = ((0.1, 0.64), (0.03, 1.43), (0.002, 5.1))
"""Amplitude [m] and frequency [Hz] of the motion's parts."""
MANY = (*((0.1, 0.64), (0.03, 1.43)), *((0.006 / f**2, f) for f in (2.3, 3.1, 4.1, 5.3, 6.7, 7.9, 9.1, 10.3)))
"""The same of a motion that tells both sides of the resonance."""


def two_masses(share=SHARE, *, seed=0, noise=0.02, rate=500.0, duration=6.0, drag=0.0, lines=LINES):
    """Two records of a slide whose load swings in a steady state, by the transfer function of Spong 1987; a third held out.

    The joint's damping, stated, is ``drag`` [N s/m], all of it at the load.
    """
    runs, t = [], np.arange(round(duration * rate)) / rate
    for i in range(3):
        rng = np.random.default_rng([seed, i])
        q, v, force = np.zeros(len(t)), np.zeros(len(t)), np.zeros(len(t))
        for size, line in lines:
            s, w = 2.0j * np.pi * line, 2.0 * np.pi * FREQUENCY
            turn = size * np.exp(s * t + 2.0j * np.pi * rng.random())
            rubs = drag / (share * MASS) if share else 0.0
            follows = (2.0 * RATIO * w * s + w**2) / (s**2 + (2.0 * RATIO * w + rubs) * s + w**2)
            q, v = q + turn.imag, v + (s * turn).imag
            force = force + ((MASS * (1.0 - share + share * follows) * s**2 + drag * follows * s) * turn).imag
        force = force + 2.0 * np.tanh(v / 1.0e-3) + noise * rng.standard_normal(len(t))
        channels = {"position": q + 1.0e-6 * rng.standard_normal(len(t)), "force": force}
        role = "test" if i == 2 else "fit"
        runs.append(Run(name=f"run {i}", role=role, time=t, channels=channels, sample_interval=1.0 / rate))
    tables = {
        "schema": "stochfric.scenario/1",
        "title": "two masses",
        "mechanism": {"kind": "prismatic_joint", "mass": MASS, "normal_force": 10.0, "damping": drag},
        "law": {"kind": "coulomb", "mu_s": 0.2, "mu_k": 0.2},
        "uncertainty": {"mass": 0.03, "offset": 0.1, "mu_s": 0.3, "mu_k": 0.3} | ({"damping": 0.1} if drag else {}),
        "simulation": {"duration": duration, "output_step": 1.0e-3},
    }
    return Dataset(title="two masses", scenario_path=None, scenario=any_scenario_from_dict(tables), runs=tuple(runs))


def first_stage(dataset):
    source = source_of(dataset)
    balances, nuisances = source.balances("", "fit", 0.0), source.nuisances("")
    return Selector(balances, nuisances, source.stated("")).run().stages[0]


def test_where_no_more_than_noise_is_left_no_load_is_looked_for():
    stage = first_stage(two_masses(0.0))
    assert not stage.accepted
    assert {t.candidate.kind for t in stage.trials}.isdisjoint({"joint_compliance", "backlash"})


def test_what_no_engine_of_one_body_carries_says_so(tmp_path):
    dataset = two_masses()
    effect = make_effect("joint_compliance", load_share=SHARE, frequency=FREQUENCY, damping_ratio=RATIO)
    tables = dataset.scenario.to_dict() | {"effects": [effect.to_dict()]}
    stated = any_scenario_from_dict(tables)
    assert stated.effects == (effect,)
    with pytest.raises(InputError, match="second body"):
        joint_friction(stated, smoothing_velocity=1.0e-3)
    assert any_scenario_from_dict(stated.to_dict()).effects == (effect,)
    assert 'kind = "joint_compliance"' in scenario_toml(stated)


@pytest.mark.parametrize("drag_is_looked_for", [True, False])
def test_viscous_friction_of_a_load_on_its_own_rail_is_not_taken_for_damping_of_its_spring(drag_is_looked_for):
    drag = 6.0
    source = source_of(two_masses(drag=drag, lines=MANY))
    balances, nuisances = source.balances("", "fit", 0.0), source.nuisances("")
    rubs = {"load_damping": 1.0} if drag_is_looked_for else {}
    start = make_effect(
        "joint_compliance", load_share=0.5, frequency=9.0, damping_ratio=0.1, start_in_phase=0.1, start_quadrature=0.1, **rubs
    )
    found = fit(begun(start, balances).added_to(source.stated("")), balances, nuisances, noise=0.02).model.effects[0]
    # noise of the positions in the inertia, which the share of the load takes up, is a third of what is left
    if drag_is_looked_for:
        assert found.load_share == pytest.approx(SHARE, rel=0.05)
        assert found.frequency == pytest.approx(FREQUENCY, rel=0.01)
        assert found.damping_ratio == pytest.approx(RATIO, rel=0.1)
        assert found.load_damping == pytest.approx(drag, rel=0.1)
    else:
        assert found.damping_ratio > 2.0 * RATIO


@pytest.mark.slow
@pytest.mark.parametrize(
    ("form", "design", "strength", "seed", "kind", "numbers"),
    [
        # as the motor is held, where the generator has motor and load together: sqrt(1 - load_share) of its frequency
        ("joint_compliance.soft_coupling", "slide", 0.5, 0, "joint_compliance", {"load_share": 0.6, "frequency": 3.677}),
        ("backlash.play", "mjcf_hinge", 0.5, 0, "backlash", {"load_share": 0.7, "gap": 0.0609}),
    ],
)
def test_loads_of_the_generator_have_their_names(form, design, strength, seed, kind, numbers, tmp_path):
    write(Case(form, design, strength, seed), tmp_path / "set", tmp_path / "truth.json")
    outcome = joint_outcome(load_dataset(tmp_path / "set"))
    result = outcome.result
    assert [e.kind for e in result.effects] == [kind]
    assert result.gap.closed > 0.6
    for name, true in numbers.items():
        size = result.effects[0].parameters[name]
        assert size.low < size.value < size.high
        assert size.value == pytest.approx(true, rel=0.06)  # stated inertias, of which it is a share, are off by 5 %
    assert any("second body" in note for note in result.notes)
    written = files(outcome)
    assert kind in written["augmented.toml"]
    assert "exudyn_friction.py" not in written
