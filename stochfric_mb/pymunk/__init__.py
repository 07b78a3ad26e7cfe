"""The pymunk adapter: friction in pymunk's collision callbacks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stochfric_mb.pymunk.attach import ContactFriction, ContactReading, add_friction
    from stochfric_mb.pymunk.stepping import start

__all__ = ["ContactFriction", "ContactReading", "add_friction", "start"]


def __getattr__(name: str) -> Any:
    """Load the adapter, and with it pymunk, when it is first used."""
    if name in __all__:
        from stochfric_mb.pymunk import attach, stepping

        return getattr(stepping if name == "start" else attach, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
