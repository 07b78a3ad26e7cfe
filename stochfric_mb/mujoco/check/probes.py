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
"""Force over the limit that tells motion from creep, see `Probe.break_away`."""
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
UNSTEADY = 0.5
"""Relative change of the normal force above which a contact is not at rest, and a slide says nothing of friction at rest."""
LOST = "the contact is lost"


@dataclasses.dataclass(frozen=True)
class Drift:
    """Sliding of a site that should hold, over the second half of a hold."""

    load: float
    """Mean friction force over its limit [-], as measured."""
    speed: float
    """Mean sliding velocity along the load [m/s or rad/s]."""


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
    """Force of sliding friction over the sliding mass [m/s^2 or rad/s^2]."""
    mass: float
    """The mass that slides with the site [kg or kg m^2]."""
    touching: float
    """Share of the slide in contact [-]: below 1 where the body hops."""


@dataclasses.dataclass(frozen=True)
class Record:
    """Samples of one run, one a step."""

    samples: list[Sample]
    """What the site did, from the start on."""
    step: float
    """Step [s]."""
    end: mujoco.MjData
    """Where the model was at the end."""
    velocities: list[Array]
    """The generalised velocities at the start and after each step, each of shape (nv,)."""

    def column(self, name: str) -> Array:
        """Return one of `Sample`'s numbers over time."""
        return np.array([getattr(sample, name) for sample in self.samples], dtype=float)

    @property
    def touching(self) -> float:
        """Share of samples in contact [-]."""
        return float(self.column("touching").mean())

    def integral(self, name: str) -> Array:
        """Return the integral over the time since the start of one of `Sample`'s numbers."""
        values = self.column(name)
        return np.concatenate([[0.0], np.cumsum(0.5 * self.step * (values[1:] + values[:-1]))])


def started(model: mujoco.MjModel, state: mujoco.MjData) -> mujoco.MjData:
    """Return new data in a state, perhaps of a model with other friction: then what plugins remember begins anew."""
    data = mujoco.MjData(model)
    mujoco.mj_copyState(model, state, data, PHYSICS)
    if len(state.plugin_state) == len(data.plugin_state):
        data.plugin_state[:] = state.plugin_state
    mujoco.mj_forward(model, data)
    return data


