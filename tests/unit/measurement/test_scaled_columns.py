"""Columns that a factor makes the quantity that is asked for: torques of pulleys, counts, ticks."""

import numpy as np
import pytest

from stochfric_mb import load_dataset
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.assemble import RunEntry, assemble

N = 200
SCENARIO = """
schema = "stochfric.scenario/1"
[mechanism]
kind = "prismatic_joint"
mass = 2.0
normal_force = 20.0
[law]
kind = "coulomb"
mu_s = 0.3
mu_k = 0.2
[simulation]
duration = 1.0
output_step = 1e-3
"""


def write(folder):
    ticks = np.arange(N)
    rows = [f"{5 * i},{400 + i},{0.5 * np.sin(i / 20.0):.6f}" for i in ticks]
    (folder / "log.csv").write_text("\n".join(["clock,counts,torque [N m]", *rows]) + "\n")
    return folder / "log.csv"


def entry(file, **keys):
    columns = {"time": "clock", "position": "counts", "force": "torque"}
    return RunEntry(file=file, name="log", columns=columns, **keys)


def test_a_torque_over_a_radius_is_a_force_counts_are_lengths_and_ticks_are_times(tmp_path):
    run = assemble(
        entry(
            write(tmp_path),
            units={"time": "ms", "position": "um", "force": "N"},
            scale={"time": 0.2, "position": 5.0, "force": 25.0},
            sign={"force": -1.0},
        ),
        rotational=False,
    )
    np.testing.assert_allclose(run.time[:3], [0.0, 1e-3, 2e-3])
    np.testing.assert_allclose(run.channels["position"][:2], [2000e-6, 2005e-6])
    np.testing.assert_allclose(run.channels["force"], -12.5 * np.sin(np.arange(N) / 20.0), atol=2e-5)
    assert not any("taken to be in" in note for note in run.notes)  # what is scaled may be in another unit


@pytest.mark.parametrize(
    ("scale", "message"),
    [
        ("{ force = 0.0 }", r"runs 1: scale.force = 0.0; a column times 0 shows nothing"),
        ('{ force = "1/r" }', r"runs 1: scale.force = '1/r'"),
        ("{ load = 2.0 }", r"log.csv: .*'load'"),
    ],
)
def test_what_is_no_factor_is_refused_by_its_key(tmp_path, scale, message):
    write(tmp_path)
    (tmp_path / "rig.toml").write_text(SCENARIO)
    (tmp_path / "dataset.toml").write_text(f"""
schema = "stochfric.dataset/1"
title = "rig"
scenario = "rig.toml"
[[runs]]
file = "log.csv"
role = "fit"
columns = {{ time = "clock", position = "counts", force = "torque" }}
units = {{ time = "ms", position = "um", force = "N" }}
scale = {scale}
""")
    with pytest.raises(InputError, match=message):
        load_dataset(tmp_path)


@pytest.mark.parametrize("unit", ["deg", "rad"])
def test_the_angle_of_a_rig_that_turns_is_read_as_an_arc_as_the_error_says(tmp_path, unit):
    file = tmp_path / "log.csv"
    file.write_text("\n".join([f"time [s],position [{unit}]", *(f"{1e-3 * i:.3f},{0.5 * i}" for i in range(N))]) + "\n")
    with pytest.raises(InputError, match=r"radius of the contact: of 40 mm, scale = \{ position = 0.04 \}") as caught:
        assemble(RunEntry(file=file, name="log"), rotational=False)
    assert 'units = { position = "m" }' in str(caught.value)
    in_rad = {"deg": np.pi / 180.0, "rad": 1.0}[unit]
    run = assemble(
        RunEntry(file=file, name="log", units={"position": "m"}, scale={"position": 0.04 * in_rad}), rotational=False
    )
    np.testing.assert_allclose(run.channels["position"][:3], 0.04 * in_rad * np.array([0.0, 0.5, 1.0]))


def test_a_current_is_refused_with_the_constant_that_makes_it_a_torque(tmp_path):
    file = tmp_path / "log.csv"
    file.write_text("\n".join(["time [s],torque [mA]", *(f"{1e-3 * i:.3f},{0.5 * i}" for i in range(N))]) + "\n")
    with pytest.raises(InputError, match=r"of 0.1 N m/A, scale = \{ torque = 0.0001 \} and units = \{ torque = \"N m\" \}"):
        assemble(RunEntry(file=file, name="log"), rotational=True)
