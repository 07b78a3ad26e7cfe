"""What a check of a model's friction finds, and how it is written."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import mujoco
import numpy as np

from stochfric_mb.laws import Law
from stochfric_mb.mujoco.check.probes import BreakAway, Drift, Slide

SCHEMA = "stochfric.check/1"
SHARES = (0.5, 0.9)
"""Loads that should hold, over the limit."""


@dataclasses.dataclass(frozen=True)
class Findings:
    """What the probes found with one friction."""

    own: Drift
    """Under the load that the site carries in the given state."""
    held: tuple[Drift | None, ...]
    """Under each of `SHARES` of the limit; None where the site carries more already."""
    break_away: BreakAway | None
    """Under a rising load; None where friction followed to the end."""
    slide: Slide | None
    """Sliding; None where it could not be measured."""
    energy_created: float
    """Most energy that friction gave to the motion in any probe [J]."""
    energy_dissipated: float
    """Energy that friction took in all probes [J]."""
    notes: tuple[str, ...] = ()
    """What could not be measured, and why."""


@dataclasses.dataclass(frozen=True)
class Row:
    """One contact pair, joint or tendon."""

    kind: str
    """contact, joint or tendon."""
    name: str
    """Its name; for a contact pair both geoms'."""
    names: tuple[str, ...]
    """The geoms' names, the body's first, or the joint's or tendon's."""
    unit: str
    """Unit of displacements: m or rad."""
    coefficient: float | None
    """The model's sliding coefficient [-]; None for joints and tendons."""
    normal_force: float
    """Mean normal force [N]; for joints and tendons the frictionloss [N or N m]."""
    limit: float
    """Mean limit of the friction force [N or N m]."""
    problem: str
    """Why the site was not probed, empty if it was."""
    native: Findings | None
    """With the model's own friction."""
    ours: Findings | None
    """With a law of this package."""
    ours_problem: str
    """Why there is nothing of ours, empty if there is."""
    law: Law | None
    """The law that ran."""
    mass: float
    """Least mass that a force at the site feels [kg or kg m^2]."""
    mode: str
    """How it ran: by MuJoCo's solver, or explicitly with RK4 where the timestep is below half its limit."""
    step_limit: float
    """Largest stable explicit step of that law here [s]."""
    advice: str
    """What to change."""

    def to_dict(self) -> dict[str, Any]:
        """Return plain values; numbers that are not finite become None."""
        plain: dict[str, Any] = {f.name: getattr(self, f.name) for f in dataclasses.fields(self)}
        for key in ("native", "ours"):
            plain[key] = dataclasses.asdict(plain[key]) if plain[key] is not None else None
        plain["law"] = self.law.to_dict() if self.law is not None else None
        return _plain(plain)


@dataclasses.dataclass(frozen=True)
class CheckResult:
    """What `check` found."""

    model: str
    """File, or the model's name."""
    timestep: float
    """The model's step [s]."""
    integrator: str
    """Its integrator."""
    cone: str
    """Its friction cone."""
    impratio: float
    """Its ratio of frictional to normal impedance [-]."""
    keyframe: str
    """Keyframe it started from, empty: the default state."""
    settle: float
    """Time that it was left to settle [s]."""
    duration: float
    """Time of a hold [s]."""
    mu_k_ratio: float
    """mu_k over mu_s of ours [-]."""
    rows: tuple[Row, ...]
    """What has friction."""
    notes: tuple[str, ...]
    """What was left out, and why."""

    def to_dict(self) -> dict[str, Any]:
        """Return the content of ``check.json``."""
        plain = {f.name: getattr(self, f.name) for f in dataclasses.fields(self)} | {"rows": [r.to_dict() for r in self.rows]}
        return _plain({"schema": SCHEMA, "mujoco": mujoco.__version__, "shares": SHARES} | plain)


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    if isinstance(value, float | np.floating):
        return float(value) if math.isfinite(value) else None
    return value
