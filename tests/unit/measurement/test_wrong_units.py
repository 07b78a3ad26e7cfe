"""Records that cannot be right are refused with file, column, factor and remedy; those that can are read."""

import dataclasses
import datetime
import math
import re
from pathlib import Path

import numpy as np
import pytest

from stochfric_mb import InputError, load_scenario
from stochfric_mb.measurement import load_dataset
from stochfric_mb.measurement.scales import Shown, inertia, likeliest, load_in_kilograms, slip_time, stuck_speed
from stochfric_mb.reference import simulate

from .files import csv, measured

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def truth():
    return load_scenario("kang2015_table1", overrides=("simulation.duration=20",))


@pytest.fixture(scope="module")
def motion(truth):
    result = simulate(truth, seed=2)
    noise = 2e-6 * np.random.default_rng(1).standard_normal(result.time.size)
    return result.time, result.position + noise


def _load(folder, motion, scenario, *, unit="m", scale=1.0, time_unit="s", time_scale=1.0, **more):
    time, position = motion
    heads = {f"time__{time_unit}": time * time_scale, f"position__{unit}": position * scale}
    return load_dataset(csv(folder / "run.csv", **heads, **more), scenario)


def _stated(truth, **changes):
    return dataclasses.replace(truth, mechanism=dataclasses.replace(truth.mechanism, **changes))


@pytest.mark.parametrize(("unit", "scale"), [("m", 1.0), ("mm", 1e3), ("um", 1e6)])
def test_right_units_are_read(tmp_path, motion, truth, unit, scale):
    assert _load(tmp_path, motion, truth, unit=unit, scale=scale).fit


@pytest.mark.parametrize(
    ("unit", "scale", "really", "factor"),
    [
        ("m", 1e3, "mm", "1000 times"),
        ("um", 1e3, "mm", "1/1000 of"),
        ("mm", 1.0, "m", "1/1000 of"),
        ("m", 1e6, "um", "1e+06 times"),
        ("m", 1 / 0.0254, "in", "39.37 times"),
    ],
)
def test_a_position_in_another_unit_than_its_label(tmp_path, motion, truth, unit, scale, really, factor):
    with pytest.raises(InputError) as caught:
        _load(tmp_path, motion, truth, unit=unit, scale=scale)
    text = str(caught.value)
    assert text.startswith(f"{tmp_path / 'run.csv'}: column position [{unit}] is {factor} what fits")
    assert f"write its header as 'position [{really}]'" in text


def test_a_sensor_s_factor_that_was_forgotten_is_no_unit(tmp_path, motion, truth):
    """It happens to be that of inches to m, and the header says m: what stands there is not the remedy."""
    with pytest.raises(
        InputError, match=r"1/25\.4 of what fits.*factor of a sensor may be missing, such as scale = "
    ) as caught:
        _load(tmp_path, motion, truth, scale=1.0 / 25.4)
    assert "write its header" not in str(caught.value)


def test_a_torsion_rig_by_inertia_and_torsion_stiffness_is_more_than_a_unit(tmp_path, motion, truth):
    """What is left once the best unit is corrected is a factor of 7: no unit, and the page on rigs that turn is named."""
    box = truth.mechanism
    stated = _stated(truth, mass=box.mass / 150.0, stiffness=box.stiffness / 150.0, damping=box.damping / 150.0)
    with pytest.raises(InputError, match=r"still range over 6\.\d+ times mu_s N/k: .*A rig that turns"):
        _load(tmp_path, motion, stated)


def test_an_arc_of_degrees_is_told_from_inches(tmp_path, motion, truth):
    with pytest.raises(
        InputError, match=r"57\.3 times what fits.* probably in deg; what turns .*multiply scale.position by pi / 180"
    ):
        _load(tmp_path, motion, truth, scale=180.0 / math.pi)


