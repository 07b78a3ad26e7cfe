"""The reference against a second method: each law's automaton in plain Python, integrated by SciPy.

Nothing here calls a law module. The equations are those of the laws' docstrings; the random coefficients are read at
the knots only, and the integration restarts there and at every switch. SciPy finds a switch on its dense output, the
reference by bisection on the step size, and memory laws are integrated with different formulas (LSODA).
"""

import dataclasses
import itertools
import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stochfric_mb import (
    BeltBox,
    CoefficientPath,
    Coulomb,
    Dahl,
    ElasticStick,
    Havsin,
    Karnopp,
    Knots,
    Lugre,
    PerEvent,
    PiecewiseLinear,
    Smooth,
    Spatial,
    Stribeck,
    Tanh,
)
from stochfric_mb.reference import solve

TABLE_1 = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
TABLE_2 = BeltBox(
    mass=5.632,
    damping=0.768,
    stiffness=5610.0,
    normal_force=14.0,
    belt_velocity=1.0e-3,
    excitation_amplitude=0.5e-3,
    excitation_angular_frequency=18.7,
)
KNOTS = Knots(sigma_s=0.015, sigma_k=0.023, spacing=0.01)
TOLERANCE = 1.0e-9
"""[m] The accuracy that the reference claims; both methods run at 1e-12 of their scales a step."""
EVENT_TOLERANCE = 1.0e-9
"""[s] A switch is a zero of a force or velocity that passes it at 1 N/s or 1 m/s^2 or faster, of an error of 1e-11."""
VELOCITY_TOLERANCE = 1.0e-8
"""[m/s] An event 1e-8 s off (1e-9 m at 0.1 m/s) changes the velocity by that times an acceleration of about 1 m/s^2."""


@dataclasses.dataclass
class Exit:
    """A way out of a mode: ``slack`` is positive inside, ``leave`` gives the next mode and y."""

    slack: Callable
    leave: Callable


class Automaton:
    """Modes of a law on a belt-box: y = (x, v, z); mu = (mu_s, mu_k) at t, and their rates."""

    def __init__(self, box, law):
        self.box, self.law = box, law
        self.N, self.vb = box.normal_force, box.belt_velocity

    def hold(self, t, y):
        b = self.box
        return (
            b.damping * y[1]
            + b.stiffness * y[0]
            - b.stiffness * b.excitation_amplitude * math.cos(b.excitation_angular_frequency * t)
        )

    def w(self, y):
        return self.vb - y[1]

    def stuck(self, mode):
        return mode in (0.0, (0, 0)) or (isinstance(mode, tuple) and mode[0] in ("stick", "pressed"))

    def move(self, t, y, force, dz=0.0):
        return [y[1], (force - self.hold(t, y)) / self.box.mass, dz]


class TrueStick(Automaton):
    """Coulomb and Stribeck: mode 0 stuck, +-1 sliding."""

    def mu(self, speed, mu_s, mu_k):
        law = self.law
        if law.kind == "coulomb":
            return mu_k
        r = max(speed, 0.0) / law.stribeck_velocity
        return (
            mu_k
            + (mu_s - mu_k)
            * {"exponential": math.exp(-r), "gaussian": math.exp(-r * r), "lorentzian": 1 / (1 + r * r)}[law.form]
        )

    def first(self, t, y, mu):
        return self.at_rest(t, y, mu) if self.w(y) == 0.0 else (math.copysign(1.0, self.w(y)), y)

    def at_rest(self, t, y, mu):
        y = [y[0], self.vb, 0.0]
        h = self.hold(t, y)
        return (0.0 if abs(h) <= mu[0] * self.N else math.copysign(1.0, h)), y

    def rates(self, mode, t, y, mu):
        if mode == 0.0:
            return [self.vb, 0.0, 0.0]
        return self.move(t, y, mode * self.mu(mode * self.w(y), *mu[:2]) * self.N)

    def exits(self, mode):
        if mode == 0.0:
            return [
                Exit(lambda t, y, mu, s=s: mu[0] * self.N - s * self.hold(t, y), lambda t, y, mu, s=s: (s, y))
                for s in (1.0, -1.0)
            ]
        return [Exit(lambda t, y, mu: mode * self.w(y), self.at_rest)]


