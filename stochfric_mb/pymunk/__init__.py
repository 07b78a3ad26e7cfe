"""The pymunk adapter: friction in pymunk's collision callbacks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stochfric_mb.pymunk.attach import ContactFriction, ContactReading, add_friction
    from stochfric_mb.pymunk.joints import JointFriction, add_joint_friction, add_surface_friction
    from stochfric_mb.pymunk.stepping import start

_HOMES = {
    "ContactFriction": "attach",
    "ContactReading": "attach",
    "JointFriction": "joints",
    "add_friction": "attach",
    "add_joint_friction": "joints",
    "add_surface_friction": "joints",
    "start": "stepping",
}

__all__ = [
    "ContactFriction",
    "ContactReading",
    "JointFriction",
    "add_friction",
    "add_joint_friction",
    "add_surface_friction",
    "start",
]


def __getattr__(name: str) -> Any:
    """Load the adapter, and with it pymunk, when it is first used."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import importlib

    return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)
