"""A dry run reads, checks and draws, and infers nothing; its picture shows every slip."""

import dataclasses
import json
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from stochfric_mb import load_scenario
from stochfric_mb.__main__ import main
from stochfric_mb.commands.dry_run import only_records
from stochfric_mb.measurement.scales import slip_spans
from stochfric_mb.reference import simulate
from stochfric_mb.report.record_picture import COLUMNS, _thinned, record


@pytest.fixture(scope="module")
def motion():
    return simulate(load_scenario("kang2015_table1", overrides=("simulation.duration=30",)), seed=3)


def _write(path, motion, step=1):
    table = np.column_stack([motion.time, motion.position])[::step]
    np.savetxt(path, table, "%.9g", ",", header="time [s],position [m]", comments="")
    return str(path)


def invoke(*words):
    return CliRunner().invoke(main, [str(w) for w in words])


def test_what_may_stand_at_out_is_as_docs_commands_md_says(tmp_path, motion):
    file = _write(tmp_path / "run.csv", motion)
    asked = ("discover", file, "--scenario", "kang2015_table1", "--dry-run", "--out", tmp_path / "raw")
    assert invoke(*asked).exit_code == 0
    assert only_records(str(tmp_path / "raw"))  # what a discovery replaces by itself
    assert "--force to replace it" in " ".join(invoke(*asked).output.split())
    assert invoke(*asked, "--force").exit_code == 0
    (tmp_path / "raw" / "records.html").rename(tmp_path / "raw" / "result.json")
    assert "is a folder without records.html" in " ".join(invoke(*asked, "--force").output.split())


def test_records_are_drawn_and_the_plan_is_told(tmp_path, motion):
    file = _write(tmp_path / "run.csv", motion)
    done = invoke("discover", file, "--scenario", "kang2015_table1", "--dry-run", "--out", tmp_path / "raw")
    assert done.exit_code == 0, done.output
    assert "Would search" in done.output
    assert "Expected time" in done.output
    assert "every other number of the scenario is taken as exact" in done.output
    page = (tmp_path / "raw" / "records.html").read_text()
    assert page.count("<svg ") == 2
    assert not re.findall(r'(?:src|href)="(?!data:|#)|url\((?!#)|@import|<script ', page)


def test_its_json_counts_the_slips(tmp_path, motion):
    file = _write(tmp_path / "run.csv", motion)
    done = invoke("discover", file, "--scenario", "kang2015_table1", "--dry-run", "--json", "--out", tmp_path / "raw")
    runs = json.loads(done.stdout)["runs"]
    assert [run["role"] for run in runs] == ["fit", "test"]
    assert all(run["slips"] > 5 for run in runs)


def test_records_that_are_refused_are_drawn_all_the_same(tmp_path, motion):
    file = _write(tmp_path / "run.csv", motion, step=40)  # 25 Hz: too few samples in a slip
    done = invoke("discover", file, "--scenario", "kang2015_table1", "--dry-run", "--out", tmp_path / "raw")
    assert done.exit_code == 2
    assert "samples a second" in done.stderr
    assert "samples a second" in (tmp_path / "raw" / "records.html").read_text()


@pytest.mark.parametrize("words", [("--dry-run",), ()])
def test_records_in_a_wrong_unit_are_drawn_all_the_same(tmp_path, motion, words):
    file = _write(tmp_path / "run.csv", dataclasses.replace(motion, position=1e3 * motion.position))
    done = invoke("discover", file, "--scenario", "kang2015_table1", *words, "--out", tmp_path / "raw")
    assert done.exit_code == 2
    assert "It is probably in mm" in " ".join(done.stderr.split())
    assert (tmp_path / "raw" / "records.html").read_text().count("<svg ") == 2


def test_a_discovery_that_refuses_records_draws_them(tmp_path, motion):
    file = _write(tmp_path / "run.csv", motion, step=40)
    for _ in range(2):  # drawn records are no result: the next try replaces them
        done = invoke("discover", file, "--scenario", "kang2015_table1", "--out", tmp_path / "out")
        assert done.exit_code == 2
        assert f"(the raw records are drawn in {tmp_path / 'out' / 'records.html'})" in " ".join(done.stderr.split())
        assert [p.name for p in (tmp_path / "out").iterdir()] == ["records.html"]
    page = (tmp_path / "out" / "records.html").read_text()
    assert "samples a second" in page
    assert page.count("<svg ") == 2