def test_a_time_in_another_unit_than_its_label(tmp_path, motion, truth):
    with pytest.raises(InputError, match=r"column time \[s\] is 1000 times what fits.*probably in ms"):
        _load(tmp_path, motion, truth, time_scale=1e3)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("belt_velocity", 2.5, r"mechanism.belt_velocity = 2.5 m/s .* is 1000 times .*in mm/s; write belt_velocity = 0.0025"),
        ("stiffness", 3.956, r"mechanism.stiffness = 3.956 N/m .* is 1/1000 of .*in N/mm; write stiffness = 3956"),
        ("mass", 6080.0, r"mechanism.mass = 6080 kg .* is 1000 times .*in g; write mass = 6.08"),
        ("normal_force", 0.013, r"mechanism.normal_force = 0.013 N .* is 1/1000 of .*in kN; write normal_force = 13"),
    ],
)
def test_a_stated_number_in_another_unit(tmp_path, motion, truth, key, value, message):
    with pytest.raises(InputError, match=message):
        _load(tmp_path, motion, _stated(truth, **{key: value}))


def test_a_number_of_one_run_in_another_unit_is_named_where_it_stands(tmp_path, motion, truth):
    time, position = motion
    csv(tmp_path / "run.csv", time__s=time, position__m=position)
    (tmp_path / "dataset.toml").write_text(
        'schema = "stochfric.dataset/1"\ntitle = "t"\nscenario = "kang2015_table1"\n'
        '[[runs]]\nfile = "run.csv"\nrole = "fit"\nset = { belt_velocity = 2.5 }\n'
        '[[runs]]\nfile = "run.csv"\nrole = "test"\n'
    )
    with pytest.raises(InputError, match=r"^set.belt_velocity of run .* = 2.5 m/s .* write belt_velocity = 0.0025"):
        load_dataset(tmp_path)


@pytest.mark.parametrize(
    ("column", "value", "changes", "message"),
    [
        ("belt_velocity__m/s", 2.5e-3, {"belt_velocity": 2.5}, r"belt_velocity is 0.0025 m/s, but .*mechanism.* = 2.5 m/s"),
        ("normal_force__N", 0.013, {}, r"normal_force is 0.013 N, but .*mechanism.normal_force = 13 N: correct the one"),
    ],
)
def test_a_column_that_contradicts_what_is_stated(tmp_path, motion, truth, column, value, changes, message):
    values = np.full(motion[0].size, value)
    with pytest.raises(InputError, match=message):  # discovery takes the stated number, and would not look at the column
        _load(tmp_path, motion, _stated(truth, **changes), **{column: values})
    name = column.partition("__")[0]
    assert _load(tmp_path, motion, truth, **{column: np.full(values.size, 1.2 * getattr(truth.mechanism, name))}).fit


@pytest.mark.parametrize("factor", [0.7, 1.4])
@pytest.mark.parametrize("key", ["belt_velocity", "stiffness", "mass", "normal_force"])
def test_numbers_that_are_merely_wrong_are_left_to_discovery(tmp_path, motion, truth, key, factor):
    assert _load(tmp_path, motion, _stated(truth, **{key: factor * getattr(truth.mechanism, key)})).fit


def test_a_box_that_rides_on_the_belt_throughout_has_no_wrong_unit(tmp_path, motion, truth):
    time, _ = motion
    assert _load(tmp_path, (time, truth.mechanism.belt_velocity * time), truth).fit


def test_slips_that_a_sensor_cuts_short_are_no_mass_in_grams():
    cut = Shown(speed=0.0, length=0.0, time=math.log10(0.13))  # a thousandth of the mass would make them 4.1
    grams = Shown(speed=0.0, length=0.0, time=math.log10(1.5 / 1000.0**0.5))
    assert likeliest(cut) is None
    assert likeliest(grams).name == "mass"


def test_slips_that_are_shorter_than_the_look_at_them_tell_no_time(motion):
    _, position = motion
    interval = 1e-3
    speed, lag = stuck_speed(position, interval)
    real = slip_time(position, interval, speed, lag)
    assert real > lag * interval
    long = round(4.0 * real / interval)
    assert slip_time(position, interval, speed, long) is None  # clamped to a sample, it was taken for a wrong mass


