"""Blocks of an ensemble: jobs, parts on the disk, workers that die, datasets."""

import dataclasses
import json
import os
import pickle
import signal
import tracemalloc

import numpy as np
import pytest

from stochfric_mb import ensemble
from stochfric_mb.ensemble import parts as parts_module
from stochfric_mb.ensemble import workers
from stochfric_mb.ensemble.dataset import open_dataset, read_ensemble, write_ensemble
from stochfric_mb.ensemble.job import compute, describe, job
from stochfric_mb.ensemble.parts import open_parts, parts_folder
from stochfric_mb.ensemble.produce import memory, produce
from stochfric_mb.errors import InputError, SimulationError, StabilityError
from stochfric_mb.scenario import load_scenario

TIMES = np.array([0.0, 0.3, 1.1, 1.5])
SKETCH = ("counts", "low", "exponent", "moments")


def scenario(law="coulomb", **changes):
    return dataclasses.replace(load_scenario("kang2015_table1", law=law), duration=1.5, **changes)


def a_job(n_runs=100, block=15, **options):
    return job(scenario(), n_runs, **{"seed": 3, "output_times": TIMES, "block": block} | options)


def equal(a, b):
    if a.position is None:
        same = all(np.array_equal(getattr(a.sketches[q], f), getattr(b.sketches[q], f)) for q in a.sketches for f in SKETCH)
        same = same and np.array_equal(a.stuck, b.stuck)
    else:
        same = all(np.array_equal(getattr(a, n), getattr(b, n)) for n in ("position", "velocity", "stick"))
    return same and np.array_equal(a.time, b.time) and np.array_equal(a.tallies, b.tallies, equal_nan=True)


def stop_at(runs):
    def stop(done):
        if done >= runs:
            raise KeyboardInterrupt

    return stop


# --- the whole way ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("ending", [".nc", ".zarr"])
@pytest.mark.parametrize("statistics_only", [False, True])
def test_what_is_on_the_disk_is_what_run_returns_to_the_bit(tmp_path, ending, statistics_only):
    if ending == ".zarr":
        pytest.importorskip("zarr")
    made = produce(a_job(statistics_only=statistics_only, first_sample=40), tmp_path / f"ens{ending}", workers=2)
    result, stored = read_ensemble(made.path)
    wanted = ensemble.run(
        scenario(), 100, seed=3, first_sample=40, output_times=TIMES, statistics_only=statistics_only, threads=2
    )
    assert equal(result, wanted)
    assert stored == scenario()
    assert result.attributes["engine"] == "reference"
    assert (result.attributes["seed"], result.attributes["first_sample"], result.attributes["n_runs"]) == (3, 40, 100)
    assert json.loads(result.attributes["versions"])["numba"]
    assert [p.name for p in tmp_path.iterdir()] == [f"ens{ending}"]
    with open_dataset(made.path) as dataset:
        assert dataset["run"].values.tolist() == list(range(40, 140))
        assert dataset["time"].attrs["units"] == "s"
        assert dataset.attrs["Conventions"].startswith("CF-")
        assert all("long_name" in dataset[name].attrs for name in dataset.data_vars)


def test_zarr_and_netcdf_hold_the_same(tmp_path, monkeypatch):
    pytest.importorskip("zarr")
    monkeypatch.setattr("stochfric_mb.ensemble.dataset.CHUNK_BYTES", 8 * len(TIMES) * 22)  # chunks of 22 runs
    for name in ("a.nc", "b.zarr"):
        produce(a_job(), tmp_path / name, workers=1)
    with open_dataset(tmp_path / "a.nc") as a, open_dataset(tmp_path / "b.zarr") as b:
        assert a.identical(b[list(a.data_vars)])
        assert b["position"].encoding["chunks"] == (22, 4)


def test_write_and_read_again(tmp_path):
    result = ensemble.run(scenario(), 5, output_times=TIMES)
    write_ensemble(result, tmp_path / "e.nc", scenario=scenario())
    assert equal(read_ensemble(tmp_path / "e.nc")[0], result)
    with pytest.raises(InputError, match=r"e\.nc exists; give another name, or --force"):
        write_ensemble(result, tmp_path / "e.nc", scenario=scenario())
    with pytest.raises(InputError, match=r"ending '\.csv' is unknown"):
        write_ensemble(result, tmp_path / "e.csv", scenario=scenario())
    (tmp_path / "no.nc").write_text("no")
    with pytest.raises(InputError, match="no ensemble"):
        read_ensemble(tmp_path / "no.nc")
    with pytest.raises(InputError, match="no such file"):
        read_ensemble(tmp_path / "none.nc")


