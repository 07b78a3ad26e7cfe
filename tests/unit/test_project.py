"""The project keeps its own promises: README, CI and laziness."""

import re
import subprocess
import sys
from pathlib import Path

import stochfric_mb

ROOT = Path(__file__).parents[2]


def test_ci_runs_exactly_the_readmes_test_command():
    command = re.findall(r"^python3 -m venv .*/pytest .*$", (ROOT / "README.md").read_text(encoding="utf-8"), re.M)
    assert len(command) == 1
    assert command[0] in (ROOT / ".ci" / "run").read_text(encoding="utf-8").splitlines()


def test_first_screen_of_the_readme():
    lines = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
    assert any("pip install" in line for line in lines[:10])
    assert any("add_friction(" in line for line in lines[:15])
    assert any(line.startswith("stochfric compare") for line in lines[:25])
    for target in re.findall(r"\]\((\w[^)]*)\)", "\n".join(lines)):
        assert (ROOT / target).exists(), target


def test_importing_the_package_loads_no_compiler_engine_or_plotting():
    heavy = ("numba", "numpy", "mujoco", "exudyn", "pymunk", "matplotlib")
    code = f"import stochfric_mb, sys; print([m for m in {heavy} if m in sys.modules])"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"


def test_the_public_face_is_listed_once_and_loads():
    lines = [x for x in (ROOT / "stochfric_mb" / "__init__.pyi").read_text(encoding="utf-8").splitlines() if " as " in x]
    names = [line.rpartition(" as ")[2] for line in lines]
    assert len(names) == len(set(names))
    assert set(names) == set(stochfric_mb.__all__)
    assert {"run", "compare", "discover", "Dataset", "load_scenario"} <= set(names)
    for name in names:
        assert getattr(stochfric_mb, name).__name__ == name


def test_naming_a_law_compiles_nothing():
    code = "from stochfric_mb import ElasticStick; f = ElasticStick.functions().force; print(len(f.signatures))"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "0"
