"""A run of the adaptive reference: what does not change in it, and what does."""

# pyright: reportUnknownParameterType=false, reportUnknownVariableType=false, reportUnknownArgumentType=false
# pyright: reportUnknownMemberType=false

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from stochfric_mb.coefficients.path import CURSOR
from stochfric_mb.laws.abi import MAX_STATE
from stochfric_mb.laws.contract import GUARDS
from stochfric_mb.mechanisms.belt_box import BoxNumbers
from stochfric_mb.numerics.runge_kutta import DOP853

STAGES = len(DOP853.b)
"""Stages of a step; its error estimates use the rates at its end as one more."""
CHECKS = 4
"""Even parts of a step at whose ends, at least, the guards are looked at."""
ALL_GUARDS = GUARDS + 4
"""The law's guards, two for the stick speed (laws without a mode) and two for knots along the belt."""
# Entries of Run.segment: the coefficients between the knots around the present state
ORIGIN, MU_S, SLOPE_S, MU_K, SLOPE_K, LOW, HIGH, KNOT, EVENTS = range(9)
# Entries of Run.clock
NOW, STEP, STUCK, N_STEPS, STATUS, N_EVENTS = range(6)


class Problem(NamedTuple):
    """What does not change during a run."""

    init: int
    """Address of the law's ``init``; likewise the next four."""
    force: int
    commit: int
    guards: int
    flow: int
    parameters: Any
    """The law's parameter vector."""
    moded: bool
    """Whether the law's first state entry is a mode, 0 being stick."""
    holding: bool
    """Whether the law holds a stuck contact still."""
    bristle: int
    """Index of the bristle deflection in the law's state; -1 for laws without ``flow``."""
    stick_speed: float
    """Speed [m/s] below which a contact without a mode counts as stuck."""
    box: BoxNumbers
    """The mechanism."""
    descriptor: Any
    """Descriptor of the coefficient path; then its address."""
    seed: int
    sample: int
    contact: int
    tolerance: float
    """Largest local error of a step, relative to ``scale``."""
    scale: Any
    """Scales of x [m], x' [m/s] and z [m], shape (3,)."""
    longest: float
    """Longest step [s]."""
    restart: float
    """First step after the start and after each event [s]."""
    shortest: float
    """Step [s] that is taken whatever its error: only a jump that no guard announces asks for it."""


_REAL = np.float64
RUN = np.dtype(
    [
        ("y", _REAL, 3),  # present (x, x', z)
        ("state", _REAL, MAX_STATE),  # the law's state
        ("segment", _REAL, 9),  # coefficients between the knots around the present state
        ("clock", _REAL, 6),  # time, step size, stick flag and counters
        ("armed", _REAL, ALL_GUARDS),  # 1 for a guard that has been positive since the last switch
        ("guards", _REAL, ALL_GUARDS),  # present values of the guards
        ("end", _REAL, 3),  # (x, x', z) at the end of the step tried last
        ("stages", _REAL, (STAGES + 1, 3)),  # rates of the step tried last
        ("probe", _REAL, 3),  # (x, x', z) of a stage or a check point
        ("checks", _REAL, 3 * CHECKS + 1),  # check points of a step, in parts of it
        ("table", _REAL, (3 * CHECKS + 1, ALL_GUARDS)),  # guards at the check points of a step
        ("out", _REAL, MAX_STATE + GUARDS),  # where a law's functions write
        ("cursor", _REAL, CURSOR),  # knots around the present state
        ("output_cursor", _REAL, CURSOR),  # knots around the last output
    ]
)
"""What changes during a run: a record, which compiled functions pass as one pointer and write in place."""


def new_run() -> Any:
    """Return the record of a run."""
    run = np.zeros(1, RUN).view(np.recarray)[0]
    run.guards[:] = 1.0
    run.table[:] = 1.0
    return run
