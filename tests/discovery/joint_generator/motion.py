"""What a controller is asked to follow: strokes of several lengths and speeds, or sums of sines; sweeps, ramps and series."""

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


def ramps(rng: Generator, times: Array, reach: float, speed: float) -> tuple[Array, Array]:
    """Strokes of trapezoidal velocity, a quarter to speed up, one to slow down (Biagiotti and Melchiorri 2008, section 3.2)."""
    q, v = np.zeros_like(times), np.zeros_like(times)
    t, here, side = times[0], 0.0, 1.0
    while t < times[-1]:
        there = side * reach * rng.uniform(0.5, 1.0)
        top = speed * rng.uniform(0.25, 1.0)
        lasts = abs(there - here) / (0.75 * top)
        s = np.clip((times - t) / lasts, 0.0, 1.0)
        inside = times >= t
        v[inside] = (np.sign(there - here) * top * np.clip(4.0 * np.minimum(s, 1.0 - s), 0.0, 1.0))[inside]
        rising, falling = np.minimum(s, 0.25), np.minimum(1.0 - s, 0.25)
        share = 2.0 * rising**2 + np.clip(s - 0.25, 0.0, 0.5) + np.where(s > 0.75, 0.125 - 2.0 * falling**2, 0.0)
        q[inside] = (here + (there - here) * share / 0.75)[inside]
        t, here, side = t + lasts + rng.uniform(0.0, 0.2), there, -side
    return q, v


def sweep(rng: Generator, times: Array, reach: float, speed: float) -> tuple[Array, Array]:
    """A sine whose frequency rises fourfold and whose top speed stays (Pintelon and Schoukens 2012, section 5.3)."""
    s = (times - times[0]) / (times[-1] - times[0])
    rate = 1.2 * speed / reach * 4.0 ** (s - 0.6)
    phase = rng.uniform(0.0, 2.0 * np.pi) + np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(times))])
    size = np.minimum(reach, speed / rate)
    return size * np.sin(phase), np.gradient(size * np.sin(phase), times)


def series(rng: Generator, times: Array, reach: float, speed: float) -> tuple[Array, Array]:
    """A finite Fourier series of five harmonics, the same period in every run (Swevers and others 1997)."""
    k = np.arange(1.0, 6.0)
    sizes = rng.standard_normal((2, 5)) / k
    base = 0.45 * speed / reach
    angle = np.outer(times, base * k)
    q = np.cos(angle) @ sizes[0] + np.sin(angle) @ sizes[1]
    v = np.cos(angle) @ (sizes[1] * base * k) - np.sin(angle) @ (sizes[0] * base * k)
    factor = min(reach / np.abs(q).max(), speed / np.abs(v).max())
    return factor * q, factor * v


MOTIONS = {"strokes": strokes, "sines": sines, "ramps": ramps, "sweep": sweep, "series": series}
"""The first two are drawn by rigs; a form asks for the others."""
