"""What a controller is asked to follow: strokes of several lengths and speeds, or sums of sines."""

import numpy as np

from .plant import Array

Generator = np.random.Generator


def strokes(rng: Generator, times: Array, reach: float, speed: float) -> tuple[Array, Array]:
    """Strokes between random places: position and velocity over times, rests of up to 0.3 s between them.

    Each is a minimum-jerk path (Flash and Hogan 1985); its top speed, 1.875 times its mean, is 0.15 to 1 times `speed`.
    """
    q, v = np.zeros_like(times), np.zeros_like(times)
    t, here, side = times[0], 0.0, 1.0
    while t < times[-1]:
        there = side * reach * rng.uniform(0.35, 1.0)
        lasts = 1.875 * abs(there - here) / (speed * rng.uniform(0.15, 1.0))
        s = np.clip((times - t) / lasts, 0.0, 1.0)
        inside = times >= t
        q[inside] = (here + (there - here) * (10 * s**3 - 15 * s**4 + 6 * s**5))[inside]
        v[inside] = ((there - here) / lasts * (30 * s**2 - 60 * s**3 + 30 * s**4))[inside]
        t, here, side = t + lasts + rng.uniform(0.0, 0.3), there, -side
    return q, v


def sines(rng: Generator, times: Array, reach: float, speed: float) -> tuple[Array, Array]:
    """Three sines whose amplitudes sum to `reach`, and whose speeds do to about `speed`."""
    shares = np.array([0.62, 0.26, 0.12]) * rng.uniform(0.85, 1.15, 3)
    ratios = np.array([1.0, rng.uniform(2.3, 2.9), rng.uniform(4.1, 5.3)])
    omega = speed / (reach * np.sum(shares * ratios)) * ratios
    phases = rng.uniform(0.0, 2.0 * np.pi, 3)
    angle = np.outer(times, omega) + phases
    return reach * np.sin(angle) @ shares, reach * np.cos(angle) @ (shares * omega)


MOTIONS = {"strokes": strokes, "sines": sines}