@pytest.mark.parametrize(("ending", "options"), [(".nc", {}), (".zarr", {}), (".nc", {"statistics_only": True})])
def test_memory_is_what_is_stated_before_the_run(tmp_path, monkeypatch, ending, options):
    if ending == ".zarr":
        pytest.importorskip("zarr")
    monkeypatch.setattr("stochfric_mb.ensemble.dataset.CHUNK_BYTES", 2**20)
    monkeypatch.setattr("stochfric_mb.ensemble.produce.CHUNK_BYTES", 2**20)
    times = np.arange(1, 301) / 200
    produce(a_job(20, output_times=times, **options), tmp_path / f"first{ending}", workers=1)  # compile and import
    task = a_job(4000, block=200, output_times=times, **options)
    stated = memory(task, tmp_path / f"ens{ending}", 1)
    tracemalloc.start()
    produce(task, tmp_path / f"ens{ending}", workers=1)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    # Python's own objects, HDF5's and Zarr's buffers come on top: 3 MB here
    assert 0.3 * stated < peak < stated + 3e6


# --- interrupted and resumed ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("statistics_only", [False, True])
def test_an_interrupted_ensemble_goes_on_and_computes_nothing_twice(tmp_path, monkeypatch, statistics_only):
    monkeypatch.setattr(parts_module, "CHECKPOINT_BYTES", 1)
    monkeypatch.setattr(parts_module.Sketch, "nbytes", staticmethod(lambda n_times, bins=0: 1))
    task, target = a_job(statistics_only=statistics_only), tmp_path / "ens.nc"
    begun = []

    def counted(given, number, threads=1):
        begun.append(number)
        return compute(given, number, threads)

    monkeypatch.setattr(workers, "compute", counted)
    for at, finished in ((30, 2), (75, 5)):
        with pytest.raises(KeyboardInterrupt):
            produce(task, target, workers=1, progress=stop_at(at))
        kept = open_parts(target, task).finished
        assert len(kept) == finished
        assert not target.exists()
    if statistics_only:
        assert sorted(p.name for p in parts_folder(target).iterdir()) == ["checkpoint.npz", "job.json"]
    before = len(begun)
    made = produce(task, target, workers=1)
    assert (made.n_resumed, made.n_computed) == (5, 2)
    assert sorted(begun[before:]) == sorted(set(range(7)) - kept)
    assert equal(
        read_ensemble(target)[0], ensemble.run(scenario(), 100, seed=3, output_times=TIMES, statistics_only=statistics_only)
    )
    assert not parts_folder(target).exists()


def test_blocks_out_of_order_give_the_same_statistics(tmp_path):
    task = a_job(statistics_only=True)
    for name, order in (("a.nc", [3, 6, 0, 2, 1, 5, 4]), ("b.nc", range(7))):
        parts = open_parts(tmp_path / name, task)
        for number in order:
            parts.add(number, compute(task, number))
        write_ensemble(parts.result({}), tmp_path / name, scenario=scenario())
    assert equal(*(read_ensemble(tmp_path / name)[0] for name in ("a.nc", "b.nc")))


def test_a_damaged_or_half_written_part_is_computed_anew(tmp_path):
    task, target = a_job(), tmp_path / "ens.nc"
    with pytest.raises(KeyboardInterrupt):
        produce(task, target, workers=1, progress=stop_at(60))
    folder = parts_folder(target)
    files = sorted(folder.glob("block-*"))
    assert len(files) == 4
    files[0].write_bytes(files[0].read_bytes()[:-200])
    content = bytearray(files[1].read_bytes())
    content[300] ^= 1
    files[1].write_bytes(content)
    (folder / ".block-0000005.npz.abc.partial").write_bytes(b"half")
    made = produce(task, target, workers=1)
    assert made.n_resumed == 2
    assert equal(read_ensemble(target)[0], ensemble.run(scenario(), 100, seed=3, output_times=TIMES))