class Zone(Automaton):
    """Karnopp: mode (0, 0) stuck, (1, s) in the zone, (2, s) outside."""

    def first(self, t, y, mu):
        return ((2, math.copysign(1.0, self.w(y))), y) if abs(self.w(y)) > self.law.v_s else self.enter(t, y, mu)

    def enter(self, t, y, mu):
        h = self.hold(t, y)
        return ((1, math.copysign(1.0, h)), y) if abs(h) > mu[0] * self.N else self.stop(t, y, mu)

    def stop(self, t, y, mu):
        return (0, 0), [y[0], self.vb, 0.0]

    def rates(self, mode, t, y, mu):
        if mode[0] == 0:
            return [self.vb, 0.0, 0.0]
        return self.move(t, y, mode[1] * self.N * (mu[0] if mode[0] == 1 else mu[1]))

    def exits(self, mode):
        s = mode[1]
        if mode[0] == 0:
            return [
                Exit(lambda t, y, mu, s=s: mu[0] * self.N - s * self.hold(t, y), lambda t, y, mu, s=s: ((1, s), y))
                for s in (1.0, -1.0)
            ]
        if mode[0] == 1:
            return [
                Exit(lambda t, y, mu: self.law.v_s - s * self.w(y), lambda t, y, mu: ((2, s), y)),
                Exit(lambda t, y, mu: self.law.v_s + s * self.w(y), lambda t, y, mu: ((2, -s), y)),
                Exit(lambda t, y, mu: s * self.hold(t, y) - mu[0] * self.N, self.stop),
            ]
        return [Exit(lambda t, y, mu: s * self.w(y) - self.law.v_s, self.enter)]


class Elastic(Automaton):
    """Elastic stick: ("stick", 0), ("pressed", s) with z on its limit, ("peak", s), ("slip", s)."""

    def __init__(self, box, law):
        super().__init__(box, law)
        self.k = law.mu_s * self.N / law.e_lim
        self.c = 2.0 * law.zeta * math.sqrt(self.k * box.mass)

    def first(self, t, y, mu):
        w = self.w(y)
        return (("slip", math.copysign(1.0, w)), y) if abs(w) > self.law.v_s else (("stick", 0.0), [y[0], y[1], 0.0])

    def rates(self, mode, t, y, mu):
        what, s = mode
        w, cap = self.w(y), mu[0] * self.N
        if what == "stick":
            return self.move(t, y, min(max(self.k * y[2] + self.c * w, -cap), cap), w)
        if what == "pressed":
            return self.move(t, y, s * min(cap, cap + s * self.c * w), s * mu[2] * self.N / self.k)
        fall = math.exp(-(max(s * w, self.law.v_s) - self.law.v_s) / self.law.decay_velocity) if what == "slip" else 1.0
        return self.move(t, y, s * self.N * (mu[1] + (mu[0] - mu[1]) * fall))

    def let_go(self, t, y, mu, s):
        if s * self.w(y) > 0.0:
            return ("slip" if s * self.w(y) > self.law.v_s else "peak", s), y
        return ("pressed", s), y

    def restick(self, t, y, mu, s):
        z = (s * mu[0] * self.N - self.c * self.w(y)) / self.k
        limit = mu[0] * self.N / self.k
        if s * z >= limit:
            return ("pressed", s), [y[0], y[1], s * limit]
        return ("stick", 0.0), [y[0], y[1], z]

    def exits(self, mode):
        what, s = mode
        if what == "stick":
            return [
                Exit(lambda t, y, mu, s=s: mu[0] * self.N / self.k - s * y[2], lambda t, y, mu, s=s: self.let_go(t, y, mu, s))
                for s in (1.0, -1.0)
            ]
        if what == "pressed":
            return [
                Exit(lambda t, y, mu: s * self.w(y) - mu[2] * self.N / self.k, lambda t, y, mu: (("stick", 0.0), y)),
                Exit(lambda t, y, mu: -s * self.w(y), lambda t, y, mu: self.let_go(t, y, mu, s)),
            ]
        back = Exit(
            lambda t, y, mu: s * self.w(y) - (self.law.v_s if what == "slip" else 0.0),
            lambda t, y, mu: self.restick(t, y, mu, s),
        )
        up = Exit(lambda t, y, mu: self.law.v_s - s * self.w(y), lambda t, y, mu: (("slip", s), y))
        return [back] if what == "slip" else [back, up]


