"""How an engine carries effects: the law that it runs, and what it reports afterwards."""

from __future__ import annotations

from collections.abc import Sequence

from stochfric_mb.effects.augmented_law import augmented_law
from stochfric_mb.effects.columns import as_measured, without_loads
from stochfric_mb.effects.combine import moving, with_compliance
from stochfric_mb.effects.contract import Effect
from stochfric_mb.laws import Law
from stochfric_mb.laws.substitute import elastic_substitute
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.trajectory import Trajectory


def running_law(
    law: Law,
    mechanism: BeltBox,
    effects: Sequence[Effect],
    dt: float,
    *,
    substitute: bool,
    seed: int,
    sample: int,
) -> tuple[Law, list[str]]:
    """Return the law that an engine runs, and notes on what stands in for what.

    Args:
        law: the scenario's law.
        mechanism: the belt-box.
        effects: the scenario's effects.
        dt: step [s].
        substitute: whether the engine needs the elastic substitute of a law with true stick even without effects.
        seed: first part of the address of random numbers.
        sample: second part.

    Raises:
        InputError: a law that cannot carry the effects.
    """
    law = with_compliance(law, effects)
    notes: list[str] = []
    if substitute or moving(effects):
        law, note = elastic_substitute(law, dt, mechanism.normal_force, mechanism.mass)
        notes += [note] if note else []
    return augmented_law(law, mechanism, effects, seed=seed, sample=sample), notes


def reported(trajectory: Trajectory, mechanism: BeltBox, effects: Sequence[Effect], *, seed: int, sample: int) -> Trajectory:
    """Return an engine's trajectory with friction by itself, the normal force that acted, and the sensor's reading.

    Args:
        trajectory: what the engine recorded.
        mechanism: the belt-box.
        effects: the scenario's effects.
        seed: first part of the address of random numbers.
        sample: second part.
    """
    if not effects:
        return trajectory
    trajectory = without_loads(trajectory, mechanism, effects, seed=seed, sample=sample)
    return as_measured(trajectory, effects, seed=seed, sample=sample)
