"""What effects that drift leave in the slips: the same coefficients in all runs, and distance apart from time."""

from types import SimpleNamespace

import numpy as np
import pytest

from stochfric_mb.effects.kinds.distance_drift import DistanceDrift
from stochfric_mb.effects.kinds.friction_drift import FrictionDrift


def slips_of(pace, load, static):
    """Two runs of eight slips; ``pace``: distance slid in a second [m/s], ``load``, ``static``: forces of each run [N]."""
    run = np.repeat([0, 1], 8)
    time = np.tile(np.arange(8.0), 2)
    before = np.array(pace)[run] * time
    return SimpleNamespace(
        run=run,
        n_runs=2,
        duration=8.0,
        onset_time=time,
        mean_time=time + 0.1,
        node_time=time[:, None] + np.array([0.05, 0.15]),
        slid_before=before,
        slip_distance=np.full((16, 2), 0.01),
        normal_force=np.array(load)[run],
        static=np.array(static)[run],
        kinetic=0.7 * np.array(static)[run],
        column=lambda held, inside: (
            np.column_stack([np.zeros(16) if held is None else held, *np.atleast_2d(np.transpose(inside))])
            if inside is not None
            else np.column_stack([held, np.zeros(16)])
        ),
    )


def test_a_drift_that_is_over_at_once_stands_for_no_difference_between_runs():
    """Friction of the second run is 1.5 times what its load says: a law of the load, which no drift may take."""
    slips = slips_of((1.0, 1.0), (10.0, 20.0), (6.0, 18.0))
    quickest = [h for h in FrictionDrift.hypotheses(slips) if h.variant == ""][1]
    late = np.tile(np.arange(8) >= 3, 2)  # 3 s are twelve times its 0.24 s
    over_load = quickest.columns[0][late, 0] / slips.normal_force[late]
    np.testing.assert_allclose(over_load, over_load[0], rtol=1e-4)


@pytest.mark.parametrize(("pace", "looked_for"), [((1.0, 1.05), False), ((1.0, 2.0), True)])
def test_distance_is_told_from_time_where_runs_slide_at_other_paces(pace, looked_for):
    slips = slips_of(pace, (10.0, 10.0), (6.0, 6.0))
    ways = DistanceDrift.hypotheses(slips)
    assert bool(ways) == looked_for
    if looked_for:  # linear in the distance: at the same time twice as much in the second run
        first = ways[0].columns[0][:, 0]
        np.testing.assert_allclose(first[9:], 2.0 * first[1:8])