class Memoryless(Automaton):
    """A coefficient that depends on velocity alone: no modes; error control takes care of kinks."""

    def first(self, t, y, mu):
        return None, y

    def rates(self, mode, t, y, mu):
        w = self.w(y)
        return self.move(t, y, math.copysign(self.curve(abs(w), *mu[:2]), w) * self.N)

    def exits(self, mode):
        return []

    def curve(self, v, mu_s, mu_k):
        law = self.law
        match law.kind:
            case "havsin":
                if v <= law.v_s:
                    return 0.5 * mu_s * (1.0 - math.cos(math.pi * v / law.v_s))
                if v <= law.v_d:
                    return mu_s + 0.5 * (mu_k - mu_s) * (1.0 - math.cos(math.pi * (v - law.v_s) / (law.v_d - law.v_s)))
                return mu_k
            case "piecewise_linear":
                return float(np.interp(v, [0.0, law.v_s, law.v_d], [0.0, mu_s, mu_k]))
            case "tanh":
                return mu_k * math.tanh(v / law.v_s)
            case "smooth":
                return 2.0 / math.pi * math.atan(v / law.v_s) * (mu_k + (mu_s - mu_k) / (1.0 + (v / law.v_d) ** 2))
        raise AssertionError(law.kind)


class Bristle(Memoryless):
    """Dahl and LuGre; faster than 0.1 mm/s, or than the Stribeck velocity, they start with the bristle of steady sliding."""

    def first(self, t, y, mu):
        law, w = self.law, self.w(y)
        if law.kind == "dahl":
            g, slow = mu[1], 1.0e-4
        else:
            g, slow = mu[1] + (mu[0] - mu[1]) * math.exp(-((w / law.stribeck_velocity) ** 2)), law.stribeck_velocity
        return None, [y[0], y[1], 0.0 if abs(w) <= slow else math.copysign(g / law.sigma_0, w)]

    def rates(self, mode, t, y, mu):
        law, w, z = self.law, self.w(y), y[2]
        if law.kind == "dahl":
            return self.move(t, y, law.sigma_0 * z * self.N, w - law.sigma_0 * abs(w) * z / mu[1])
        g = mu[1] + (mu[0] - mu[1]) * math.exp(-((w / law.stribeck_velocity) ** 2))
        rate = w - law.sigma_0 * abs(w) * z / g
        return self.move(t, y, (law.sigma_0 * z + law.sigma_1 * rate + law.sigma_2 * w) * self.N, rate)


AUTOMATA = {
    "coulomb": TrueStick,
    "stribeck": TrueStick,
    "karnopp": Zone,
    "elastic_stick": Elastic,
    "dahl": Bristle,
    "lugre": Bristle,
}


class InTime:
    """Coefficients of a path along time, linear between its knots."""

    def __init__(self, path, spacing, duration):
        self.spacing, self.pairs = spacing, path.pairs(round(duration / spacing) + 2)

    def __call__(self, start, t, y, sticks):
        knot = round(start / self.spacing)
        slope = (self.pairs[knot + 1] - self.pairs[knot]) / self.spacing
        pair = self.pairs[knot] + slope * (t - start)
        return (*pair, *slope)


