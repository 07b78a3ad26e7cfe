"""Friction that remembers: the rate-and-state law with ageing, of a block pulled through a spring.

mu = mu_0 + a ln(v/v_0) + b ln(v_0 theta/D),  theta' = 1 - v theta/D (ageing) or -v theta/D ln(v theta/D) (slip)
or 1 - (v theta/(2 D))^2 (quadratic),  mu' = k (v_load_point - v).

References: Dieterich, J. Geophys. Res. 84, 1979, 2161-2168, doi 10.1029/JB084iB05p02161; Ruina, J. Geophys. Res. 88, 1983,
10359-10370, doi 10.1029/JB088iB12p10359; Perrin, Rice and Zheng, J. Mech. Phys. Solids 43, 1995, 1461-1495 (quadratic law).
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false

from __future__ import annotations

import numpy as np

from stochfric_mb.compile import compiled

AGEING, SLIP, QUADRATIC = 0, 1, 2
"""Laws of the state."""
SLOWEST = 1.0e-12
"""Least speed over the reference speed, and the inverse of the greatest: an unstable slip ends somewhere [-]."""
SUBSTEPS = 8
"""Steps of the integration in one sample."""


@compiled
def friction_path(speed, interval, direct, evolution, distance, stiffness, begin, reference_speed, state, mu):
    """Fill ``mu`` with the friction coefficient less mu_0 at each sample; it starts at the load point's speed.

    Each step is split into the spring at constant state and the ageing at constant speed, both solved exactly, so that no
    stiffness of spring or state limits the step.

    Args:
        speed: speed of the load point over the interval that follows each sample [m/s], shape (n,), > 0.
        interval: distance between samples [s].
        direct: a [-], > 0.
        evolution: b [-].
        distance: D [m], > 0.
        stiffness: k [1/m], > 0.
        begin: state at the start over that of steady sliding [-], > 0: what came before.
        reference_speed: v_0 [m/s], > 0.
        state: the state's law: `AGEING`, `SLIP` or `QUADRATIC`.
        mu: where the result goes, shape (n,).
    """
    h = interval / SUBSTEPS
    v = speed[0]
    theta = begin * (2.0 if state == QUADRATIC else 1.0) * distance / v
    for i in range(len(speed)):
        mu[i] = direct * np.log(v / reference_speed) + evolution * np.log(reference_speed * theta / distance)
        pull = speed[i]
        for _ in range(SUBSTEPS):
            # a d(ln v)/dt = k (pull - v): 1/v relaxes to 1/pull
            fade = np.exp(-stiffness * pull * h / direct)
            v = 1.0 / (1.0 / pull + (1.0 / v - 1.0 / pull) * fade)
            before = theta
            gone = np.exp(-v * h / distance)
            if state == SLIP:
                theta = distance / v * np.exp(np.log(v * theta / distance) * gone)
            elif state == QUADRATIC:
                share, rise = 0.5 * v * theta / distance, np.tanh(0.5 * v * h / distance)
                theta = 2.0 * distance / v * (share + rise) / (1.0 + share * rise)
            else:
                theta = distance / v + (theta - distance / v) * gone
            v *= np.exp(min(max(-evolution / direct * np.log(theta / before), -20.0), 20.0))
            v = min(max(v, SLOWEST * reference_speed), reference_speed / SLOWEST)
