"""What each effect would leave in the slips: regressors for the screening, one or more hypotheses an effect.

A hypothesis is a small set of columns (see `Pool.column`); parameters that enter nonlinearly are laid out on a grid,
one hypothesis a grid point. The columns are the first-order change of the onset force and of the friction force in the
slip when the effect is switched on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from stochfric_mb.discovery.oscillator import oscillator_pull
from stochfric_mb.discovery.pool import Pool
from stochfric_mb.discovery.record import Array
from stochfric_mb.effects import effect_class, effect_kinds
from stochfric_mb.effects.marks import Columns, Hypothesis


def velocity_weakening(pool: Pool) -> list[Hypothesis]:
    """Return N exp(-v/v_w) in the slip, for decay velocities v_w about the belt's and the slips'."""
    speed = pool.relative_velocity
    load = pool.normal_force[:, None]
    fastest = float(np.median(speed.max(axis=1)))
    return [
        Hypothesis(
            "velocity_weakening",
            [pool.column(None, load * np.exp(-speed / decay))],
            (decay,),
            lambda b, d=decay: {"amplitude": float(b[0]), "decay_velocity": float(d)},
        )
        for decay in fastest * np.array([0.05, 0.1, 0.2, 0.4, 0.8])
    ]


def viscous_friction(pool: Pool) -> list[Hypothesis]:
    """Return the relative velocity in the slip, linear or levelling off, proportional to the load or not."""
    speed = pool.relative_velocity
    fastest = float(np.median(speed.max(axis=1)))
    reference = float(pool.normal_force[0])
    found: list[Hypothesis] = []
    loads = [(np.ones(len(pool.run)), 0.0)]
    if np.ptp(pool.normal_force) > 0.05 * reference:
        loads.append((pool.normal_force / reference, reference))
    for load, name in loads:
        more = {"reference_load": name} if name else {}
        # a start that levels off beyond the fastest slip: a fit can find either end from there
        linear = lambda b, more=more: more | {"coefficient": 1.3 * float(b[0]), "saturation_velocity": 1.5 * fastest}  # noqa: E731
        found.append(Hypothesis("viscous_friction", [pool.column(None, speed * load[:, None])], (), linear))
        for knee in fastest * np.array([0.15, 0.4]):
            curved = lambda b, v=knee, more=more: more | {"coefficient": float(b[0]), "saturation_velocity": float(v)}  # noqa: E731
            columns = [pool.column(None, -knee * np.expm1(-speed / knee) * load[:, None])]
            found.append(Hypothesis("viscous_friction", columns, (knee,), curved))
    return found


def frictional_lag(pool: Pool) -> list[Hypothesis]:
    """Return friction that falls with the distance slipped since the break-away, or with the time."""
    gap = np.maximum(pool.static - pool.kinetic, 0.02 * pool.static)[:, None]
    found: list[Hypothesis] = []
    for name, since, shares in (
        ("distance", pool.slip_distance, (0.007, 0.014, 0.028, 0.056, 0.11, 0.22)),
        ("time_constant", pool.node_time - pool.onset_time[:, None], (0.03, 0.06, 0.12, 0.24)),
    ):
        whole = float(np.median(since.max(axis=1)))
        for scale in whole * np.array(shares):
            start = lambda b, name=name, scale=scale: {name: float(scale * np.clip(b[0], 0.2, 3.0))}  # noqa: E731
            columns = [pool.column(None, gap * np.exp(-since / scale))]
            found.append(Hypothesis("frictional_lag", columns, (scale,), start, variant=name))
    return found


def dwell_ageing(pool: Pool) -> list[Hypothesis]:
    """Return N ln(1 + dwell/tau) at the onset, where the dwell differs enough between slips to show it."""
    if np.std(np.log(pool.dwell)) < 0.08:
        return []
    return [
        Hypothesis(
            "dwell_ageing",
            [pool.column(pool.normal_force * np.log1p(pool.dwell / tau), None)],
            (tau,),
            lambda b, tau=tau: {"rate": float(b[0]), "time_constant": float(tau)},
        )
        for tau in (0.03, 0.1, 0.3, 1.0)
    ]


def _apart(
    kind: str, static: Array, kinetic: Array, pool: Pool, name: str, more: dict[str, float], unit: float = 1.0
) -> list[Hypothesis]:
    """Return a change of both coefficients by the same share, and one of each by its own.

    Args:
        kind: the effect.
        static: change of the onset force for a unit of the parameter [N], shape (n,).
        kinetic: change of the force in slip [N], shape (n,).
        pool: the slips.
        name: the parameter.
        more: further parameters.
        unit: parameter for a coefficient of one.
    """

    def alike(b: Array) -> dict[str, float]:
        return more | {name: float(b[0] * unit)}

    def each(b: Array) -> dict[str, float]:
        kinetic_share = b[1] if abs(b[1]) > 0.01 * abs(b[0]) else 0.01 * abs(b[0]) + 1.0e-9
        return more | {name: float(kinetic_share * unit), "static_share": float(b[0] / kinetic_share)}

    return [
        Hypothesis(kind, [pool.column(static, kinetic)], (), alike),
        Hypothesis(kind, [pool.column(static, None), pool.column(None, kinetic)], (), each),
    ]


def direction_asymmetry(pool: Pool) -> list[Hypothesis]:
    """Return the share of the runs with a reversed belt."""
    if len(set(pool.direction)) < 2:
        return []
    back = (pool.direction < 0).astype(np.float64)
    return _apart("direction_asymmetry", pool.static * back, pool.kinetic * back, pool, "asymmetry", {})


def load_dependence(pool: Pool) -> list[Hypothesis]:
    """Return ln(N/N_0) times the friction, where the load differs between runs."""
    if np.ptp(pool.normal_force) < 0.05 * pool.normal_force.mean():
        return []
    reference = float(pool.normal_force[0])
    change = np.log(pool.normal_force / reference)
    more = {"reference_load": reference}
    return _apart("load_dependence", pool.static * change, pool.kinetic * change, pool, "exponent", more)[:1]


def nonlinear_stiffness(pool: Pool) -> list[Hypothesis]:
    """Return -x^3, and -x|x| with it, in stick and slip, along the typical slip; the stiffness at rest is left open."""
    onset, position = pool.typical_onset, pool.typical_position
    scale = float(np.median(np.abs(onset)))
    stiffness = pool.per_run(lambda s: s.record.mechanism.stiffness)
    linear = pool.column(-onset * stiffness, -position * stiffness[:, None])
    # sides of the spring, not of the mirrored record: both parts are odd, so that a mirrored run looks the same
    square, cube = (
        pool.column(-np.sign(onset) * np.abs(onset / scale) ** n, -np.sign(position) * np.abs(position / scale) ** n)
        for n in (2, 3)
    )

    def start(b: Array) -> dict[str, float]:
        more = {"quadratic": float(b[2] / scale**2)} if len(b) > 2 else {}
        return {"cubic": float(b[0] / scale**3), "stiffness": float(b[1])} | more

    return [
        Hypothesis("nonlinear_stiffness", [cube, linear], (), start),
        Hypothesis("nonlinear_stiffness", [cube, linear, square], (), start),
    ]


def quadratic_damping(pool: Pool) -> list[Hypothesis]:
    """Return -x'|x'|."""
    velocity = pool.node_velocity
    columns = [pool.column(-(pool.belt_velocity**2), -velocity * np.abs(velocity))]
    return [Hypothesis("quadratic_damping", columns, (), lambda b: {"coefficient": float(b[0])})]


def backlash(pool: Pool) -> list[Hypothesis]:
    """Return the spring force that a narrow dead zone takes away, for places of the zone along the slip.

    Where directions or loads differ, so does the friction that a shift of the whole spring would look like: the side of
    the gap on which the spring counts as unloaded is then left open.
    """
    width = 0.02 * float(np.median(pool.typical_onset))
    if width <= 0.0:
        return []
    stiffness = pool.per_run(lambda s: s.record.mechanism.stiffness)
    back = pool.direction < 0
    low, high = np.quantile(pool.typical_position, (0.08, 0.92))
    places = list(np.linspace(low, high, 16))
    if back.any():
        places += list(-np.linspace(low, high, 16) - width)
    shift = pool.column(*(2 * [-pool.direction * stiffness * width]))
    shifted = back.any() or np.ptp(pool.normal_force) > 0.05 * pool.normal_force.mean()

    def passed(x: Array, place: float) -> Array:
        """Return how much of the gap is passed, seen in the mirrored frame of runs with a reversed belt."""
        away = back if x.ndim == 1 else back[:, None]
        return np.where(away, np.clip(x + place + width, 0.0, width) - width, np.clip(x - place, 0.0, width))

    def start(b: Array, place: float) -> dict[str, float]:
        found = {"gap": float(abs(b[0]) * width), "position": place}
        return found | ({"share_below": float(np.clip(b[1] / b[0], 0.05, 0.95))} if len(b) > 1 and b[0] != 0.0 else {})

    found: list[Hypothesis] = []
    for place in map(float, places):
        nodes = stiffness[:, None] * passed(pool.typical_position, place)
        columns = [pool.column(stiffness * passed(pool.typical_onset, place), nodes)]
        columns += [shift] if shifted else []
        found.append(Hypothesis("backlash", columns, (place,), lambda b, place=place: start(b, place)))
    return found


def second_mode(pool: Pool) -> list[Hypothesis]:
    """Return the force of a light oscillator on the box, driven by the slips; what was weighed with the box is left open."""
    natural = pool.slips[0].record.angular_frequency / (2.0 * np.pi)
    mass = pool.per_run(lambda s: s.record.mechanism.mass)
    inertia = pool.column(None, -mass[:, None] * pool.node_acceleration)
    found: list[Hypothesis] = []
    for frequency in natural * np.geomspace(1.5, 7.0, 100):
        for ratio in (0.01, 0.03, 0.1):
            onset, nodes = oscillator_pull(pool, frequency, ratio)

            def start(b: Array, frequency: float = frequency, ratio: float = ratio) -> dict[str, float]:
                share = float(np.clip(b[0], 0.005, 0.9))
                return {"mass_ratio": share, "frequency": frequency, "damping_ratio": ratio, "mass": float(b[1])}

            columns = [pool.column(mass * onset, mass[:, None] * nodes), inertia]
            found.append(Hypothesis("second_mode", columns, (frequency, ratio), start))
    return found


def friction_drift(pool: Pool) -> list[Hypothesis]:
    """Return friction that drifts in each run: linearly, or towards a limit."""
    last, middle = pool.duration, pool.mean_time
    found = _apart(
        "friction_drift", pool.static * pool.onset_time / last, pool.kinetic * middle / last, pool, "rate", {}, 1.0 / last
    )
    # neighbours differ by a fifth: a coarser grid would leave a clear record to what names no physics
    for share in np.geomspace(0.03, 1.0, 22):
        tau = float(share * last)
        static, kinetic = (level * -np.expm1(-t / tau) for level, t in ((pool.static, pool.onset_time), (pool.kinetic, middle)))
        found += _apart("friction_drift", static, kinetic, pool, "rate", {"time_constant": tau}, 1.0 / tau)
    return found


def sensor_drift(pool: Pool) -> list[Hypothesis]:
    """Return k times a drift of the position, the same in stick and slip."""
    last = pool.duration
    stiffness = pool.per_run(lambda s: s.record.mechanism.stiffness)

    def start(b: Array) -> dict[str, float]:
        return {"rate": float(b[0] / last)}

    shapes: list[Callable[[Array], Array]] = [lambda t: t / last, lambda t: np.sqrt(np.maximum(t, 0.0) / last)]
    return [
        Hypothesis(
            "sensor_drift",
            [pool.column(pool.direction * stiffness * s(pool.onset_time), pool.direction * stiffness * s(pool.mean_time))],
            (),
            start,
        )
        for s in shapes
    ]


def sensor_delay(pool: Pool) -> list[Hypothesis]:
    """Return minus the rate of the known force, where there is one: a late record compares with a force that has moved on."""
    if not any(s.record.mechanism.excitation_amplitude for s in pool.slips):
        return []
    onset = np.zeros(len(pool.run))
    nodes = np.zeros_like(pool.node_time)
    for run, slips in enumerate(pool.slips):
        mine = pool.run == run
        box = slips.record.mechanism
        w = box.excitation_angular_frequency
        scale = box.stiffness * box.excitation_amplitude * w
        onset[mine] = scale * np.sin(w * pool.onset_time[mine])
        nodes[mine] = scale * np.sin(w * pool.node_time[mine])
    return [Hypothesis("sensor_delay", [pool.column(onset, nodes)], (), lambda b: {"delay": float(b[0])})]


SCREENS: dict[str, Callable[[Pool], list[Hypothesis]]] = {
    screen.__name__: screen
    for screen in (
        velocity_weakening, viscous_friction, frictional_lag, dwell_ageing, direction_asymmetry, load_dependence,
        nonlinear_stiffness, quadratic_damping, backlash, second_mode, friction_drift, sensor_drift, sensor_delay,
    )
}  # fmt: skip
"""Kind of effect -> its hypotheses for a pool; for periodic effects see `waves`."""


def screens() -> dict[str, Callable[[Pool], list[Hypothesis]]]:
    """Return kind of effect -> its hypotheses for a pool, effects of installed packages included."""
    return SCREENS | {kind: effect_class(kind).hypotheses for kind in effect_kinds() if kind not in SCREENS}


def step_times(pool: Pool) -> Array:
    """Return the times at which a step is looked for [s]."""
    return np.arange(0.08 * pool.duration, 0.94 * pool.duration, max(1.0, pool.duration / 80.0))


def steps(pool: Pool, run: int, *, multiplied: bool) -> list[Array]:
    """Return columns of a step of one run's friction (``multiplied``) or of its position sensor, one a time of `step_times`."""
    mine = pool.run == run
    stiffness = pool.per_run(lambda s: s.record.mechanism.stiffness)
    static, kinetic = (pool.static, pool.kinetic) if multiplied else (stiffness * pool.direction,) * 2
    return [pool.column(static * (pool.onset_time > t) * mine, kinetic * (pool.mean_time > t) * mine) for t in step_times(pool)]


