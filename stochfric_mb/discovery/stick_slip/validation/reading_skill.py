"""The gap in the readings themselves: held-out samples that stray, and a position against a velocity that was measured with it.

Forecasts of a whole cycle show neither: a stray reading is one of thousands, and a forecast that starts late ends late.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery.inference.noise import white_noise
from stochfric_mb.discovery.result import Gap
from stochfric_mb.discovery.stick_slip.decision.kinematics import VELOCITY_WINDOW
from stochfric_mb.discovery.stick_slip.records.record import Array, Record
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.effects import Effect
from stochfric_mb.effects.traits import LATE, STRAY
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.smoothing import smooth, window

AROUND = np.array([-1.0, 4.0, 0.0, 4.0, -1.0]) / 6.0
"""What the four readings around one say of it: a cubic through them."""
WIDE = 8.0
"""Standard deviations of the wider part over which a mixture is integrated [-]: beyond lie 1e-15 of it."""


def reading_gap(model: Model, study: Study, held_out: Sequence[Record]) -> Gap | None:
    """Return the gap in the readings of held-out runs; None where the first effect is no fault that single readings show.

    Args:
        model: the augmented model.
        study: what the fit runs show.
        held_out: the held-out runs, cleaned.
    """
    if not held_out or not model.effects:
        return None
    first = model.effects[0]
    if STRAY in first.signatures:
        return _of_stray(first, study.records, held_out)
    if LATE in first.signatures and model.measured:
        return _of_late(model.late, study.dataset, held_out)
    return None


def _of_stray(effect: Effect, seen: Sequence[Record], held_out: Sequence[Record]) -> Gap:
    """Return minus the mean log likelihood of held-out readings, given those around them, in units of their noise [-].

    The noise is normal; a share of the readings strays by a normal error beside it (Tukey 1960), as many and as far as in the
    fit runs. The score is proper (Good 1952): strays that come more often, or further off, than those cost what they should.
    """
    calm = np.concatenate([_from_around(r)[~r.outlier[2:-2]] for r in seen])
    noise = max(float(np.sqrt(np.mean(calm**2))), 1.0e-300)
    share, wide = (float(getattr(effect, name)) for name in ("fraction", "size"))
    spread = float(np.hypot(1.0, wide / noise))
    x = np.concatenate([_from_around(r) for r in held_out]) / noise
    before, after = float(np.mean(_surprise(x, 0.0, spread))), float(np.mean(_surprise(x, share, spread)))
    # the expected score of the mixture under itself; fine about 0 and wide beyond
    grid = np.sinh(np.linspace(-1.0, 1.0, 4001) * np.arcsinh(WIDE * spread))
    each = _surprise(grid, share, spread)
    floor = float(np.trapezoid(np.exp(-each) * each, grid))
    source = "what readings score on average if as many stray, and as far, as in the fit runs"
    return Gap("log_score_readings", "-", True, before, before, after, min(floor, after), source)


def _surprise(x: Array, share: float, spread: float) -> Array:
    """Return minus the log density of readings over their noise, some of which stray, shape as ``x``."""
    calm = -0.5 * x**2 + np.log(max(1.0 - share, 1.0e-300))
    stray = -0.5 * (x / spread) ** 2 + np.log(max(share, 1.0e-300) / spread)
    return 0.5 * np.log(2.0 * np.pi) - (calm if share == 0.0 else np.logaddexp(calm, stray))


def _from_around(record: Record) -> Array:
    """Return how far each reading is from what the cleaned ones around it say [m], shape (n - 4,)."""
    return record.raw[2:-2] - np.convolve(record.position, AROUND, mode="valid")


def _of_late(late: float, dataset: Dataset, held_out: Sequence[Record]) -> Gap | None:
    """Return how far held-out velocities are from the rate of the position [m/s], rms, both through one window."""
    velocities = {r.name: r.channels["velocity"] for r in dataset.test if "velocity" in r.channels}
    errors: list[Array] = []
    noises: list[float] = []
    for record in held_out:
        if record.name not in velocities:
            continue
        interval, width = 1.0 / record.rate, VELOCITY_WINDOW / record.angular_frequency
        velocity = record.direction * velocities[record.name]
        rate = smooth(record.position, width, interval, derivative=1)
        edge = int(np.ceil((width + abs(late)) / interval)) + 2
        pair = [smooth(velocity, width, interval, shift=shift) - rate for shift in (0.0, late)]
        errors.append(np.stack(pair)[:, edge:-edge])
        taps = (window(width, interval), window(width, interval, derivative=1))
        white = (white_noise(velocity), white_noise(record.position))
        noises += [sum(float(np.sum(t**2)) * s**2 for t, s in zip(taps, white, strict=True))]
    if not errors:
        return None
    before, after = np.sqrt(np.mean(np.concatenate(errors, axis=1) ** 2, axis=1))
    source = "white noise of position and velocity, through the same window"
    return Gap(
        "velocity_of_position", "m/s", True, float(before), float(before), float(after),
        min(float(np.sqrt(np.mean(noises))), float(after)), source,
    )  # fmt: skip
