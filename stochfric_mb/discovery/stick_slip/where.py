"""Where each effect shows, in words for a reader."""

from __future__ import annotations

from stochfric_mb.discovery.result import Where
from stochfric_mb.effects import effect_class


def where_of(kind: str) -> Where:
    """Return where an effect shows."""
    cls = effect_class(kind)
    return Where(cls.shows_on or kind, cls.shows or f"{kind} explains the disagreement")
