"""Planned runs of a spring slider: its load point steps between two speeds; how large must each law be to be named?

Friction of the stated model is constant. The score of a law is n ln(1 + x) less its cost, where x is the mean square of what
the law adds to constant friction over that of the noise: discovery's own score, for the law that is there.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.inference.noise import independent_count
from stochfric_mb.discovery.planning.planned_run import PlannedRun
from stochfric_mb.discovery.planning.rig_plan import Further, Part, RigPlan
from stochfric_mb.discovery.planning.signature import BEYOND, Signature, missed_share
from stochfric_mb.discovery.velocity_step.laws import Law, Track, laws
from stochfric_mb.discovery.velocity_step.velocity_steps import track_of
from stochfric_mb.effects import kind_with_signature
from stochfric_mb.effects.traits import MEMORY, MORE_DAMPING, RATE, SLOPE_IN_DISTANCE
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.run import Run

Array = npt.NDArray[np.float64]

SHARE_OF_FRICTION = 1.0e-3
"""Noise of a friction coefficient of which nobody said how good it is, over its value [-]: a load cell's resolution."""
SHARE_OF_STEP = 0.1
"""Distance that friction remembers over the distance slid at the slow speed between two steps [-]: the transient ends."""
FEWEST_STEPS = 2.0
"""Steps up and down below which a run says too little [-]."""
SIZES = (1.0e-8, 1.0)
"""Least and largest change of a friction coefficient that is tried as a limit [-]."""
NONE_LEFT = 1.0e-6
"""Share of the evidence below which another law explains all of it [-]: rounding."""
NUDGE = 1.0e-3
"""Step of the numbers of a law by which its columns are taken, over their natural steps [-]."""


@dataclasses.dataclass(frozen=True)
class LawSignature(Signature):
    """What a law adds to constant friction."""

    cost: float = 0.0
    """What its numbers and starts take off its score [-]."""
    independent: float = math.inf
    """Independent samples [-]."""


@dataclasses.dataclass(frozen=True)
class StepPlan(RigPlan):
    """Planned runs of a spring slider."""

    shown = ("force_noise", "slow_speed", "fast_speed", "period")

    def part(self, run: PlannedRun, seed: int) -> Part:
        """Return a planned run, simulated.

        Raises:
            InputError: no two speeds are planned, or too few steps between them.
        """
        slow, fast, period = run.slow_speed, run.fast_speed, run.period
        if slow is None or fast is None or period is None or slow >= fast:
            raise InputError(
                f"{run.name}: friction that remembers shows in steps of the speed; plan two speeds, and the time of a step up "
                "and one down, such as --run slow_speed=1e-6,fast_speed=1e-5,period=100,duration=400"
            )
        if run.duration < FEWEST_STEPS * period:
            raise InputError(
                f"{run.name}: {run.duration:g} s are {run.duration / period:.3g} steps up and down; plan "
                f"{FEWEST_STEPS * period:g} s or more"
            )
        if run.stroke is not None or run.settings:
            raise InputError(f"{run.name}: at a spring slider plan slow_speed, fast_speed, period, duration and noise")
        stated = run.with_noise(0.0, SHARE_OF_FRICTION * self._friction)
        return Part(stated, self._measured(stated, slow, fast, period, seed))

    def signatures(self, parts: Sequence[Part]) -> tuple[list[LawSignature], dict[str, str]]:
        """Return what the laws would leave in some runs; none of them is out of sight where the speed steps."""
        data = self.records(*(p.measured for p in parts))
        tracks = [track_of(run, data) for run in data.runs]
        reference = float(np.median(tracks[0].speed))
        shortest = 2.0 * min(float(np.median(t.speed)) * t.run.sample_interval for t in tracks)
        way = float(np.ptp(np.concatenate([t.slid for t in tracks])))
        known = laws(reference, self.scenario.mechanism.stiffness, self.scenario.law.mu_k, shortest, way)
        rest = [t.friction - float(np.mean(t.friction)) for t in tracks]
        study = _Study(
            tracks,
            known,
            math.log(self.scenario.mechanism.stiffness),
            noise=float(np.sqrt(np.mean(np.concatenate(rest) ** 2))),
            independent=max(sum(independent_count(r) for r in rest), 4.0),
        )
        distance = SHARE_OF_STEP * min(0.5 * (p.run.period or 0.0) * (p.run.slow_speed or 0.0) for p in parts)
        return _signatures(study, max(distance, shortest)), {}

    def apart(self, true: LawSignature, other: Sequence[LawSignature]) -> float:
        """Return the size over its limit from which on a law is distinguished from another one; inf: at no size.

        Laws are of one class where their scores differ by less than `TIE`; a richer one must take away more, too, `BEYOND`.
        """
        return max((_apart(true, form) for form in other), default=1.0)

    def further(self, first: PlannedRun) -> list[Further]:
        """Return runs that may be added: a faster speed, more time between steps, a quieter load cell."""
        fast, period = first.fast_speed or 1.0, first.period or 1.0
        quiet = 0.5 * (first.force_noise or SHARE_OF_FRICTION * self._friction)
        longer = {"period": 5.0 * period, "duration": 5.0 * first.duration}
        return [
            (f"a run with ten times the fast speed, {10.0 * fast:.3g} m/s", {"fast_speed": 10.0 * fast}),
            (f"a run five times as long between the steps, period = {5.0 * period:.3g} s", longer),
            (f"a run with a load cell of noise {quiet:.3g}", {"force_noise": quiet}),
        ]

    @property
    def _friction(self) -> float:
        """Stated friction [N]."""
        return self.scenario.law.mu_k * self.scenario.mechanism.normal_force

    def _measured(self, run: PlannedRun, slow: float, fast: float, period: float, seed: int) -> Run:
        """Return the load point's way and a constant friction coefficient, with noise."""
        generator, time = np.random.default_rng(seed), run.time
        speed = np.where(np.mod(time, period) < 0.5 * period, slow, fast)
        position = np.concatenate([[0.0], np.cumsum(speed)[:-1]]) / run.sample_rate
        position = position + (run.noise or 0.0) * generator.standard_normal(len(time))
        noise = (run.force_noise or 0.0) / self.scenario.mechanism.normal_force
        friction = self.scenario.law.mu_k + noise * generator.standard_normal(len(time))
        return run.record({"position": position}, {"friction_coefficient": friction})


