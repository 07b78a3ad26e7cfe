"""How a form of the third set enters the list of forms."""

from __future__ import annotations

import itertools
from collections.abc import Callable

from tests.discovery.unseen_forms import forms

_TURNS = itertools.cycle(("paper", "press", "paper", "soft", "small", "paper", "fast", "micro"))
"""Rigs that forms take in turn."""


def form(*truth: str, source: str, rig: str | None = None, **options: object) -> Callable:
    """Enter a function (world, strength) into the list of forms as `third_` and its own name."""

    def entered(apply: Callable) -> Callable:
        apply.__name__ = f"third_{apply.__name__}"
        return forms.form(*truth, source=source, rig=rig or next(_TURNS), series=3, **options)(apply)

    return entered
