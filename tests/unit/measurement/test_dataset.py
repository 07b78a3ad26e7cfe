"""Datasets: what a good one becomes, and what is said about a bad one."""

import dataclasses
import shutil

import numpy as np
import pytest

from stochfric_mb import InputError, load_scenario
from stochfric_mb.measurement import load_dataset
from stochfric_mb.measurement.assemble import RunEntry, assemble
from stochfric_mb.scenario import any_scenario_from_dict, bundled_scenarios

from .files import POSITION, TIME, csv, dataset, measured

FIT = 'file = "run.csv"\nrole = "fit"'
TEST = 'file = "run.csv"\nrole = "test"'


@pytest.fixture
def rig(tmp_path):
    csv(tmp_path / "run.csv", time__s=TIME, position__m=POSITION)
    return tmp_path


def only(folder, run=FIT):
    """Return the first run of a dataset of two."""
    return load_dataset(dataset(folder, run, TEST)).runs[0]


def test_a_dataset(rig):
    csv(rig / "slow.csv", time__ms=1e3 * TIME, position__mm=1e3 * POSITION, humidity=TIME, normal_force__kN=0.013 + 0.0 * TIME)
    slow = 'file = "slow.csv"\nrole = "test"\nset = { belt_velocity = 1e-3 }'
    shutil.copy(bundled_scenarios()["kang2015_table1"], rig / "scenario.toml")
    data = load_dataset(dataset(rig, FIT, slow, scenario="scenario.toml"))
    assert (data.title, data.scenario_path, [r.name for r in data.runs]) == ("rig", rig / "scenario.toml", ["run", "slow"])
    (fit,), (test,) = data.fit, data.test
    np.testing.assert_array_equal(fit.channels["position"], POSITION)
    np.testing.assert_allclose(test.channels["position"], POSITION, rtol=1e-15)
    np.testing.assert_allclose(test.time, TIME, rtol=1e-12)
    np.testing.assert_allclose(test.channels["normal_force"], 13.0, rtol=1e-12)
    np.testing.assert_array_equal(test.covariates["humidity"], TIME)
    assert test.units == {"position": "m", "normal_force": "N", "humidity": ""}
    assert test.sample_interval == pytest.approx(1e-3, rel=1e-12)
    assert test.notes == ("normal_force is constant (13 N)",)
    assert fit.mechanism(data.scenario) == data.scenario.mechanism
    assert test.mechanism(data.scenario) == dataclasses.replace(data.scenario.mechanism, belt_velocity=1e-3)


@pytest.mark.parametrize(("header", "unit", "same"), [("mNm", "mN m", True), ("m/s", "m s-1", True), ("mm", "um", False),
                                                      ("rpm", "rad/s", False), ("mm", "bananas", False)])  # fmt: skip
def test_another_spelling_of_a_unit_is_no_other_unit(tmp_path, header, unit, same):
    csv(tmp_path / "run.csv", time__s=TIME, position__m=POSITION, **{f"load__{header}": TIME})
    said = only(tmp_path, f'{FIT}\nunits = {{ load = "{unit}" }}').notes
    assert any(f"taken to be in {unit}" in note for note in said) != same


def test_a_bundled_scenario_is_named_by_its_file(rig):
    assert load_dataset(dataset(rig, FIT, TEST)).scenario_path == bundled_scenarios()["kang2015_table1"]


def test_the_file_itself_and_a_scenario_as_an_object(rig):
    scenario = dataclasses.replace(load_scenario("kang2015_table1"), title="mine")
    data = load_dataset(dataset(rig, FIT, TEST) / "dataset.toml", scenario)
    assert data.scenario is scenario
    assert data.scenario_path is None
    assert [r.name for r in data.runs] == ["run #1", "run #2"]


