"""Options of a model with which friction cannot act, or is known to be inaccurate: refused, or warned of.

They are looked at when friction is added, and again whenever data of a model are made, by the plugins themselves.
"""

from __future__ import annotations

import warnings
from typing import Any

import mujoco
import numpy as np

from stochfric_mb.errors import InputError
from stochfric_mb.mujoco.memory import layout
from stochfric_mb.mujoco.memory.structs import DISCRETE, ELLIPTIC, EULER, PGS, RUNGE_KUTTA

NO_PASSIVE_FORCES = int(mujoco.mjtDisableBit.mjDSBL_SPRING | mujoco.mjtDisableBit.mjDSBL_DAMPER)
"""With both of these disabled, MuJoCo leaves out all passive forces."""
SWITCHED_OFF = (
    "option.disableflags has both spring and damper disabled, with which MuJoCo leaves out all passive forces, "
    "friction too; enable one of them (and set stiffness or damping to 0 instead)"
)
"""What is said of that."""
N_BIAS, DAMPING, N_GEAR = int(mujoco.mjNBIAS), 2, 6
"""Numbers of an actuator's bias, the place of minus kv among them, numbers of its gear."""
STIFF = 1.0
"""Step times damping over mass [-] above which a step with implicit damping is another one than the solver foresaw."""
LONG, LONG_STAGES = 4.0e-3, 2.0e-3
"""Steps [s], and those with RK4, above which stuck contacts slip by it: on a servo table that shakes at 1 Hz with 2 m/s^2 by
1 um at 2 ms, 30 um at 5 ms, .4 mm at 10 ms, with the fourth power of the step, and alike for all dampings above `STIFF`. With
RK4, whose stages damping changes, by 1 um at 2 ms, 4 um at 4 ms, and .4 mm there at h c/m = 2.5, where it is hardly stable."""


class IntegratorWarning(UserWarning):
    """An integrator with which friction is known to be inaccurate."""


def check_options(option: Any, *, steered: bool = True, stacklevel: int = 2) -> None:
    """Look at a model's ``disableflags`` and ``integrator``.

    Args:
        option: ``option`` of a spec or ``opt`` of a model.
        steered: whether the law steers MuJoCo's own solver (modes auto and solver).
        stacklevel: of the warning.

    Raises:
        InputError: passive forces are off, and friction with them.

    Warns:
        IntegratorWarning: the ``discrete`` integrator, with what cannot be steered in it: joints, tendons, explicit friction.
    """
    if option.disableflags & NO_PASSIVE_FORCES == NO_PASSIVE_FORCES:
        raise InputError(SWITCHED_OFF)
    if option.integrator == DISCRETE and not steered:
        warnings.warn(
            "integrator discrete makes its constraints' references anew after friction has set them: joints and tendons creep "
            "with it as with native friction, and explicit friction is inaccurate; use Euler, implicitfast, implicit or RK4",
            IntegratorWarning,
            stacklevel=stacklevel + 1,
        )


def require_elliptic(option: Any) -> None:
    """Refuse pyramidal cones.

    Raises:
        InputError: the cones are pyramidal.
    """
    if option.cone != ELLIPTIC:
        raise InputError(
            "option.cone is pyramidal: the coefficients of pyramidal contacts are fixed before friction can set them; use "
            "cone='elliptic' (on a compiled model: model.opt.cone = mujoco.mjtCone.mjCONE_ELLIPTIC), or mode='explicit' with a "
            "step below the law's limit"
        )


def require_primal(option: Any) -> None:
    """Refuse solvers that make the rows' matrix before friction that differs by direction can turn them.

    Raises:
        InputError: PGS, or noslip iterations.
    """
    if option.solver == PGS or option.noslip_iterations > 0:
        raise InputError(
            f"option.solver = {mujoco.mjtSolver(option.solver).name}, noslip_iterations = {option.noslip_iterations}: friction "
            "that differs by direction needs Newton or CG, without noslip iterations (stuck contacts do not creep without them)"
        )


def warn_of_stiff_damping(model: int, *, stacklevel: int = 2) -> None:
    """Warn where damping and a long step let stuck contacts slip in the model at an address.

    Warns:
        IntegratorWarning: they do.
    """
    ratio, timestep = stiff_damping(model), layout.struct("mjModel").from_address(model).opt.timestep
    if ratio > 0.0:
        warnings.warn(
            f"timestep = {timestep:g} s with h kv/m = {ratio:.3g} of an actuator or joint: contacts that it carries slip while "
            "stuck, by tenths of a millimetre at 10 ms where it shakes them; use implicitfast with a timestep of 2 ms, or "
            "integrator discrete",
            IntegratorWarning,
            stacklevel=stacklevel + 1,
        )


def stiff_damping(model: int) -> float:
    """Return the largest h c/m [-] of joints and of actuators with kv, where stuck contacts slip by it; otherwise 0.

    ``model`` is a model's address.
    """
    m = layout.struct("mjModel").from_address(model)
    h, integrator = m.opt.timestep, m.opt.integrator
    if integrator == DISCRETE or h <= (LONG_STAGES if integrator == RUNGE_KUTTA else LONG):
        return 0.0
    ratios = h * layout.doubles(m.dof_damping, m.nv) * layout.doubles(m.dof_invweight0, m.nv)
    if integrator != EULER and m.nu:
        moved = np.abs(layout.doubles(m.actuator_gear, N_GEAR * m.nu)[::N_GEAR]) * layout.doubles(m.actuator_acc0, m.nu)
        ratios = np.append(ratios, -h * layout.doubles(m.actuator_biasprm, N_BIAS * m.nu)[DAMPING::N_BIAS] * moved)
    ratio = float(ratios.max(initial=0.0))
    return ratio if ratio > STIFF else 0.0
