"""Trajectories that come back as they went."""

import dataclasses
import tomllib

import numpy as np
import pytest

from stochfric_mb import InputError, MissingEngineError, Trajectory, load_scenario
from stochfric_mb.storage import FORMATS, SCHEMA, read_trajectory, trajectory_ending, write_trajectory
from stochfric_mb.trajectory import COLUMNS


@pytest.fixture
def trajectory():
    rng = np.random.default_rng(5)
    n = 50
    columns = [np.arange(n) * 1e-3, *rng.normal(size=(6, n)), (rng.uniform(size=n) > 0.5).astype(float)]
    about = {"engine": "mujoco", "version": "4.0.0", "hook": "plugin", "dt": 1e-4, "seed": 3, "law": "havsin"}
    return Trajectory(*columns, attributes=about | {"notes": ["one", "two"], "n_steps": 500, "extra": [1.0, 2.0]})


@pytest.fixture
def scenario():
    return load_scenario("kang2015_table1")


def _need(ending):
    if ending == ".parquet":
        pytest.importorskip("pyarrow", reason="Parquet needs pyarrow")


@pytest.mark.parametrize("ending", list(FORMATS))
def test_numbers_come_back_to_the_bit(tmp_path, trajectory, scenario, ending):
    _need(ending)
    path = write_trajectory(trajectory, tmp_path / f"run{ending}", scenario=scenario)
    back = read_trajectory(path)
    for name in COLUMNS:
        np.testing.assert_array_equal(getattr(back, name), getattr(trajectory, name))
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("ending", [".nc", ".parquet"])
def test_attributes_come_back(tmp_path, trajectory, scenario, ending):
    _need(ending)
    about = read_trajectory(write_trajectory(trajectory, tmp_path / f"run{ending}", scenario=scenario)).attributes
    assert about["schema"] == SCHEMA
    assert about["notes"] == ["one", "two"]
    assert {k: about[k] for k in ("engine", "seed", "dt", "law", "n_steps")} == {
        k: trajectory.attributes[k] for k in ("engine", "seed", "dt", "law", "n_steps")
    }
    assert tomllib.loads(about["scenario"]) == scenario.to_dict()


def test_netcdf_follows_the_cf_conventions(tmp_path, trajectory):
    import xarray

    with xarray.open_dataset(write_trajectory(trajectory, tmp_path / "run.nc"), engine="h5netcdf") as dataset:
        assert dict(dataset.sizes) == {"time": 50}
        assert set(dataset.variables) == set(COLUMNS)
        assert dataset.time.dtype == np.float64
        assert dataset.velocity.attrs == {"units": "m s-1", "long_name": "velocity of the body"}
        assert all({"units", "long_name"} <= set(v.attrs) for v in dataset.variables.values())


def test_csv_header_names_quantity_and_unit(tmp_path, trajectory):
    path = write_trajectory(trajectory, tmp_path / "run.csv")
    header = path.read_text(encoding="utf-8").splitlines()[0]
    assert header.startswith("time [s],position [m],velocity [m/s],friction_force [N]")


def test_existing_file_is_kept_without_force(tmp_path, trajectory):
    path = tmp_path / "run.csv"
    path.write_text("mine")
    with pytest.raises(InputError, match=r"exists.*--force"):
        write_trajectory(trajectory, path)
    assert path.read_text() == "mine"
    write_trajectory(trajectory, path, force=True)
    assert len(read_trajectory(path).time) == 50


def test_unknown_ending_lists_the_endings(trajectory, tmp_path):
    with pytest.raises(InputError, match=r"'\.txt'.*\.nc, \.csv, \.parquet"):
        write_trajectory(trajectory, tmp_path / "run.txt")


def test_parquet_without_pyarrow_names_the_extra(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pyarrow", None)
    with pytest.raises(MissingEngineError, match=r"pip install .\.\[parquet\]."):
        trajectory_ending("run.parquet")


def test_missing_folders_are_made(tmp_path, trajectory):
    assert write_trajectory(trajectory, tmp_path / "a" / "b" / "run.csv").is_file()


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda lines: [lines[0], lines[1], lines[2].replace(",", ",oops", 1)], "row 3.*oops"),
        (lambda lines: [lines[0].replace("[m]", "[mm]"), *lines[1:]], "position .mm.*unknown"),
        (lambda lines: [lines[0], lines[2], lines[1]], "sample 2: time does not grow"),
        (lambda lines: [lines[0], lines[1], "0.001" + ",nan" * 7], "sample 2: position is not finite"),
        (lambda lines: [",".join(line.split(",")[:3]) for line in lines], "'friction_force' is missing"),
        (lambda lines: [], "is missing"),
    ],
)
def test_spoilt_csv_is_named(tmp_path, trajectory, spoil, message):
    path = write_trajectory(trajectory, tmp_path / "run.csv")
    path.write_text("\n".join(spoil(path.read_text().splitlines())))
    with pytest.raises(InputError, match=message):
        read_trajectory(path)


@pytest.mark.parametrize("ending", [".nc", ".parquet"])
def test_a_file_of_another_kind_is_named(tmp_path, ending):
    _need(ending)
    path = tmp_path / f"run{ending}"
    path.write_text("not this")
    with pytest.raises(InputError, match="not a"):
        read_trajectory(path)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        read_trajectory(tmp_path / "none.nc")


def test_a_broken_write_leaves_nothing(tmp_path, trajectory, monkeypatch):
    def write(_columns, _attributes, path):
        path.write_text("half")
        raise KeyboardInterrupt

    monkeypatch.setitem(FORMATS, ".csv", (write, FORMATS[".csv"][1]))
    with pytest.raises(KeyboardInterrupt):
        write_trajectory(trajectory, tmp_path / "run.csv")
    assert list(tmp_path.iterdir()) == []


def test_trajectory_without_attributes_can_be_written(tmp_path, trajectory):
    bare = dataclasses.replace(trajectory, attributes={})
    assert read_trajectory(write_trajectory(bare, tmp_path / "run.nc")).attributes["notes"] == []


def test_truth_values_are_stored_as_numbers(tmp_path):
    columns = {name: np.zeros(3) for name in COLUMNS} | {"time": np.arange(3.0)}
    write_trajectory(Trajectory(**columns, attributes={"located": True}), tmp_path / "run.nc")
    assert read_trajectory(tmp_path / "run.nc").attributes["located"] == 1