def test_one_file_alone_holds_out_its_last_third(rig):
    fit, test = load_dataset(
        csv(rig / "long.csv", time__s=np.arange(301) * 0.01, position__m=np.arange(301.0)), "kang2015_table1"
    ).runs
    assert (fit.role, test.role) == ("fit", "test")
    assert fit.time[-1] == pytest.approx(1.99)
    assert (test.time[0], test.time[-1]) == pytest.approx((2.0, 3.0))
    np.testing.assert_array_equal(np.concatenate([fit.channels["position"], test.channels["position"]]), np.arange(301.0))


def test_untidy_file(rig):
    rows = np.c_[1e3 * TIME, 7.0 + 0.0 * TIME, 1e3 * POSITION]
    np.savetxt(rig / "raw.csv", rows, delimiter="\t", fmt="%.17g")
    keys = (
        'file = "raw.csv"\nrole = "fit"\ncolumns = { time = 0, position = 2 }\nunits = { time = "ms", position = "mm" }\n'
        "sign = { position = -1 }\nskip_rows = 15\ntime_range = [0.3, 0.36]"
    )
    run = only(rig, keys)
    kept = (TIME >= 0.3 - 1e-12) & (TIME <= 0.36 + 1e-12)
    np.testing.assert_allclose(run.time, TIME[kept], rtol=1e-12)
    np.testing.assert_allclose(run.channels["position"], -POSITION[kept], rtol=1e-14)
    assert set(run.channels) == {"position"}
    assert run.covariates == {}


def test_columns_by_name_leave_the_others_as_covariates(rig):
    csv(rig / "run.csv", t=TIME, qm=POSITION, position=2.0 * POSITION, light=TIME, word=["a"] * TIME.size)
    keys = 'columns = { time = "t", position = "qm" }\nunits = { time = "s", position = "m" }'
    run = load_dataset(dataset(rig, f"{FIT}\n{keys}", f"{TEST}\n{keys}")).fit[0]
    np.testing.assert_array_equal(run.channels["position"], POSITION)
    assert set(run.covariates) == {"light"}
    assert run.notes == ("column 'position' is left out: position is column 'qm'",)


