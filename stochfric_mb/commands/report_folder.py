"""The folder of a report: its numbers, its page and its plots."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any


def write_report(folder: Path, *, numbers: str, content: Mapping[str, Any], plots: Mapping[str, str], page: str) -> None:
    """Write a report into an existing folder.

    Args:
        folder: where.
        numbers: name of the JSON file.
        content: what it holds.
        plots: name -> SVG, written to ``plots/``.
        page: text of ``report.html``.
    """
    (folder / "plots").mkdir()
    for name, svg in plots.items():
        (folder / "plots" / f"{name}.svg").write_text(svg, encoding="utf-8")
    (folder / numbers).write_text(json.dumps(content, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    (folder / "report.html").write_text(page, encoding="utf-8")
