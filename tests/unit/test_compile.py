"""Compiled code is kept on disk, and never used after a source file that it is made of has changed."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import stochfric_mb
from stochfric_mb.compile import compiled
from stochfric_mb.linking import StoredPart

PACKAGE = Path(stochfric_mb.__file__).parent
REPORT = """
import sys
import stochfric_mb.caller, stochfric_mb.apart
answer = stochfric_mb.caller.twice(1.0), stochfric_mb.apart.answer(1.0)
print(*answer, *(sum(f.stats.cache_hits.values()) for f in (stochfric_mb.caller.twice, stochfric_mb.apart.answer)))
"""


@pytest.fixture
def package(tmp_path):
    """A package with this one's compiler: ``caller`` uses ``called`` through ``between``, ``apart`` uses neither."""
    folder = tmp_path / "stochfric_mb"
    folder.mkdir()
    for name in ("compile.py", "linking.py", "sources.py"):
        shutil.copy(PACKAGE / name, folder / name)
    texts = {
        "__init__": "",
        "called": "from stochfric_mb.compile import compiled\n\n@compiled\ndef value(x):\n    return 1.0 * x\n",
        "between": "from stochfric_mb import (\n    called,\n)\n\nvalue = called.value\n",
        "caller": "from stochfric_mb.compile import compiled\nfrom stochfric_mb import between as b\n\n"
        "@compiled\ndef twice(x):\n    return 2.0 * b.value(x)\n",
        "apart": "from stochfric_mb.compile import compiled\n\n@compiled\ndef answer(x):\n    return 42.0 * x\n",
    }
    for name, text in texts.items():
        (folder / f"{name}.py").write_text(text, encoding="utf-8")
    return folder


def _run(package, **environment):
    """Return (twice(1), answer(1), whether twice came from the cache, whether answer did) from a new process."""
    settings = {**os.environ, "PYTHONPATH": str(package.parent), "PYTHONDONTWRITEBYTECODE": "1", **environment}
    settings.pop("NUMBA_CACHE_DIR", None)
    out = subprocess.run(
        [sys.executable, "-c", REPORT], capture_output=True, text=True, check=True, env=settings, cwd=package.parent
    )
    return [float(word) for word in out.stdout.split()]


def _stored(package):
    return sorted(p.name for p in package.rglob("*.nb[ic]"))


def test_editing_a_called_file_renews_the_caller_and_nothing_else(package):
    assert _run(package) == [2.0, 42.0, 0, 0]
    assert _run(package) == [2.0, 42.0, 1, 1]
    called = package / "called.py"
    called.write_text(called.read_text(encoding="utf-8").replace("1.0", "5.0"), encoding="utf-8")
    assert _run(package) == [10.0, 42.0, 0, 1]
    assert _run(package) == [10.0, 42.0, 1, 1]


def test_code_of_older_versions_is_removed(package):
    _run(package)
    before = _stored(package)
    called = package / "called.py"
    called.write_text("\n\n" + called.read_text(encoding="utf-8").replace("1.0", "5.0"), encoding="utf-8")
    _run(package)
    assert len(_stored(package)) == len(before)
    assert [name for name in _stored(package) if name in before] == [name for name in before if name.startswith("apart.")]


def test_a_file_that_is_only_touched_renews_nothing(package):
    _run(package)
    os.utime(package / "called.py", (1.0e9, 1.0e9))
    assert _run(package) == [2.0, 42.0, 1, 1]


def test_read_only_package_uses_the_users_cache_folder(package, tmp_path):
    if os.getuid() == 0:
        (package / "__pycache__").write_text("no folder can be made here, not even by root", encoding="utf-8")
    else:
        package.chmod(0o500)
    settings = {"HOME": str(tmp_path / "home"), "XDG_CACHE_HOME": str(tmp_path / "home" / "cache")}
    (tmp_path / "home").mkdir()
    assert _run(package, **settings) == [2.0, 42.0, 0, 0]
    assert _run(package, **settings) == [2.0, 42.0, 1, 1]
    package.chmod(0o700)
    assert not _stored(package)
    assert list((tmp_path / "home").rglob("*.nbc"))


