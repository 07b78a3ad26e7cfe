"""Options of a model with which friction cannot act, or is known to be inaccurate: refused, or warned of.

They are looked at when friction is added, and again whenever data of a model are made, by the plugins themselves.
"""

from __future__ import annotations

import warnings
from typing import Any

import mujoco
import numpy as np

from stochfric_mb.errors import InputError
from stochfric_mb.mujoco.memory import structs
from stochfric_mb.mujoco.memory.structs import array_at, record_at

NO_PASSIVE_FORCES = int(mujoco.mjtDisableBit.mjDSBL_SPRING | mujoco.mjtDisableBit.mjDSBL_DAMPER)
"""With both of these disabled, MuJoCo leaves out all passive forces."""
NO_FRICTION_LOSS = int(mujoco.mjtDisableBit.mjDSBL_FRICTIONLOSS)
SWITCHED_OFF = (
    "option.disableflags has both spring and damper disabled, with which MuJoCo leaves out all passive forces, "
    "friction too; enable one of them (and set stiffness or damping to 0 instead)"
)
"""What is said of that."""
STIFF = 1.0
"""Step times damping over mass [-] above which a step with implicit damping is another one than the solver foresaw."""
SHAKES = 4.0
"""The same above which the difference, told to stuck rows a step late, shakes them at any step (see `joint.friction`)."""
LONG, LONG_STAGES = 4.0e-3, 2.0e-3
"""Steps [s], and those with RK4, above which stuck contacts slip by it: on a servo table that shakes at 1 Hz with 2 m/s^2 by
1 um at 2 ms, 30 um at 5 ms, .4 mm at 10 ms, with the fourth power of the step, and alike for all dampings above `STIFF`. With
RK4, whose stages damping changes, by 1 um at 2 ms, 4 um at 4 ms, and .4 mm there at h c/m = 2.5, where it is hardly stable."""


class IntegratorWarning(UserWarning):
    """An integrator with which friction is known to be inaccurate."""


def check_options(option: Any, *, steered: bool = True, coordinate: bool = False) -> None:
    """Refuse what switches friction off, and warn of ``discrete`` and noslip iterations where friction is inaccurate with them.

    With noslip iterations a box on an incline, mu_s 0.8 (38.66 degrees), breaks away at 1, 2 and 5 ms at 31.9 to 32.8 degrees
    with ``discrete`` and any solver, at 32.7 to 34.8 with PGS, at 38.7 with the others.

    Args:
        option: ``option`` of a spec, ``opt`` of a model, or a model's record.
        steered: whether the law steers MuJoCo's own solver at contacts; other friction suffers from ``discrete``.
        coordinate: whether the friction is of a joint or tendon.
    """
    if option.disableflags & NO_PASSIVE_FORCES == NO_PASSIVE_FORCES:
        raise InputError(SWITCHED_OFF)
    if coordinate and option.disableflags & NO_FRICTION_LOSS:
        raise InputError(
            "option.disableflags has frictionloss disabled, so MuJoCo's solver has no friction of joints and tendons for the "
            "law to steer; enable it (and leave frictionloss out where there should be none)"
        )
    if option.integrator == structs.DISCRETE and not steered:
        warnings.warn(
            "integrator discrete makes its constraints' references anew after friction has set them: joints and tendons creep "
            "with it as with native friction, and explicit friction is inaccurate; use Euler, implicitfast, implicit or RK4",
            IntegratorWarning,
            stacklevel=3,
        )
    if steered and option.noslip_iterations > 0 and (option.solver == structs.PGS or option.integrator == structs.DISCRETE):
        what = "the PGS solver" if option.solver == structs.PGS else "the discrete integrator"
        warnings.warn(
            f"noslip_iterations = {option.noslip_iterations} with {what}: bodies on several contacts break away below mu_s N "
            "(a box at 32 instead of 38.66 degrees); use noslip_iterations 0: stuck contacts do not creep without them",
            IntegratorWarning,
            stacklevel=3,
        )


def require_elliptic(option: Any) -> None:
    """Refuse pyramidal cones."""
    if option.cone != structs.ELLIPTIC:
        raise InputError(
            "option.cone is pyramidal: the coefficients of pyramidal contacts are fixed before friction can set them; use "
            "cone='elliptic' (on a compiled model: model.opt.cone = mujoco.mjtCone.mjCONE_ELLIPTIC), or mode='explicit' with a "
            "step below the law's limit"
        )


def require_primal(option: Any) -> None:
    """Refuse solvers that make the rows' matrix before friction that differs by direction can turn them."""
    if option.solver == structs.PGS or option.noslip_iterations > 0:
        raise InputError(
            f"option.solver = {mujoco.mjtSolver(option.solver).name}, noslip_iterations = {option.noslip_iterations}: friction "
            "that differs by direction needs Newton or CG, without noslip iterations (stuck contacts do not creep without them)"
        )


def warn_of_stiff_damping(model: int) -> None:
    """Warn where damping and a long step let stuck contacts slip in the model at an address.

    What counts is the largest h c/m [-] of its joints and its actuators with kv.
    """
    m = record_at(structs.MODEL, model)
    if m.integrator == structs.DISCRETE:
        return
    ratios = array_at(m.dof_damping, m.nv) * array_at(m.dof_invweight0, m.nv)
    if m.integrator != structs.EULER:
        moved = np.abs(array_at(m.actuator_gear, structs.N_GEAR * m.nu)[:: structs.N_GEAR]) * array_at(m.actuator_acc0, m.nu)
        kv = -array_at(m.actuator_biasprm, structs.N_BIAS * m.nu)[structs.DAMPING :: structs.N_BIAS]
        ratios = np.append(ratios, kv * moved)
    ratio = float(m.timestep * ratios.max(initial=0.0))
    long = m.timestep > (LONG_STAGES if m.integrator == structs.RUNGE_KUTTA else LONG)
    if ratio > (STIFF if long else SHAKES):
        warnings.warn(
            f"timestep = {m.timestep:g} s with h kv/m = {ratio:.3g} of an actuator or joint: contacts "
            "that it carries slip while stuck, by tenths of a millimetre at 10 ms where it shakes them; use integrator "
            f"discrete, or implicitfast with a timestep of at most 2 ms and h kv/m of at most {SHAKES:g}",
            IntegratorWarning,
            stacklevel=3,
        )
