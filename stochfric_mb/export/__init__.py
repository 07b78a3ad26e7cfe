"""Friction for other codes: C libraries and Functional Mock-up Units made from a friction file or a scenario."""

from __future__ import annotations

from stochfric_mb.export.exported import Exported, load_exported

__all__ = ["Exported", "load_exported"]
