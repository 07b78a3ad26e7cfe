"""Ensembles on a local Dask cluster: the same bits as here, whatever becomes of a worker."""

import dataclasses
import os
import signal

import numpy as np
import pytest

from stochfric_mb.ensemble import cluster
from stochfric_mb.ensemble.dataset import open_dataset, read_ensemble
from stochfric_mb.ensemble.job import job
from stochfric_mb.ensemble.produce import produce
from stochfric_mb.errors import InputError, SimulationError
from stochfric_mb.scenario import load_scenario

distributed = pytest.importorskip("distributed")

# distributed leaves it to the garbage collector to close some of its sockets
pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")

TIMES = np.arange(1, 101) / 100


@pytest.fixture(scope="module")
def two_processes():
    options = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": ":0"}
    with distributed.LocalCluster(**options) as local, distributed.Client(local, set_as_default=False) as client:
        yield client


def a_job(n_runs=400, block=20, **options):
    scenario = dataclasses.replace(load_scenario("kang2015_table1", law="coulomb"), duration=1.0)
    return job(scenario, n_runs, seed=5, output_times=TIMES, block=block, **options)


@pytest.mark.parametrize("statistics_only", [False, True])
def test_a_worker_that_dies_costs_its_blocks_and_no_bit(two_processes, tmp_path, statistics_only):
    client = two_processes
    client.wait_for_workers(2, timeout=60)
    victim = client.run(os.getpid)
    seen = []

    def kill_one(done):
        seen.append(done)
        if len(seen) == 4:
            os.kill(next(iter(victim.values())), signal.SIGTERM if os.name == "nt" else signal.SIGKILL)

    task = a_job(statistics_only=statistics_only)
    far = produce(task, tmp_path / "far.nc", scheduler=client, progress=kill_one)
    here = produce(task, tmp_path / "here.nc", workers=2)
    client.wait_for_workers(2, timeout=60)
    assert set(client.run(os.getpid).values()) != set(victim.values())  # one is gone, another in its place
    assert (far.n_computed, here.n_computed) == (20, 20)
    assert seen == [0, *range(20, 401, 20)]  # every block came once
    with open_dataset(far.path) as a, open_dataset(here.path) as b:
        assert a.identical(b)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["far.nc", "here.nc"]


def test_an_address_will_do_and_the_cluster_finishes_what_was_begun_here(two_processes, tmp_path):
    task, target = a_job(), tmp_path / "ens.nc"

    def stop(done):
        if done >= 100:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        produce(task, target, workers=1, progress=stop)
    done = produce(task, target, scheduler=two_processes.scheduler.address)
    assert (done.n_resumed, done.n_computed) == (5, 15)
    produce(task, tmp_path / "whole.nc", workers=1)
    with open_dataset(target) as a, open_dataset(tmp_path / "whole.nc") as b:
        assert a.identical(b)


def test_an_engine_on_the_cluster(two_processes, tmp_path):
    pytest.importorskip("mujoco")
    scenario = dataclasses.replace(load_scenario("kang2015_table1"), duration=0.05)
    task = job(scenario, 6, engine="mujoco", block=3)
    produce(task, tmp_path / "far.nc", scheduler=two_processes)
    produce(task, tmp_path / "here.nc", workers=2)
    far, here = (read_ensemble(tmp_path / name)[0] for name in ("far.nc", "here.nc"))
    assert np.array_equal(far.position, here.position)


def test_no_scheduler_there(monkeypatch):
    monkeypatch.setattr(cluster, "CONNECT", 0.2)
    with pytest.raises(InputError, match=r"no Dask scheduler at 'tcp://127.0.0.1:9'.*start one with `dask scheduler`"):
        cluster.connect("tcp://127.0.0.1:9")


def test_no_workers(monkeypatch):
    monkeypatch.setattr(cluster, "PATIENCE", 0.3)
    options = {"n_workers": 0, "processes": False, "dashboard_address": ":0"}
    with (
        distributed.LocalCluster(**options) as empty,
        distributed.Client(empty, set_as_default=False) as client,
        pytest.raises(SimulationError, match="has had no workers"),
    ):
        next(cluster.on_cluster(a_job(), [0], client))


def test_other_versions_on_a_worker_are_refused():
    with pytest.raises(SimulationError, match="install the same versions everywhere"):
        cluster._require_same({"stochfric_mb": "0.0.1"}, {"stochfric_mb": "0.1.0"})
