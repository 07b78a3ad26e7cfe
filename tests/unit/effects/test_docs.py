"""The page on effects shows what the registry holds."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

from stochfric_mb.effects import EFFECTS

DOCS = Path(__file__).parents[3] / "docs"
pytestmark = pytest.mark.skipif(not DOCS.is_dir(), reason="installed without the documentation")


def page_maker() -> ModuleType:
    spec = importlib.util.spec_from_file_location("make_effects_page", DOCS / "make_effects_page.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("kind", sorted(EFFECTS))
def test_each_effect_has_an_example(kind: str) -> None:
    """A course that had to come back to where it began was given a step, and the page could not be written any more."""
    assert page_maker().example(kind).kind == kind


def test_table_of_effects_is_the_registry() -> None:
    module = page_maker()
    page = (DOCS / "effects.md").read_text(encoding="utf-8")
    assert module.filled(page, "effects", module.effects_table()) == page