def test_processes_that_start_together_agree(package):
    settings = {**os.environ, "PYTHONPATH": str(package.parent)}
    settings.pop("NUMBA_CACHE_DIR", None)
    command = [sys.executable, "-c", REPORT]
    options = {"stdout": subprocess.PIPE, "text": True, "env": settings, "cwd": package.parent}
    together = [subprocess.Popen(command, **options) for _ in range(3)]
    assert [process.communicate()[0].split()[:2] for process in together] == [["2.0", "42.0"]] * 3
    assert _run(package)[2:] == [1, 1]


NESTED = """
import sys
import stochfric_mb.left, stochfric_mb.right
made = stochfric_mb.left.whole, stochfric_mb.right.whole
print(*(f(1.0) for f in made), *(sum(f.stats.cache_hits.values()) for f in made))
"""


def test_nested_functions_are_kept_for_each_file_whose_functions_they_hold(package):
    """Two modules fill in one nested function: each has its own stored code, renewed when that module changes."""
    imports = "from stochfric_mb.compile import compiled\n"
    text = (
        "\ndef make(part, file):\n    def whole(x):\n        return 2.0 * part(x)\n\n    return compiled(whole, parts=file)\n"
    )
    (package / "frame.py").write_text(imports + text, encoding="utf-8")
    for name, factor in (("left", 3.0), ("right", 4.0)):
        text = "from stochfric_mb.compile import compiled\nfrom stochfric_mb.frame import make\n\n@compiled\ndef part(x):\n"
        (package / f"{name}.py").write_text(
            f"{text}    return {factor} * x\n\nwhole = make(part, __file__)\n", encoding="utf-8"
        )

    def run():
        settings = {**os.environ, "PYTHONPATH": str(package.parent), "PYTHONDONTWRITEBYTECODE": "1"}
        settings.pop("NUMBA_CACHE_DIR", None)
        command = [sys.executable, "-c", NESTED]
        out = subprocess.run(command, capture_output=True, text=True, check=True, env=settings, cwd=package.parent)
        return [float(word) for word in out.stdout.split()]

    assert run() == [6.0, 8.0, 0, 0]
    assert run() == [6.0, 8.0, 1, 1]
    right = package / "right.py"
    right.write_text(right.read_text(encoding="utf-8").replace("4.0", "5.0"), encoding="utf-8")
    assert run() == [6.0, 10.0, 1, 0]
    assert run() == [6.0, 10.0, 1, 1]


def test_nested_functions_that_hold_numbers_are_told_apart(package):
    text = "from stochfric_mb.compile import compiled\n\ndef make(factor):\n    def times(x):\n        return factor * x\n\n"
    (package / "numbers.py").write_text(text + "    return compiled(times)\n", encoding="utf-8")
    code = "from stochfric_mb.numbers import make; print(make(2.0)(1.0), make(3.0)(1.0))"
    settings = {**os.environ, "PYTHONPATH": str(package.parent)}
    settings.pop("NUMBA_CACHE_DIR", None)
    for _ in range(2):
        command = [sys.executable, "-c", code]
        out = subprocess.run(command, capture_output=True, text=True, check=True, env=settings, cwd=package.parent)
        assert out.stdout.split() == ["2.0", "3.0"]


@pytest.mark.parametrize("kind", ["nbi", "nbc"])
def test_stored_code_that_cannot_be_read_is_made_anew(package, kind):
    _run(package)
    for path in package.rglob(f"*.{kind}"):
        path.write_bytes(path.read_bytes()[:-20])
    assert _run(package) == [2.0, 42.0, 0, 0]
    assert _run(package) == [2.0, 42.0, 1, 1]


def test_what_compiled_code_alone_calls_has_no_machine_code_and_is_stored_without():
    @compiled
    def part(x):
        return 3.0 * x

    @compiled
    def entry(x):
        return part(x) + 1.0

    assert entry(2.0) == 7.0
    (as_part,) = part._called.overloads.values()
    assert as_part.library.get_pointer_to_function(as_part.fndesc.mangled_name) == 0
    payload = as_part._reduce()
    again = StoredPart(part.py_func).rebuild(as_part.target_context, payload)
    assert [f.name for f in again.library.get_defined_functions()] == [f.name for f in as_part.library.get_defined_functions()]


def test_a_part_that_needs_objects_of_python_is_refused():
    @compiled
    def part(x):
        print("x", x)
        return x

    @compiled
    def entry(x):
        return part(x)

    with pytest.raises(TypeError, match="needs objects of Python"):
        entry(1.0)
