"""Quiet, verbose, JSON, completion, hints: the command line as a script and a hurried user meet it."""

import errno
import json
import os
import subprocess
import sys

import click
import numpy as np
import pytest
from click.testing import CliRunner

from stochfric_mb.__main__ import COMMANDS, main
from stochfric_mb.commands import progress
from stochfric_mb.commands.list import _LISTS
from stochfric_mb.commands.options import command_line
from stochfric_mb.commands.speech import Speech, spoken
from stochfric_mb.commands.tables import print_table
from stochfric_mb.errors import InputError

RUN = ["run", "kang2015_table1", "--set", "simulation.duration=0.05"]


def invoke(*words):
    return CliRunner().invoke(main, [str(w) for w in words])


@pytest.mark.parametrize(("typed", "meant"), [("comprae", "compare"), ("discovr", "discover"), ("ensembel", "ensemble")])
def test_a_mistyped_command_is_answered_with_the_nearest(typed, meant):
    done = invoke(typed)
    assert done.exit_code == 2
    assert f"unknown command {typed!r}; did you mean {meant!r}? Known: " in done.stderr


@pytest.mark.parametrize(("typed", "meant"), [(("list", "law"), "laws"), (("init", "belt_bx", "--out", "rig"), "belt_box")])
def test_a_mistyped_name_is_answered_with_the_nearest(typed, meant):
    done = invoke(*typed)
    assert done.exit_code == 2
    assert f"{typed[1]!r}; did you mean {meant!r}? Known: " in done.stderr


def test_a_reader_of_stdout_may_stop_early(monkeypatch):
    def closed():
        raise BrokenPipeError(errno.EPIPE, "Broken pipe")

    monkeypatch.setitem(_LISTS, "laws", closed)
    done = invoke("list", "laws")
    assert done.exit_code == 1
    assert not done.stderr


def test_quiet_prints_nothing_but_errors(tmp_path):
    done = invoke(*RUN, "-o", tmp_path / "run.nc", "-q")
    assert (done.exit_code, done.stdout, done.stderr) == (0, "", "")
    again = invoke(*RUN, "-o", tmp_path / "run.nc", "-q")
    assert again.exit_code == 2
    assert "exists" in again.stderr


def test_json_is_all_that_is_on_stdout(tmp_path):
    done = invoke(*RUN, "-o", tmp_path / "run.nc", "--json")
    content = json.loads(done.stdout)
    assert content["out"] == str(tmp_path / "run.nc")
    assert (content["n_samples"], content["engine"], content["period"]) == (51, "reference", None)


def test_no_period_is_told_of_samples_between_which_slips_fall(tmp_path):
    """Cycles of 1.02 s at a sample a second: every sample finds the box stuck or not, and their changes have a period."""
    steps = ("--set", "simulation.duration=200", "--set", "simulation.output_step=1")
    done = invoke("run", "kang2015_table1", "--law", "coulomb", *steps, "-o", tmp_path / "run.csv", "--json")
    content = json.loads(done.stdout)
    assert content["period"] is None
    assert any("slips may fall between samples 1 s apart" in note for note in content["notes"])


def test_how_a_command_speaks_is_no_part_of_the_command_line():
    @click.command()
    @spoken
    @click.option("-o", "--out")
    def made(out):
        click.echo(command_line())

    done = CliRunner().invoke(made, ["-v", "--out", "here"])
    assert done.output.strip() == "stochfric made --out here"


@pytest.mark.parametrize("what", ["laws", "processes", "effects", "engines"])
def test_lists_are_json_too(what):
    assert len(json.loads(invoke("list", what, "--json").stdout)) == 1


def test_verbose_shows_progress_off_a_terminal(tmp_path):
    done = invoke(*RUN, "-o", tmp_path / "run.nc", "--verbose")
    assert "[0 s] loading reference" in done.stderr
    assert "samples over" in done.stdout


def test_two_ways_to_speak_do_not_go_together(tmp_path):
    done = invoke(*RUN, "-o", tmp_path / "run.nc", "-q", "--json")
    assert done.exit_code == 2
    assert "--quiet and --json do not go together" in done.stderr or "--json and --quiet do not go together" in done.stderr


def leaves():
    """Yield each command that does something: those of a group, in the place of the group."""
    for name in COMMANDS:
        command = main.get_command(None, name)
        yield from command.commands.items() if isinstance(command, click.Group) else [(name, command)]


@pytest.mark.parametrize(("name", "command"), list(leaves()))
def test_every_command_has_the_same_short_options(name, command):
    options = {text for p in command.params for text in p.opts}
    assert {"-q", "-v", "--json"} <= options, name
    assert "--out" not in options or "-o" in options


@pytest.mark.parametrize(
    ("words", "keys"),
    [
        (("export", "c", "kang2015_table1", "-o", "c"), {"out", "law", "effects", "notes", "files"}),
        (("translate", "kang2015_table1", "--to", "physx", "-o", "x.toml"),
         {"to", "law", "dialect", "max_error", "rms_error", "break_away_error", "lost", "out"}),
    ],
)  # fmt: skip
def test_exports_and_translations_speak_as_they_are_told(tmp_path, monkeypatch, words, keys):
    monkeypatch.chdir(tmp_path)
    content = json.loads(invoke(*words, "--json").stdout)
    assert set(content) == keys
    assert content["out"] == words[-1]
    quiet = invoke(*words, "-q", "--force")
    assert (quiet.exit_code, quiet.stdout, quiet.stderr) == (0, "", "")
    assert invoke(*words, "--force").stdout.strip()


