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
from stochfric_mb.mujoco.memory.structs import model_at

NO_PASSIVE_FORCES = int(mujoco.mjtDisableBit.mjDSBL_SPRING | mujoco.mjtDisableBit.mjDSBL_DAMPER)
"""With both of these disabled, MuJoCo leaves out all passive forces."""
SWITCHED_OFF = (
    "option.disableflags has both spring and damper disabled, with which MuJoCo leaves out all passive forces, "
    "friction too; enable one of them (and set stiffness or damping to 0 instead)"
)
"""What is said of that."""
DISCRETE, ELLIPTIC = 4, 1
"""mjtIntegrator and mjtCone."""
PYRAMIDAL = (
    "option.cone is pyramidal: the coefficients of pyramidal contacts are fixed before friction can set them; use "
    "cone='elliptic' (on a compiled model: model.opt.cone = mujoco.mjtCone.mjCONE_ELLIPTIC), or mode='explicit' with a step "
    "below the law's limit"
)
"""What is said of pyramidal cones."""


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
        IntegratorWarning: the ``discrete`` integrator.
    """
    if disabled & NO_PASSIVE_FORCES == NO_PASSIVE_FORCES:
        raise InputError(SWITCHED_OFF)
    if steered and cone != ELLIPTIC:
        raise InputError(PYRAMIDAL)
    if integrator == DISCRETE:
        warnings.warn(
            "integrator discrete makes its constraints' references anew after friction has set them: stuck contacts creep, as "
            "with native friction; use Euler, implicitfast, implicit or RK4",
            IntegratorWarning,
            stacklevel=stacklevel + 1,
        )


def _check(steered: int, options: int, cone: int) -> int:
    check_options(options >> 8, options & 255, cone, steered=bool(steered))
    return 1


MESSAGE = ctypes.create_string_buffer(f"stochfric_mb: {SWITCHED_OFF}".encode())
"""`SWITCHED_OFF` as a C string."""
CHECKER = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, ctypes.c_int64, ctypes.c_int64)(_check)
"""`check_options` as a C function; an error in it is printed and 0 comes back."""


@compiled
def options_allow(model, steered):
    """Return whether friction can act with the model's options; says why not, or warns."""
    m = model_at(model)
    allowed = m.disableflags & NO_PASSIVE_FORCES != NO_PASSIVE_FORCES and m.integrator != DISCRETE
    if allowed and (m.cone == ELLIPTIC or not steered):
        return True
    return w.call_python(w.entry(w.OPTIONS_CHECKER), int(steered), (m.disableflags << 8) + m.integrator, m.cone) == 1


@compiled
def require_passive_forces(model):
    """Stop with MuJoCo's error where passive forces are off: they were switched off after the data were made."""
    if model_at(model).disableflags & NO_PASSIVE_FORCES == NO_PASSIVE_FORCES:
        engine.mju_error(w.entry(w.NO_PASSIVE_MESSAGE))