def test_samples_that_are_fitted_and_held_out_are_spoken_of(rig):
    data = load_dataset(dataset(rig, FIT, TEST))
    assert not data.fit[0].notes
    assert data.test[0].notes[0].startswith(f"{TIME.size} of its samples are in run 'run #1', which is fitted")
    cut = float(TIME[TIME.size // 2])
    apart = load_dataset(dataset(rig, f"{FIT}\ntime_range = [0, {cut}]", f"{TEST}\ntime_range = [{cut}, 9]"))
    assert not any("which is fitted" in note for note in apart.test[0].notes)  # they meet in a sample


def test_a_unit_given_in_the_place_of_the_header_s_is_spoken_of(rig):
    notes = load_dataset(dataset(rig, FIT, f'{TEST}\nunits = {{ position = "mm" }}')).test[0].notes
    assert "position is taken to be in mm, as its run says, and not in m, as the file's header does" in notes


def test_covariate_with_missing_values_is_left_out_and_said(rig):
    csv(rig / "run.csv", time__s=TIME, position__m=POSITION, light__lx=[*TIME[1:], np.nan])
    run = only(rig)
    assert run.covariates == {}
    assert run.notes == ("covariate 'light' has missing values and is left out",)


def test_environment_variables(rig, monkeypatch):
    monkeypatch.setenv("RIG", str(rig))
    run = only(rig, 'file = "${RIG}/run.csv"\nrole = "fit"')
    assert run.time.size == TIME.size
    monkeypatch.delenv("RIG")
    with pytest.raises(InputError, match=r"environment variable RIG is not set; set it to the folder"):
        load_dataset(rig)


def test_data_beside_the_project_stand_in_for_the_variable(monkeypatch):
    from stochfric_mb.measurement.entries import expanded

    path = measured("emps/DATA_EMPS.mat")
    monkeypatch.setenv("STOCHFRIC_DATA", str(path.parents[1]))
    assert expanded("${STOCHFRIC_DATA}/emps/DATA_EMPS.mat") == str(path)


@pytest.mark.parametrize("unit", ["deg", "rad", "°"])
def test_angles_where_the_mechanism_rotates(rig, unit):
    factor = 1.0 if unit == "rad" else 180.0 / np.pi
    csv(rig / "turn.csv", time__s=TIME, **{f"position__{unit}": factor * POSITION, "torque__Nm": TIME, "velocity__rpm": TIME})
    run = assemble(RunEntry(file=rig / "turn.csv", name="turn"), rotational=True)
    np.testing.assert_allclose(run.channels["position"], POSITION, rtol=1e-14)
    np.testing.assert_allclose(run.channels["velocity"], TIME * 2.0 * np.pi / 60.0, rtol=1e-14)
    assert run.units == {"position": "rad", "torque": "N m", "velocity": "rad/s"}


def test_temperature_keeps_its_scale(rig):
    csv(rig / "run.csv", time__s=TIME, position__m=POSITION, temperature__K=TIME)
    assert only(rig).units["temperature"] == "K"
    csv(rig / "run.csv", time__s=TIME, position__m=POSITION, temperature__degF=50.0 + 0.0 * TIME)
    run = only(rig)
    assert run.units["temperature"] == "degC"
    np.testing.assert_allclose(run.channels["temperature"], 10.0, rtol=1e-12)


# --- errors ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("fil = 3", r"dataset\.toml: unknown key of runs 1 'fil'; did you mean 'file'"),
        ("set = { belt_speed = 1.0 }", r"run 'run #1': unknown key of set \(mechanism belt_box\) 'belt_speed'.*belt_velocity"),
        ("set = { mass = -1.0 }", r"run 'run #1': mass = -1 kg is out of range"),
        ('set = { mass = "heavy" }', r"set\.mass = 'heavy' is not a number"),
        (
            "columns = { position = 7 }",
            r"columns\.position = 7, but the file has 'time', 'position'; columns are counted from 0",
        ),
        ('columns = { position = "posiion" }', r"unknown column for columns\.position 'posiion'; did you mean 'position'"),
        ("columns = { position = 1.5 }", r"columns\.position = 1\.5; give the name of a column"),
        ('units = { force = "N" }', r"unknown quantity in units .*'force'"),
        ("units = { position = 3 }", r"units\.position = 3; give a unit in quotes"),
        ('units = { position = "N" }', r"run\.csv: unit 'N' is not one of position, which is kept in m .*; give m, mm"),
        (
            'units = { position = "kN" }',
            r"a load cell on the spring .* shows k x: .* scale = \{ position = 8.333e-4 \}, which is 1/k",
        ),
        (
            'units = { position = "deg" }',
            r"'deg' is not one of position, which is kept in m \(this mechanism moves along a line\)",
        ),
        ('units = { position = "furlung" }', r"unit 'furlung' of position is unknown; give m, mm"),
        ('units = { position = "10**10**10" }', r"unit '10\*\*10\*\*10' of position is unknown; give m, mm"),
        ("sign = { position = -2 }", r"sign\.position = -2; a sign is 1 or -1"),
        ("sign = { force = -1 }", r"unknown quantity in sign .*'force'"),
        ("skip_rows = -1", r"skip_rows = -1; give a whole number"),
        ("skip_rows = 9999", r"no rows after skip_rows = 9999; lower it"),
        ("time_range = [2.0]", r"time_range = \[2\.0\]; give \[first, last\] in s"),
        ("time_range = [2.0, 1.0]", r"the first must be before the last"),
        ("time_range = [5.0, 6.0]", r"holds no sample; the file goes from 0\.25 to 0\.369 s"),
        ("time_range = [0.25, 0.26]", r"11 samples; at least 30 are needed"),
        ("max_gap = 0.0", r"max_gap = 0 s is out of range"),
        ("columns = 3", r"columns = 3 is not a table"),
    ],
)
def test_keys_of_a_run(rig, keys, message):
    with pytest.raises(InputError, match=message):
        only(rig, f"{FIT}\n{keys}")


