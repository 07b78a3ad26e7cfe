"""Confirmation in the engine: the user's model runs forward with the identified friction, and the controller in the loop.

Before each step the friction that is available in each joint or tendon goes into MuJoCo's own ``frictionloss``, which holds
at rest and opposes motion; in a pair it goes into our plugin's coefficients (`mjcf_places`). Where a controller drives a joint
it acts again, on simulated positions; other joints get their measured drive. Without a controller errors would add up along
the record, so there the model starts anew from the measured state, `AHEAD`.
"""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import contextlib
import copy
import dataclasses
from collections.abc import Generator, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.weak_form import narrowest
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.mjcf.compiled_model import add_payload, scale_masses, tendon_row
from stochfric_mb.discovery.driven_joint.mjcf.inverse import MjcfSource
from stochfric_mb.discovery.driven_joint.mjcf.joint_loops import joint_loops
from stochfric_mb.discovery.driven_joint.mjcf.loaded_model import without_friction
from stochfric_mb.discovery.driven_joint.mjcf.measured_columns import corrected, drive_of, payload_of, position_of_joint
from stochfric_mb.discovery.driven_joint.mjcf.places import pair_direction, place_of
from stochfric_mb.discovery.driven_joint.simulation.scores import AHEAD
from stochfric_mb.measurement.run import Run

Array = npt.NDArray[np.float64]
Models = Mapping[str, JointModel]
"""Place -> model of its friction."""

SETTLE = 0.25
"""Time from which a simulated closed loop is compared: what is wrong in its first state has faded [s]."""
STIFF = (2.0, 1.0)
"""Reference time [steps] and damping ratio of the friction constraints: as stiff as the step allows, so that rest is rest."""
HARD = (0.9999, 0.9999, 0.001, 0.5, 2.0)
"""Their impedance."""
HELD = 1.0e4
"""Inertia of a joint that is held, over its own: little moves it within a step, after which it is put back; of more, the
engine's solver loses the friction of other joints to rounding."""


@dataclasses.dataclass(frozen=True)
class Forward:
    """Simulated runs against measured ones."""

    position: float
    """Error of the positions, rms over joints and samples [`unit`]."""
    unit: str
    """Unit of the measured positions: m, rad, or both."""
    drive: float | None
    """Error of what the controller gives, relative rms [-]; None without a controller."""


def forward(source: MjcfSource, models: Models, delay: float) -> Forward:
    """Return how far the simulated held-out runs are from the measured ones.

    Args:
        source: the model and the runs.
        models: friction and corrections of each place.
        delay: by how much positions come after the driving force in the record [s].
    """
    wrong = wrong_drive = drive = 0.0
    count = 0
    for run in source.dataset.test:
        plant = _Plant(source, models, run, delay)
        with _unlogged(source.mujoco):
            position, given = plant.simulated()
        seen = plant.compared
        wrong += float(np.sum((position - plant.measured)[seen] ** 2))
        count += int(seen.sum()) * position.shape[1]
        for joint, output in given.items():
            recorded = plant.loops[joint].recorded[plant.start : plant.end]
            wrong_drive += float(np.sum((output - recorded)[seen] ** 2))
            drive += float(np.sum(recorded[seen] ** 2))
    moving = [n for n in source.names if isinstance(source.mechanism.positions[n], str)]
    unit = " or ".join(sorted({"rad" if source.rotates(n) else "m" for n in moving}))
    return Forward(float(np.sqrt(wrong / count)), unit, float(np.sqrt(wrong_drive / drive)) if drive > 0.0 else None)


