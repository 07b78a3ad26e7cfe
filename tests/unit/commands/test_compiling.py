"""Another process compiles engines beside the first, and only those of which nothing is compiled."""

import subprocess
import sys

import tomli_w

from stochfric_mb import load_scenario
from stochfric_mb.commands import compiling


def test_what_is_compiled_is_left_alone(monkeypatch):
    monkeypatch.setattr(compiling, "is_compiled", lambda _name: True)
    monkeypatch.setattr(compiling.subprocess, "Popen", _never)
    with compiling.compiling_beside(["mujoco", "exudyn"], load_scenario("kang2015_table1")) as wait_for:
        wait_for("mujoco")


def test_one_core_compiles_nothing_beside(monkeypatch):
    monkeypatch.setattr(compiling, "is_compiled", lambda _name: False)
    monkeypatch.setattr(compiling.os, "cpu_count", lambda: 1)
    monkeypatch.setattr(compiling.subprocess, "Popen", _never)
    with compiling.compiling_beside(["mujoco", "pymunk"], load_scenario("kang2015_table1")) as wait_for:
        wait_for("mujoco")


def _never(*_arguments, **_options):
    raise AssertionError("a process was started")


def test_the_first_is_compiled_beside_and_waited_for(monkeypatch):
    """The process is a short Python program here: what counts is which engine it is told, and who waits for it."""
    monkeypatch.setattr(compiling, "is_compiled", lambda name: name == "exudyn")
    monkeypatch.setattr(compiling.os, "cpu_count", lambda: 2)
    started, real = [], subprocess.Popen

    def start(command, **options):
        started.append((command, real([sys.executable, "-c", "import sys; sys.stdin.read()"], **options)))
        return started[-1][1]

    monkeypatch.setattr(compiling.subprocess, "Popen", start)
    with compiling.compiling_beside(["mujoco", "exudyn", "pymunk"], load_scenario("kang2015_table1")) as wait_for:
        (command, process) = started[0]
        assert command[-1:] == ["mujoco"]
        wait_for("mujoco")
        assert process.returncode == 0  # it has ended, so it was waited for


def test_the_other_process_simulates(tmp_path):
    text = tomli_w.dumps(compiling.short(load_scenario("kang2015_table1")).to_dict())
    command = [sys.executable, "-m", "stochfric_mb.commands.compiling", "reference"]
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_a_folder_with_compiled_code_is_seen(tmp_path, monkeypatch):
    monkeypatch.setattr(compiling, "__file__", str(tmp_path / "commands" / "compiling.py"))
    (tmp_path / "exudyn" / "__pycache__").mkdir(parents=True)
    assert not compiling.is_compiled("exudyn")
    (tmp_path / "exudyn" / "__pycache__" / "hooks.call-1.py311.nbi").write_text("")
    assert compiling.is_compiled("exudyn")
    assert compiling.is_compiled("an engine elsewhere")