@pytest.mark.parametrize(
    ("runs", "message"),
    [
        ([], r"no runs; add a \[\[runs\]\] table"),
        (['file = "run.csv"'], r'role = None; write role = "fit"'),
        (['role = "fit"'], r'file = None; write file = "run.csv"'),
        (['file = "run.csv"\nrole = "train"'], r"role = 'train'; it is \"fit\" \(used to fit\) or \"test\""),
        (['file = "other.csv"\nrole = "fit"'], r"other\.csv: no such file"),
        ([FIT], r"no run is held out \(run: fit\).*time_range"),
        ([TEST], r"no run to fit \(run: test\); give at least one run role = \"fit\""),
    ],
)
def test_runs(rig, runs, message):
    with pytest.raises(InputError, match=message):
        load_dataset(dataset(rig, *runs))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("schema = 3", r"schema = 3; this version reads 'stochfric\.dataset/1'"),
        ('schema = "stochfric.dataset/1"\nrun = 3', r"unknown key 'run'; did you mean 'runs'"),
        ('schema = "stochfric.dataset/1"\n[[runs]]\n' + FIT, r"scenario = None: a dataset names the file"),
        ('schema = "stochfric.dataset/1"\nscenario = "no.toml"\n[[runs]]\n' + FIT, r"no scenario file"),
        ("schema =", r"not a TOML file"),
    ],
)
def test_dataset_file(rig, text, message):
    (rig / "dataset.toml").write_text(text)
    with pytest.raises(InputError, match=rf"dataset\.toml: {message}"):
        load_dataset(rig)


def test_paths(rig):
    with pytest.raises(InputError, match=r"is a folder without dataset\.toml; write one"):
        load_dataset(rig)
    with pytest.raises(InputError, match="no such file; give a folder"):
        load_dataset(rig / "none")
    (rig / "scenario.toml").write_text('schema = "stochfric.scenario/1"\n[mechanism]\nkind = "belt_box"\n')
    with pytest.raises(InputError, match=r"scenario.toml is a scenario, not a dataset; .* --scenario"):
        load_dataset(rig / "scenario.toml")
    with pytest.raises(InputError, match="a measured file alone says nothing about the rig; give --scenario"):
        load_dataset(rig / "run.csv")
    with pytest.raises(InputError, match=r"40 samples in its last third.*at least 50"):
        load_dataset(rig / "run.csv", "kang2015_table1")


def broken(sample, value):
    values = TIME.copy()
    values[sample] = value
    return values


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({"time": TIME, "position__m": POSITION}, r"time has no unit; write the header as 'time \[s\]', or give units"),
        ({"time__s": TIME, "position__": POSITION}, r"position has no unit"),
        ({"time__s": TIME, "position": POSITION}, r"position has no unit; write the header as 'position \[m\]'"),
        ({"t__s": TIME, "position__m": POSITION}, r"no column is time; its columns are 't', 'position'"),
        ({"time__s": TIME, "x__m": POSITION}, r"no column is a known quantity; its columns are 'time', 'x'"),
        ({"time__s": broken(9, 0.2), "position__m": POSITION}, r"line 11: time falls from 0\.258 s to 0\.2 s; sort the rows"),
        (
            {"time__s": np.sin(40.0 * TIME), "position__m": TIME},
            r"line \d+: the time falls in \d+ of \d+ rows: that is no time;",
        ),
        ({"time__s": broken(9, TIME[8]), "position__m": POSITION}, r"line 11: time stamp 0\.258 s is there twice; remove"),
        ({"time__s": broken(9, np.nan), "position__m": POSITION}, r"line 11: time is nan, a missing value"),
        ({"time__s": TIME, "position__m": broken(9, np.inf)}, r"line 11: position is missing or not finite; remove or correct"),
        ({"time__s": TIME[:29], "position__m": POSITION[:29]}, r"29 samples; at least 30 are needed"),
        (
            {"time__s": TIME + (TIME > 0.29) + (TIME > 0.33), "position__m": POSITION},
            r"line \d+: 1\.001 s without a sample.*max_gap = 1\.1",
        ),
        ({"time__s": TIME, "position__s": POSITION}, r"unit 's' is not one of position"),
        ({"time__s": TIME, "position__m": POSITION, "force__mN m": TIME}, r"unit 'mN m' .* divided by radius or lead"),
    ],
)
def test_content_of_a_file(rig, columns, message):
    csv(rig / "run.csv", **columns)
    with pytest.raises(InputError, match=rf"run\.csv(, |: ){message}"):
        only(rig)


