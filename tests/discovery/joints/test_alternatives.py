"""What could be instead is held against by the same likelihood: forms of the fifth unseen series that other names had taken."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint import joint_outcome
from stochfric_mb.discovery.driven_joint.decision.adequacy import _worse_at_most_times
from stochfric_mb.discovery.driven_joint.decision.selection import Selector
from stochfric_mb.discovery.driven_joint.fit.fitting import fit
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.discovery.driven_joint.search.candidate_fits import is_none
from stochfric_mb.discovery.driven_joint.simulation.scores import noise_floor, white_floor
from stochfric_mb.discovery.driven_joint.source import source_of
from stochfric_mb.effects import make_effect
from stochfric_mb.measurement import Dataset, load_dataset
from tests.discovery.joint_generator.case import Case, write
from tests.discovery.joints.test_parts import coulomb, pair, scenario, sine_run


def fitted(dataset, *effects):
    source = source_of(dataset)
    balances, nuisances = source.balances("", "fit", 0.0), source.nuisances("")
    return fit(source.stated("").plus(*effects), balances, nuisances, noise=1.0), balances, nuisances


def pressed(friction):
    """Runs of a slide whose normal force is measured and swings by half; ``friction`` of it, and of the time."""
    runs = []
    for i, role in enumerate(("fit", "fit", "test")):
        run = sine_run(lambda q, v: 0.0 * v, seed=i, role=role)
        plain = sine_run(coulomb, seed=i, role=role)
        turned = np.sign(plain.channels["force"] - run.channels["force"])
        normal = scenario().mechanism.normal_force * (1.0 + 0.5 * np.sin(2.1 * run.time))
        channels = {**run.channels, "normal_force": normal}
        channels["force"] = run.channels["force"] + friction(normal) * turned
        runs.append(dataclasses.replace(run, channels=channels))
    return Dataset(title="", scenario_path=None, scenario=scenario(), runs=tuple(runs))


def test_friction_of_a_measured_normal_force_is_what_is_stated():
    mu = scenario().law.mu_k
    assert joint_outcome(pressed(lambda n: mu * n)).result.verdict == "none"
    load = scenario().mechanism.normal_force
    adheres = joint_outcome(pressed(lambda n: mu * (n + load) / 2.0)).result
    assert [e.kind for e in adheres.effects] == ["load_dependence"]
    assert adheres.effects[0].parameters["adhesion"].value == pytest.approx(load, rel=0.15)


def test_a_gain_that_is_less_everywhere_does_not_change_along_the_stroke():
    curve = make_effect("drive_gain_change", change=-0.05, slope=0.3, curvature=-2.0)
    given = pair(coulomb)
    more = [dataclasses.replace(r, channels={**r.channels, "force": r.channels["force"] / 0.9}) for r in given.runs]
    weak, *_ = fitted(dataclasses.replace(given, runs=tuple(more)), curve)
    assert is_none(weak, 0)


def test_a_load_whose_share_ends_at_its_bound_stands_for_something_else():
    gap = make_effect("backlash", gap=0.01, load_share=0.5, contact_frequency=10.0, damping_ratio=0.3)
    seen, *_ = fitted(pair(coulomb), gap)
    known = dataclasses.replace(seen, covariance=np.zeros_like(seen.covariance))

    def of_share(share):
        effect = dataclasses.replace(known.model.effects[0], load_share=share, gap=0.01)
        return dataclasses.replace(known, model=dataclasses.replace(known.model, effects=(effect,)))

    assert is_none(of_share(0.95), 0)
    assert not is_none(of_share(0.7), 0)


def test_names_that_trade_most_windows_for_a_few_do_not_stand():
    source = source_of(pair(coulomb))
    balances, nuisances = source.balances("", "fit", 0.0), source.nuisances("")
    selected = Selector(balances, nuisances, source.stated("")).run()

    def left(burst, level):
        rest = np.full(1000, level)
        rest[::50] = burst
        return dataclasses.replace(selected.recalibrated, remainders=(rest,))

    for level, worse in ((1.5, True), (0.9, False)):
        both = dataclasses.replace(selected, recalibrated=left(100.0, 1.0), final=left(20.0, level))
        place = PlaceOutcome("", both, tuple(nuisances), source.stated(""), tuple(balances), tuple(balances), {}, 0.1)
        assert bool(_worse_at_most_times(place)) is worse


def test_white_noise_of_the_channels_is_the_noise_of_the_balance_where_nothing_else_is():
    source = source_of(pair(coulomb))
    balances, nuisances = source.balances("", "fit", 0.0), source.nuisances("")
    model = Selector(balances, nuisances, source.stated("")).recalibrated.model
    assert noise_floor(model, balances, nuisances) < criteria.COLOURED * white_floor(balances)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("form", "design", "strength", "first"),
    [
        ("load_dependence.least_friction", "slide", 0.5, "load_dependence"),
        ("constant_force.guide_is_not_level", "arm", 1.0, "constant_force"),
        ("drive_gain.partly_demagnetised", "mjcf_hinge", 0.5, "drive_gain"),
        ("backlash.worn_bevel_gear", "mjcf_hinge", 1.0, "backlash"),
        ("backlash.dog_clutch", "mjcf_slide", 0.5, "backlash"),
        ("unknown.meter_rings", "mjcf_hinge", 0.5, "unknown"),
    ],
)
def test_forms_have_their_names(form, design, strength, first, tmp_path):
    write(Case(form, design, strength, 51), tmp_path / "set", tmp_path / "truth.json")
    result = joint_outcome(load_dataset(tmp_path / "set")).result
    assert [result.verdict, *(e.kind for e in result.effects)][min(len(result.effects), 1)] == first
