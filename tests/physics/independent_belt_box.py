"""A belt-box with effects, written a second time: SciPy's solve_ivp with events, one mode after the other, no numba.

Forms are written out here as the docstrings of the effects state them; nothing is shared with the package but their
parameters.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
from scipy.integrate import solve_ivp

TOLERANCE = {"rtol": 1.0e-10, "atol": 1.0e-13, "method": "DOP853", "max_step": 5.0e-3}


@dataclasses.dataclass
class Box:
    m: float = 6.08
    c: float = 0.768
    k: float = 3956.0
    N: float = 13.0
    vb: float = 2.5e-3
    mu_s: float = 0.8
    mu_k: float = 0.46
    terms: dict = dataclasses.field(default_factory=dict)

    def get(self, kind):
        return self.terms.get(kind)

    def belt(self, t):
        """Velocity, acceleration, travel."""
        v, a, u = self.vb, 0.0, self.vb * t
        if e := self.get("belt_speed_ripple"):
            w = 2 * math.pi * e["frequency"]
            v += self.vb * e["amplitude"] * math.cos(w * t + e["phase"])
            a -= self.vb * e["amplitude"] * w * math.sin(w * t + e["phase"])
            u += self.vb * e["amplitude"] / w * (math.sin(w * t + e["phase"]) - math.sin(e["phase"]))
        return v, a, u

    def normal(self, t):
        e = self.get("normal_load_ripple")
        return self.N * (1 + e["amplitude"] * math.cos(2 * math.pi * e["frequency"] * t + e["phase"])) if e else self.N

    def force(self, t, x, v, q, w):
        """Everything on the box but friction."""
        f = -self.k * x - self.c * v
        if e := self.get("nonlinear_stiffness"):
            square, cube, end = e.get("quadratic", 0.0), e["cubic"], math.copysign(min(abs(x), e.get("reach", math.inf)), x)
            f -= square * end * abs(end) + cube * end**3 + (2 * square * abs(end) + 3 * cube * end**2) * (x - end)
        if e := self.get("quadratic_damping"):
            f -= e["coefficient"] * v * abs(v)
        if e := self.get("backlash"):
            over = x - e["position"]
            f += self.k * (0.0 if over < 0 else over if over < e["gap"] else e["gap"])
            f -= self.k * e.get("share_below", 0.0) * e["gap"]
        if e := self.get("harmonic_force"):
            f += e["amplitude"] * math.cos(2 * math.pi * e["frequency"] * t + e["phase"])
        if e := self.get("position_dependent_force"):
            away = x - e["zero"]
            f -= e["stiffness"] * away + e["cubic"] * away**3
            f += e["amplitude"] * math.cos(2 * math.pi * x / e["wavelength"] + e["phase"])
            f += e["amplitude_2"] * math.cos(4 * math.pi * x / e["wavelength"] + e["phase_2"])
        if e := self.get("second_mode"):
            big = 2 * math.pi * e["frequency"]
            f += e["mass_ratio"] * self.m * (big**2 * (q - x) + 2 * e["damping_ratio"] * big * (w - v))
        return f

    def oscillator(self, x, v, q, w):
        e = self.get("second_mode")
        if not e:
            return 0.0
        big = 2 * math.pi * e["frequency"]
        return -(big**2) * (q - x) - 2 * e["damping_ratio"] * big * (w - v)

    def factor(self, t, x, travel, side):
        g = 1.0
        if e := self.get("position_dependent_friction"):
            s = travel - x if e["axis"] == "belt" else x
            for h, (a, p) in enumerate([("amplitude", "phase"), ("amplitude_2", "phase_2"), ("amplitude_3", "phase_3")], 1):
                if e[a]:
                    if h == 1:
                        base = g
                        total = 0.0
                    total += e[a] * math.cos(2 * math.pi * h * s / e["wavelength"] + e[p])
            g = base * (1.0 + total)
        if e := self.get("friction_drift"):
            tau = e["time_constant"]
            g *= 1 + e["rate"] * (t if math.isinf(tau) else tau * (1 - math.exp(-t / tau)))
        if e := self.get("distance_drift"):  # the box never overtakes the belt, so that all of the way is one way
            far = e["settling_distance"]
            g *= 1 + e["rate"] * far * (1 - math.exp(-abs(travel - x) / far))
        if e := self.get("direction_asymmetry"):
            g *= 1 + e["asymmetry"] * (side < 0)
        if e := self.get("load_dependence"):
            load, stuck = self.normal(t), e.get("adhesion", 0.0)
            g *= (load / e["reference_load"]) ** e["exponent"] * (1 + stuck / load) / (1 + stuck / e["reference_load"])
        return g

    def table(self, s):
        """Broken line through seven even knots."""
        e = self.terms["unnamed"]
        knots = np.linspace(e["low"], e["high"], 7)
        return float(np.interp(s, knots, [0.0] + [e[f"change_{i}"] for i in range(1, 7)]))

    def static(self, t, x, travel, side, dwell):
        mu_s = self.mu_s
        if e := self.get("unnamed"):
            mu_s += e["static_share"] * self.table(x)
        if e := self.get("dwell_ageing"):
            mu_s += e["rate"] * math.log(1 + dwell / e["time_constant"])
        return mu_s * self.factor(t, x, travel, side)

    def kinetic(self, t, x, v, travel, side, slip, dwell, slip_time):
        speed = max(side * (self.belt(t)[0] - v), 0.0)
        mu_k = self.mu_k
        if self.get("unnamed"):
            mu_k += self.table(x)
        if e := self.get("velocity_weakening"):
            away = (speed / e["decay_velocity"]) ** e.get("shape_exponent", 1.0)
            mu_k += e["amplitude"] * ((1.0 + e["tail"] * away) ** (-1.0 / e["tail"]) if "tail" in e else math.exp(-away))
        if e := self.get("frictional_lag"):
            mu_s = self.static(t, x, travel, side, dwell) / self.factor(t, x, travel, side)
            mu_k += (mu_s - mu_k) * math.exp(-slip / e.get("distance", math.inf) - slip_time / e.get("time_constant", math.inf))
        extra = self.get("viscous_friction")["coefficient"] * speed if self.get("viscous_friction") else 0.0
        if e := self.get("direction_asymmetry"):
            extra -= side * e.get("viscous_difference", 0.0) / 2 * speed
        return mu_k * self.factor(t, x, travel, side) * self.normal(t) + extra


def simulate(box: Box, times: np.ndarray) -> np.ndarray:
    """Return positions at ``times`` from a start at rest at x = 0, belt running, box at x' = 0 (sliding)."""
    t, y = 0.0, np.array([0.0, 0.0, 0.0, 0.0])  # x, v, q, w
    stuck, side, dwell, since, broke = False, math.copysign(1.0, box.vb), 0.0, 0.0, 0.0
    out = np.empty(len(times))
    done = 0
    while done < len(times):
        travel0 = box.belt(t)[2]
        if stuck:
            x_stuck = y[0]

            def ride(s, x_stuck=x_stuck, travel0=travel0):
                return x_stuck + box.belt(s)[2] - travel0

            def rates(s, z, ride=ride):
                v = box.belt(s)[0]
                return [0.0, 0.0, z[3], box.oscillator(ride(s), v, z[2], z[3])]

            def needed(s, z, ride=ride):
                v, a, _ = box.belt(s)
                return box.m * a - box.force(s, ride(s), v, z[2], z[3])

            def event(s, z, ride=ride, needed=needed, since=since):
                hold = needed(s, z)
                limit = box.static(s, ride(s), box.belt(s)[2], math.copysign(1.0, hold), s - since)
                return limit * box.normal(s) - abs(hold)
        else:

            def rates(s, z, side=side, dwell=dwell, broke=broke, begun=t):
                travel = box.belt(s)[2]
                f = side * box.kinetic(s, z[0], z[1], travel, side, abs(travel - z[0] - broke), dwell, s - begun)
                return [z[1], (f + box.force(s, *z)) / box.m, z[3], box.oscillator(*z)]

            def event(s, z, side=side, t=t):
                return side * (box.belt(s)[0] - z[1]) if s > t + 1e-9 else 1.0

        event.terminal, event.direction = True, -1
        r = solve_ivp(rates, (t, times[-1]), y, events=event, dense_output=True, **TOLERANCE)
        end = r.t[-1]
        while done < len(times) and times[done] <= end + 1e-12:
            s = min(times[done], end)
            out[done] = ride(s) if stuck else r.sol(s)[0]
            done += 1
        if done == len(times):
            break
        t, y = end, r.y[:, -1].copy()
        v, _, travel = box.belt(t)
        if stuck:
            y[0], y[1] = ride(t), v
            side = math.copysign(1.0, needed(t, y))
            stuck, dwell, broke = False, t - since, travel - y[0]
        else:
            y[1] = v
            a = box.belt(t)[1]
            hold = box.m * a - box.force(t, *y)
            assert abs(hold) <= box.static(t, y[0], travel, math.copysign(1.0, hold), 0.0) * box.normal(t)
            stuck, since = True, t
    return out
