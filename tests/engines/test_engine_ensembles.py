"""Ensembles by engines: each sample is the engine's own run, and all of them agree with the reference in distribution."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb import ensemble
from stochfric_mb.engines import ENGINES, adapter
from stochfric_mb.ensemble.dataset import read_ensemble
from stochfric_mb.ensemble.job import BATCH, PROCESSES, compute, describe, job
from stochfric_mb.ensemble.produce import produce
from stochfric_mb.errors import InputError, StabilityError
from stochfric_mb.scenario import load_scenario
from stochfric_mb.statistics import ks_test

TABLE_1, TABLE_2 = "kang2015_table1", "kang2015_table2_13_8"
# SciPy takes the asymptotic p-value where the exact one cannot be computed, and says so
pytestmark = pytest.mark.filterwarnings("ignore:ks_2samp. Exact calculation unsuccessful:RuntimeWarning")

RESOLUTION = 1.0e-6
"""Velocities are compared to this [m/s]: runs that stick have one velocity to 1e-16 m/s, and ranks would see rounding."""


def short(name, duration, **changes):
    return dataclasses.replace(load_scenario(name), duration=duration, **changes)


@pytest.fixture(params=["mujoco", "exudyn", "pymunk"])
def engine(request):
    if not ENGINES[request.param].installed:
        pytest.skip(f"{request.param} is not installed")
    return request.param


@pytest.mark.parametrize("name", [TABLE_1, TABLE_2])
def test_sample_i_is_the_engines_run_to_the_bit(engine, name):
    scenario = short(name, 0.2)
    times = [0.0, 0.05, 0.2]
    task = job(scenario, 3, seed=7, first_sample=4, engine=engine, output_times=times)
    block = compute(task, 0, threads=2)
    for j in range(3):
        run = adapter(engine).simulate(scenario, seed=7, sample=4 + j)
        at = np.round(np.array(times) / scenario.output_step).astype(int)
        assert np.array_equal(block.position[j], run.position[at])
        assert np.array_equal(block.velocity[j], run.velocity[at])
        assert np.array_equal(block.stick[j], run.stick[at] == 1.0)
    assert len(np.unique(block.position[:, 2])) == 3


def test_workers_and_blocks_change_no_bit(engine, tmp_path):
    scenario = short(TABLE_1, 0.05)
    items = []
    for block, count in ((5, 1), (2, 2)):
        task = job(scenario, 5, seed=2, engine=engine, block=block)
        assert task.how == (BATCH if engine == "mujoco" else PROCESSES)
        made = produce(task, tmp_path / f"{block}.nc", workers=count)
        assert made.n_computed == task.n_blocks
        items.append(read_ensemble(made.path)[0])
    for name in ("position", "velocity", "stick"):
        assert np.array_equal(getattr(items[0], name), getattr(items[1], name))
    assert np.array_equal(items[0].tallies, items[1].tallies, equal_nan=True)
    assert items[0].attributes["engine_version"] == ENGINES[engine].version


@pytest.mark.parametrize("law", ["coulomb", "havsin"])
def test_mujocos_threads_are_its_simulate_for_other_laws_too(law):
    pytest.importorskip("mujoco")
    from stochfric_mb.mujoco import belt_box

    for name in (TABLE_1, TABLE_2):
        scenario = dataclasses.replace(load_scenario(name, law=law), duration=0.05)
        for j, run in enumerate(belt_box.simulate_many(scenario, seed=1, first_sample=2, n=3, threads=2)):
            alone = belt_box.simulate(scenario, seed=1, sample=2 + j)
            for column in ("position", "velocity", "friction_force", "normal_force", "mu_s", "mu_k", "stick"):
                assert np.array_equal(getattr(run, column), getattr(alone, column)), column


def test_a_law_that_stands_in_is_named():
    pytest.importorskip("mujoco")
    scenario = dataclasses.replace(load_scenario(TABLE_1, law="coulomb"), duration=0.01)
    about = describe(job(scenario, 3, engine="mujoco"))
    assert about.law == "elastic_stick"
    assert len(about.notes) == 1
    assert "coulomb" in about.notes[0]


def test_what_an_engine_cannot_do_is_said_before_it_runs(engine):
    scenario = short(TABLE_1, 0.05, output_step=0.01)
    with pytest.raises(StabilityError, match="beyond the stability limit"):
        describe(job(scenario, 3, engine=engine, dt=0.01, output_times=[0.05]))
    with pytest.raises(InputError, match=r"does not divide"):
        describe(job(scenario, 3, engine=engine, dt=0.003))


def agreement(engine, name, *, n, duration, times, dt, block=None):
    """Return the p-values of position and velocity at ``times`` against other samples of the reference, and of the events."""
    scenario = short(name, duration)
    task = job(scenario, n, seed=1, engine=engine, dt=dt, output_times=times, block=block)
    blocks = [compute(task, number, threads=2) for number in range(task.n_blocks)]
    x, v, _, tallies = (np.concatenate(a) for a in zip(*blocks, strict=True))
    wanted = ensemble.run(scenario, n, seed=2, output_times=times)
    table = {}
    for i, t in enumerate(times):
        table[f"x({t:g} s)"] = ks_test(x[:, i], wanted.position[:, i]).p_value
        rounded = (np.round(values / RESOLUTION) for values in (v[:, i], wanted.velocity[:, i]))
        table[f"v({t:g} s)"] = ks_test(*rounded).p_value
    table["first break-away"] = ks_test(tallies[:, 1], wanted.first_break_away).p_value
    return table


def test_engines_agree_with_the_reference_in_distribution_small(engine):
    """N = 40 to the first slip of Table 1; the long test below is the real one."""
    result = agreement(engine, TABLE_1, n=40, duration=1.2, times=[1.1, 1.2], dt=1e-3)
    # 5 tests at 0.001 each: one of 200 seeds fails by chance, and this seed does not
    assert min(result.values()) > 1e-3, result


def test_the_comparison_sees_a_wrong_ensemble():
    """Another mu_s, 2 % lower: what the tests above must be able to see."""
    scenario = short(TABLE_1, 1.2)
    law = dataclasses.replace(scenario.law, mu_s=0.98 * scenario.law.mu_s)
    wrong = ensemble.run(dataclasses.replace(scenario, law=law), 40, seed=1, output_times=[1.1, 1.2])
    wanted = ensemble.run(scenario, 40, seed=2, output_times=[1.1, 1.2])
    assert ks_test(wrong.position[:, 0], wanted.position[:, 0]).p_value < 1e-3


@pytest.mark.long
@pytest.mark.parametrize("name", [TABLE_1, TABLE_2])
def test_engines_agree_with_the_reference_in_distribution(engine, name):
    """N = 300 over the tables' 10 s, at the default step that the documentation recommends."""
    result = agreement(engine, name, n=300, duration=10.0, times=[2.0, 4.0, 10.0], dt=None, block=25)
    # 7 tests at 0.001 each: one of 140 seeds fails by chance, and this seed does not
    assert min(result.values()) > 1e-3, result