@pytest.mark.parametrize("noise", [0.0, 2e-6])
def test_slips_are_where_the_box_turns_back(motion, noise):
    """A slip is a stretch of backward motion of the simulated box, not of ringing after it."""
    measured = motion.position + noise * np.random.default_rng(0).standard_normal(motion.time.size)
    result = slip_spans(measured, 1e-3)
    back = motion.velocity < -1e-3  # of the order of the belt's speed, well above ringing
    edges = np.flatnonzero(np.diff(np.concatenate(([0], back.astype(int), [0]))))
    true = [(i, j) for i, j in zip(edges[::2], edges[1::2], strict=True) if j - i > 20]
    assert len(result) == len(true)
    for (first, last), (i, j) in zip(result, true, strict=True):
        assert abs(first - i) <= 40  # the lag over which slopes are taken under noise [samples]
        assert abs(last - j) <= 40


def test_no_slips_are_seen_in_a_sine():
    time = np.arange(5000) * 1e-3
    assert slip_spans(np.sin(10.0 * time), 1e-3) == []


def test_a_thinned_curve_keeps_every_peak():
    values = np.zeros(100_000)
    values[[777, 50_001, 99_999]] = (3.0, -2.0, 5.0)
    _, thin = _thinned(np.arange(100_000.0), values)
    assert thin.size == 2 * COLUMNS
    assert {3.0, -2.0, 5.0} <= set(thin)


def test_of_many_slips_some_are_drawn_closely(motion):
    slips = slip_spans(motion.position, 1e-3)
    many = [(i, i + 4) for i in range(10, 29_000, 300)]
    assert record(motion.time, motion.position, "position", slips).count('class="axes"') == 1
    assert record(motion.time, motion.position, "position", many).count('class="axes"') == 2


def test_names_from_a_file_are_escaped():
    svg = record(np.arange(10.0), np.arange(10.0), "<script>")
    assert "<script>" not in svg
    assert re.search("&lt;script&gt;", svg)


JOINT = """
schema = "stochfric.scenario/1"
[mechanism]
kind = "{kind}"
{numbers}
[law]
kind = "coulomb"
mu_s = 0.03
mu_k = 0.02
[simulation]
duration = 20.0
output_step = 1.0e-3
"""


JOINTS = [
    (
        "prismatic_joint",
        "mass = 95.0\nnormal_force = 932.0",
        "kinds of effects in 1 run and score on 1, prismatic_joint",
        "force [N]",
        "has no force (it has position)",
    ),
    (
        "spring_slider",
        "stiffness = 2000.0",
        "Would search friction with memory",
        "friction_coefficient [-]",
        "neither friction_coefficient",
    ),
]


def look_at_joint(tmp_path, kind, numbers, *more):
    """A dry run of a joint whose record has positions, and further columns of what moves with them."""
    (tmp_path / "rig.toml").write_text(JOINT.format(kind=kind, numbers=numbers))
    time = np.arange(20000) * 1e-3
    columns = np.column_stack([time, np.sin(time), *(0.6 + np.cos(time) * 20.0 * ("force" in name) for name in more)])
    head = ",".join(("time [s]", "position [m]", *more))
    np.savetxt(tmp_path / "run.csv", columns, header=head, comments="", delimiter=",")
    return invoke("discover", tmp_path / "run.csv", "--scenario", tmp_path / "rig.toml", "--dry-run", "--out", tmp_path / "raw")


@pytest.mark.parametrize(("kind", "numbers", "searched", "column", "lacks"), JOINTS)
def test_what_a_joint_lacks_is_said_before_anything_is_computed(tmp_path, kind, numbers, searched, column, lacks):
    done = look_at_joint(tmp_path, kind, numbers)
    assert done.exit_code == 2
    assert lacks in " ".join(done.stderr.split())
    assert searched not in done.output  # what is refused is not searched
    assert (tmp_path / "raw" / "records.html").exists()


@pytest.mark.parametrize(("kind", "numbers", "searched", "column", "lacks"), JOINTS)
def test_what_would_be_done_at_a_joint_is_said(tmp_path, kind, numbers, searched, column, lacks):
    done = look_at_joint(tmp_path, kind, numbers, column)
    assert done.exit_code == 0, done.output
    assert searched in done.output
    assert "Expected time: 5 to 45 s of one processor" in done.output


def test_too_few_slips_are_said(tmp_path, motion):
    short = dataclasses.replace(motion, time=motion.time[:9000], position=motion.position[:9000])
    file = _write(tmp_path / "run.csv", short)
    done = invoke("discover", file, "--scenario", "kang2015_table1", "--dry-run", "--out", tmp_path / "raw")
    assert "too few slips to judge friction by in run (first two thirds), run (last third): each run needs 12" in " ".join(
        done.output.split()
    )