@pytest.mark.parametrize("unit", ["Hz", "1/s", "m/s"])
def test_what_is_no_angle_is_not_taken_for_one(rig, unit):
    csv(rig / "turn.csv", time__s=TIME, velocity=TIME)
    entry = RunEntry(file=rig / "turn.csv", name="turn", units={"velocity": unit})
    with pytest.raises(
        InputError, match=rf"unit '{unit}' is not one of velocity, which is kept in rad/s \(this mechanism rotates\)"
    ):
        assemble(entry, rotational=True)


# --- clocks ----------------------------------------------------------------------------------------------------------


def test_rounded_time_stamps_are_on_their_grid(rig):
    exact = np.arange(200) / 300.0
    csv(rig / "run.csv", time__s=np.round(exact, 4), position__m=np.sin(exact))
    run = only(rig)
    assert run.notes == ()
    np.testing.assert_allclose(run.time, exact, atol=1e-4)  # four digits are written
    np.testing.assert_array_equal(run.channels["position"], np.sin(exact))


def test_jitter_is_interpolated_and_said(rig):
    rng = np.random.default_rng(3)
    time = np.cumsum(rng.uniform(0.8e-3, 1.2e-3, 400))
    csv(rig / "run.csv", time__s=time, position__m=np.sin(30.0 * time), light=2.0 * time)
    run = only(rig)
    steps = np.diff(run.time)
    np.testing.assert_allclose(steps, run.sample_interval, rtol=1e-9)
    assert run.sample_interval == pytest.approx(np.median(np.diff(time)), rel=1e-12)
    bound = 30.0**2 * 1.2e-3**2 / 8.0  # linear interpolation: max |f''| h^2 / 8
    assert np.max(np.abs(run.channels["position"] - np.sin(30.0 * run.time))) < bound
    np.testing.assert_allclose(run.covariates["light"], 2.0 * run.time, rtol=1e-12)
    assert len(run.notes) == 1
    assert "interpolated linearly onto a uniform grid" in run.notes[0]


def test_a_gap_is_bridged_where_that_is_allowed(rig):
    csv(rig / "run.csv", time__s=TIME + 0.01 * (TIME > 0.3), position__m=POSITION)
    entry = RunEntry(file=rig / "run.csv", name="run")
    with pytest.raises(InputError, match=r"max_gap = 0\.011"):
        assemble(entry, rotational=False)
    run = assemble(dataclasses.replace(entry, max_gap=0.011), rotational=False)
    assert run.time.size == TIME.size + 10


def test_no_gap_is_bridged_on_a_belt(rig):
    """A belt runs on in a gap: a straight line across three seconds of stick and slip was called a mass in tonnes."""
    csv(rig / "run.csv", time__s=TIME + 0.3 * (TIME > 0.3), position__m=POSITION)
    data = load_dataset(dataset(rig, f"{FIT}\nmax_gap = 0.4", f"{TEST}\nmax_gap = 0.4"))
    assert len(data.fit) == 2
    assert all("max_gap is not used" in run.notes[0] for run in data.fit)


