"""Options of a model with which friction cannot act, or is known to be inaccurate: refused, or warned of.

They are looked at when friction is added, and again whenever data of a model are made, by the plugins themselves.
"""

# pyright: reportMissingParameterType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import ctypes
import warnings

import mujoco

from stochfric_mb.compile import compiled
from stochfric_mb.errors import InputError
from stochfric_mb.mujoco.memory import engine
from stochfric_mb.mujoco.memory import words as w
from stochfric_mb.mujoco.memory.structs import DISCRETE, ELLIPTIC, EULER, IMPLICIT, IMPLICITFAST, PGS, RUNGE_KUTTA, model_at

NO_PASSIVE_FORCES = int(mujoco.mjtDisableBit.mjDSBL_SPRING | mujoco.mjtDisableBit.mjDSBL_DAMPER)
"""With both of these disabled, MuJoCo leaves out all passive forces."""
SWITCHED_OFF = (
    "option.disableflags has both spring and damper disabled, with which MuJoCo leaves out all passive forces, "
    "friction too; enable one of them (and set stiffness or damping to 0 instead)"
)
"""What is said of that."""
PYRAMIDAL = (
    "option.cone is pyramidal: the coefficients of pyramidal contacts are fixed before friction can set them; use "
    "cone='elliptic' (on a compiled model: model.opt.cone = mujoco.mjtCone.mjCONE_ELLIPTIC), or mode='explicit' with a step "
    "below the law's limit"
)
"""What is said of pyramidal cones."""


N_BIAS, DAMPING, N_GEAR = int(mujoco.mjNBIAS), 2, 6
"""Numbers of an actuator's bias, the place of minus kv among them, numbers of its gear."""
STIFF = 1.0
"""Step times damping over mass [-] above which a step with implicit damping is another one than the solver foresaw."""
LONG = 4.0e-3
"""Step [s] above which stuck contacts slip by it: on a servo table that shakes at 1 Hz with 2 m/s^2 by 1 um at 2 ms, 30 um at
5 ms, .4 mm at 10 ms, with the fourth power of the step, and alike for all dampings above `STIFF`. With RK4, whose stages
damping changes, at any step: 10 um at h c/m = 1, 2.4 mm at 2.5."""


class IntegratorWarning(UserWarning):
    """An integrator with which friction is known to be inaccurate."""


def check_options(disabled: int, integrator: int, cone: int, *, steered: bool = True, stacklevel: int = 2) -> None:
    """Look at a model's ``disableflags``, ``integrator`` and ``cone``.

    Args:
        disabled: ``option.disableflags``.
        integrator: ``option.integrator``.
        cone: ``option.cone``.
        steered: whether the law steers MuJoCo's own solver (modes auto and solver).
        stacklevel: of the warning.

    Raises:
        InputError: passive forces are off, and friction with them; or pyramidal cones.

    Warns:
        IntegratorWarning: the ``discrete`` integrator, with what cannot be steered in it: joints, tendons, explicit friction.
    """
    if disabled & NO_PASSIVE_FORCES == NO_PASSIVE_FORCES:
        raise InputError(SWITCHED_OFF)
    if steered and cone != ELLIPTIC:
        raise InputError(PYRAMIDAL)
    if integrator == DISCRETE and not steered:
        warnings.warn(
            "integrator discrete makes its constraints' references anew after friction has set them: joints and tendons creep "
            "with it as with native friction, and explicit friction is inaccurate; use Euler, implicitfast, implicit or RK4",
            IntegratorWarning,
            stacklevel=stacklevel + 1,
        )


def require_primal(solver: int, noslip_iterations: int) -> None:
    """Refuse solvers that make the rows' matrix before friction that differs by direction can turn them.

    Raises:
        InputError: PGS, or noslip iterations.
    """
    if solver == PGS or noslip_iterations > 0:
        raise InputError(
            f"option.solver = {mujoco.mjtSolver(solver).name}, noslip_iterations = {noslip_iterations}: friction that differs "
            "by direction needs Newton or CG, without noslip iterations (stuck contacts do not creep without them)"
        )


def _check(steered: int, options: int, cone: int) -> int:
    check_options(options >> 8, options & 255, cone, steered=bool(steered))
    return 1


def warn_of_stiff_damping(ratio: float, timestep: float, *, stacklevel: int = 2) -> None:
    """Warn where damping and a long step let stuck contacts slip; ``ratio`` is `stiff_damping`.

    Warns:
        IntegratorWarning: they do.
    """
    if ratio > 0.0:
        warnings.warn(
            f"timestep = {timestep:g} s with h kv/m = {ratio:.3g} of an actuator or joint: contacts that it carries slip while "
            "stuck, by tenths of a millimetre at 10 ms where it shakes them; use implicitfast with a timestep of 2 ms, or "
            "integrator discrete",
            IntegratorWarning,
            stacklevel=stacklevel + 1,
        )


def _warn(thousandths: int, nanoseconds: int, _: int) -> int:
    warn_of_stiff_damping(1.0e-3 * thousandths, 1.0e-9 * nanoseconds)
    return 1


WARNER = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, ctypes.c_int64, ctypes.c_int64)(_warn)
"""`warn_of_stiff_damping` as a C function, of thousandths and nanoseconds."""
MESSAGE = ctypes.create_string_buffer(f"stochfric_mb: {SWITCHED_OFF}".encode())
"""`SWITCHED_OFF` as a C string."""
CHECKER = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, ctypes.c_int64, ctypes.c_int64)(_check)
"""`check_options` as a C function; an error in it is printed and 0 comes back."""


@compiled
def stiff_damping(model):
    """Return the largest h c/m [-] of joints and of actuators with kv, where stuck contacts slip by it; otherwise 0."""
    m = model_at(model)
    joints = m.integrator in (EULER, IMPLICIT, IMPLICITFAST, RUNGE_KUTTA)
    actuators = joints and m.integrator != EULER
    ratio = 0.0
    for i in range(m.nv if joints else 0):
        ratio = max(ratio, m.timestep * w.at(m.dof_damping, i) * w.at(m.dof_invweight0, i))
    for i in range(m.nu if actuators else 0):
        moved = abs(w.at(m.actuator_gear, N_GEAR * i)) * w.at(m.actuator_acc0, i)
        ratio = max(ratio, -m.timestep * w.at(m.actuator_biasprm, N_BIAS * i + DAMPING) * moved)
    return ratio if ratio > STIFF and (m.timestep > LONG or m.integrator == RUNGE_KUTTA) else 0.0


@compiled
def options_allow(model, steered):
    """Return whether friction can act with the model's options; says why not, or warns."""
    m = model_at(model)
    ratio = stiff_damping(model) if steered else 0.0
    if ratio > 0.0:
        w.call_python(w.entry(w.WARNER), int(1.0e3 * min(ratio, 1.0e12)), int(1.0e9 * m.timestep), 0)
    allowed = m.disableflags & NO_PASSIVE_FORCES != NO_PASSIVE_FORCES and (steered or m.integrator != DISCRETE)
    if allowed and (m.cone == ELLIPTIC or not steered):
        return True
    return w.call_python(w.entry(w.OPTIONS_CHECKER), int(steered), (m.disableflags << 8) + m.integrator, m.cone) == 1


@compiled
def require_passive_forces(model):
    """Stop with MuJoCo's error where passive forces are off: they were switched off after the data were made."""
    if model_at(model).disableflags & NO_PASSIVE_FORCES == NO_PASSIVE_FORCES:
        engine.mju_error(w.entry(w.NO_PASSIVE_MESSAGE))
