"""Every code block of the pages: commands and options that exist, Python that compiles and imports, TOML that parses.

A quick look at each; tests/examples/test_pages_run.py and test_tutorials.py run them all.
"""

import ast
import importlib
import tomllib

import click
import pytest

from stochfric_mb.__main__ import main
from tests.examples.doc_blocks import PAGES, blocks, commands

OPTIONAL = {"mujoco_warp", "warp", "pybullet", "distributed", "torch", "exudyn", "mujoco", "pymunk"}
"""Packages of extras: what is imported from them is not looked up where they are missing."""
SHELL = ("sh", "bash")
ALL = [(page, block) for page in PAGES for block in blocks(page)]


def _of(*languages):
    return [pytest.param(page, block, id=f"{page}:{block.line}") for page, block in ALL if block.language in languages]


@pytest.mark.parametrize(("page", "block"), _of(*SHELL))
def test_commands_are_valid(page, block):
    for words in commands(block):
        command, rest = main, words[1:]
        while isinstance(command, click.Group) and rest:
            name, command, rest = command.resolve_command(click.Context(command), rest)
        if "--help" not in rest:
            command.make_context(name, [w for w in rest if w != "..."])


@pytest.mark.parametrize(("page", "block"), _of("python"))
def test_python_compiles_and_its_imports_exist(page, block):
    tree = ast.parse(block.text)
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("stochfric_mb"):
            try:
                module = importlib.import_module(node.module)
            except ImportError as error:
                if OPTIONAL & set((error.name or "").split(".")) or type(error).__name__ == "MissingEngineError":
                    pytest.skip(f"{error.name} is not installed")
                raise
            for alias in node.names:
                assert hasattr(module, alias.name) or importlib.import_module(f"{node.module}.{alias.name}"), alias.name


@pytest.mark.parametrize(("page", "block"), _of("toml"))
def test_toml_parses(page, block):
    assert tomllib.loads(block.text)


def test_every_language_is_looked_at():
    assert {block.language for _, block in ALL} <= {*SHELL, "python", "toml", "text", "xml", "c", "json"}
