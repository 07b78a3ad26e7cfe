"""What to change in a model, from the findings of a check of its friction."""

from __future__ import annotations

import dataclasses
import math

from stochfric_mb.mujoco.check.findings import Findings, Row
from stochfric_mb.mujoco.check.probes import Drift

SLIDING = 0.95
"""A site that carries more of its limit than this in the given state slides already."""
CREEP = 1.0e-6
"""Drift that is worth a word [m/s or rad/s]."""
CREATED = 0.01
"""Energy created over energy dissipated that is worth a word [-]."""
WRONG = 0.05
"""Relative error of break-away that is worth a word [-]; twice that for the deceleration, whose mass is less certain."""
MUCH_BETTER = 0.1
"""Drift over the native one below which it is no fault any more [-]."""


def advice(row: Row, invented: frozenset[str]) -> str:
    """Return what is wrong with the model's friction and what to change, in words; ``invented`` names are not the user's."""
    if row.native is None:
        return "not probed: " + row.problem
    native = _faults(row, row.native, 0.0)
    ours = _faults(row, row.ours, row.limit * getattr(row.law, "e_lim", 0.0)) if row.ours is not None else {}
    for key in ("break_away", "slide"):
        if key in native and key in ours:  # then the body's other motion changes the normal force: it tells nothing
            del native[key], ours[key]
    if not native:
        return "nothing to change" + (f" ({'; '.join(row.native.notes)})" if row.native.notes else "")
    said = "; ".join(native.values())
    if row.ours is None:
        return f"{said}. Ours could not be measured: {row.ours_problem}"
    before, after = _worst_drift(row.native), _worst_drift(row.ours)
    if before is not None and after is not None and after.speed < MUCH_BETTER * before.speed:
        ours.pop("drift", None)
    if not native.keys() - ours.keys():
        return f"{said}. Ours does no better at this timestep ({'; '.join(ours.values())})"
    left = f" (that still {'; '.join(ours.values())})" if ours else ""
    return f"{said}: take it over with {_call(row)}{left}{_conditions(row, invented)}"


def _call(row: Row) -> str:
    """Return the call of `add_friction` that takes the site over, with the law's parameters that are no defaults."""
    where, load = repr(row.names), ""
    if row.kind != "contact":
        where, load = f"{row.kind.capitalize()}({row.names[0]!r})", f", normal_force={row.limit:.6g}"
    given = [(f.name, getattr(row.law, f.name), f.default) for f in dataclasses.fields(row.law)] if row.law else []
    words = ", ".join(f"{name}={value:.4g}" for name, value, default in given if isinstance(value, float) and value != default)
    return f"add_friction(spec, {where}, {type(row.law).__name__}({words}){load})"


def _conditions(row: Row, invented: frozenset[str]) -> str:
    explicit = row.mode == "explicit" and math.isfinite(row.step_limit)
    unnamed = " and ".join(n for n in row.names if n in invented)
    return (f"; explicit, timestep <= {row.step_limit:.2g} s" if explicit else "") + (
        f" (it needs a name first: here {unnamed}, by number)" if unnamed else ""
    )


def _faults(row: Row, findings: Findings, stored: float) -> dict[str, str]:
    """Return what is wrong, in words; ``stored`` [J] may come back from a law's spring and is not created."""
    faults: dict[str, str] = {}
    worst = _worst_drift(findings)
    if worst is not None and worst.speed > CREEP:
        speed, of = 1.0e6 * worst.speed, "mu N" if row.kind == "contact" else "the frictionloss"
        shown = f"{speed:.0f}" if speed >= 100.0 else f"{speed:.2g}"
        faults["drift"] = f"creeps {shown} u{row.unit}/s at {100.0 * worst.load:.0f} % of {of}"
    broken = findings.break_away
    if broken is not None and abs(broken.share - 1.0) > WRONG:
        faults["break_away"] = f"breaks away at {100.0 * broken.share:.0f} % of its limit"
    slide = findings.slide
    if slide is not None and abs(slide.deceleration - slide.expected) > 2.0 * WRONG * slide.expected:
        faults["slide"] = f"slows down at {slide.deceleration:.3g} instead of {slide.expected:.3g} {row.unit}/s^2"
    if findings.energy_created > max(CREATED * findings.energy_dissipated, stored, 1.0e-9):
        faults["energy"] = f"creates energy ({findings.energy_created:.2g} J)"
    return faults


def _worst_drift(findings: Findings) -> Drift | None:
    """Return the fastest drift under a load that should hold."""
    held = [d for d in (findings.own, *findings.held) if d is not None and d.load < SLIDING]
    return max(held, key=lambda d: d.speed, default=None)
