"""Friction while a model runs in MuJoCo: in joints and tendons by ``frictionloss``, in a pair by our plugin's coefficients."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import importlib
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import known_temperature
from stochfric_mb.discovery.driven_joint.balance.weak_form import narrowest
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.mjcf.geom_pairs import touch
from stochfric_mb.discovery.driven_joint.mjcf.inverse import MjcfSource
from stochfric_mb.discovery.driven_joint.mjcf.measured_columns import back_emf, in_si
from stochfric_mb.discovery.driven_joint.simulation.friction_function import FrictionAt
from stochfric_mb.measurement.run import Run

Array = npt.NDArray[np.float64]

LEAST = 1.0e-9
"""Least friction that the engine is given: none at all would switch it off [N or N m]."""
MARK_S, MARK_K = 0.123456, 0.0654321
"""Coefficients by which their places are known."""
LOOSE = 1.0e-3
"""Normal force over the stated one below which a pair is left as it is [-]."""


def place_of(source: MjcfSource, name: str, model: JointModel, run: Run) -> LossPlace | PairPlace:
    """Return friction in a joint, tendon or pair, for one run."""
    return (PairPlace if name in source.mechanism.pairs else LossPlace)(source, name, model, run)


class _Place:
    """Friction in one place while the model runs, and what it remembers of the way there."""

    def __init__(self, source: MjcfSource, name: str, model: JointModel, run: Run, *, contact: bool) -> None:
        self.name, self._load = name, model.load
        self._friction = FrictionAt(model.law, model.effects_in(run.name), model.load, contact=contact)
        self._turned, self._side = 0.0, 0.0
        # conditions as they were: what drifts changes little by an error of the simulation
        self._travelled, self._slip, self._temperature = (
            source.travelled(run, name),
            source.slip(run, name),
            known_temperature(run),
        )

    def _begin(self, q: float, side: float, sample: int) -> None:
        """Begin in the middle of a stroke as the record has it."""
        self._side, self._turned = side, q - side * float(self._slip[sample])

    def _available(self, t: float, q: float, v: float, sample: int, **more: float) -> tuple[float, float]:
        """Return the friction that is available now, and what else pushes along the place [N or N m]."""
        side = 1.0 if v > 0.0 else -1.0 if v < 0.0 else self._side
        if side != self._side:
            self._turned, self._side = q, side
        available, pushed = self._friction(
            t, q, v, side, slip=abs(q - self._turned), travelled=self._travelled[sample], temperature=self._temperature[sample],
            **more,
        )  # fmt: skip
        return max(available, LEAST), pushed


class LossPlace(_Place):
    """Friction in one joint or tendon while the model runs: what is available there is MuJoCo's ``frictionloss``."""

    def __init__(self, source: MjcfSource, name: str, model: JointModel, run: Run) -> None:
        super().__init__(source, name, model, run, contact=model.contact)
        self._contact = model.contact
        self._joint = name in source.names
        self._number = (source.names if self._joint else source.tendons).index(name)
        self._gain = model.nuisances.get("gain", 1.0)
        self._damping = back_emf(run, source.mechanism, name)
        self._loads = source.loads.get(run.name)

    def _seen(self, data: Any) -> tuple[float, float]:
        if self._joint:
            return float(data.qpos[self._number]), float(data.qvel[self._number])
        return float(data.ten_length[self._number]), float(data.ten_velocity[self._number])

    def start(self, data: Any, sample: int) -> None:
        """Begin where the model is, in the middle of a stroke as the record has it."""
        q, v = self._seen(data)
        self._begin(q, 1.0 if v >= 0.0 else -1.0, sample)

    def set(self, model: Any, data: Any, t: float, drive: float, sample: int) -> float:
        """Give the engine the friction that is available now; returns what else pushes along the place [N or N m]."""
        q, v = self._seen(data)
        stated = drive / self._gain
        # the load that friction knows of is that of the drive as stated, as in the fits, unless it was measured
        load = abs(stated - self._damping * v if self._loads is None else float(self._loads[sample]))
        pressed = load / self._load if self._contact else 1.0
        available, pushed = self._available(t, q, v, sample, load=load, drive=stated, pressed=pressed)
        loss = model.dof_frictionloss if self._joint else model.tendon_frictionloss
        loss[self._number] = available
        return pushed


class PairPlace(_Place):
    """Friction in a pair while the model runs: our plugin's coefficients are what is available over the normal force."""

    def __init__(self, source: MjcfSource, name: str, model: JointModel, run: Run) -> None:
        super().__init__(source, name, model, run, contact=True)
        self._source, self._more = source, model.law.mu_s / model.law.mu_k
        path = source.path(run, name, narrowest(run))
        self._position, self._direction = path.position, np.sign(path.velocity)
        measured = source.mechanism.pairs[name].normal_force
        self._measured = in_si(run, measured, "normal_force") if measured else None
        self._at = 0.0
        self._attach: Any = importlib.import_module("stochfric_mb.mujoco")
        self._slots: _Slots | None = None

    def start(self, data: Any, sample: int) -> None:
        """Begin where the model is, in the middle of a stroke as the record has it."""
        self._at = float(self._position[sample])
        self._begin(self._at, float(self._direction[sample]), sample)

    def set(self, model: Any, data: Any, t: float, drive: float, sample: int) -> float:
        """Give the plugin the coefficients that friction has now; returns what else pushes along the pair [N]."""
        instance, contacts = next(iter(self._attach.readings(model, data).items()))
        pressed = sum(c.normal_force for c in contacts)
        if pressed < LOOSE * self._load:
            return 0.0
        v = float(pair_direction(self._source, model, data, self.name) @ data.qvel)
        self._at += v * model.opt.timestep
        normal = pressed if self._measured is None else max(float(self._measured[sample]), 0.0)
        available, pushed = self._available(t, self._at, v, sample, load=normal, pressed=normal / self._load)
        if self._slots is None:
            self._slots = _Slots(self._attach, model, data, instance)
        mu = available / pressed
        self._slots.write(data, self._more * mu, mu)
        return pushed


class _Slots:
    """Where the plugin keeps an instance's coefficients, asked once: a model runs for thousands of steps."""

    def __init__(self, attach: Any, model: Any, data: Any, instance: str) -> None:
        before = data.plugin_state
        probe = attach.set_friction(before.copy(), model, instance, mu_s=MARK_S, mu_k=MARK_K)
        marked = (probe == MARK_S) | (probe == MARK_K)
        self._places = np.flatnonzero(marked | ((probe != before) & (probe < 0.0)))  # a time before all: evaluate anew
        self._values = probe[self._places]
        self._s, self._k = self._values == MARK_S, self._values == MARK_K

    def write(self, data: Any, mu_s: float, mu_k: float) -> None:
        self._values[self._s], self._values[self._k] = mu_s, mu_k
        data.plugin_state[self._places] = self._values


def pair_direction(source: MjcfSource, model: Any, data: Any, pair: str) -> Array:
    """Return how a pair slides with each joint in the present state, shape (n_joints,); zeros where it does not touch."""
    seen = touch(source.mujoco, model, data, *source.geoms[pair])
    return np.zeros(model.nv) if seen is None else source.line(pair) @ seen.slide