class AlongBelt:
    """Coefficients of a path along u = v_b t - x."""

    def __init__(self, path, spacing, belt_velocity):
        self.spacing, self.belt_velocity, self.first = spacing, belt_velocity, -200
        self.pairs = path.pairs(600, self.first)

    def __call__(self, start, t, y, sticks):
        r = (self.belt_velocity * t - y[0]) / self.spacing - self.first
        knot = math.floor(r)
        slope = self.pairs[knot + 1] - self.pairs[knot]
        pair = self.pairs[knot] + slope * (r - knot)
        return (*pair, *(slope * (self.belt_velocity - y[1]) / self.spacing))


class PerStick:
    """One pair for each stick phase."""

    def __init__(self, path):
        self.pairs = path.pairs(50)

    def __call__(self, start, t, y, sticks):
        return (*self.pairs[sticks], 0.0, 0.0)


def independent(automaton, coefficients, times, *, formula="DOP853", max_step=2.0e-3):
    """Return y at ``times`` (shape (n, 3)), restarting at each; and the events."""
    y = [automaton.box.initial_position, automaton.box.initial_velocity, 0.0]
    sticks, switches = 0, []
    mode, y = automaton.first(0.0, y, coefficients(0.0, 0.0, y, 0))
    ys = [y]
    for start, end in itertools.pairwise(times):
        t = start
        while t < end:

            def mu(t, y, start=start, sticks=sticks):
                return coefficients(start, t, y, sticks)

            exits = automaton.exits(mode)
            events = [lambda t, y, e=e, mu=mu: e.slack(t, y, mu(t, y)) for e in exits]
            for event in events:
                event.terminal, event.direction = True, -1.0
            solution = solve_ivp(
                lambda t, y, mode=mode, mu=mu: automaton.rates(mode, t, y, mu(t, y)),
                (t, end),
                y,
                method=formula,
                rtol=1.0e-12,
                atol=[1.0e-15, 1.0e-14, 1.0e-17],
                max_step=max_step,
                events=events,
            )
            assert solution.success
            t, y = solution.t[-1], list(solution.y[:, -1])
            if solution.status == 1:
                which = next(i for i, result in enumerate(solution.t_events) if len(result))
                stuck = automaton.stuck(mode)
                mode, y = exits[which].leave(t, y, mu(t, y))
                sticks += automaton.stuck(mode) and not stuck
                if automaton.stuck(mode) != stuck:
                    switches.append((t, float(stuck)))
        ys.append(y)
    return np.array(ys), np.array(switches).reshape(-1, 2)


def compare(box, law, process, duration, *, seed=3, event_tolerance=EVENT_TOLERANCE, **options):
    """Assert agreement at every 10 ms and of the events; return the reference."""
    path = CoefficientPath(process, law, seed=seed)
    times = np.arange(round(duration / 0.01) + 1) * 0.01
    trajectory = solve(box, law, path, times, method="adaptive")
    match process:
        case Spatial():
            coefficients = AlongBelt(path, process.spacing, box.belt_velocity)
        case PerEvent():
            coefficients = PerStick(path)
        case _:
            coefficients = InTime(path, 0.01, duration)
    automaton = AUTOMATA.get(law.kind, Memoryless)(box, law)
    y, switches = independent(automaton, coefficients, times, **options)
    np.testing.assert_allclose(trajectory.position, y[:, 0], rtol=0.0, atol=TOLERANCE)
    np.testing.assert_allclose(trajectory.velocity, y[:, 1], rtol=0.0, atol=VELOCITY_TOLERANCE)
    if type(automaton) in (TrueStick, Zone, Elastic):
        np.testing.assert_array_equal(trajectory.events[:, 1], switches[:, 1])
        np.testing.assert_allclose(trajectory.events[:, 0], switches[:, 0], rtol=0.0, atol=event_tolerance)
    return trajectory


