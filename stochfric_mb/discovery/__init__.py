"""Discovery: find where measured data and a model disagree, name the missing effect, add it, show that the gap shrinks.

One direction: record -> slips (events and friction forces) -> calibration -> regression and kinematics (screening) ->
confirmation by simulating -> decision -> refit -> gap on held-out data -> result.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stochfric_mb.discovery.outcome import Outcome
    from stochfric_mb.measurement.dataset import Dataset
    from stochfric_mb.scenario import Scenario


def discover(
    dataset: str | Path | Dataset,
    *,
    scenario: str | Path | Scenario | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Outcome:
    """Return what measured data say about a model: which effect it lacks, none, or something unknown.

    Args:
        dataset: a folder with ``dataset.toml``, that file, one measured file (then ``scenario`` is needed), or a
            `Dataset`, such as one of arrays.
        scenario: the present model; replaces the dataset's own.
        progress: called with the name of each stage as it begins.

    Raises:
        InputError: data or scenario that cannot be used; names file, key or row, rule and remedy.
    """
    from threadpoolctl import threadpool_limits

    from stochfric_mb.discovery.stick_slip.workflow import discover_belt_box
    from stochfric_mb.measurement.dataset import Dataset, checked, load_dataset
    from stochfric_mb.mechanisms import BeltBox

    data = checked(dataset, scenario=scenario) if isinstance(dataset, Dataset) else load_dataset(dataset, scenario)
    with threadpool_limits(1, user_api="blas"):  # thousands of small systems: a pool of threads waits longer than it works
        if not isinstance(data.scenario.mechanism, BeltBox):
            from stochfric_mb.discovery.driven_joint import joint_outcome

            return joint_outcome(data, progress=progress)
        return discover_belt_box(data, progress=progress)
