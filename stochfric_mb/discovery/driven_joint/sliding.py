"""Whether joints slide enough for friction to be estimated, and what makes their windows wide where they do not."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Sequence

from stochfric_mb.discovery.driven_joint.balance.balances import Balances
from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.discovery.driven_joint.balance.weak_form import least_width
from stochfric_mb.errors import InputError

FEWEST = 8
"""Fewest windows of sliding in the runs of a role: fewer say nothing about friction."""


def require_sliding(source: Balances) -> None:
    """Return if every place slides in the runs of both roles.

    Raises:
        InputError: one hardly does.
    """
    found = hardly_sliding(source)
    if found is not None:
        name, role, balances = found
        runs = ", ".join(s.run for s in balances)
        where = f"joint {name!r}" if name else "the joint"
        raise InputError(
            f"{where} slides one way in only {_windows(balances)} windows of the runs with role {role!r} ({runs}); at least "
            f"{FEWEST} are needed: record longer or livelier motion, or check units and columns of position and drive"
            f"{_widened(balances, source.dataset.scenario.law.mu_k * source.places[name])}"
        )


def _widened(balances: Sequence[ForceBalance], friction: float) -> str:
    """Return how wide the widest windows are, and whose noise made them so; empty: they are the narrowest.

    Args:
        balances: the balances of a place.
        friction: what is stated of its friction [N or N m].
    """
    widest = max(balances, key=lambda b: b.window.half_width)
    seen = widest.window
    narrow = dataclasses.replace(seen, half_width=least_width(seen.count) * seen.interval)
    if not widest.white or seen.half_width <= narrow.half_width:
        return ""
    noise = {derivative: narrow.gain(derivative) * size for derivative, size in widest.white.items()}
    loudest = max(noise, key=lambda derivative: noise[derivative])
    wide, least = (2.0 * window.half_width for window in (seen, narrow))
    return (
        f". Its windows are up to {wide:.2g} s wide ({least:.2g} s without noise), and it has to slide one way through all of "
        f"one: in narrow ones the noise of the {'position' if loudest else 'drive'} is {noise[loudest]:.3g} {widest.unit}, "
        f"beside {friction:.3g} {widest.unit} of friction; record it with less noise (a controller that chatters is part of "
        "that), or slides that last longer"
    )


def hardly_sliding(source: Balances) -> tuple[str, str, list[ForceBalance]] | None:
    """Return a place that slides in too few windows of the runs of a role, with these; None: there is none."""
    for name, role in itertools.product(source.places, ("fit", "test")):
        balances = source.balances(name, role, source.stated_delay)
        if _windows(balances) < FEWEST:
            return name, role, balances
    return None


def _windows(balances: Sequence[ForceBalance]) -> int:
    return sum(int(s.sliding.sum()) for s in balances)
