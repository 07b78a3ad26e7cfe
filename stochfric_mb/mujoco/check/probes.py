"""Experiments on one site with friction: hold, break away, slide; each from the same state, on a model as it comes."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import mujoco
import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import SimulationError
from stochfric_mb.mujoco.check.sites import Sample, Site, kick
from stochfric_mb.mujoco.reading import diverged

Array = npt.NDArray[np.float64]

PHYSICS = int(mujoco.mjtState.mjSTATE_INTEGRATION) & ~int(mujoco.mjtState.mjSTATE_PLUGIN)
"""What of a state is carried into any copy of the model."""
RISE = 0.25
"""Share of a hold in which the load rises."""
OVERLOAD = 1.4
"""Load at the end of the break-away ramp, over the limit."""
BREAK_AWAY_TIME = 2.0
"""Duration of the break-away ramp, over that of a hold."""
AVERAGED = 0.02
"""Share of the break-away ramp over which the friction force is averaged."""
EXCESS = 0.02
"""Force over the limit that tells motion from creep, see `break_away`."""
LEAST_STEPS = 10
"""Fewest steps of a run."""
SLIDE_STEPS, MOST_SLIDE_STEPS = 10, 400
"""Steps in which a slide should lose half its speed, and most steps of one."""
FIRST_SLIDE_STEP = 2
"""Step after which the deceleration is measured: a kicked contact that was stuck needs one to notice."""
SLIDE_SPEED = 0.05
"""Least speed of a slide [m/s or rad/s]; far above the velocities at which coefficients fall."""
TOUCHING = 0.9
"""Share of samples in contact below which a contact flickers."""


@dataclasses.dataclass(frozen=True)
class Drift:
    """Sliding of a site that should hold."""

    load: float
    """Friction force over its limit [-], as measured."""
    speed: float
    """Mean sliding velocity along the load, after the transient [m/s or rad/s]."""


@dataclasses.dataclass(frozen=True)
class BreakAway:
    """What a rising load shows."""

    share: float
    """Friction force at break-away over the limit at rest [-]: 1 where the site breaks away at mu_s N."""
    slip: float
    """Displacement by the time that the friction reached 98 % of that [m or rad]."""


@dataclasses.dataclass(frozen=True)
class Slide:
    """Deceleration of a sliding site, by friction alone."""

    deceleration: float
    """Difference between the accelerations without and with the site's friction [m/s^2 or rad/s^2]."""
    expected: float
    """Limit force over the sliding mass [m/s^2 or rad/s^2], with the static coefficient."""
    mass: float
    """The mass that slides with the site [kg or kg m^2]."""
    touching: float
    """Share of the slide in contact [-]: below 1 where the body hops."""


@dataclasses.dataclass(frozen=True)
class Record:
    """Samples of one run, one a step."""

    samples: Array
    """Columns as `Sample`'s fields, shape (n, 6)."""
    step: float
    """Step [s]."""
    end: State
    """Where the model was at the end."""
    following: Array
    """Velocity of the motion that `run` followed [m/s or rad/s], shape (n,)."""

    def column(self, name: str) -> Array:
        """Return one of `Sample`'s fields over time."""
        return self.samples[:, Sample._fields.index(name)]

    @property
    def touching(self) -> float:
        """Share of samples in contact [-]."""
        return float(self.column("touching").mean())

    def displacement(self) -> Array:
        """Return the sliding displacement since the start [m or rad]."""
        return _integral(self.column("velocity"), self.step)

    def energy_created(self) -> float:
        """Return the most energy that friction had given to the motion at any time [J], 0 where it never did."""
        return max(0.0, float(_integral(self.column("power"), self.step).max()))

    def energy_dissipated(self) -> float:
        """Return the energy that friction took from the motion [J]."""
        return -float(_integral(self.column("power"), self.step)[-1])


def _integral(values: Array, step: float) -> Array:
    return np.concatenate([[0.0], np.cumsum(0.5 * step * (values[1:] + values[:-1]))])


@dataclasses.dataclass(frozen=True)
class State:
    """Where a model is; it can be carried into a copy of the model with other friction."""

    physics: Array
    """All that the engine integrates, and its inputs."""
    plugins: Array
    """What plugins remember; they begin anew in a model where this does not fit."""


def snapshot(model: mujoco.MjModel, data: mujoco.MjData) -> State:
    """Return the state that data are in."""
    physics = np.zeros(mujoco.mj_stateSize(model, PHYSICS))
    mujoco.mj_getState(model, data, physics, PHYSICS)
    return State(physics, data.plugin_state.copy())


def started(model: mujoco.MjModel, state: State) -> mujoco.MjData:
    """Return new data at a state."""
    data = mujoco.MjData(model)
    mujoco.mj_setState(model, data, state.physics, PHYSICS)
    if len(state.plugins) == len(data.plugin_state):
        data.plugin_state[:] = state.plugins
    mujoco.mj_forward(model, data)
    return data