def competitors(pool: Pool) -> dict[str, tuple[str, Sequence[Array]]]:
    """Return regressors that name no physics: if one of them wins, the answer is "unknown".

    Returns:
        Name -> (axis on which the disagreement lives, columns).
    """
    n = len(pool.run)
    load = pool.normal_force
    found: dict[str, tuple[str, Sequence[Array]]] = {}
    shape: Columns = []
    for q in range(1, pool.features.shape[1] - 1):
        column = np.zeros_like(pool.features)
        column[:, 1 + q] = load
        shape.append(column)
    found["slip_shape"] = ("shape of the friction force within a slip", shape)
    alternating = np.concatenate([(-1.0) ** np.arange(len(s)) for s in pool.slips])
    runs = [pool.run == r for r in range(pool.n_runs)]
    found["parity"] = (
        "alternates from slip to slip",
        [pool.column(pool.static * alternating * r, None) for r in runs]
        + [pool.column(None, pool.kinetic * alternating * r) for r in runs],
    )
    knots = np.linspace(0.0, pool.duration, 8)
    hats = [np.clip(1.0 - np.abs(t - k) / knots[1], 0.0, 1.0) for k in knots[1:] for t in (pool.onset_time, pool.mean_time)]
    found["time"] = (
        "time within the run",
        [pool.column(h * r, None) for h in hats[0::2] for r in runs]
        + [pool.column(None, h * r) for h in hats[1::2] for r in runs],
    )
    low, high = np.quantile(pool.typical_position, (0.02, 0.98))
    places = np.linspace(low, high, 10)
    width = places[1] - places[0]
    found["time_common"] = (
        "time within the run",
        [pool.column(h, None) for h in hats[0::2]] + [pool.column(None, h) for h in hats[1::2]],
    )
    found["position"] = (
        "position of the box",
        [
            pool.column(
                np.clip(1.0 - np.abs(pool.typical_onset - p) / width, 0.0, 1.0),
                np.clip(1.0 - np.abs(pool.typical_position - p) / width, 0.0, 1.0),
            )
            for p in places[1:-1]
        ],
    )
    assert all(c.shape[0] == n for _, columns in found.values() for c in columns)
    return found
