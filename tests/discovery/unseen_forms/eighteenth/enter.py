"""How a form of the eighteenth set enters the list of forms."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

from tests.discovery.unseen_forms import forms

from .rigs import RIGS_OF_THE_SET

_TURNS = itertools.cycle(RIGS_OF_THE_SET)
"""Rigs that forms take in turn."""


def form(*truth: str, source: str, rig: str | None = None, **options: Any) -> Callable:
    """Enter a function (world, strength) into the list of forms as `eighteenth_` and its own name."""

    def entered(apply: Callable) -> Callable:
        apply.__name__ = f"eighteenth_{apply.__name__}"
        return forms.form(*truth, source=source, rig=rig or next(_TURNS), series=18, **options)(apply)

    return entered