def test_dead_channels(tmp_path, motion, truth):
    zero = np.zeros(motion[0].size)
    with pytest.raises(
        InputError, match=r"run.csv: velocity is 0 m/s in all 20001 samples: a dead channel.*leave the column out"
    ):
        _load(tmp_path, motion, truth, **{"velocity__m/s": zero})
    with pytest.raises(InputError, match=r"run.csv: position is 0 m in all 20001 samples: a dead channel.*leave the run out"):
        _load(tmp_path, (motion[0], zero), truth)


def test_a_channel_that_freezes_in_a_run_is_noted(tmp_path, motion, truth):
    time, _ = motion
    force = np.where(time < 6.0, np.sin(time), np.sin(6.0))
    run = _load(tmp_path, motion, truth, force__N=force).fit[0]
    assert "from 6 to 20 s (70% of the run)" in str(run.notes), run.notes
    assert not any("stays at" in note for note in _load(tmp_path, motion, truth).fit[0].notes)


def test_a_position_that_freezes_while_the_belt_runs_on(tmp_path, motion, truth):
    time, position = motion
    frozen = np.where(time < 6.0, position, position[6000])
    with pytest.raises(InputError, match=r"position stays at .* from 6 to 20 s, while the belt runs on by 0.035 m.*time_range"):
        _load(tmp_path, (time, frozen), truth)
    clipped = np.minimum(position, np.quantile(position, 0.6))  # four tenths of the samples, but no cycle in a whole
    assert _load(tmp_path, (time, clipped), truth).fit
    coarse = 4.0e-4 * np.round(position / 4.0e-4)  # a sixth of a second of the belt
    assert _load(tmp_path, (time, coarse), truth).fit


def test_a_damping_with_which_nothing_slips_again(tmp_path, motion, truth):
    with pytest.raises(InputError, match=r"mechanism.damping = 768 N s/m is 2.48 times the critical damping .* = 310 N s/m"):
        _load(tmp_path, motion, _stated(truth, damping=768.0))
    assert _load(tmp_path, motion, _stated(truth, damping=300.0)).fit


def test_two_wrong_units_are_a_note(tmp_path, motion, truth):
    """Positions in mm and a stiffness in N/mm: their ratio is right, and no single unit explains the belt's speed."""
    run = _load(tmp_path, motion, _stated(truth, stiffness=3.956), scale=1e3).fit[0]
    assert any("moves at 1.01e+03 times the belt's speed" in n and "two units or numbers may" in n for n in run.notes)
    assert not any("may be wrong" in n for n in _load(tmp_path, motion, truth).fit[0].notes)


def test_a_velocity_that_is_not_the_rate_of_the_position(tmp_path, motion, truth):
    rate = np.gradient(*motion[::-1])
    smooth = np.convolve(rate, np.ones(15) / 15.0, mode="same")
    assert _load(tmp_path, motion, truth, **{"velocity__m/s": smooth}).fit
    with pytest.raises(InputError, match=r"velocity is .* times the rate at which position changes"):
        _load(tmp_path, motion, truth, **{"velocity__m/s": 1e3 * smooth})
    with pytest.raises(InputError, match=r"velocity is 2\.\d+ times the rate at which position changes"):
        _load(tmp_path, motion, truth, **{"velocity__m/s": 2.2 * smooth})
    with pytest.raises(InputError, match=r"velocity is negative where position rises.*sign = { velocity = -1 }"):
        _load(tmp_path, motion, truth, **{"velocity__m/s": -smooth})


def test_columns_that_are_swapped(tmp_path, motion, truth):
    time, position = motion
    rate = np.convolve(np.gradient(position, time), np.ones(15) / 15.0, mode="same")
    with pytest.raises(InputError, match=r"the two are swapped"):
        _load(tmp_path, (time, rate), truth, **{"velocity__m/s": position})


def test_an_empty_file(tmp_path, truth):
    (tmp_path / "run.csv").write_text("\n \n")
    with pytest.raises(InputError, match=r"run.csv: the file is empty"):
        load_dataset(tmp_path / "run.csv", truth)