def test_a_gap_is_left_out_and_each_piece_is_a_run(rig):
    """Interpolating across a gap is motion that nobody measured: it looked like a step of the sensor."""
    time = np.arange(400) * 1e-3
    kept = (time < 0.15) | ((time > 0.2) & (time < 0.21)) | (time > 0.3)  # the middle piece is too short for a run
    csv(rig / "run.csv", time__s=time[kept], position__m=np.sin(30.0 * time)[kept])
    data = load_dataset(dataset(rig, FIT, TEST))
    first, second = data.fit
    assert (first.name, second.name) == ("run #1, piece 1", "run #1, piece 2")
    assert first.time[-1] < 0.15
    assert second.time[0] > 0.3
    for run in data.runs:
        np.testing.assert_allclose(run.channels["position"], np.sin(30.0 * run.time), atol=1e-9)
        note = "samples are missing: 2 pieces between the gaps are runs of their own"
        said = tuple(
            n for n in run.notes if "samples are missing" in n
        )  # a sine of 1 m is no motion of this rig, which is noted, too
        assert said == ((note,) if run.name.endswith("piece 1") else ())  # said once a file


def test_the_pieces_of_a_file_alone_are_shared_out_by_time(rig):
    time = np.arange(900) * 1e-3
    kept = (time < 0.2) | (time > 0.25)
    csv(rig / "run.csv", time__s=time[kept], position__m=np.sin(30.0 * time)[kept])
    data = load_dataset(rig / "run.csv", "kang2015_table1")
    spans = [(run.role, round(float(run.time[0]), 3), round(float(run.time[-1]), 3)) for run in data.runs]
    assert spans == [("fit", 0.0, 0.199), ("fit", 0.251, 0.599), ("test", 0.6, 0.899)]


# --- real files ------------------------------------------------------------------------------------------------------


def test_positioning_system(tmp_path):
    file = measured("emps/DATA_EMPS.mat")
    keys = (
        f'file = "{file}"\ncolumns = {{ time = "t", position = "qm", voltage = "vir" }}\n'
        'units = { time = "s", position = "m", voltage = "V" }'
    )
    data = load_dataset(
        dataset(tmp_path, f'{keys}\nrole = "fit"\ntime_range = [0, 16]', f'{keys}\nrole = "test"\ntime_range = [16.0005, 99]')
    )
    assert sum(run.time.size for run in data.runs) == 24841
    assert data.fit[0].sample_interval == pytest.approx(1e-3, rel=1e-9)
    assert data.fit[0].constants["kp"] == pytest.approx(160.18, abs=0.01)
    assert set(data.fit[0].covariates) == {"qg"}


def test_cylinder_seal(tmp_path):
    entry = RunEntry(
        file=measured("pneuseal/O-ring_3bar.csv"),
        name="seal",
        columns={"time": 0, "position": 4, "pressure": 5, "force": 6},
        units={"time": "ms", "position": "mm", "pressure": "bar", "force": "N"},
        skip_rows=15,
    )
    with pytest.raises(InputError, match=r"0\.3 s without a sample, where 0\.01 s is usual.*max_gap = 0\.3"):
        assemble(entry, rotational=False)
    run = assemble(dataclasses.replace(entry, max_gap=0.3), rotational=False)
    assert run.sample_interval == pytest.approx(0.01)
    assert 2.0e5 < np.median(run.channels["pressure"]) < 4.0e5


def test_rock(tmp_path):
    columns = {"time": "Time", "position": "Displ", "pressure": "Normal_stress"}
    file = measured("rock_velocity_steps/velstep4_BRAVA_expb819_basalt.txt")
    run = assemble(RunEntry(file=file, name="basalt", columns=columns, max_gap=0.1), rotational=False)
    assert 19e6 < np.median(run.channels["pressure"]) < 21e6
    assert 8.5e-3 < run.channels["position"][0] < 8.6e-3
    assert "Friction" in run.covariates


@pytest.mark.parametrize("log", ["2026-01-15_10h28m10", "2026-01-15_10h28m17"])
def test_servo(log):
    units = {"time": "s", "position": "rad", "velocity": "rad/s", "voltage": "V", "temperature": "degC"}
    columns = {"time": "timestamp", "velocity": "speed", "voltage": "input_volts", "temperature": "temp"}
    run = assemble(RunEntry(file=measured(f"bam_xl330/{log}.json"), name=log, columns=columns, units=units), rotational=True)
    assert 0.003 < run.sample_interval < 0.006
    assert "jittered" in run.notes[0]
    assert 7.0 < np.median(run.channels["voltage"]) < 8.0