@contextlib.contextmanager
def _unlogged(mujoco: Any) -> Generator[None]:
    """Keep what MuJoCo says of a motion that grows without bounds, whose error tells, out of MUJOCO_LOG.TXT."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda text: None)
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(before)


class _Plant:
    """One run, simulated."""

    def __init__(self, source: MjcfSource, models: Models, run: Run, delay: float) -> None:
        self._source, self._models, self._run, self._delay = source, models, run, delay
        mujoco = source.mujoco
        self._mechanism = corrected(source.mechanism, {p: models[p].nuisances for p in source.places})
        name = next(iter(source.places))
        first = models[name].nuisances
        if name in source.mechanism.pairs:
            law = models[name].law
            model = without_friction(mujoco, source.mechanism, (name, law.mu_s, law.mu_k))
        else:
            model = copy.copy(source.model)
        scale_masses(mujoco, model, first.get("mass", 1.0))
        add_payload(mujoco, model, payload_of(first))
        model.dof_armature *= first.get("armature", 1.0)
        for i, name in enumerate(source.names):
            factor = models[name].nuisances.get("damping", 1.0) if name in models else 1.0
            model.dof_damping[i] = factor * model.dof_damping[i] + self._mechanism.damping.get(name, 0.0)
        self._steps = max(1, round(run.sample_interval / model.opt.timestep))
        model.opt.timestep = run.sample_interval / self._steps
        reference = STIFF[0] * model.opt.timestep, STIFF[1]
        model.dof_solref[:], model.tendon_solref_fri[:] = reference, reference
        model.dof_solimp[:], model.tendon_solimp_fri[:] = HARD, HARD
        self._model, self._data = model, mujoco.MjData(model)
        # through the narrowest window: velocities to start from
        narrow = narrowest(run)
        self._state = tuple(source.joints(run, narrow, d) for d in (0, 1))
        rows = [position_of_joint(run, source.mechanism, n) for n in source.names]
        # what a contact carries finds its own place; something else, a brake or a drive, holds the other joints that stay
        stays = np.array([not isinstance(source.mechanism.positions[n], str) for n in source.names])
        parts = [source.path(run, pair, narrow).part for pair in source.mechanism.pairs]
        self._carried = stays & np.any([np.zeros(len(stays)), *(np.abs(p).max(axis=0) for p in parts if p is not None)], axis=0)
        self._held = stays & ~self._carried
        model.dof_armature[self._held] = HELD * model.dof_M0[self._held]
        self.start, self.end = int(narrow.centres[0]), int(narrow.centres[-1])
        self.measured: Array = np.column_stack(rows)[self.start : self.end]
        """Measured positions, shape (n, n_joints)."""
        self.loops = joint_loops(run, self._mechanism, source.dataset.scenario.controller)
        """Joint -> its controller."""
        late = SETTLE / run.sample_interval if self.loops else 0
        self.compared: npt.NDArray[np.bool_] = np.arange(len(self.measured)) >= late
        """Samples that are compared, shape (n,)."""

    def simulated(self) -> tuple[Array, dict[str, Array]]:
        """Return positions, shape (n, n_joints), and what each controller gives, shape (n,)."""
        mujoco, model, data, run = self._source.mujoco, self._model, self._data, self._run
        n, h, held = self.end - self.start, run.sample_interval, self._held
        places_held = self.measured[0, held]
        places = [place_of(self._source, p, self._models[p], run) for p in self._source.places]
        period = getattr(self._source.dataset.scenario.controller, "period", 0.0)
        hold = max(1, round(period / h * self._steps)) if period > 0.0 else 1
        drives = {p: self._late(drive_of(run, self._mechanism, p)) for p in self._mechanism.drives}
        positions, given = np.empty((n, model.nv)), {joint: np.empty(n) for joint in self.loops}
        again = n if self.loops else max(1, round(AHEAD / h))
        forces: dict[str, float] = {}
        for i in range(n):
            if i % again == 0:
                self._start(self.start + i)
                for place in places:
                    place.start(data, self.start + i)
            positions[i] = data.qpos
            for k in range(self._steps):
                if (i * self._steps + k) % hold == 0:
                    for joint in self.loops:
                        output, forces[joint] = self._controlled(joint, self.start + i, k / self._steps)
                        if k == 0:
                            given[joint][i] = output
                applied = {p: forces.get(p, float(series[self.start + i])) for p, series in drives.items()}
                data.qfrc_applied[:] = 0.0
                for place, force in applied.items():
                    self._push(place, force)
                for place, force in self._mechanism.offset.items():
                    self._push(place, -force)
                now = float(run.time[self.start + i]) + k * model.opt.timestep
                for place in places:
                    self._push(place.name, place.set(model, data, now, applied.get(place.name, 0.0), self.start + i))
                mujoco.mj_step(model, data)
                data.qpos[held], data.qvel[held] = places_held, 0.0
        return positions, given

    def _late(self, drive: Array) -> Array:
        at = np.arange(len(drive)) - self._delay / self._run.sample_interval
        return np.interp(at, np.arange(len(drive)), drive)

    def _start(self, sample: int) -> None:
        mujoco, data, carried = self._source.mujoco, self._data, self._carried
        before = data.qpos.copy(), data.qvel.copy()
        mujoco.mj_resetData(self._model, data)
        data.qpos[:], data.qvel[:] = self._state[0][sample], self._state[1][sample]
        if sample > self.start:  # what is carried by a contact has found its place
            data.qpos[carried], data.qvel[carried] = before[0][carried], before[1][carried]
        mujoco.mj_forward(self._model, data)

    def _push(self, place: str, force: float) -> None:
        """Add a force along a joint, tendon or pair."""
        if force == 0.0:
            return
        if place in self._source.names:
            self._data.qfrc_applied[self._source.names.index(place)] += force
        elif place in self._source.mechanism.pairs:
            self._data.qfrc_applied[:] += force * pair_direction(self._source, self._model, self._data, place)
        else:
            self._data.qfrc_applied[:] += force * tendon_row(self._model, self._data, self._source.tendons.index(place))

    def _controlled(self, joint: str, sample: int, part: float) -> tuple[float, float]:
        """Return what the controller of a joint gives, and the force of it, a part of an interval after a sample."""
        loop, dof = self.loops[joint], self._source.names.index(joint)
        goal = (1.0 - part) * loop.reference[sample] + part * loop.reference[min(sample + 1, len(loop.reference) - 1)]
        u = float(loop.output(goal, self._data.qpos[dof], self._data.qvel[dof], sample))
        return u, u * float(loop.force[sample])
