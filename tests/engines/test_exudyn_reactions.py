"""Reactions as normal forces: friction is that of the reaction of the step itself, whether steps are located or not."""

# ruff: noqa: E402  (the adapter can be imported only where exudyn is)

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

exudyn = pytest.importorskip("exudyn", reason="exudyn is not installed")

from stochfric_mb.exudyn import silent_settings, solve_dynamic
from stochfric_mb.laws import make_law
from tests.engines.exudyn_systems import four_bar

LAW = make_law("elastic_stick", mu_s=0.5, mu_k=0.3)


def run(dt: float, *, locate: bool, **options: float) -> tuple[float, Any]:
    """Return the energy [J] of a four-bar after 1 s, and what its contacts recorded, shape (contacts, times, columns)."""
    system = four_bar(LAW, **options)
    system.mbs.Assemble()
    rows = [contact.record(np.arange(1, 1001) * 1.0e-3) for contact in system.contacts]
    solve_dynamic(system.mbs, silent_settings(dt, 1.0), solver="generalized_alpha", locate=locate)
    return system.energy(), np.array(rows)


@pytest.mark.parametrize("locate", [True, False], ids=["located", "plain"])
@pytest.mark.parametrize(("speed", "radius"), [(10.0, 0.02), (4.0, 0.05)])
def test_friction_in_a_four_bar_stays_within_mu_s_of_the_reaction(speed: float, radius: float, locate: bool) -> None:
    _, rows = run(1.0e-3, locate=locate, speed=speed, radius=radius)
    force, mu_s, normal = np.abs(rows[:, :, 3]), rows[:, :, 4], rows[:, :, 7]
    assert np.ptp(rows[:, :, 6]) == 1.0  # some stick, some slide
    # a step is repeated up to four times; what is left of a reaction's change then is the coupling mu r/length to the fifth
    # power: 2e-4 of it, if 0.18; changes are at most as large as the reaction
    assert np.all(force <= mu_s * normal + 2.0e-4 * mu_s * np.max(normal))


def test_location_makes_a_four_bar_better_not_worse() -> None:
    fine, _ = run(1.0e-4, locate=False, speed=10.0, radius=0.02)
    located, plain = (abs(run(2.0e-3, locate=on, speed=10.0, radius=0.02)[0] - fine) for on in (True, False))
    assert located <= plain + 1.0e-3  # of 14 J
    assert located <= 2.0e-3