@dataclasses.dataclass(frozen=True)
class _Study:
    """Records of the stated model, and the laws that are fitted to them."""

    tracks: Sequence[Track]
    known: Sequence[Law]
    log_stiffness: float
    """Logarithm of the stated stiffness [1/m]."""
    noise: float
    """Standard deviation of the friction coefficient's noise [-]."""
    independent: float
    """Independent samples [-]."""

    def law(self, kind: str, variant: str = "") -> Law:
        return next(law for law in self.known if law.kind == kind and law.variant == variant)

    def added(self, law: Law, values: Sequence[float]) -> Array:
        """Return what a law adds to constant friction, its mean taken out, shape (rows,)."""
        added = np.concatenate(law.predict(self.tracks, np.array(values)))
        return added - float(np.mean(added))

    def columns(self, law: Law, values: Sequence[float]) -> Array:
        """Return what each number of a law but mu_0 changes, shape (rows, numbers - 1)."""
        at = np.array(values)
        steps = NUDGE * np.diag([n.scale for n in law.numbers])[1:]
        return np.stack([self.added(law, at + s) - self.added(law, at - s) for s in steps], axis=1)


def _signatures(study: _Study, distance: float) -> list[LawSignature]:
    """Return the signature of each law, the numbers of memory at a distance [m] that the steps leave time for."""
    drift, speed = study.law(kind_with_signature(SLOPE_IN_DISTANCE)), study.law(kind_with_signature(RATE))
    pulled, memory = study.law(kind_with_signature(RATE), "through the spring"), study.law(kind_with_signature(MEMORY))
    mu, stiffness = drift.starts[0][0], study.log_stiffness

    def remembering(size: float) -> Sequence[float]:
        return (mu, 0.0, size, size, math.log(distance), stiffness, 0.0)

    slope = study.columns(drift, (mu, 0.0))
    slow = study.columns(speed, (mu, 0.0, 0.0))
    signatures = [_at_limit(study, drift, drift.kind, ("slope", "1/m"), lambda s: (mu, s), slope, None)]
    for kind, sign in ((kind_with_signature(RATE), -1.0), (kind_with_signature(MORE_DAMPING), 1.0)):
        size = ("a_minus_b", "-")
        one = _at_limit(study, speed, kind, size, lambda s, sign=sign: (mu, 0.0, sign * s), slow[:, ::-1] * sign, slope)
        signatures.append(one)
        if one is not None:
            # pulled through the spring, it follows the steps late: a form that memory may be taken for
            late = study.columns(pulled, (mu, 0.0, max(one.limit, SIZES[0]), stiffness))[:, ::-1] * sign
            signatures.append(dataclasses.replace(one, limit=math.inf, columns=late))
    size = ("evolution_effect", "-")
    one = _at_limit(study, memory, memory.kind, size, remembering, None, slope, {"distance": distance})
    if one is not None:
        at = remembering(one.limit)
        one = dataclasses.replace(one, columns=study.columns(memory, at))
    return [s for s in (*signatures, one) if s is not None]


def _at_limit(
    study: _Study,
    law: Law,
    kind: str,
    size: tuple[str, str],
    numbers: Callable[[float], Sequence[float]],
    columns: Array | None,
    simpler: Array | None,
    beside: Mapping[str, float] | None = None,
) -> LawSignature | None:
    """Return a law at its limit; None: at no size.

    Its score must reach that of a name, and it must take away more than `MATERIAL` beyond the ``simpler`` law.
    """
    cost = (len(law.numbers) - 1) * math.log(study.independent) + 2.0 * math.log(len(law.starts))
    share = math.expm1((criteria.NAMED + cost) / study.independent)
    basis = None if simpler is None else np.linalg.qr(simpler)[0]

    def surplus(log_size: float) -> float:
        added = study.added(law, numbers(math.exp(log_size))) / study.noise
        left = added if basis is None else added - basis @ (basis.T @ added)
        clear = float(np.mean(left**2)) / BEYOND if basis is not None else math.inf
        return math.log(max(min(float(np.mean(added**2)) / share, clear), 1.0e-300))

    scale = (1.0 / float(np.ptp(study.tracks[0].slid))) if size[1] == "1/m" else 1.0
    low, high = (math.log(scale * s) for s in SIZES)
    if surplus(high) < 0.0:
        return None
    limit = math.exp(float(brentq(surplus, low, high)))  # pyright: ignore[reportArgumentType]  # a number, without full_output
    signal = study.added(law, numbers(limit)) / study.noise
    fitted = np.zeros((len(signal), 0)) if columns is None else columns
    return LawSignature(
        kind, size[0], size[1], limit, beside or {}, (signal,), fitted, cost=cost, independent=study.independent
    )


def _apart(true: LawSignature, form: LawSignature) -> float:
    share = math.expm1(max(criteria.TIE + true.cost - form.cost, 0.0) / true.independent)
    if true.cost > form.cost:
        share = max(share, BEYOND)
    missed = missed_share(true, form)
    if share == 0.0:
        return 1.0
    return max(math.sqrt(share / (missed * np.mean(true.signals[0] ** 2))), 1.0) if missed > NONE_LEFT else math.inf
