"""Held-out runs simulated again, with the model as stated, recalibrated and augmented."""

from __future__ import annotations

import dataclasses
import importlib.util
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from stochfric_mb.discovery.driven_joint.balance.inverse_dynamics import drive_channel, measured_load
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.fit.wave_scan import with_phases
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.discovery.driven_joint.simulation.closed_loop import controller_output
from stochfric_mb.discovery.driven_joint.simulation.scores import drive_floor
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.mechanisms import HingePendulum, Mjcf, PrismaticJoint
from stochfric_mb.mechanisms.mjcf_parts import Drive

JOINT = "joint"
"""Name of the joint of a slide or hinge in its MJCF."""
Models = Mapping[str, JointModel]


def simulated(
    source: Any, tell: Callable[[str], None], places: Sequence[PlaceOutcome]
) -> tuple[list[PlaceOutcome], float | None]:
    """Return the places with the errors of forward simulation, and the noise of what a controller gives [-].

    Slides and hinges with a cascade are simulated already; one that is slow and prescribed has nothing to simulate.

    Args:
        source: balances of the dataset.
        tell: called with what is being done.
        places: the outcomes; the first one's scores are completed.
    """
    dataset = source.dataset
    mechanism = dataset.scenario.mechanism
    floor = None
    if dataset.scenario.controller is not None and not isinstance(mechanism, Mjcf):
        return list(places), drive_floor([controller_output(r, mechanism) for r in dataset.test])
    if not isinstance(mechanism, Mjcf) and not _moves_freely(dataset):
        return list(places), None
    from stochfric_mb.discovery.driven_joint.mjcf.forward import forward
    from stochfric_mb.discovery.driven_joint.mjcf.joint_loops import joint_loops

    base = source.stated_delay
    delay = base + places[0].late
    names = {p.place or next(iter(source.places)): p for p in places}
    early = any(p.undelayed is not None for p in places)
    stages: dict[str, tuple[Models, float]] = {
        "baseline": ({n: p.stated for n, p in names.items()}, base),
        "recalibrated": ({n: p.undelayed or p.selected.recalibrated.model for n, p in names.items()}, base if early else delay),
        "augmented": ({n: with_phases(p.selected.final.model, p.test, p.nuisances) for n, p in names.items()}, delay),
    }
    scores = dict(places[0].scores)
    for label, (models, late) in stages.items():
        if any(e.moves_load for m in models.values() for e in m.effects):
            continue  # the engine's joints are one body
        tell(f"forward simulation, {label}")
        if isinstance(mechanism, Mjcf):
            seen = forward(source, models, late)
        else:
            seen = forward(*as_mjcf(dataset, next(iter(models.values()))), late)
        scores[label] = dataclasses.replace(scores[label], loop=seen.drive, forward=seen.position, forward_unit=seen.unit)
    if dataset.scenario.controller is not None:
        loops = [joint_loops(run, mechanism, dataset.scenario.controller) for run in dataset.test]
        floor = drive_floor([loop.recorded for of in loops for loop in of.values()])
    return [dataclasses.replace(places[0], scores=scores), *places[1:]], floor


def _moves_freely(dataset: Dataset) -> bool:
    """Return whether a slide or hinge can be run forward: it has inertia, a measured drive only, and the engine is there."""
    mechanism = dataset.scenario.mechanism
    driven = isinstance(mechanism, HingePendulum) or (
        isinstance(mechanism, PrismaticJoint) and mechanism.mass > 0.0 and mechanism.piston_area == 0.0
    )
    measured = all("position" in run.channels and not run.settings for run in dataset.test)
    return driven and measured and importlib.util.find_spec("mujoco") is not None


def as_mjcf(dataset: Dataset, model: JointModel) -> tuple[Any, Models]:
    """Return a slide or hinge with the corrections of ``model`` as a MuJoCo source, and its friction by joint."""
    from stochfric_mb.discovery.driven_joint.mjcf.inverse import MjcfSource
    from stochfric_mb.discovery.export import plain_mjcf

    mujoco: Any = importlib.import_module("mujoco")
    stated: Any = dataset.scenario.mechanism
    mechanism = dataclasses.replace(stated, **model.nuisances)
    name, factor = drive_channel(mechanism)
    electric = name == "voltage"  # damping is that of the motor's back-emf as well: no torque that the joint transmits
    place = Mjcf(
        file=Path(),
        friction={JOINT: model.load},
        positions={JOINT: "position"},
        drives={JOINT: Drive(columns=(name,), gain=factor)},
        damping={JOINT: mechanism.damping} if electric else {},
        offset={JOINT: mechanism.offset},
    )
    scenario = dataclasses.replace(dataset.scenario, mechanism=place, controller=None)
    compiled = mujoco.MjModel.from_xml_string(
        plain_mjcf(dataclasses.replace(mechanism, damping=0.0) if electric else mechanism)
    )
    known = {run.name: measured_load(run, stated) for run in dataset.runs}
    source = MjcfSource(dataclasses.replace(dataset, scenario=scenario), place, mujoco, compiled, (JOINT,), ())
    source = dataclasses.replace(source, loads={name: load for name, load in known.items() if load is not None})
    return source, {JOINT: dataclasses.replace(model, nuisances={})}
