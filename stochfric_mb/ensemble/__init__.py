"""Ensembles: response distributions over many realisations of the coefficients."""

from __future__ import annotations

from stochfric_mb.ensemble.planning import Plan, plan
from stochfric_mb.ensemble.result import Block, EnsembleResult
from stochfric_mb.ensemble.runner import run, run_block
from stochfric_mb.ensemble.sketch import Sketch

__all__ = ["Block", "EnsembleResult", "Plan", "Sketch", "plan", "run", "run_block"]
