"""What the nominal balance of forces leaves of a record once its numbers are corrected within their stated uncertainty.

A plain least-squares fit, so that a form can be said to be visible without asking the method that is judged: positions are
differentiated through a running polynomial of 50 ms (Savitzky and Golay 1964), and blocks of 50 ms in which the joint slides
one way count once each.
"""

import numpy as np
from scipy.signal import savgol_filter

from .bench import UNCERTAINTY, Bench
from .case import Made
from .forms.null import drives
from .forms.sensor import positions
from .plant import Array

_HALF, _BLOCK = 0.025, 0.05  # s


def _inertial(bench: Bench, q: list[Array], v: list[Array], a: list[Array]) -> tuple[Array, Array]:
    """Force that the links need, and that of the rotor, where the effect sits [N or N m]."""
    n = bench.numbers
    if bench.design != "arm":
        if "gravity" not in n:
            return n["inertia"] * a[0], 0.0 * a[0]
        return n["mass"] * n["length"] ** 2 * a[0] + n["gravity"] * np.sin(q[0]), n["rotor_part"] * a[0]
    c, s = np.cos(q[1]), np.sin(q[1])
    outer, both = n["gravity_2"] * np.sin(q[0] + q[1]), n["inertia_2"] + n["coupling"] * c
    if bench.place == 1:
        return n["inertia_2"] * a[1] + both * a[0] + n["coupling"] * s * v[0] ** 2 + outer, n["rotor_2"] * a[1]
    first = (n["inertia"] + both + n["coupling"] * c) * a[0] + both * a[1]
    whirl = n["coupling"] * s * (2.0 * v[0] * v[1] + v[1] ** 2)
    return first - whirl + n["gravity"] * np.sin(q[0]) + outer, n["rotor"] * a[0]


def _blocks(made: Made, run: int) -> tuple[Array, Array]:
    """Residual of each block, and its change by one standard deviation of each number."""
    b, record = made.nominal, made.record(run)
    rate = 1.0 / float(np.median(np.diff(record["time [s]"])))
    window = 2 * max(3, round(_HALF * rate)) + 1
    q, v, a = (
        [savgol_filter(record[name], window, 4, deriv=k, delta=1.0 / rate) for name in positions(record)] for k in range(3)
    )
    place = b.place if b.design == "arm" else 0
    links, rotor = _inertial(b, q, v, a)
    side, drag = np.sign(v[place]), b.numbers["damping"] * v[place]
    drive = savgol_filter(record[drives(record)[place]], window, 4) * b.gain
    residual = drive - links - rotor - b.level * side - drag
    if b.pressures:
        residual = residual - b.numbers["area"] * record["pressure [Pa]"]
    u = UNCERTAINTY
    numbers = [links * u["mass"], rotor * u["inertia"], b.level * side * u["mu"], drag * u["damping"], b.offset_sd + 0.0 * side]
    size = max(1, round(_BLOCK * rate))
    n = side.size // size

    def mean(x: Array) -> Array:
        return x[: n * size].reshape(n, size).mean(axis=1)

    quick = mean(1.0 * (np.abs(v[place]) > 0.1 * b.speed)) == 1.0
    quick[:1], quick[-1:] = False, False
    kept = quick & (np.abs(mean(side)) == 1.0)
    return mean(residual)[kept], np.stack([mean(x)[kept] for x in numbers], axis=1)


def misfit(made: Made, noise: float) -> float:
    """Least sum of squares over all runs to fit, of residuals in units of `noise` [N or N m] and corrections in theirs."""
    blocks = [_blocks(made, i) for i, role in enumerate(made.roles) if role == "fit"]
    residual, numbers = (np.concatenate(parts) / noise for parts in zip(*blocks, strict=True))
    rows = np.vstack([numbers, np.eye(numbers.shape[1])])
    target = np.concatenate([residual, np.zeros(numbers.shape[1])])
    left = target - rows @ np.linalg.lstsq(rows, target, rcond=None)[0]
    return float(left @ left)
