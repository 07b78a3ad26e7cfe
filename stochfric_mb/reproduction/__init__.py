"""Reproduction of a published study: each of its claims put to a test, with numbers, intervals and a verdict by rule."""

from __future__ import annotations

from stochfric_mb.reproduction.claims import FAILS, HOLDS, UNDECIDABLE, Claim, Mend, Number
from stochfric_mb.reproduction.kang2015 import Reproduction, reproduce
from stochfric_mb.reproduction.settings import FULL, QUICK, Settings

__all__ = [
    "FAILS", "FULL", "HOLDS", "QUICK", "UNDECIDABLE", "Claim", "Mend", "Number", "Reproduction", "Settings", "reproduce",
]  # fmt: skip