def test_a_failed_write_leaves_no_part(tmp_path, monkeypatch):
    parts = open_parts(tmp_path / "ens.nc", a_job())

    def full(file, **arrays):
        file.write(b"half of it")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np, "savez", full)
    with pytest.raises(OSError, match="No space left"):
        parts.add(0, compute(a_job(), 0))
    assert [p.name for p in parts.folder.iterdir()] == ["job.json"]
    assert parts.finished == set()


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"seed": 4}, "seed"),
        ({"n_runs": 101}, "n_runs"),
        ({"block": 20}, "block"),
        ({"output_times": TIMES[1:]}, "n_times, output_times"),
        ({"statistics_only": True}, "statistics_only"),
        ({"first_sample": 1}, "first_sample"),
    ],
)
def test_parts_of_another_ensemble_are_refused(tmp_path, change, named):
    target = tmp_path / "ens.nc"
    with pytest.raises(KeyboardInterrupt):
        produce(a_job(), target, workers=1, progress=stop_at(30))
    other = a_job(**change)
    with pytest.raises(InputError, match=rf"ens\.nc\.parts holds parts of another ensemble \(other {named}\).*--force"):
        produce(other, target, workers=1)
    made = produce(other, target, workers=1, force=True)
    assert made.n_resumed == 0


def test_parts_of_another_version_or_scenario_are_refused(tmp_path, monkeypatch):
    target = tmp_path / "ens.nc"
    open_parts(target, a_job())
    with pytest.raises(InputError, match=r"\(other scenario\)"):
        open_parts(target, dataclasses.replace(a_job(), scenario=scenario(title="another")))
    monkeypatch.setattr("stochfric_mb.ensemble.job.__version__", "9.9.9")
    with pytest.raises(InputError, match=r"\(other versions\)"):
        open_parts(target, a_job())


def test_a_folder_of_somebody_else_is_left_alone(tmp_path):
    folder = parts_folder(tmp_path / "ens.nc")
    folder.mkdir()
    (folder / "precious.txt").write_text("mine")
    with pytest.raises(InputError, match="is not a parts folder"):
        open_parts(tmp_path / "ens.nc", a_job(), force=True)
    assert (folder / "precious.txt").read_text() == "mine"


# --- workers ----------------------------------------------------------------------------------------------------------


def test_the_block_does_not_depend_on_the_workers_and_a_job_travels():
    task = job(scenario(), 10_000, output_times=TIMES)
    assert task.block == 2048
    assert job(scenario(), 10_000).block < 2048  # 1501 output times: a block is no more than 32 MiB
    assert job(scenario("elastic_stick"), 10_000, output_times=TIMES).block == 512
    assert pickle.loads(pickle.dumps(task)) == task
    assert task.plan(2).bytes_working == 2 * task.plan(1).bytes_working * 2


def dies_once(given, number, threads=1):
    """Compute a block; the first worker that gets block 2 dies of it."""
    flag = os.environ["STOCHFRIC_TEST_FLAG"]
    if number == 2 and not os.path.exists(flag):  # noqa: PTH110
        open(flag, "w").close()  # noqa: PTH123
        os.kill(os.getpid(), signal.SIGTERM)
    return compute(given, number, threads)


def always_dies(given, number, threads=1):
    os.kill(os.getpid(), signal.SIGTERM)


def test_a_worker_process_that_dies_costs_its_blocks_only(tmp_path, monkeypatch):
    monkeypatch.setenv("STOCHFRIC_TEST_FLAG", str(tmp_path / "flag"))
    monkeypatch.setattr(workers, "compute", dies_once)
    monkeypatch.setattr("stochfric_mb.ensemble.job.Job.how", "processes")
    made = produce(a_job(), tmp_path / "ens.nc", workers=2)
    assert (tmp_path / "flag").exists()
    assert equal(read_ensemble(made.path)[0], ensemble.run(scenario(), 100, seed=3, output_times=TIMES))


def test_workers_that_keep_dying_are_an_error(tmp_path, monkeypatch):
    monkeypatch.setattr(workers, "compute", always_dies)
    monkeypatch.setattr("stochfric_mb.ensemble.job.Job.how", "processes")
    with pytest.raises(SimulationError, match=r"a worker process died 3 times in a row .* take fewer workers"):
        produce(a_job(), tmp_path / "ens.nc", workers=1)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"workers": 0}, "workers = 0 must be from 1"),
        ({"workers": 2, "scheduler": "tcp://nowhere:1"}, "give one of them"),
        ({"max_bytes": 1000}, r"need .* MiB, over .*\.zarr"),
    ],
)
def test_what_cannot_be_used_is_said_before_anything_runs(tmp_path, options, message):
    with pytest.raises(InputError, match=message):
        produce(a_job(), tmp_path / "ens.nc", **options)
    assert list(tmp_path.iterdir()) == []


def test_a_step_beyond_the_limit_is_refused_for_kernels_too():
    with pytest.raises(StabilityError, match=r"dt = 0\.01 s is beyond the stability limit"):
        describe(job(scenario("elastic_stick"), 3, dt=0.01))
    assert describe(a_job()).dt == 0.0