@pytest.mark.parametrize("zone", ["", "Z", "+02:00"])
def test_dates_are_seconds_since_the_first(tmp_path, motion, truth, zone):
    time, position = (values[:2000] for values in motion)
    start = datetime.datetime(2026, 3, 28, 23, 59, 59)
    dates = [(start + datetime.timedelta(seconds=float(t))).isoformat(timespec="microseconds") + zone for t in time]
    data = load_dataset(csv(tmp_path / "run.csv", time=dates, position__m=position), truth)
    assert data.fit[0].time[0] == 0.0
    assert data.fit[0].sample_interval == pytest.approx(1e-3, rel=1e-6)  # dates are read to a microsecond


@pytest.fixture(scope="module")
def slide():
    """A mass of 4.2 kg, driven along a line by 9 N of friction and 12 N s/m, and the force that it takes [N]."""
    time = np.arange(0.0, 20.0, 1.0 / 487.0)
    waves = [(0.05, 0.23, 1.0), (0.025, 0.61, 2.0), (0.0125, 1.37, 3.0)]
    turns = [(a, 2.0 * np.pi * f, p) for a, f, p in waves]
    position = sum(a * np.sin(w * time + p) for a, w, p in turns)
    velocity = sum(a * w * np.cos(w * time + p) for a, w, p in turns)
    acceleration = sum(-a * w**2 * np.sin(w * time + p) for a, w, p in turns)
    noise = np.random.default_rng(3).standard_normal((2, time.size))
    force = 4.2 * acceleration + 12.0 * velocity + 9.0 * np.sign(velocity) + 0.05 * noise[0]
    return time, position + 2e-6 * noise[1], force


JOINT = """
schema = "stochfric.scenario/1"
[mechanism]
kind = "prismatic_joint"
mass = {mass}
normal_force = 20.0
[law]
kind = "coulomb"
mu_s = 0.5
mu_k = 0.4
[simulation]
duration = 10.0
output_step = 1.0e-3
"""


@pytest.mark.parametrize(
    ("scales", "mass", "remedies"),
    [
        ((1.0, 1.0, 1.0), 4.0, []),
        ((1.0, 1.0, 1.0), 8.0, []),  # a payload, a wrong guess: that is for discovery
        ((1.0, 1e3, 1.0), 4.0, ['position = "mm"', "is in g"]),  # these two look the same
        ((1e3, 1.0, 1.0), 4.0, ['time = "ms"']),
        ((1e6, 1.0, 1.0), 4.0, ['time = "us"']),
        ((1.0, 1.0, 1e-3), 4.0, ['force = "kN"']),
        ((1.0, 1.0, 1.0), 4000.0, ['position = "mm"', "write mass = 4 (kg)"]),
    ],
)
def test_units_at_a_driven_joint_by_force_over_acceleration(tmp_path, slide, scales, mass, remedies):
    time, position, force = (s * values for s, values in zip(scales, slide, strict=True))
    (tmp_path / "scenario.toml").write_text(JOINT.format(mass=mass))
    file = csv(tmp_path / "run.csv", time__s=time, position__m=position, force__N=force)
    if not remedies:
        assert load_dataset(file, tmp_path / "scenario.toml").fit
        return
    with pytest.raises(InputError) as caught:
        load_dataset(file, tmp_path / "scenario.toml")
    text = str(caught.value)
    assert text.startswith(f"{file}: the force is ")
    assert text.count("write ") == len(remedies)
    assert all(remedy in text for remedy in remedies), text


def test_a_drive_in_volts_is_named_with_its_gain(tmp_path, slide):
    time, position, force = slide
    (tmp_path / "scenario.toml").write_text(JOINT.format(mass="4.0\nforce_gain = 20.0"))
    file = csv(tmp_path / "run.csv", time__s=time, position__m=position, voltage__mV=force / 20.0)
    with pytest.raises(InputError, match=r"column voltage \[mV\] with force_gain = 20 in .* is 1/1000 of what fits"):
        load_dataset(file, tmp_path / "scenario.toml")


