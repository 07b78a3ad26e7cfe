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
from stochfric_mb.mujoco import native as n

NO_PASSIVE_FORCES = int(mujoco.mjtDisableBit.mjDSBL_SPRING | mujoco.mjtDisableBit.mjDSBL_DAMPER)
"""With both of these disabled, MuJoCo leaves out all passive forces."""
SWITCHED_OFF = (
    "option.disableflags has both spring and damper disabled, with which MuJoCo leaves out all passive forces, "
    "friction too; enable one of them (and set stiffness or damping to 0 instead)"
)
"""What is said of that."""
DISCRETE = 4
"""mjtIntegrator."""


class IntegratorWarning(UserWarning):
    """An integrator with which friction is known to be inaccurate."""


def check_options(disabled: int, integrator: int, *, stacklevel: int = 2) -> None:
    """Look at a model's ``disableflags`` and ``integrator``.

    Raises:
        InputError: passive forces are off, and friction with them.

    Warns:
        IntegratorWarning: the ``discrete`` integrator.
    """
    if disabled & NO_PASSIVE_FORCES == NO_PASSIVE_FORCES:
        raise InputError(SWITCHED_OFF)
    if integrator == DISCRETE:
        warnings.warn(
            "integrator discrete: its friction error is twenty times that of Euler; use RK4 (best), Euler or implicitfast",
            IntegratorWarning,
            stacklevel=stacklevel + 1,
        )


def _check(_: int, disabled: int, integrator: int) -> int:
    check_options(disabled, integrator)
    return 1


MESSAGE = ctypes.create_string_buffer(f"stochfric_mb: {SWITCHED_OFF}".encode())
"""`SWITCHED_OFF` as a C string."""
CHECKER = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, ctypes.c_int64, ctypes.c_int64)(_check)
"""`check_options` as a C function; an error in it is printed and 0 comes back."""


@compiled
def options_allow(model):
    """Return whether friction can act with the model's options; says why not, or warns."""
    disabled, integrator = n.int_field(model, n.M_DISABLE), n.int_field(model, n.M_INTEGRATOR)
    if disabled & NO_PASSIVE_FORCES != NO_PASSIVE_FORCES and integrator != DISCRETE:
        return True
    return n.call_python(n.entry(n.OPTIONS_CHECKER), model, disabled, integrator) == 1


@compiled
def require_passive_forces(model):
    """Stop with MuJoCo's error where passive forces are off: they were switched off after the data were made."""
    if n.int_field(model, n.M_DISABLE) & NO_PASSIVE_FORCES == NO_PASSIVE_FORCES:
        n.mju_error(n.entry(n.NO_PASSIVE_MESSAGE))
