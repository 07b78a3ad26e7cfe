"""Friction while a model runs in MuJoCo: in joints and tendons by ``frictionloss``, in a pair by our plugin's coefficients."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import dataclasses
import importlib
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import known_temperature
from stochfric_mb.discovery.driven_joint.balance.weak_form import narrowest
from stochfric_mb.discovery.driven_joint.fit.friction_along import chain, resistance
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.mjcf.geom_pairs import geom_numbers, touch
from stochfric_mb.discovery.driven_joint.mjcf.inverse import MjcfSource
from stochfric_mb.discovery.driven_joint.mjcf.measured_columns import in_si
from stochfric_mb.effects.contract import LOAD, WORLD
from stochfric_mb.measurement.run import Run

Array = npt.NDArray[np.float64]

LEAST = 1.0e-9
"""Least friction that the engine is given: none at all would switch it off [N or N m]."""
MARK_S, MARK_K = 0.123456, 0.0654321
"""Coefficients by which their places are known."""
LOOSE = 1.0e-3
"""Normal force over the stated one below which a pair is left as it is [-]."""


def place_of(
    source: MjcfSource, name: str, load: float, model: JointModel, run: Run, directions: PairDirections
) -> LossPlace | PairPlace:
    """Return friction in a joint, tendon or pair, for one run."""
    if name in source.mechanism.pairs:
        return PairPlace(source, name, load, model, run, directions)
    return LossPlace(source, name, load, model, run)


class LossPlace:
    """Friction in one joint or tendon while the model runs: what is available there is MuJoCo's ``frictionloss``."""

    def __init__(self, source: MjcfSource, name: str, load: float, model: JointModel, run: Run) -> None:
        self._source, self.name, self._links = source, name, chain(model.law, model.effects_in(run.name), load)
        self._joint = name in source.names
        self._number = (source.names if self._joint else source.tendons).index(name)
        self._world, self._memory = np.zeros(WORLD), np.zeros(8)
        self._gain = model.nuisances.get("gain", 1.0)
        self._damping = source.mechanism.damping.get(name, 0.0)
        self._turned, self._side = 0.0, 0.0
        # conditions as they were: what drifts changes little by an error of the simulation
        self._travelled = source.travelled(run, name)
        self._slip = source.slip(run, name)
        self._temperature = known_temperature(run)
        self._loads = source.loads.get(run.name)

    def _seen(self, data: Any) -> tuple[float, float]:
        if self._joint:
            return float(data.qpos[self._number]), float(data.qvel[self._number])
        return float(data.ten_length[self._number]), float(data.ten_velocity[self._number])

    def start(self, data: Any, sample: int) -> None:
        """Begin where the model is, in the middle of a stroke as the record has it."""
        q, v = self._seen(data)
        self._side = 1.0 if v >= 0.0 else -1.0
        self._turned = q - self._side * self._slip[sample]

    def set(
        self, model: Any, data: Any, t: float, forces: Mapping[str, float], drives: Mapping[str, Array], sample: int
    ) -> float:
        """Give the engine the friction that is available now; returns what else pushes along the place [N or N m]."""
        q, v = self._seen(data)
        side = 1.0 if v > 0.0 else -1.0 if v < 0.0 else self._side
        if side != self._side:
            self._turned, self._side = q, side
        drive = forces.get(self.name, float(drives[self.name][sample]) if self.name in drives else 0.0)
        # the load that friction knows of is that of the drive as stated, as in the fits, unless it was measured
        load = abs(drive / self._gain - self._damping * v if self._loads is None else float(self._loads[sample]))
        links = self._links
        against = side * float(
            resistance(
                links.numbers, links.calls, links.parameters, self._world, self._memory, t, q, v, load,
                abs(q - self._turned), side, self._travelled[sample], self._temperature[sample], 1.0, drive / self._gain, 0.0,
            )
        )  # fmt: skip
        pushed = float(self._world[LOAD])
        loss = model.dof_frictionloss if self._joint else model.tendon_frictionloss
        loss[self._number] = max(against + side * pushed, LEAST)
        return pushed