@pytest.mark.parametrize(
    ("stated", "channel", "what"),
    [
        ("drive_factor = 83.0", {"force__N": 0.83}, r"column force \[N\] with drive_factor = 83 .* is 105[.\d]* times"),
        ("force_gain = 900.0", {"voltage__V": 20.0}, r"column voltage \[V\] with force_gain = 900 .* is 47[.\d]* times"),
    ],
)
def test_a_bare_number_of_the_drive_may_be_off_by_any_factor(tmp_path, slide, stated, channel, what):
    """83 for 83 %: no unit is a hundred times another, and yet mass and friction say which number is wrong."""
    time, position, force = slide
    (tmp_path / "scenario.toml").write_text(JOINT.format(mass=f"4.0\n{stated}"))
    file = csv(tmp_path / "run.csv", time__s=time, position__m=position, **{k: force / v for k, v in channel.items()})
    with pytest.raises(InputError, match=what + " what fits: correct one of them"):
        load_dataset(file, tmp_path / "scenario.toml")


def swung(pace, cam=0.0):
    """An arm of 1.1 kg at 0.4 m in gravity, a bearing with 0.6 N m of friction, and the torque that its motion takes [N m]."""
    time = np.arange(0.0, 20.0, 1.0 / 487.0)
    waves = [(0.9, 0.23, 1.0), (0.5, 0.61, 2.0), (0.25, 1.37, 3.0)]
    turns = [(a, 2.0 * np.pi * f * pace, p) for a, f, p in waves]
    angle = sum(a * np.sin(w * time + p) for a, w, p in turns)
    velocity = sum(a * w * np.cos(w * time + p) for a, w, p in turns)
    acceleration = sum(-a * w**2 * np.sin(w * time + p) for a, w, p in turns)
    noise = np.random.default_rng(5).standard_normal((2, time.size))
    weight = 1.1 * 9.81 * 0.4 * np.sin(angle) + cam * np.abs(np.sin(3.0 * angle))
    torque = 1.1 * 0.4**2 * acceleration + 0.3 * velocity + 0.6 * np.sign(velocity) + weight + 0.01 * noise[0]
    return time, angle + 2e-5 * noise[1], torque


@pytest.fixture(scope="module")
def swing():
    return swung(1.0)


PACE, CAM = 0.4, 3.0
"""Speed of a slower motion [-] and torque of a cam [N m]."""
HINGE = """
schema = "stochfric.scenario/1"
[mechanism]
kind = "hinge_pendulum"
mass = {mass}
length = {length}
normal_force = 2.0
[law]
kind = "coulomb"
mu_s = 0.4
mu_k = 0.3
[simulation]
duration = 10.0
output_step = 1.0e-3
"""


@pytest.mark.parametrize(
    ("scales", "mass", "length", "remedies"),
    [
        ((1.0, 1.0, 1.0), 1.0, 0.4, []),
        ((1.0, 1.0, 1.0), 2.0, 0.4, []),  # a payload: that is for discovery
        ((1.0, 180.0 / np.pi, 1.0), 1.0, 0.4, ['position = "deg"']),
        ((1e3, 1.0, 1.0), 1.0, 0.4, ['time = "ms"']),
        ((1.0, 1.0, 1e3), 1.0, 0.4, ['torque = "mN m"']),
        ((1.0, 1.0, 1e2), 1.0, 0.4, ['torque = "N cm"']),
        ((1.0, 1.0, 1.0), 1000.0, 0.4, ["write mass = 1 (kg)"]),
        ((1.0, 1.0, 1.0), 1.0, 400.0, ["write length = 0.4 (m)"]),
    ],
)
def test_units_at_a_hinge_by_torque_over_acceleration_and_weight(tmp_path, swing, scales, mass, length, remedies):
    time, angle, torque = (s * values for s, values in zip(scales, swing, strict=True))
    (tmp_path / "scenario.toml").write_text(HINGE.format(mass=mass, length=length))
    file = csv(tmp_path / "run.csv", time__s=time, position__rad=angle, **{"torque__N m": torque})
    if not remedies:
        assert load_dataset(file, tmp_path / "scenario.toml").fit
        return
    with pytest.raises(InputError) as caught:
        load_dataset(file, tmp_path / "scenario.toml")
    text = str(caught.value)
    assert text.startswith(f"{file}: the torque ")
    assert all(remedy in text for remedy in remedies), text
    assert text.count("write ") == len(remedies), text


