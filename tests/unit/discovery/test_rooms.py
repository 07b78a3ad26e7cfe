"""The rooms of discovery: small, each with a sentence at its door; and engines imported by name where that is meant alone."""

import ast
from pathlib import Path

import pytest

import stochfric_mb
from stochfric_mb.effects import EFFECTS, effect_class, kind_with_signature, kinds_with
from stochfric_mb.effects.traits import ANONYMOUS
from stochfric_mb.errors import InputError

PACKAGE = Path(stochfric_mb.__file__).parent
ROOMS = sorted(f.parent for f in (PACKAGE / "discovery").rglob("__init__.py"))
ENGINES = {"mujoco", "exudyn", "pymunk"}
BY_NAME = ("discovery/export.py", "discovery/driven_joint/mjcf/", "discovery/driven_joint/simulation/resimulation.py")
"""Where discovery exports to an engine, or reads a user's own MuJoCo model."""
ADAPTERS = ("mujoco/", "exudyn/", "pymunk/", "commands/check.py")


@pytest.mark.parametrize("room", ROOMS, ids=lambda room: room.name)
def test_a_room_holds_a_dozen_files_at_most_and_says_what_for(room):
    files = [f for f in room.glob("*.py") if f.name != "__init__.py"]
    assert len(files) <= 12
    assert ast.get_docstring(ast.parse((room / "__init__.py").read_text(encoding="utf-8")))


def test_no_two_modules_of_discovery_share_a_name():
    names = [f.name for f in (PACKAGE / "discovery").rglob("*.py") if f.name != "__init__.py"]
    assert len(names) == len(set(names))


def imported_by_name(file: Path) -> set[str]:
    """Modules that a file imports by a string, which import rules do not see."""
    calls = (n for n in ast.walk(ast.parse(file.read_text(encoding="utf-8"))) if isinstance(n, ast.Call) and n.args)
    named = (c for c in calls if ast.unparse(c.func).split(".")[-1] in ("import_module", "__import__"))
    return {c.args[0].value for c in named if isinstance(c.args[0], ast.Constant)}


def test_engines_are_imported_by_name_where_that_is_meant_alone():
    lines: list[str] = []
    for file in PACKAGE.rglob("*.py"):
        place = file.relative_to(PACKAGE).as_posix()
        parts = {part for name in imported_by_name(file) for part in name.split(".")}
        if parts & ENGINES and not place.startswith((*BY_NAME, *ADAPTERS)):
            lines.append(place)
    assert lines == []
    assert imported_by_name(PACKAGE / "discovery/export.py") & ENGINES  # the search finds what is there


def test_no_module_of_discovery_names_an_effect():
    """Effects say of themselves what discovery needs to know; else a new effect would be a change of discovery."""
    kinds = set(EFFECTS) - set(kinds_with(ANONYMOUS))  # which is a word of ours, too
    lines: list[str] = []
    for file in (PACKAGE / "discovery").rglob("*.py"):
        words = (n.value for n in ast.walk(ast.parse(file.read_text(encoding="utf-8"))) if isinstance(n, ast.Constant))
        # a docstring may speak of knocks by their name
        lines += [f"{file.name}: {w}" for w in words if isinstance(w, str) and kinds & {w, *w.split(".")}]
    assert lines == []


def test_findings_have_one_effect_each():
    said = [finding for kind in EFFECTS for finding in effect_class(kind).signatures]
    assert sorted(said) == sorted(set(said))
    assert {kind_with_signature(finding) for finding in said} == {kind for kind in EFFECTS if effect_class(kind).signatures}
    with pytest.raises(InputError, match="no effect has the signature 'nothing'"):
        kind_with_signature("nothing")


def test_an_effect_is_told_from_known_ones():
    assert {other for kind in EFFECTS for other in effect_class(kind).separated_by} <= set(EFFECTS)


STRAIGHT = ("stick_slip", "velocity_step", "inference")
"""Rooms in which functions are held to `MOST_BRANCHES`."""
MOST_BRANCHES = 15
BRANCHES = (ast.If, ast.IfExp, ast.For, ast.While, ast.ExceptHandler, ast.Assert, ast.comprehension)


def branches(function: ast.AST) -> int:
    """Cyclomatic complexity by McCabe, comprehensions and operators between conditions included."""
    count = 1
    for node in ast.walk(function):
        count += isinstance(node, BRANCHES)
        count += len(node.values) - 1 if isinstance(node, ast.BoolOp) else 0
        count += len(node.ifs) if isinstance(node, ast.comprehension) else 0
    return count


@pytest.mark.parametrize("room", STRAIGHT)
def test_functions_are_straight(room):
    for file in (PACKAGE / "discovery" / room).rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef):
                inner = sum(branches(n) - 1 for n in ast.walk(node) if isinstance(n, ast.FunctionDef) and n is not node)
                assert branches(node) - inner <= MOST_BRANCHES, f"{file.name}: {node.name}"