class PairPlace:
    """Friction in a pair while the model runs: our plugin's coefficients are what is available over the normal force."""

    def __init__(
        self, source: MjcfSource, name: str, load: float, model: JointModel, run: Run, directions: PairDirections
    ) -> None:
        self.name, self._load, self._directions = name, load, directions
        self._links = chain(model.law, model.effects_in(run.name), load, contact=True)
        self._more = model.law.mu_s / model.law.mu_k
        self._world, self._memory = np.zeros(WORLD), np.zeros(8)
        self._travelled = source.travelled(run, name)
        self._slip = source.slip(run, name)
        self._temperature = known_temperature(run)
        path = source.path(run, name, narrowest(run))
        self._position, self._direction = path.position, np.sign(path.velocity)
        measured = source.mechanism.pairs[name].normal_force
        self._measured = in_si(run, measured, "normal_force") if measured else None
        self._turned, self._side, self._at = 0.0, 0.0, 0.0
        self._attach: Any = importlib.import_module("stochfric_mb.mujoco")
        self._slots: _Slots | None = None

    def start(self, data: Any, sample: int) -> None:
        """Begin where the model is, in the middle of a stroke as the record has it."""
        self._at, self._side = float(self._position[sample]), float(self._direction[sample])
        self._turned = self._at - self._side * float(self._slip[sample])

    def set(
        self, model: Any, data: Any, t: float, forces: Mapping[str, float], drives: Mapping[str, Array], sample: int
    ) -> float:
        """Give the plugin the coefficients that friction has now; returns what else pushes along the pair [N]."""
        readings = self._attach.readings(model, data)
        instance, contacts = next(iter(readings.items()))
        pressed = sum(c.normal_force for c in contacts)
        if pressed < LOOSE * self._load:
            return 0.0
        v = float(self._directions(self.name) @ data.qvel)
        self._at += v * model.opt.timestep
        side = 1.0 if v > 0.0 else -1.0 if v < 0.0 else self._side
        if side != self._side:
            self._turned, self._side = self._at, side
        normal = pressed if self._measured is None else max(float(self._measured[sample]), 0.0)
        links = self._links
        against = side * float(
            resistance(
                links.numbers, links.calls, links.parameters, self._world, self._memory, t, self._at, v, normal,
                abs(self._at - self._turned), side, self._travelled[sample], self._temperature[sample], normal / self._load,
                0.0, 0.0,
            )
        )  # fmt: skip
        pushed = float(self._world[LOAD])
        mu = max(against + side * pushed, LEAST) / pressed
        if self._slots is None:
            self._slots = _Slots.of(self._attach, model, data, instance)
        self._slots.write(data, self._more * mu, mu)
        return pushed


@dataclasses.dataclass(frozen=True)
class _Slots:
    """Where the plugin keeps an instance's coefficients, asked once: a model runs for thousands of steps."""

    places: npt.NDArray[np.int64]
    """What `set_friction` writes to in ``plugin_state``."""
    values: Array
    """What it writes there, mu_s and mu_k apart."""
    mu_s: npt.NDArray[np.bool_]
    """Which of the places hold mu_s."""
    mu_k: npt.NDArray[np.bool_]
    """Which hold mu_k."""

    @classmethod
    def of(cls, attach: Any, model: Any, data: Any, instance: str) -> _Slots:
        probe = data.plugin_state.copy()
        attach.set_friction(probe, model, instance, mu_s=MARK_S, mu_k=MARK_K)
        marked = (probe == MARK_S) | (probe == MARK_K)
        places = np.flatnonzero(marked | ((probe != data.plugin_state) & (probe < 0.0)))  # a time before all: evaluate anew
        values = probe[places]
        return cls(places, values, values == MARK_S, values == MARK_K)

    def write(self, data: Any, mu_s: float, mu_k: float) -> None:
        values = self.values.copy()
        values[self.mu_s], values[self.mu_k] = mu_s, mu_k
        data.plugin_state[self.places] = values


class PairDirections:
    """How the pairs of a model slide with its joints in the state that it is in, worked out once for each state."""

    def __init__(self, source: MjcfSource, model: Any, data: Any) -> None:
        self._source, self._model, self._data = source, model, data
        pairs = source.mechanism.pairs
        self._geoms = {name: geom_numbers(source.mujoco, model, pair) for name, pair in pairs.items()}
        self._known: dict[str, Array] = {}

    def __call__(self, pair: str) -> Array:
        """Return how a pair slides with each joint, shape (n_joints,); zeros where it does not touch."""
        if pair not in self._known:
            seen = touch(self._source.mujoco, self._model, self._data, *self._geoms[pair])
            still = np.zeros(self._model.nv)
            self._known[pair] = still if seen is None else self._source.line(pair) @ seen.axes.T @ seen.slide
        return self._known[pair]

    def forget(self) -> None:
        """Say that the state has changed."""
        self._known.clear()