@pytest.mark.parametrize(
    ("sign", "zero", "words"), [(-1.0, 0.0, "sign = { position = -1 }"), (1.0, 0.05, "spring is unstressed")]
)
def test_a_position_that_discovery_refuses_is_refused(tmp_path, motion, sign, zero, words):
    file = _write(tmp_path / "run.csv", dataclasses.replace(motion, position=sign * motion.position + zero))
    done = invoke("discover", file, "--scenario", "kang2015_table1", "--dry-run", "--out", tmp_path / "raw")
    assert done.exit_code == 2
    assert words in " ".join(done.stderr.split())


def test_a_belt_off_its_stated_speed_is_said(tmp_path, motion):
    (tmp_path / "rig.toml").write_text(
        (Path(__file__).parents[3] / "models" / "belt_box" / "kang2015_table1.toml").read_text().replace("2.5e-3", "2.0e-3")
    )
    file = _write(tmp_path / "run.csv", motion)
    done = invoke("discover", file, "--scenario", tmp_path / "rig.toml", "--dry-run", "--out", tmp_path / "raw")
    assert done.exit_code == 0
    assert "but belt_velocity = 0.002 m/s is stated: no effect would be named" in " ".join(done.output.split())


@pytest.mark.parametrize(("factor", "words"), [(-1.0, "give sign = { force = -1 }"), (0.0, "force is 0 in all samples")])
def test_a_drive_that_is_dead_or_turned_round_is_refused(tmp_path, factor, words):
    numbers = "mass = 4.2\nnormal_force = 300.0\ndamping = 60.0"
    (tmp_path / "rig.toml").write_text(JOINT.format(kind="prismatic_joint", numbers=numbers))
    time = np.arange(12000) / 500.0
    waves = [(0.05, 1.4, 1.0), (0.025, 3.8, 2.0), (0.0125, 8.6, 3.0)]
    position = sum(a * np.sin(w * time + p) for a, w, p in waves)
    velocity = sum(a * w * np.cos(w * time + p) for a, w, p in waves)
    acceleration = sum(-a * w**2 * np.sin(w * time + p) for a, w, p in waves)
    force = factor * (4.2 * acceleration + 60.0 * velocity + 9.0 * np.sign(velocity))
    columns = np.column_stack([time, position, force])
    np.savetxt(tmp_path / "run.csv", columns, header="time [s],position [m],force [N]", comments="", delimiter=",")
    done = invoke("discover", tmp_path / "run.csv", "--scenario", tmp_path / "rig.toml", "--dry-run", "--out", tmp_path / "raw")
    assert done.exit_code == 2
    assert words in " ".join(done.stderr.split())


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("", "No [uncertainty] is stated: every number of the scenario is taken as exact"),
        ("[uncertainty]\nmass = 0.0\n", "No [uncertainty] is stated: every number of the scenario is taken as exact"),
        ("[uncertainty]\nmass = 0.5\noffset = 0.5\n", "Stated: mass ± 50 %, offset ± 0.5 N; every other number"),
    ],
)
def test_how_sure_the_scenario_is_of_its_numbers_is_said(tmp_path, table, said):
    kind, numbers, _, column, _ = JOINTS[0]
    assert said in look_at_joint(tmp_path, kind, f"{numbers}\n{table}", column).output


MODEL = """<mujoco><worldbody><body>
<joint name="{name}" type="{type}" axis="0 0 1"/><geom type="box" size="0.1 0.1 0.1" mass="5"/>
</body></worldbody></mujoco>
"""


@pytest.mark.parametrize(
    ("name", "kind", "unit", "of", "drive"), [("lid", "hinge", "deg", "N m", "torque"), ("rod", "slide", "mm", "N", "force")]
)
def test_columns_that_joints_of_a_model_are_read_from_are_listed(tmp_path, name, kind, unit, of, drive):
    pytest.importorskip("mujoco", reason="the model is one of MuJoCo's")
    (tmp_path / "model.xml").write_text(MODEL.format(name=name, type=kind))
    reads = f'positions = {{ {name} = "where" }}\ndrives = {{ {name} = "{drive}" }}'
    numbers = f'file = "model.xml"\nfriction = {{ {name} = 4.0 }}\n{reads}'
    (tmp_path / "rig.toml").write_text(JOINT.format(kind="mjcf", numbers=f"{numbers}\n[uncertainty]\noffset = 0.3\n"))
    time = np.arange(9000) * 1e-3
    columns = np.column_stack([time, 20.0 * np.sin(time), np.cos(time)])
    head = f"time [s],where [{unit}],{drive} [{of}]"
    np.savetxt(tmp_path / "run.csv", columns, header=head, comments="", delimiter=",")
    done = invoke("discover", tmp_path / "run.csv", "--scenario", tmp_path / "rig.toml", "--dry-run", "--out", tmp_path / "raw")
    said = " ".join(done.output.split())
    assert f"{drive} [{of}], where [{unit}]" in said
    assert f"offset ± 0.3 {of};" in said