def test_lines_of_progress_wait_and_are_rare(monkeypatch, capsys):
    now = 0.0
    monkeypatch.setattr(progress.time, "monotonic", lambda: now)
    lines = progress.Lines(progress.PATIENCE)
    lines.note("loading")
    now = 3.0
    lines.note("screening")
    advance = lines.stage("mujoco", 10.0)
    for step in range(100):
        now = 3.0 + 0.25 * step
        advance(0.1 * step)
    said = capsys.readouterr().err.splitlines()
    assert said[:2] == ["[3 s] screening", "[3 s] mujoco"]
    assert said[2:] == [
        "[13 s] mujoco: 4 / 10 s simulated, about 15 s left",
        "[23 s] mujoco: 8 / 10 s simulated, about 5 s left",
    ]


@pytest.mark.parametrize("told_at", [(0.0, 10.0), (10.0, 12.0)])
@pytest.mark.parametrize(("duration", "left"), [(964.0, "40 min"), (1.0e4, "7 h"), (1.0e6, "29 days")])
def test_a_run_that_would_take_days_says_so_after_ten_seconds(monkeypatch, capsys, duration, left, told_at):
    now = 0.0
    monkeypatch.setattr(progress.time, "monotonic", lambda: now)
    advance = progress.Lines(0.0).stage("exudyn", duration)
    for told in told_at:
        now = told
        advance(0.4 * told)
    assert capsys.readouterr().err.splitlines()[-1].endswith(f"simulated, about {left} left")


@pytest.mark.parametrize("shown", [progress.Lines(0.0), progress.Silence()])
@pytest.mark.parametrize(("however_long", "pace"), [(False, 0.4), (True, 0.4), (False, 4.0e3)])
def test_a_run_of_days_stops_unless_it_is_meant(monkeypatch, shown, however_long, pace):
    now = 0.0
    monkeypatch.setattr(progress.time, "monotonic", lambda: now)
    advance = shown.run("exudyn", 1.0e6, however_long=however_long)
    for now in np.arange(50.0, 80.1, 1.0):  # compiling took 50 s, which count for nothing
        advance(pace * (now - 50.0))
    now = 81.0
    if however_long or pace > 1.0:
        advance(pace * 31.0)
        return
    with pytest.raises(
        InputError, match=r"the rest takes about 29 days: shorten simulation.duration, .* or give --however-long"
    ):
        advance(pace * 31.0)


@pytest.mark.parametrize("quiet", [False, True])
def test_what_engines_print_is_not_on_stdout(monkeypatch, capsys, quiet):
    monkeypatch.setattr(progress, "speech", lambda: Speech.QUIET if quiet else Speech.JSON)
    with progress.display():
        print("banner")
    shown = capsys.readouterr()
    assert (shown.out, shown.err) == ("", "" if quiet else "banner\n")


def test_silence_is_silent(capsys):
    progress.Silence().note("anything")
    assert capsys.readouterr().err == ""
    assert Speech("quiet") is Speech.QUIET


@pytest.mark.parametrize(
    ("words", "completed"),
    [
        ("stochfric disc", ["discover"]),
        ("stochfric run kang2015_table2", ["kang2015_table2_13_8", "kang2015_table2_18_7"]),
        ("stochfric run x --engine mu", ["mujoco"]),
        ("stochfric compare x --engines mujoco,ex", ["mujoco,exudyn"]),
        ("stochfric run x --law elastic", ["elastic_stick"]),
    ],
)
def test_the_shell_completes(words, completed):
    place = {"COMP_WORDS": words, "COMP_CWORD": str(len(words.split()) - 1), "_STOCHFRIC_COMPLETE": "bash_complete"}
    code = "from stochfric_mb.__main__ import main; main(prog_name='stochfric')"
    done = subprocess.run([sys.executable, "-c", code], env=os.environ | place, capture_output=True, text=True, check=False)
    offered = [line.partition(",")[2] for line in done.stdout.splitlines() if line.startswith("plain,")]
    assert offered == completed


def test_a_missing_model_is_said_first(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "check.json").write_text("{}")  # which would be an error of its own
    done = invoke("check", "nosuch.xml")
    assert done.exit_code == 2
    assert "nosuch.xml: no such file" in done.stderr


def test_no_formula_is_cut_at_80_columns():
    """A table on a terminal of 80 columns folds what it cannot break."""
    code = "import sys; sys.argv[1:] = ['list', 'effects']; from stochfric_mb.__main__ import main; main()"
    forced = {"COLUMNS": "80", "FORCE_COLOR": "1", "TERM": "xterm"}
    done = subprocess.run([sys.executable, "-c", code], env=os.environ | forced, capture_output=True, text=True, check=True)
    assert "velocity_weakening" in done.stdout
    assert "…" not in done.stdout


def test_numbers_of_a_whole_table_are_not_broken(capsys):
    """Beside the geoms' long names of a fruit fly's model, -0.0048 stood in two lines, and so did heads."""
    head, row = ("site", *7 * ["deceleration"]), ("tarsal_claw_T1_left_collision - floor", *7 * ["-0.0048 %"])
    print_table(head, [row], whole=True)
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert [*head] in lines
    assert " ".join(row).split() in lines
