"""Friction in Exudyn: `add_friction` for any system, and the belt-box.

Importing this package imports Exudyn only when one of its names is used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stochfric_mb.exudyn.attach import add_friction
    from stochfric_mb.exudyn.bristle import add_bristle
    from stochfric_mb.exudyn.contact import FrictionContact, JumpWarning
    from stochfric_mb.exudyn.joint import add_joint_friction
    from stochfric_mb.exudyn.load import add_friction_load
    from stochfric_mb.exudyn.solve import silent_settings, solve_dynamic

_HOMES = {
    "FrictionContact": "contact",
    "JumpWarning": "contact",
    "add_bristle": "bristle",
    "add_friction": "attach",
    "add_friction_load": "load",
    "add_joint_friction": "joint",
    "silent_settings": "solve",
    "solve_dynamic": "solve",
}

__all__ = [
    "FrictionContact",
    "JumpWarning",
    "add_bristle",
    "add_friction",
    "add_friction_load",
    "add_joint_friction",
    "silent_settings",
    "solve_dynamic",
]


def __getattr__(name: str) -> Any:
    """Return a public name, loading the module that defines it."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import importlib

    return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)
