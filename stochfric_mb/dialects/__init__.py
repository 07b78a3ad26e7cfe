"""Friction as other codes parametrise it: each dialect's equation, fitted to our laws and back, and what is lost."""

from __future__ import annotations

from stochfric_mb.dialects.bam import Bam
from stochfric_mb.dialects.contract import Dialect
from stochfric_mb.dialects.exudyn import ExudynBristle
from stochfric_mb.dialects.modelica import ModelicaTable
from stochfric_mb.dialects.mujoco import MujocoFrictionloss
from stochfric_mb.dialects.physx import Physx
from stochfric_mb.dialects.simscape import Simscape
from stochfric_mb.dialects.thresholds import Adams, Recurdyn

DIALECTS: dict[str, type[Dialect]] = {
    cls.kind: cls for cls in (Adams, Recurdyn, Simscape, ModelicaTable, ExudynBristle, MujocoFrictionloss, Physx, Bam)
}
"""Kind of a dialect -> its class; a new dialect is a new file and one name here."""

__all__ = ["DIALECTS", "Dialect"]