LAWS = {
    "coulomb": Coulomb(mu_s=0.8, mu_k=0.46),
    "elastic_stick": ElasticStick(mu_s=0.8, mu_k=0.46),
    "stribeck exponential": Stribeck(mu_s=0.8, mu_k=0.46),
    "stribeck gaussian": Stribeck(mu_s=0.8, mu_k=0.46, form="gaussian"),
    "stribeck lorentzian": Stribeck(mu_s=0.8, mu_k=0.46, form="lorentzian"),
    "karnopp": Karnopp(mu_s=0.8, mu_k=0.46),
    "dahl": Dahl(mu_s=0.8, mu_k=0.46),
    "lugre": Lugre(mu_s=0.8, mu_k=0.46),
    "havsin": Havsin(mu_s=0.8, mu_k=0.46),
    "piecewise_linear": PiecewiseLinear(mu_s=0.8, mu_k=0.46),
    "tanh": Tanh(mu_s=0.8, mu_k=0.46),
    "smooth": Smooth(mu_s=0.8, mu_k=0.46),
}
SMOOTH = {"dahl", "lugre", "havsin", "piecewise_linear", "tanh", "smooth"}


def test_every_law_is_compared():
    from stochfric_mb.laws import LAWS as KNOWN

    assert {law.kind for law in LAWS.values()} == {k for k, (module, _) in KNOWN.items() if module.startswith("stochfric_mb.")}


@pytest.mark.parametrize("name", LAWS)
def test_table_1_with_random_knots(name):
    options = {"formula": "LSODA"} if name in SMOOTH else {}
    trajectory = compare(TABLE_1, LAWS[name], KNOTS, 3.2, **options)
    # Three stick-slip cycles of 1.02 s fit into 3.2 s (tanh and dahl have no mu_s, hence no such cycle).
    assert len(trajectory.events) >= (4 if name in {"tanh", "dahl"} else 5)


@pytest.mark.parametrize("name", ["coulomb", "elastic_stick", "stribeck exponential", "karnopp"])
def test_table_2_with_excitation(name):
    law = dataclasses.replace(LAWS[name], mu_k=0.55)
    trajectory = compare(TABLE_2, law, KNOTS, 4.0)
    assert len(trajectory.events) >= 5


@pytest.mark.parametrize("name", LAWS)
def test_thrown_past_the_belt(name):
    # From 8 mm and 0.2 m/s the box overtakes the belt, turns and slides back: v_rel has both signs.
    box = dataclasses.replace(TABLE_1, initial_position=8.0e-3, initial_velocity=0.2)
    options = {"formula": "LSODA"} if name in SMOOTH else {}
    trajectory = compare(box, LAWS[name], KNOTS, 0.8, **options)
    w = box.belt_velocity - trajectory.velocity
    assert w.min() < -0.1
    assert w.max() > 0.1


@pytest.mark.parametrize("name", ["coulomb", "elastic_stick", "stribeck gaussian", "karnopp", "havsin", "lugre"])
def test_spatial_field(name):
    # Knots of 0.1 mm: a slip of 2 mm crosses twenty of them, the thrown box crosses some in both directions.
    box = dataclasses.replace(TABLE_1, initial_velocity=0.05)
    options = {"formula": "LSODA"} if name in SMOOTH else {"max_step": 5.0e-4}
    process = Spatial(sigma_s=0.015, sigma_k=0.023, spacing=1.0e-4)
    # A field of slope 400/m turns 1e-11 m in u into 5e-8 N, and break-away is approached at k v_b = 10 N/s: 5e-9 s.
    trajectory = compare(box, LAWS[name], process, 2.2, event_tolerance=1.0e-8, **options)
    u = box.belt_velocity * trajectory.time - trajectory.position
    assert np.ptp(u) > 20 * 1.0e-4
    assert np.diff(u).min() < -1.0e-4


@pytest.mark.parametrize("name", ["coulomb", "stribeck lorentzian", "karnopp"])
def test_per_event(name):
    trajectory = compare(TABLE_1, LAWS[name], PerEvent(sigma_s=0.015, sigma_k=0.023), 4.2)
    sticks = int(np.sum(trajectory.events[:, 1] == 0.0))
    assert sticks >= 4
    assert np.unique(trajectory.mu_s).size == sticks + 1
