"""Closed-form motions of the belt-box oscillator, in plain mathematics: no code of the package computes them."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from stochfric_mb.mechanisms import BeltBox

Array = npt.NDArray[np.float64]


def linear_motion(m: BeltBox, x: float, v: float, *, force: float = 0.0) -> Callable[[Array], tuple[Array, Array]]:
    """Return t -> (position [m], velocity [m/s]) of m x'' + c x' + k x = force + k u_0 cos(W t) from (x, v) at t = 0.

    Complex amplitudes: the forced part is Re(X exp(i W t)) with X = k u_0/(k - m W^2 + i c W), the free part decays at
    c/(2 m) with sqrt(k/m - (c/2m)^2); damping below critical.
    """
    w = m.excitation_angular_frequency
    forced = m.stiffness * m.excitation_amplitude / complex(m.stiffness - m.mass * w * w, m.damping * w)
    decay = m.damping / (2.0 * m.mass)
    rate = complex(-decay, math.sqrt(m.stiffness / m.mass - decay * decay))
    rest = force / m.stiffness
    x_free, v_free = x - rest - forced.real, v - (1j * w * forced).real
    free = complex(x_free, (decay * x_free + v_free) / -rate.imag)

    def motion(t: Array) -> tuple[Array, Array]:
        a, b = forced * np.exp(1j * w * t), free * np.exp(rate * t)
        return rest + (a + b).real, (1j * w * a + rate * b).real

    return motion


def sliding_stop(m: BeltBox, mu_k: float) -> tuple[float, float]:
    """Return when [s] and where [m] a box that starts at x = 0 with v > 0 on a belt at rest first stops (no damping).

    x'' = -omega^2 (x + d), d = mu_k N/k: a circle around -d in the plane of (x, v/omega).
    """
    omega, d = math.sqrt(m.stiffness / m.mass), mu_k * m.normal_force / m.stiffness
    swing = m.initial_velocity / omega
    return math.atan2(swing, d) / omega, math.hypot(d, swing) - d


def coulomb_decay(m: BeltBox, mu: float, t: Array) -> Array:
    """Return the position [m] of a box released at x_0 > 0 on a belt at rest, with mu_s = mu_k = mu and no damping.

    Each half swing is a cosine around +-d, d = mu N/k; the amplitude falls by 2 d per half swing until abs(x) <= d.
    """
    omega, d = math.sqrt(m.stiffness / m.mass), mu * m.normal_force / m.stiffness
    out = np.empty_like(t)
    for i, now in enumerate(t):
        start, side, n = m.initial_position, 1.0, 0
        while abs(start) > d and now * omega >= (n + 1) * math.pi:
            start, side, n = -start + 2.0 * side * d, -side, n + 1
        out[i] = start if abs(start) <= d else side * d + (start - side * d) * math.cos(omega * now - n * math.pi)
    return out


def load_time(m: BeltBox, force: float) -> float:
    """Return when [s] the slow load k u_0 (1 - cos(W t)) on a box held at x = u_0 has grown to ``force`` [N]."""
    return math.acos(1.0 - force / (m.stiffness * m.excitation_amplitude)) / m.excitation_angular_frequency


def coulomb_cycle(m: BeltBox, mu_s: float, mu_k: float) -> tuple[float, float, float]:
    """Return period [s], highest and lowest position [m] of the stick-slip cycle with constant belt velocity.

    Stuck, x grows at v_b up to (mu_s N - c v_b)/k. Sliding is the damped motion from there until x' = v_b again, found by
    bisection of the closed form; it overshoots by about v_b^2 m/(2 (mu_s - mu_k) N) at the top and at the bottom.
    """
    v_b = m.belt_velocity
    top = (mu_s * m.normal_force - m.damping * v_b) / m.stiffness
    motion = linear_motion(m, top, v_b, force=mu_k * m.normal_force)
    half_turn = math.pi / math.sqrt(m.stiffness / m.mass - (m.damping / (2.0 * m.mass)) ** 2)
    low, high = half_turn, 2.0 * half_turn  # after half a turn the box moves against the belt's direction no more
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if motion(np.array([middle]))[1][0] < v_b else (low, middle)
    x, _ = motion(np.linspace(0.0, low, 100_001))  # a parabola between points 1 us apart: to 1e-12 m
    return low + (top - float(x[-1])) / v_b, float(np.max(x)), float(np.min(x))
