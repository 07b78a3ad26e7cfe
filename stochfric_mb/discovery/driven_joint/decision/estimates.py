"""The numbers of a result, with their units and 95 % intervals."""

from __future__ import annotations

import dataclasses

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.fit.fitting import prior_weight
from stochfric_mb.discovery.driven_joint.fit.profiles import profile
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.discovery.inference.free_parameter import FreeParameter
from stochfric_mb.discovery.inference.intervals import confidence_interval
from stochfric_mb.discovery.result import Interval
from stochfric_mb.effects.shapes.course import Shaped
from stochfric_mb.effects.shapes.splines import PIECES

LEAST_WAVE = 1.0e-3
"""Shortest wavelength that is tried, over the fitted one [-]: there is none of length 0."""
ROTATIONAL = {
    "N": "N m", "m": "rad", "m/s": "rad/s", "N s/m": "N m s/rad", "N s^2/m^2": "N m s^2/rad^2",
    "N/m": "N m/rad", "N/m^3": "N m/rad^3", "1/m": "1/rad", "1/m^2": "1/rad^2", "kg": "kg m^2",
}  # fmt: skip
"""Unit of a parameter where friction acts along a line -> where it acts about an axis."""
FACTORS = {
    "mass": "mass_factor", "armature": "armature_factor", "gain": "drive_factor", "damping": "damping_factor",
    "offset": "drive_offset",
}  # fmt: skip
"""Correction of a named joint -> its name in the result, where the scenario's own numbers are tables of joints."""


def unit_at(straight: str, unit_of_friction: str) -> str:
    """Return the unit of a parameter at a place, its unit along a line and the unit of friction there [N or N m] given."""
    return ROTATIONAL.get(straight, straight) if unit_of_friction == "N m" else straight


def parameters(place: PlaceOutcome, owner: int) -> dict[str, Interval]:
    """Return the numbers of an effect of the final model at a place, its ``owner``-th, with their intervals."""
    fit = place.selected.final
    effect = fit.model.effects[owner]
    intervals: dict[str, Interval] = {}
    shape: tuple[str, ...] = ()
    if isinstance(effect, Shaped) and effect.any_shape:  # augmented.toml has its weights
        intervals[effect.course_size] = _course_size(place, owner, effect)
        shape = effect.course_size, *effect.shaped_by
    for field in dataclasses.fields(effect):
        if field.name in shape:
            continue
        unit = unit_at(str(field.metadata.get("unit", "-")), place.fit[0].unit)
        value = getattr(effect, field.name)
        own = any((kind, name) == (effect.kind, field.name) for kind, _, name in fit.model.own)
        if own or not isinstance(value, int | float) or not np.isfinite(value):
            continue
        deviation = fit.deviation(owner, field.name)
        if deviation < 1.0e-6 * abs(value):  # not known that well: nothing in these data depends on it
            continue
        if np.isfinite(deviation):
            intervals[field.name] = confidence_interval(value, deviation, unit, field.metadata["low"], field.metadata["high"])
        elif value != field.default:
            intervals[field.name] = Interval(value, value, value, unit)
    # the numbers of a wave trade off against each other where it is longer than the stroke
    if (
        hasattr(effect, "wavelength")
        and "amplitude" in intervals
        and intervals["amplitude"].low <= 0.0 <= intervals["amplitude"].high
    ):
        intervals |= _profiled(place, owner, intervals)
    return intervals


def _course_size(place: PlaceOutcome, owner: int, effect: Shaped) -> Interval:
    """Return the largest change along a course of any shape, which is linear in the numbers fitted."""
    fit = place.selected.final
    along = np.linspace(0.0, 1.0, 20 * PIECES + 1)
    course = effect.shape(along)
    most = int(np.argmax(np.abs(course)))
    at = [i for i, k in enumerate(fit.free) if k.owner == owner and k.name in effect.shaped_by]
    values = {fit.free[i].name: float(getattr(effect, fit.free[i].name)) for i in at}
    row = np.array([effect.changed(**{n: x + 1.0}).shape(along[[most]])[0] - course[most] for n, x in values.items()])
    size = float(getattr(effect, effect.course_size))
    deviation = abs(size) * float(np.sqrt(max(row @ fit.covariance[np.ix_(at, at)] @ row, 0.0)))
    unit = unit_at(effect.unit_of(effect.course_size), place.fit[0].unit)
    return confidence_interval(size * float(course[most]), deviation, unit, -np.inf, np.inf)


def _profiled(place: PlaceOutcome, owner: int, numbers: dict[str, Interval]) -> dict[str, Interval]:
    """Return amplitude and wavelength of a wave with intervals that do not take the fit as linear in them."""
    fit, intervals = place.selected.final, dict[str, Interval]()
    for name in ("amplitude", "wavelength"):
        value, unit = numbers[name].value, numbers[name].unit
        nothing = LEAST_WAVE * value if name == "wavelength" else 0.0
        ends = (nothing, np.inf) if value > 0.0 else (-np.inf, nothing)
        low, high = profile(fit, owner, name, place.fit, place.selected.nuisances, prior_weight(fit), *ends)
        intervals[name] = Interval(value, low, high, unit)
    return intervals


def mechanism_estimates(place: PlaceOutcome) -> dict[str, Interval]:
    """Return the corrected numbers of law and mechanism at a place, with their intervals."""
    fit = place.selected.final
    return {
        _name(place, one): confidence_interval(float(value), fit.deviation(one.owner, one.name), one.unit, one.low, one.high)
        for one, value in zip(fit.free, fit.values, strict=True)
        if one.owner < 0
    }


def against_priors(place: PlaceOutcome) -> tuple[list[str], dict[str, float]]:
    """Return the numbers of a place that their prior has made, and by how many stated deviations measured ones are off."""
    fit = place.selected.final
    prior_made: list[str] = []
    off: dict[str, float] = {}
    for one, value in zip(fit.free, fit.values, strict=True):
        if one.owner >= 0 or not np.isfinite(one.prior):
            continue
        if 1.0 - (fit.deviation(one.owner, one.name) / one.prior) ** 2 < criteria.DECIDED_BY_DATA:
            prior_made.append(_name(place, one))
        elif abs(by := (float(value) - one.nominal) / one.prior) > criteria.SURPRISING:
            off[_name(place, one)] = by
    return prior_made, off


def _name(place: PlaceOutcome, one: FreeParameter) -> str:
    """Return the name that a number of law or mechanism has in the result."""
    return FACTORS.get(one.name, one.name) if place.place else one.name
