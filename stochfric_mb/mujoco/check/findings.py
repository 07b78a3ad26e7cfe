"""What a check of a model's friction finds, and how it is written."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import mujoco

from stochfric_mb.laws import Law
from stochfric_mb.mujoco.check.probes import BreakAway, Drift, Slide

SCHEMA = "stochfric.check/1"
SHARES = (0.5, 0.9)
"""Loads that should hold, over the limit."""


@dataclasses.dataclass(frozen=True)
class Findings:
    """Findings of the probes with one friction."""

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
    notes: tuple[str, ...]
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
    normal_force: float = math.nan
    """Mean normal force [N]; for joints and tendons the frictionloss [N or N m]."""
    limit: float = math.nan
    """Mean limit of the friction force [N or N m]."""
    problem: str = ""
    """Why the site was not probed, empty if it was."""
    native: Findings | None = None
    """With the model's own friction."""
    ours: Findings | None = None
    """With a law of this package."""
    ours_problem: str = ""
    """Why there is nothing of ours, empty if there is."""
    law: Law | None = None
    """The law that ran."""
    mass: float = math.nan
    """Least mass that a force at the site feels [kg or kg m^2]."""
    mode: str = ""
    """How it ran: by MuJoCo's solver, or explicitly."""
    step_limit: float = math.nan
    """Largest stable explicit step of that law here [s]."""
    advice: str = ""
    """What to change."""


@dataclasses.dataclass(frozen=True)
class CheckResult:
    """Findings of `check`."""

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
        """Return the content of ``check.json``: plain values; numbers that are not finite become None."""
        return {"schema": SCHEMA, "mujoco": mujoco.__version__, "shares": list(SHARES)} | _plain(self)


def _plain(value: Any) -> Any:
    if isinstance(value, Law):
        return value.to_dict()
    if dataclasses.is_dataclass(value):
        return {f.name: _plain(getattr(value, f.name)) for f in dataclasses.fields(value)}
    if isinstance(value, tuple):
        return [_plain(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