def run(
    model: mujoco.MjModel,
    state: State,
    site: Site,
    duration: float,
    load: Callable[[float], float] = lambda t: 0.0,
    change: Array | None = None,
    follow: Array | None = None,
) -> Record:
    """Return what a site does under a load.

    Args:
        model: the model.
        state: where it starts.
        site: the site.
        duration: simulated time [s].
        load: the probe's force [N or N m] at a time since the start [s].
        change: added to qvel at the start.
        follow: row of generalised velocities whose product with qvel is recorded.

    Raises:
        SimulationError: the state is not finite.
    """
    data = started(model, state)
    if change is not None:
        data.qvel += change
        mujoco.mj_forward(model, data)
    applied = data.qfrc_applied.copy()
    step = float(model.opt.timestep)
    rows = [site.sample(model, data)]
    follow = np.zeros(model.nv) if follow is None else follow
    followed = [follow @ data.qvel]
    for i in range(max(LEAST_STEPS, round(duration / step))):
        data.qfrc_applied[:] = applied + load(i * step) * site.row(model, data) if rows[-1].touching else applied
        mujoco.mj_step(model, data)
        mujoco.mj_forward(model, data)
        if not np.isfinite(data.qvel).all() or not np.isfinite(data.qacc).all() or diverged(data):
            raise SimulationError(f"the state broke {(i + 1) * step:.3g} s after the start of a probe; use a smaller timestep")
        rows.append(site.sample(model, data))
        followed.append(follow @ data.qvel)
    return Record(np.array(rows, dtype=float), step, snapshot(model, data), np.array(followed))


def hold(model: mujoco.MjModel, state: State, site: Site, duration: float, force: float) -> tuple[Drift | None, Record]:
    """Return the drift under a force that rises to ``force`` [N or N m] and stays; None if the contact is lost."""
    record = run(model, state, site, duration, lambda t: force * min(1.0, t / (RISE * duration)))
    return drift(record) if record.touching >= TOUCHING else None, record


def drift(record: Record) -> Drift:
    """Return the mean load and the mean velocity over the second half of a run."""
    half = len(record.samples) // 2
    limit = record.column("limit")[half:].mean()
    load = record.column("resistance")[half:].mean() / limit if limit > 0.0 else 0.0
    return Drift(float(load), float(record.column("velocity")[half:].mean()))


def break_away(
    model: mujoco.MjModel, state: State, site: Site, duration: float, carried: float, limit: float, mass: float
) -> tuple[BreakAway | None, Record]:
    """Return the friction force that was reached when a rising load set the site in motion; None if it never did.

    In motion is a site that is faster than `EXCESS` of its limit would make its mass in the duration of a hold.

    Args:
        model: the model.
        state: where it starts.
        site: the site.
        duration: that of a hold [s].
        carried: friction force before any load [N or N m].
        limit: limit at rest [N or N m].
        mass: the mass that slides with the site [kg or kg m^2].
    """
    span = BREAK_AWAY_TIME * duration
    top = OVERLOAD * limit - carried
    record = run(model, state, site, span, lambda t: top * t / span)
    moving = np.flatnonzero(record.column("velocity") > EXCESS * limit / mass * duration)
    if not len(moving):
        return None, record
    window = max(3, int(AVERAGED * len(record.samples)))
    force = np.convolve(record.column("resistance")[: moving[0] + 1], np.ones(window) / window, "valid")
    if not len(force):
        return None, record
    first = int(np.argmax(force >= 0.98 * force.max())) + window // 2
    return BreakAway(float(force.max() / limit), float(record.displacement()[first])), record


def slide(
    model: mujoco.MjModel, bare: mujoco.MjModel, state: State, site: Site, free: Site, limit: float
) -> tuple[Slide | None, Record | None, str]:
    """Return the deceleration by friction, or why there is none.

    The site is kicked, and the momentum of the kick's own motion is followed, (M unit) . qvel over the mass of it: a body
    that hops or pitches on the way keeps its sliding momentum.

    Args:
        model: the model.
        bare: the same model without the site's friction.
        state: where both start.
        site: the site.
        free: the site in ``bare``.
        limit: mean limit [N or N m].
    """
    data = started(model, state)
    if not site.sample(model, data).touching:
        return None, None, "the contact is lost"
    unit, mass = kick(model, data, site.row(model, data))
    if not np.isfinite(mass):
        return None, None, "other constraints forbid sliding"
    step = float(model.opt.timestep)
    rate = limit / mass
    speed = max(2.0 * SLIDE_STEPS * step * rate, SLIDE_SPEED)
    steps = int(np.clip(speed / (2.0 * rate * step), SLIDE_STEPS, MOST_SLIDE_STEPS))
    momentum = np.zeros(model.nv)
    mujoco.mj_mulM(model, data, momentum, unit)
    record = run(model, state, site, steps * step, change=speed * unit, follow=momentum / mass)
    without = run(bare, state, free, steps * step, change=speed * unit, follow=momentum / mass)
    sliding = np.flatnonzero(record.following - record.following[0] > -0.9 * speed)
    last = int(sliding[-1])
    if last < SLIDE_STEPS // 2:
        return None, record, "stops within a few steps"
    if record.touching < 0.5 or not without.column("touching")[last]:
        return None, record, "the contact is lost"
    pressing = float(without.column("limit")[: last + 1].mean()) or limit
    lost = without.following - record.following
    touching = float(record.column("touching")[: last + 1].mean())
    deceleration = (lost[last] - lost[FIRST_SLIDE_STEP]) / ((last - FIRST_SLIDE_STEP) * step)
    return Slide(float(deceleration), pressing / mass, mass, touching), record, ""
