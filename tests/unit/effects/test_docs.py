"""The page on effects shows what the registry holds."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[3] / "docs"


@pytest.mark.skipif(not DOCS.is_dir(), reason="installed without the documentation")
def test_table_of_effects_is_the_registry() -> None:
    spec = importlib.util.spec_from_file_location("make_effects_page", DOCS / "make_effects_page.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    page = (DOCS / "effects.md").read_text(encoding="utf-8")
    assert module.filled(page, "effects", module.effects_table()) == page