@dataclasses.dataclass(frozen=True)
class Probe:
    """A site of a model, in the state from which its experiments start."""

    model: mujoco.MjModel
    """The model."""
    state: mujoco.MjData
    """Where it starts."""
    site: Site
    """The site."""
    duration: float
    """Time of a hold [s]."""
    records: list[Record] = dataclasses.field(default_factory=list[Record])
    """What its runs recorded, in their order."""

    def run(
        self,
        duration: float,
        load: Callable[[float], float] = lambda t: 0.0,
        change: Array | None = None,
    ) -> Record:
        """Return what the site does in ``duration`` [s], which becomes one of the records.

        Args:
            duration: simulated time [s].
            load: the probe's force [N or N m] at a time since the start [s].
            change: added to qvel at the start.

        Raises:
            SimulationError: the state is not finite.
        """
        model, data = self.model, started(self.model, self.state)
        if change is not None:
            data.qvel += change
            mujoco.mj_forward(model, data)
        applied = data.qfrc_applied.copy()
        step = float(model.opt.timestep)
        row, samples = self.site.sample(model, data).row, list[Sample]()
        velocities = [data.qvel.copy()]
        for i in range(max(LEAST_STEPS, round(duration / step))):
            data.qfrc_applied[:] = applied + load(i * step) * row
            samples.append(self._step(data))
            if not np.isfinite(data.qvel).all() or not np.isfinite(data.qacc).all() or diverged(data):
                raise SimulationError(
                    f"the state broke {(i + 1) * step:.3g} s after the start of a probe; use a smaller timestep"
                )
            row = samples[-1].row
            velocities.append(data.qvel.copy())
        mujoco.mj_forward(model, data)
        self.records.append(Record([*samples, self.site.sample(model, data)], step, data, velocities))
        return self.records[-1]

    def _step(self, data: mujoco.MjData) -> Sample:
        """Advance by one step, and return what the site did at its start, with the mean velocity of the step.

        An integrator of one stage leaves contacts, Jacobians and forces as they were there, and they work on that velocity. RK4
        leaves those of its last stage.
        """
        if self.model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4:
            mujoco.mj_forward(self.model, data)
            sample = self.site.sample(self.model, data)
            mujoco.mj_step(self.model, data)
            return sample
        before = data.qvel.copy()
        mujoco.mj_step(self.model, data)
        return self.site.sample(self.model, data, 0.5 * (before + data.qvel))

    def hold(self, force: float) -> Drift | None:
        """Return the drift under a force that rises to ``force`` [N or N m] and stays; None if the contact is lost."""
        record = self.run(self.duration, lambda t: force * min(1.0, t / (RISE * self.duration)))
        if record.touching < TOUCHING:
            return None
        limit, load, speed = (record.column(c)[len(record.samples) // 2 :].mean() for c in ("limit", "resistance", "velocity"))
        return Drift(float(load / limit) if limit > 0.0 else 0.0, float(speed))

    def break_away(self, carried: float, limit: float, mass: float) -> BreakAway | None:
        """Return the friction force that was reached when a rising load set the site in motion; None if it never did.

        In motion is a site that is faster than `EXCESS` of its limit would make its mass in the duration of a hold.

        Args:
            carried: friction force before any load [N or N m].
            limit: limit at rest [N or N m].
            mass: the mass that slides with the site [kg or kg m^2].
        """
        span = BREAK_AWAY_TIME * self.duration
        record = self.run(span, lambda t: (OVERLOAD * limit - carried) * t / span)
        moving = np.flatnonzero(record.column("velocity") > EXCESS * limit / mass * self.duration)
        if not len(moving):
            return None
        window = min(max(3, int(AVERAGED * len(record.samples))), moving[0] + 1)
        force = np.convolve(record.column("resistance")[: moving[0] + 1], np.ones(window) / window, "valid")
        first = int(np.argmax(force >= 0.98 * force.max())) + window // 2
        return BreakAway(float(force.max() / limit), float(record.integral("velocity")[first]))

    def slide(self, bare: Probe, limit: float, ratio: float) -> tuple[Slide | None, str]:
        """Return the deceleration by friction, or why there is none.

        The site is kicked, and the momentum of the kick's own motion is followed, (M unit) . qvel over the mass of it: a body
        that hops or pitches on the way keeps its sliding momentum.

        Args:
            bare: the same without the site's friction.
            limit: mean limit [N or N m].
            ratio: mu_k over mu_s [-].
        """
        data = started(self.model, self.state)
        sample = self.site.sample(self.model, data)
        if not sample.touching:
            return None, LOST
        unit, mass = kick(self.model, data, sample.row)
        if not np.isfinite(mass):
            return None, "other constraints forbid sliding"
        step = float(self.model.opt.timestep)
        rate = limit / mass
        speed = max(2.0 * SLIDE_STEPS * step * rate, SLIDE_SPEED)
        steps = int(np.clip(speed / (2.0 * rate * step), SLIDE_STEPS, MOST_SLIDE_STEPS))
        momentum = np.zeros(self.model.nv)
        mujoco.mj_mulM(self.model, data, momentum, unit)
        record, without = (p.run(steps * step, change=speed * unit) for p in (self, bare))
        with_it, alone = (np.array([(momentum / mass) @ v for v in r.velocities]) for r in (record, without))
        last = int(np.flatnonzero(with_it - with_it[0] > -0.9 * speed)[-1])
        if last < SLIDE_STEPS // 2:
            return None, "stops within a few steps"
        pressing = float(without.column("limit")[: last + 1].mean()) or limit
        lost = alone - with_it
        touching = float(record.column("touching")[: last + 1].mean())
        deceleration = (lost[last] - lost[FIRST_SLIDE_STEP]) / ((last - FIRST_SLIDE_STEP) * step)
        if record.touching < 0.5 or not without.samples[last].touching:
            why = LOST
        elif abs(pressing - limit) > UNSTEADY * limit:
            why = f"the normal force is {100.0 * pressing / limit:.0f} % of that at rest"
        else:
            why = "" if deceleration >= 0.0 else "the body's other motion outweighs friction"
        return None if why else Slide(float(deceleration), ratio * (pressing / mass), mass, touching), why
