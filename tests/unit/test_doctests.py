"""The examples in docstrings run, and give what they say."""

import doctest
import importlib
from pathlib import Path

import pytest

import stochfric_mb

ROOT = Path(stochfric_mb.__file__).parent
FILES = [p for p in sorted(ROOT.rglob("*.py")) if ">>> " in p.read_text(encoding="utf-8")]
MODULES = [".".join([ROOT.name, *p.relative_to(ROOT).with_suffix("").parts]).removesuffix(".__init__") for p in FILES]


@pytest.mark.parametrize("name", MODULES)
def test_examples_in_docstrings_run(name: str) -> None:
    tried = doctest.testmod(importlib.import_module(name))
    assert tried.attempted > 0
    assert tried.failed == 0, f"{tried.failed} examples of {name} failed: see the captured output"
