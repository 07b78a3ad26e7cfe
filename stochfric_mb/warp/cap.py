"""The friction coefficient of a sliding contact as a Warp function, made of the law's own ``init`` and ``force``."""

from __future__ import annotations

import functools
from typing import Any

import warp as wp

from stochfric_mb.coefficients.distributions import transform
from stochfric_mb.coefficients.path import evaluate, independent_pair
from stochfric_mb.coefficients.philox import normals
from stochfric_mb.coefficients.processes import TIME, Process
from stochfric_mb.errors import InputError
from stochfric_mb.laws import Law, law_class
from stochfric_mb.warp.translate import ARRAY, INT, REAL, Made, Numbers, Translator

_CAP = """
@wp.func
def cap(speed: {real}, fast: {real}, mu_s: {real}, mu_k: {real}, p: wp.array[{real}]):
    one = {real}(1.0)
    zero = {real}(0.0)
    {state} = {init}(zero, zero, zero, wp.max(speed, fast), zero, one, mu_s, mu_k, one, zero, zero, p)
    fx, fy = {force}(zero, zero, zero, speed, zero, one, {state}, mu_s, mu_k, one, zero, zero, p)
    return fx
"""


def require_runnable(law: Law) -> None:
    """Return if a law can steer the solver.

    Raises:
        InputError: its friction is no cap with true stick below it.
    """
    if law.has_flow:
        raise InputError(
            f"law {law.kind} is a bristle, which Warp's constraint solver cannot carry; use elastic_stick or stribeck here, or "
            f"{law.kind} with stochfric_mb.mujoco.add_friction"
        )
    if not law.state_names or law.state_names[0] != "mode":
        raise InputError(
            f"law {law.kind} has no true stick: near rest its force is a function of velocity, which Warp's constraint solver "
            f"cannot carry; use stribeck or elastic_stick here, or {law.kind} with stochfric_mb.mujoco.add_friction"
        )


def require_along_time(process: Process | None) -> None:
    """Return if coefficients run along time.

    Raises:
        InputError: they run along the path or the stick phases of each contact, which a world does not keep.
    """
    if process is not None and process.clock != TIME:
        raise InputError(
            f"process {process.kind} runs along each contact's own path or stick phases, but a world of MuJoCo Warp has one "
            "path along time; use knots, ornstein_uhlenbeck or matern here"
        )


@functools.cache
def cap_function(kind: str, real: type = wp.float32) -> Any:
    """Return the Warp function ``cap(speed, fast, mu_s, mu_k, p)`` of a law: the friction coefficient while it slides [-].

    ``speed`` >= 0 [m/s]; ``fast`` [m/s] is a speed at which the law slides for certain; ``p`` are its parameters.
    """
    translator = Translator(real)
    module: Any = law_class(kind).functions()
    leading = (REAL,) * 6
    init = translator.add(module.init, (*leading, *(REAL,) * 5, ARRAY))
    count = init.returns.count if isinstance(init.returns, Numbers) else 1
    force = translator.add(module.force, (*leading, Numbers(count), *(REAL,) * 5, ARRAY))
    state = ", ".join(f"s_{i}" for i in range(count))
    source = _CAP.format(real=translator.real, state=state, init=init.name, force=force.name)
    return translator.functions(Made("cap", REAL), then=source)[0]


@functools.cache
def coefficient_functions() -> tuple[Any, ...]:
    """Return Warp functions of this package's random numbers, all in float64: to the bit what the CPU has.

    They are `path.evaluate`, `path.independent_pair`, `philox.normals` and `distributions.transform`.
    """
    translator = Translator(wp.float64)
    address = (INT, INT, INT, INT)
    return translator.functions(
        translator.add(evaluate, (ARRAY, ARRAY, INT, INT, INT, REAL, REAL, REAL)),
        translator.add(independent_pair, (ARRAY, *address)),
        translator.add(normals, (*address, INT)),
        translator.add(transform, (REAL, REAL, REAL, REAL, ARRAY, INT, INT)),
    )
