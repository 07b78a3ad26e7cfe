# type: ignore
# (Warp functions are typed by Warp)
"""A law's own functions in Warp, and its rules at rest, which contacts and joints share.

The rules are those of `stochfric_mb.mujoco.contact.solver`: how a contact breaks away and sticks again by the force that the
solver found, what a stuck row is, and at which speed a law that creeps at rest creeps.
"""

import functools
from typing import Any

import warp as wp

from stochfric_mb.coefficients.distributions import transform
from stochfric_mb.coefficients.path import evaluate, independent_pair
from stochfric_mb.coefficients.philox import normals
from stochfric_mb.errors import InputError
from stochfric_mb.laws import Law, law_class
from stochfric_mb.mujoco.contact import rows
from stochfric_mb.numerics import root
from stochfric_mb.warp.state import SLIP, STICK
from stochfric_mb.warp.translate import ARRAY, INT, REAL, Numbers, Translator

RIGID = wp.constant(rows.RIGID)
"""Share of a stuck row's deflection that the solver takes back in one step, where the law is rigid."""
CLOSE = wp.constant(1.0e-6)
"""Part of the force to which the speed of creep gives it: beyond it, float32 ends."""
ROUNDING = wp.constant(1.2e-7)
"""Relative distance of neighbouring numbers of float32 [-]."""
LEAST_MOBILITY = wp.constant(1.0e-12)
"""Keeps the mass of what cannot move a number [1/kg]."""
TRIALS = wp.constant(64)
"""Most trials for the speed of creep: halving alone would need 24."""


@wp.struct
class Touch:
    """A contact or joint as the step before left it, and as it is now; forces and motion along two tangents."""

    mode: int
    drift: wp.vec2
    """Displacement since it stuck [m]."""
    pull: wp.vec2
    """The solver's friction force in the step before [N]; it opposes the motion."""
    load: float
    """Normal force in the step before, 0 for a new contact [N]."""
    mu_s: float
    mu_k: float
    """Coefficients of the step before, then of this one [-]."""
    creep: float
    """Speed at which a law that creeps at rest has the force at hand [m/s]."""
    events: int
    """Number of stick phases that have begun."""
    path: wp.float64
    """Displacement along the contact's direction since it began [m]."""
    acceleration: wp.vec2
    """In the step before [m/s^2]."""
    springs: int
    """Whether, stuck, it is the spring of an elastic law; 0 where the law is rigid or a step cannot follow its spring."""
    cap: float
    """Coefficient of friction that the solver is allowed [-]."""
    scale: float
    """What the tangential rows of the solver's Jacobian are multiplied by [-]."""


@wp.func
def felt_mass(mobility: float):
    """Return the mass [kg, kg m^2] that a mobility stands for."""
    return 1.0 / wp.max(mobility, LEAST_MOBILITY)


def require_runnable(law: Law) -> None:
    """Return if a law can steer the solver.

    Raises:
        InputError: its friction is no cap.
    """
    if law.rest == "bristle":
        raise InputError(
            f"law {law.kind} is a bristle, which Warp's constraint solver cannot carry; use elastic_stick or stribeck here, or "
            f"{law.kind} with stochfric_mb.mujoco.add_friction"
        )


@functools.cache
def slide_function(kind: str, real: type = wp.float32) -> Any:
    """Return the law's ``sliding_coefficient(speed, mu_s, mu_k, p)`` as a Warp function."""
    translator = Translator(real)
    return translator.functions(translator.add(law_class(kind).functions().sliding_coefficient, (REAL, REAL, REAL, ARRAY)))[0]


@functools.cache
def spring_function(kind: str, real: type = wp.float32) -> Any:
    """Return ``stick_spring(normal_force, effective_mass, mu_s, p)`` of a law that is elastic at rest as a Warp function."""
    translator = Translator(real)
    return translator.functions(translator.add(law_class(kind).functions().stick_spring, (REAL, REAL, REAL, ARRAY)))[0]


@functools.cache
def creep_function(kind: str) -> Any:
    """Return the Warp function of the speed at which a law that creeps at rest has a given force."""
    slide = slide_function(kind)
    translator, b = Translator(), Numbers(len(root.Bracket._fields), root.Bracket._fields)
    bracket, is_wide, trial, narrowed = translator.functions(
        translator.add(root.bracket, (REAL,) * 4),
        translator.add(root.is_wide, (b, REAL)),
        translator.add(root.trial, (b, REAL)),
        translator.add(root.narrowed, (b, REAL, REAL)),
    )

    @wp.func
    def creep_speed(force: float, load: float, guess: float, fastest: float, mu_s: float, mu_k: float, p: wp.array[float]):
        excess = force - slide(fastest, mu_s, mu_k, p) * load
        if excess > 0.0:
            return fastest
        least = ROUNDING * fastest
        b_0, b_1, b_2, b_3, b_4, b_5 = bracket(0.0, force, fastest, excess)
        speed = guess
        if guess <= 0.0 or guess >= fastest:
            speed = trial(b_0, b_1, b_2, b_3, b_4, b_5, least)
        for _i in range(TRIALS):
            if not is_wide(b_0, b_1, b_2, b_3, b_4, b_5, least):
                break
            lack = force - slide(speed, mu_s, mu_k, p) * load
            if wp.abs(lack) <= CLOSE * force:
                return speed
            b_0, b_1, b_2, b_3, b_4, b_5 = narrowed(b_0, b_1, b_2, b_3, b_4, b_5, speed, lack)
            speed = trial(b_0, b_1, b_2, b_3, b_4, b_5, least)
        return b_1

    return creep_speed