def test_pendulum():
    units = {"time": "s", "position": "rad", "velocity": "rad/s", "torque": "N m"}
    run = assemble(RunEntry(file=measured("dfki_pendulum/ddp_measured.csv"), name="ddp", units=units), rotational=True)
    assert run.time.size == pytest.approx(3000, abs=2)
    assert run.channels["torque"].std() > 0.1


def test_a_model_with_joints_of_both_kinds_takes_lengths_and_angles(tmp_path):
    t = np.arange(100) * 1e-3
    for unit, si, factor in (("mm", "m", 1e-3), ("deg", "rad", np.pi / 180.0)):
        file = tmp_path / f"{unit}.csv"
        np.savetxt(file, np.column_stack([t, t]), delimiter=",", header=f"time [s],position [{unit}]", comments="")
        run = assemble(RunEntry(file=file, name="run"), rotational=None)
        assert run.units["position"] == si
        np.testing.assert_allclose(run.channels["position"], factor * t)
    np.savetxt(file, np.column_stack([t, t]), delimiter=",", header="time [s],position [kg]", comments="")
    with pytest.raises(InputError, match="kept in m or rad; give m, rad, mm, um, deg"):
        assemble(RunEntry(file=file, name="run"), rotational=None)
    with pytest.raises(InputError, match=r"moves along a line\); give m, mm, um$"):
        assemble(RunEntry(file=file, name="run"), rotational=False)


def turning(folder, mechanism, **columns):
    """Return the run of a rig that turns, from these columns."""
    tables = {
        "schema": "stochfric.scenario/1",
        "mechanism": mechanism,
        "law": {"kind": "coulomb", "mu_s": 0.5, "mu_k": 0.4},
        "simulation": {"duration": 1.0, "output_step": 1.0e-3},
    }
    time = np.arange(len(next(iter(columns.values())))) * 1.0e-3
    return load_dataset(csv(folder / "run.csv", time__s=time, **columns), any_scenario_from_dict(tables)).fit[0]


HINGE = {"kind": "hinge_pendulum", "mass": 1.0, "length": 0.2, "normal_force": 1.0}
TABLE = {"kind": "mjcf", "file": "table.xml", "friction": {"a": 1.0}, "positions": {"a": "angle"}, "drives": {"a": "torque"}}


@pytest.mark.parametrize("low", [0.0, -180.0])
def test_an_angle_that_starts_anew_after_each_turn_is_unwrapped(tmp_path, low):
    angle = 1500.0 * np.sin(np.linspace(0.0, 6.0, 3000)) + np.random.default_rng(1).normal(0.0, 0.05, 3000)
    wrapped, torque = (angle - low) % 360.0 + low, np.sin(angle)
    run = turning(tmp_path, HINGE, position__deg=wrapped, torque__Nm=torque)
    off = run.channels["position"] - np.deg2rad(angle[:2000])  # the rest is held out
    assert np.ptp(off) < 1e-9
    assert any("position jumps by a full turn" in note and "it is unwrapped" in note for note in run.notes)
    of_joint = turning(tmp_path, TABLE, angle__deg=wrapped, torque__Nm=torque)
    assert np.ptp(of_joint.covariates["angle"] - angle[:2000]) < 1e-9


def test_stray_readings_and_angles_of_many_turns_are_no_wrapping(tmp_path):
    angle = 3.0 * np.sin(np.linspace(0.0, 6.0, 3000))
    angle[[700, 1900]] += 4.0
    for position in (angle, 10.0 * angle):
        run = turning(tmp_path, HINGE, position__rad=position, torque__Nm=np.sin(angle))
        assert run.channels["position"] == pytest.approx(position[:2000], abs=1e-12)
        assert not any("turn" in note for note in run.notes)