@pytest.mark.parametrize(
    ("factor", "wrong"),
    [(1e3, "in g m^2"), (1e4, "in kg cm^2"), (1e7, "in g cm^2"), (1e-4, "1/1e+04 of what fits")],  # the last: converted twice
)
def test_an_inertia_about_its_own_axis_is_told_in_its_units(tmp_path, factor, wrong):
    """Most of the inertia is a rotor's: neither mass nor length of its arm is in question."""
    time = np.arange(0.0, 8.0, 1e-3)
    angle, rate = 1.2 * np.sin(3.0 * time), 3.6 * np.cos(3.0 * time)
    noise = 0.01 * np.random.default_rng(3).standard_normal(time.size)
    torque = -0.12 * 9.0 * angle + 0.3 * np.sign(rate) + 1.0e-4 * 9.81 * 0.02 * np.sin(angle) + noise
    text = HINGE.format(mass=1.0e-4, length=0.02).replace(
        "normal_force = 2.0", f"normal_force = 1.0\ninertia = {0.12 * factor}"
    )
    (tmp_path / "scenario.toml").write_text(text)
    file = csv(tmp_path / "run.csv", time__s=time, position__rad=angle, **{"torque__N m": torque})
    with pytest.raises(InputError, match=rf"Probably inertia in .* is {re.escape(wrong)}: write inertia = 0.12 \(kg m\^2\)"):
        load_dataset(file, tmp_path / "scenario.toml")


@pytest.mark.parametrize("degrees", [False, True])
def test_degrees_are_told_beside_what_the_model_lacks(tmp_path, degrees):
    """A cam leaves the inertia unsure by a tenth: degrees explain the torque, radians do not."""
    time, angle, torque = swung(PACE, CAM)
    (tmp_path / "scenario.toml").write_text(HINGE.format(mass=1.0, length=0.4))
    columns = {"position__rad": np.degrees(angle) if degrees else angle, "torque__N m": torque}
    file = csv(tmp_path / "run.csv", time__s=time, **columns)
    if not degrees:
        data = load_dataset(file, tmp_path / "scenario.toml")
        assert inertia(data.fit[0], data.scenario.mechanism) is None
        return
    with pytest.raises(InputError, match=r'column position \[rad\] is in deg: write units = \{ position = "deg" \}'):
        load_dataset(file, tmp_path / "scenario.toml")


@pytest.mark.parametrize(
    ("name", "file"),
    [("emps", "emps/DATA_EMPS.mat"), ("seal_napn", "pneuseal/NAPN_1bar.csv"), ("seal_o_ring", "pneuseal/O-ring_1bar.csv")],
)
def test_measured_joints_are_read(monkeypatch, name, file):
    """A servo axis, and two seals that move too slowly to show a mass."""
    monkeypatch.setenv("STOCHFRIC_DATA", str(measured(file).parents[1]))
    assert load_dataset(ROOT / "models" / name).fit


def test_the_speed_of_stick_is_not_that_at_which_a_coarse_sensor_counts():
    """At 5 mm/s and 500 Hz a sensor of 50 um counts every fifth sample: over 8 samples, one count is 3.1 mm/s."""
    time = np.arange(15000) * 2e-3
    position = 5e-3 * (time % 0.6)  # 3 mm of stick, and back at once
    speed, lag = stuck_speed(50e-6 * np.round(position / 50e-6), 2e-3)
    assert speed == pytest.approx(5e-3, rel=0.05)
    assert stuck_speed(position, 2e-3)[1] < lag


@pytest.mark.parametrize(
    ("shown", "stated", "said"),
    [
        ((1.78, 1.37), (0.18, 0.14), True),
        ((0.0185, 0.0185), (0.18, 0.14), False),
        ((0.9, 0.7), (0.18, 0.14), False),  # five times
        ((2.25, 1.75), (0.18, 0.14), False),
        ((1.78, 0.9), (0.18, 0.14), False),  # a wrong load moves both alike
        ((0.0981, 0.0981), (0.01, 0.01), False),  # that was stated for something else
    ],
)
def test_a_load_in_kilograms_is_told_by_both_coefficients(shown, stated, said):
    assert (
        "normal_force = 306 N is probably a mass in kg; write normal_force = 3002" in load_in_kilograms(shown, stated, 306.0)
    ) == said
