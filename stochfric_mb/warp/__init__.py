"""MuJoCo Warp: the same friction in thousands of worlds at once, steering Warp's own constraint solver."""

from __future__ import annotations

from stochfric_mb.errors import MissingEngineError

try:
    import mujoco_warp as _mujoco_warp
except ImportError as error:
    raise MissingEngineError("MuJoCo Warp is not installed; in a clone of this package run: pip install '.[warp]'") from error

from stochfric_mb.warp.attach import add_friction
from stochfric_mb.warp.domain import Domain, Spread
from stochfric_mb.warp.kinds import ContactFriction, JointFriction

__all__ = ["ContactFriction", "Domain", "JointFriction", "Spread", "add_friction"]

_ = _mujoco_warp
