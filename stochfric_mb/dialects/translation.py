"""A translation between our laws and a dialect: parameters, how well they fit, and what is lost."""

from __future__ import annotations

import dataclasses
import itertools
from typing import Any

import numpy as np

from stochfric_mb.coefficients import Process
from stochfric_mb.dialects.contract import Array, Dialect
from stochfric_mb.dialects.curve import BRISTLE, Curve, coefficient, curve_of
from stochfric_mb.dialects.fitting import fit, half_way
from stochfric_mb.laws import Law, law_class, make_law

FREE = ("mu_s", "mu_k", "v_s", "v_d", "decay_velocity", "stribeck_velocity")
"""Parameters of laws that set the curve of steady sliding; the others keep their defaults."""


@dataclasses.dataclass(frozen=True)
class Translated:
    """What a translation gives."""

    law: Law
    """Our law."""
    dialect: Dialect
    """The other code's friction."""
    max_error: float
    """Largest difference of the coefficients over the speeds [-]."""
    rms_error: float
    """Its root mean square [-]."""
    break_away_error: float
    """Difference of the coefficients at break-away, result minus original [-]."""
    lost: tuple[str, ...]
    """What the result cannot say."""


def to_dialect(
    law: Law, cls: type[Dialect], speed: Array, *, normal_force: float, mass: float = 1.0, process: Process | None = None
) -> Translated:
    """Return a law in the words of a dialect.

    Args:
        law: the law.
        cls: the dialect.
        speed: speeds at which the two are compared [m/s], shape (n,).
        normal_force: normal force [N].
        mass: mass that the contact feels [kg].
        process: how the coefficients vary.
    """
    curve = curve_of(law, speed, normal_force=normal_force, mass=mass, process=process)
    made = cls.fitted(curve)
    mu = made.coefficient(speed, normal_force)
    break_away = made.break_away(normal_force) - curve.break_away
    return _scored(law, made, mu - curve.coefficient, break_away, made.lost(curve))


def from_dialect(dialect: Dialect, kind: str, speed: Array, *, normal_force: float) -> Translated:
    """Return a dialect's friction as one of our laws.

    Args:
        dialect: the other code's friction.
        kind: kind of our law.
        speed: speeds at which the two are compared [m/s], shape (n,).
        normal_force: normal force [N].
    """
    mu, break_away = dialect.coefficient(speed, normal_force), dialect.break_away(normal_force)
    cls = law_class(kind)
    best: tuple[float, Law] | None = None
    for choices in _choices(cls):
        law, misfit = _fitted_law(
            kind, choices, dialect, Curve(speed, mu, break_away, dialect.holds, normal_force=normal_force)
        )
        if best is None or misfit < best[0]:
            best = misfit, law
    assert best is not None
    law = best[1]
    ours = curve_of(law, speed, normal_force=normal_force)
    return _scored(law, dialect, ours.coefficient - mu, ours.break_away - break_away, _lost_in_law(dialect, ours))


def _scored(law: Law, dialect: Dialect, difference: Array, break_away: float, lost: list[str]) -> Translated:
    rms = float(np.sqrt(np.mean(difference**2)))
    return Translated(law, dialect, float(np.max(np.abs(difference))), rms, float(break_away), tuple(lost))


def _lost_in_law(dialect: Dialect, ours: Curve) -> list[str]:
    lines: list[str] = []
    if dialect.holds and not ours.holds:
        lines.append("true stick: the law creeps under any load")
    if not dialect.holds and ours.holds:
        lines.append("creep: the law sticks")
    if dialect.memory == BRISTLE and ours.memory != BRISTLE:
        lines.append(BRISTLE)
    return lines


def _choices(cls: type[Law]) -> list[dict[str, Any]]:
    """Return all combinations of a law's choices."""
    named = {f.name: f.metadata["choices"] for f in dataclasses.fields(cls) if "choices" in f.metadata}
    return [dict(zip(named, values, strict=True)) for values in itertools.product(*named.values())]


def _fitted_law(kind: str, choices: dict[str, Any], dialect: Dialect, curve: Curve) -> tuple[Law, float]:
    names = [f.name for f in dataclasses.fields(law_class(kind)) if f.name in FREE]
    half = half_way(curve.speed, curve.coefficient)
    top = float(curve.speed[np.argmax(curve.coefficient)])
    guess = {
        "mu_s": max(curve.break_away, float(curve.coefficient[-1]) * 1.001),
        "mu_k": float(curve.coefficient[-1]),
        "v_s": max(min(top, 0.3 * half), 0.1 * float(curve.speed[0])),
        "v_d": 2.0 * half + float(curve.speed[0]),
        "decay_velocity": half,
        "stribeck_velocity": half,
    }
    fixed = choices | _stiffness(kind, dialect, curve)

    def made(x: Array) -> Law:
        values = dict(zip(names, map(float, x), strict=True))
        if "v_s" in values:  # what lies further below the lowest speed makes no difference
            values["v_s"] += 0.1 * float(curve.speed[0])
        if "mu_k" in values and values["mu_k"] > values["mu_s"]:
            values["mu_k"] = values["mu_s"]
        return make_law(kind, **fixed, **values)

    def model(x: Array) -> tuple[Array, float]:
        law = made(x)
        mu = coefficient(law, curve.speed)
        return mu, law.mu_s if law.state_names[:1] == ("mode",) or law.kind == "lugre" else float(np.max(mu))

    result, misfit = fit(model, [guess[n] for n in names], curve.coefficient, curve.break_away)
    return made(result), misfit


def _stiffness(kind: str, dialect: Dialect, curve: Curve) -> dict[str, float]:
    """Return the deflection at break-away of a dialect that has a stiffness."""
    stiffness = getattr(dialect, "stickingStiffness", 0.0)
    if kind != "elastic_stick" or stiffness <= 0.0:
        return {}
    return {"e_lim": curve.break_away * curve.normal_force / stiffness}