@functools.cache
def rest_rules(kind: str) -> tuple[Any, Any]:
    """Return the Warp functions ``decide`` and ``stuck_row`` of a law."""
    return {"rigid": _rigid, "elastic": _elastic, "creep": _creeping}[law_class(kind).rest](kind)


def _rigid(kind: str) -> tuple[Any, Any]:
    @wp.func
    def decide(
        touch: Touch, v: wp.vec2, h: float, stoppable: float, peak: float, saturated: int, loose: int, felt: float,
        p: wp.array[float],
    ):  # fmt: skip
        if touch.mode == STICK:
            if saturated == 0:
                touch.drift = touch.drift + h * v
            if loose == 1:
                touch.mode = SLIP
        elif saturated == 0:
            touch.mode = STICK
        if wp.length(v) > stoppable:
            touch.mode = SLIP
        return touch

    @wp.func
    def stuck_row(touch: Touch, resistance: float, h: float, peak: float, felt: float, p: wp.array[float]):
        return resistance, RIGID / (h * h), touch.mu_s, 0

    return decide, stuck_row


def _elastic(kind: str) -> tuple[Any, Any]:
    spring = spring_function(kind)
    translator = Translator()
    (spring_of,) = translator.functions(translator.add(rows.spring_of, (REAL,) * 4))

    @wp.func
    def decide(
        touch: Touch, v: wp.vec2, h: float, stoppable: float, peak: float, saturated: int, loose: int, felt: float,
        p: wp.array[float],
    ):  # fmt: skip
        stiffness, _damping, limit = spring(touch.load, felt, touch.mu_s, p)
        if touch.mode == STICK:
            if saturated == 0 or loose == 1:
                touch.drift = touch.drift + h * v
            out = wp.length(touch.drift)
            if touch.springs == 0:  # a step cannot follow the spring: as a rigid law
                touch.mode = wp.where(loose == 1, SLIP, STICK)
            elif loose == 1 and out >= limit and wp.dot(touch.drift, v) > 0.0:
                touch.mode = SLIP
            elif saturated == 1 and out > limit:
                touch.drift = touch.drift * (limit / out)
        elif saturated == 0:
            touch.mode = STICK
            if stiffness > 0.0:  # the deflection that keeps the force
                touch.drift = -touch.pull / stiffness
        if wp.length(v) > stoppable:
            touch.mode = SLIP
        return touch

    @wp.func
    def stuck_row(touch: Touch, resistance: float, h: float, peak: float, felt: float, p: wp.array[float]):
        stiffness, damping, _limit = spring(touch.load, felt, touch.mu_s, p)
        if stiffness > 0.0:
            total, own = spring_of(resistance, stiffness, damping, h)
            if own * h * h <= 1.0:  # a step would not take back more than all of the deflection
                return total, own, touch.mu_s, 1
        return resistance, RIGID / (h * h), touch.mu_s, 0

    return decide, stuck_row


def _creeping(kind: str) -> tuple[Any, Any]:
    slide, creep_speed = slide_function(kind), creep_function(kind)

    @wp.func
    def decide(
        touch: Touch, v: wp.vec2, h: float, stoppable: float, peak: float, saturated: int, loose: int, felt: float,
        p: wp.array[float],
    ):  # fmt: skip
        was = int(touch.mode)  # a copy
        speed = wp.length(v)
        if was == STICK:
            if saturated == 0 or loose == 1:
                touch.drift = touch.drift + h * v
            touch.mode = wp.where(loose == 1 or speed > stoppable, SLIP, STICK)
        else:
            touch.mode = wp.where(speed > peak, SLIP, STICK)
        force = wp.length(touch.pull)
        touch.creep = 0.0
        if touch.mode == STICK and force > 0.0:
            touch.creep = creep_speed(force, touch.load, touch.creep, peak, touch.mu_s, touch.mu_k, p)
            if was == STICK:  # its anchor follows
                touch.drift = touch.drift + (h * touch.creep / force) * touch.pull
        return touch

    @wp.func
    def stuck_row(touch: Touch, resistance: float, h: float, peak: float, felt: float, p: wp.array[float]):
        force = wp.length(touch.pull)
        total = resistance
        if force > 0.0:
            total += touch.creep / (h * force)
        return total, RIGID / (h * h), slide(peak, touch.mu_s, touch.mu_k, p), 0

    return decide, stuck_row


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
