"""The friction law differs with speed, with dwell, or remembers."""

from collections.abc import Callable

import numpy as np

from tests.discovery.generator.curve import Array, Curve, tabulate
from tests.discovery.generator.machine import Machine
from tests.discovery.generator.rig import Rig

from .form import Effect, Generator, form

_FASTEST = 1.0  # m/s, far above any slip of the rig
_USUAL_DWELL = 0.9  # s: ageing leaves mu_s at its nominal value here


def _with(parameters: dict[str, float], **fields: Curve | float) -> Effect:
    """An effect that only replaces fields of the machine."""

    def alter(machine: Machine, rng: Generator) -> Machine:
        del rng
        return machine._replace(**fields)

    return Effect(parameters, alter)


def _over_speed(parameters: dict[str, float], factor: Callable[[Array], Array], rig: Rig) -> Effect:
    """mu_k times a factor over speed, scaled so that its mean over the rig's slip is the nominal one."""
    usual = np.sin(np.linspace(0.0, np.pi, 200)) * rig.slip_speed
    level = float(np.mean(factor(usual)))
    return _with(parameters, sliding=tabulate(lambda v: factor(np.maximum(v, 0.0)) / level, 0.0, _FASTEST, 20001))


def _weakening(excess: float, scale: float, shape: Callable[[Array], Array], rig: Rig) -> Effect:
    return _over_speed({"excess": excess, "speed_scale": scale}, lambda v: 1.0 + excess * shape(v / scale), rig)


@form("velocity_weakening")
def exponential(rng: Generator, strength: float, rig: Rig) -> Effect:
    return _weakening(0.5 * strength, rig.slip_speed * rng.uniform(0.2, 0.5), lambda r: np.exp(-r), rig)


@form("velocity_weakening")
def rational(rng: Generator, strength: float, rig: Rig) -> Effect:
    return _weakening(0.6 * strength, rig.slip_speed * rng.uniform(0.15, 0.4), lambda r: 1.0 / (1.0 + r), rig)


@form("velocity_weakening")
def power(rng: Generator, strength: float, rig: Rig) -> Effect:
    exponent = rng.uniform(0.5, 0.9)
    return _weakening(0.6 * strength, rig.slip_speed * rng.uniform(0.1, 0.3), lambda r: (1.0 + r) ** -exponent, rig)


@form("velocity_weakening")
def logarithmic(rng: Generator, strength: float, rig: Rig) -> Effect:
    return _weakening(0.4 * strength, rig.slip_speed * rng.uniform(0.15, 0.3), lambda r: 1.0 - 0.35 * np.log1p(r), rig)


@form("viscous_friction")
def proportional(rng: Generator, strength: float, rig: Rig) -> Effect:
    rise = strength * rng.uniform(0.25, 0.35)
    return _over_speed({"rise": rise}, lambda v: 1.0 + rise * v / rig.slip_speed, rig)


@form("viscous_friction")
def sublinear(rng: Generator, strength: float, rig: Rig) -> Effect:
    rise, exponent = 0.3 * strength, rng.uniform(0.65, 0.85)
    return _over_speed({"rise": rise, "exponent": exponent}, lambda v: 1.0 + rise * (v / rig.slip_speed) ** exponent, rig)


@form("viscous_friction")
def thinning(rng: Generator, strength: float, rig: Rig) -> Effect:
    """A lubricant whose shear stress flattens out."""
    rise, scale = 0.4 * strength, rig.slip_speed * rng.uniform(0.8, 1.5)
    return _over_speed({"rise": rise, "speed_scale": scale}, lambda v: 1.0 + rise * np.arctan(v / scale), rig)


def _over_dwell(parameters: dict[str, float], factor: Callable[[Array], Array]) -> Effect:
    """mu_s times a factor over dwell, 1 at the usual dwell and never below 0.7: mu_s stays above mu_k."""
    usual = float(factor(np.array(_USUAL_DWELL)))
    curve = tabulate(lambda log_dwell: np.maximum(factor(np.exp(log_dwell)) / usual, 0.7), np.log(1e-3), np.log(100.0), 2001)
    return _with(parameters, ageing=curve)


@form("dwell_ageing")
def log_of_dwell(rng: Generator, strength: float, rig: Rig) -> Effect:
    del rig
    rate, cut_off = 0.07 * strength, rng.uniform(0.02, 0.1)
    return _over_dwell({"rate": rate, "cut_off": cut_off}, lambda dwell: 1.0 + rate * np.log1p(dwell / cut_off))


@form("dwell_ageing")
def power_of_dwell(rng: Generator, strength: float, rig: Rig) -> Effect:
    del rig
    exponent = strength * rng.uniform(0.08, 0.12)
    return _over_dwell({"exponent": exponent}, lambda dwell: dwell**exponent)


@form("dwell_ageing")
def saturating(rng: Generator, strength: float, rig: Rig) -> Effect:
    del rig
    loss, time = 0.25 * strength, rng.uniform(0.4, 0.9)
    return _over_dwell({"loss": loss, "time": time}, lambda dwell: 1.0 - loss * np.exp(-dwell / time))


@form("frictional_lag")
def slip_distance(rng: Generator, strength: float, rig: Rig) -> Effect:
    """mu falls from mu_s to mu_k over a distance, exponentially."""
    length = rig.slip_length * strength * rng.uniform(0.08, 0.12)
    curve = tabulate(lambda d: np.exp(-np.maximum(d, 0.0) / length), 0.0, 0.05, 50001)
    return _with({"length": length}, memory_of_distance=curve)


@form("frictional_lag")
def linear_slip_weakening(rng: Generator, strength: float, rig: Rig) -> Effect:
    """mu falls from mu_s to mu_k linearly with distance, as in earthquake models."""
    length = rig.slip_length * strength * rng.uniform(0.15, 0.25)
    return _with(
        {"length": length}, memory_of_distance=tabulate(lambda d: np.clip(1.0 - d / length, 0.0, 1.0), 0.0, 0.05, 50001)
    )


@form("frictional_lag")
def relaxation(rng: Generator, strength: float, rig: Rig) -> Effect:
    """mu falls from mu_s to mu_k over a time."""
    time = 0.03 * strength * rng.uniform(0.8, 1.2) * np.sqrt(rig.mass / rig.stiffness) / 0.0392
    curve = tabulate(lambda t: np.exp(-np.maximum(t, 0.0) / time), 0.0, 5.0, 50001)
    return _with({"time": float(time)}, memory_of_time=curve)
