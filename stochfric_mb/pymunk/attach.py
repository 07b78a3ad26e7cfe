"""Stochastic friction between shapes of any pymunk space, from the moment it is added until it is removed."""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Sequence, Set
from typing import Any

import numpy as np
import numpy.typing as npt
import pymunk
from pymunk._chipmunk_cffi import ffi, lib

from stochfric_mb.coefficients import CoefficientPath, PerEvent
from stochfric_mb.errors import InputError, SimulationError, StabilityError, require_name, require_number
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law
from stochfric_mb.laws.abi import native_law
from stochfric_mb.pymunk import records as r
from stochfric_mb.pymunk.handlers import attach, detach
from stochfric_mb.pymunk.layout import NAMES, address_of, layout
from stochfric_mb.pymunk.response import steady_force

Shapes = pymunk.Shape | Sequence[pymunk.Shape] | Set[pymunk.Shape] | int | str
"""One side of the contacts: a shape, shapes (those of a set in the order in which the space took them in), a collision
type, or ``"*"`` for all."""
ALL_SHAPES = "*"
BEYOND_LIMIT = ("raise", "cap")
"""What may be done with a contact whose law is too stiff for the step."""
MARGIN = 0.5
"""Share of the stability limit that messages recommend."""


@dataclasses.dataclass(frozen=True)
class ContactReading:
    """What one contact (one pair of shapes) had in the step last taken."""

    contact: int
    """Number of the contact, third part of the address of its coefficient path."""
    a: pymunk.Shape
    """The body's shape."""
    b: pymunk.Shape
    """The counter-surface's shape."""
    force: float
    """Friction force on the body of ``a`` [N] along ``direction``."""
    normal_force: float
    """Normal force [N]."""
    velocity: float
    """Velocity of ``b`` relative to ``a`` [m/s] along ``direction``, at the time of the force."""
    displacement: float
    """Displacement of ``b`` relative to ``a`` since they met [m], likewise."""
    mu_s: float
    """Static coefficient [-]."""
    mu_k: float
    """Kinetic coefficient [-]."""
    stick: bool
    """Whether the contact sticks."""
    rigid: bool
    """Whether pymunk's own friction solver held it, with the law's cap: always with laws of true stick, and with others where
    they are too stiff for the step and ``beyond_limit="cap"``."""
    stick_phases: int
    """How often the contact has begun to stick."""
    effective_mass: float
    """Mass that the friction force feels [kg]."""
    direction: tuple[float, float]
    """Unit vector (n_y, -n_x) of the normal n from ``b`` to ``a``."""


class ContactFriction:
    """Friction added to a space by `add_friction`; ``remove()`` takes it away."""

    def __init__(
        self, space: pymunk.Space, friction: Friction, path: CoefficientPath, capacity: int, beyond_limit: str = "raise"
    ) -> None:
        """Hold what the compiled callbacks use; called by `add_friction`."""
        self.space = space
        self.friction = friction
        self.path = path
        self.table = _table(friction, path, capacity)
        self._parameters = friction.law.parameters()
        self._pairs = np.full((capacity, r.PAIR), -1, dtype=np.int64)
        self._slots = np.zeros((capacity, r.SLOT))
        self._clock = np.zeros(r.CLOCK_SIZE)
        self._clock[[r.STICK_SPEED, r.LARGEST_LOAD]] = friction.law.stick_speed, math.inf
        self._clock[r.PEAK_SPEED] = friction.law.stick_speed
        self._sides: list[Any] = []
        self.table[r.PAIRS] = self._pairs.ctypes.data
        self.table[r.SLOTS] = self._slots.ctypes.data
        self.table[r.CLOCK] = self._clock.ctypes.data
        self.table[r.PARAMETERS] = self._parameters.ctypes.data
        self.table[r.DESCRIPTOR] = path.descriptor.ctypes.data
        if beyond_limit == "cap" and not friction.law.needs_holding_force:
            self.table[r.CAP_WHEN_STIFF] = 1
            self._clock[r.PEAK_SPEED] = _peak_speed(friction.law, self.table)
        self.table[r.LAST_STAMP] = lib.cpSpaceGetTimestamp(space._space)

    @property
    def time(self) -> float:
        """Time of the force last applied [s]; the coefficients run along it. It starts at 0 and may be set."""
        return float(self._clock[r.NOW])

    @time.setter
    def time(self, value: float) -> None:
        self._clock[[r.NOW, r.STEP_TIME]] = value

    @property
    def initial_displacement(self) -> float:
        """Displacement with which contacts start [m]: the origin of coefficients that vary along the surface."""
        return float(self._clock[r.START])

    @initial_displacement.setter
    def initial_displacement(self, value: float) -> None:
        self._clock[r.START] = value

    def readings(self) -> list[ContactReading]:
        """Return what each contact had in the step last taken, in the order of their numbers; those that touched.

        Raises:
            SimulationError: see `check`.
        """
        self.check()
        rows = self._touching()
        if not len(rows):
            return []
        shapes = {_number(shape): shape for shape in self.space.shapes}
        items = [_reading(self._pairs[i], self._slots[i], shapes) for i in rows]
        return sorted((x for x in items if x is not None), key=lambda x: x.contact)

    def step_limit(self) -> float:
        """Return the largest stable step [s] of the law for the contacts that touched in the step last taken."""
        law = self.friction.law
        slots = (s for s in self._slots[self._touching()] if s[r.NORMAL] > 0.0)
        return float(min((law.step_limit(s[r.NORMAL], s[r.EFFECTIVE_MASS]) for s in slots), default=math.inf))

    def slot(self, number: int = 0) -> npt.NDArray[np.float64]:
        """Return the live record of a contact (entries named in `stochfric_mb.pymunk.records`), in order of first touch."""
        return self._slots[number]

    def check(self) -> None:
        """Do nothing while all is well. ``space.step`` raises the same errors when they arise.

        Raises:
            SimulationError: a motion or a force that is not finite, or more contacts than ``max_contacts``.
            StabilityError: the step was beyond the stability limit of the law for several steps.
        """
        error = self.problem()
        if error is not None:
            raise error
        for body in self.space.bodies:
            x, y = body.position
            u, v = body.velocity
            if not math.isfinite(x + y + u + v + body.angular_velocity):
                raise SimulationError(
                    f"a body is at {(x, y)} with velocity {(u, v)}: the run is broken, states must be finite; lower dt or "
                    "check the forces on it"
                )

    def problem(self) -> Exception | None:
        """Return the error that `check` would raise for the contacts, or None."""
        law, problem = self.friction.law, int(self.table[r.PROBLEM])
        if problem & r.NOT_FINITE:
            return SimulationError(
                f"a contact's motion, or the force of the law {law.kind!r} on it, is not finite; lower dt or check the law's "
                "parameters and the forces on the bodies"
            )
        if problem & r.UNSTABLE:
            dt, load = self._clock[r.CHECKED_STEP], self._clock[r.WORST_LOAD]
            limit = law.step_limit(load, 1.0)
            return StabilityError(
                f"dt = {dt:g} s is beyond the stability limit {limit:.3g} s of the law {law.kind!r} "
                f"({law.step_limit_formula}) for a contact with N/m_eff = {load:.3g} N/kg; use dt <= {MARGIN * limit:.2g} s, "
                'or add_friction(..., beyond_limit="cap"), with which pymunk\'s own solver holds such contacts'
            )
        if problem & r.OVERFLOW:
            return SimulationError(
                f"more than max_contacts = {len(self._slots)} pairs of shapes touched at a time, and the rest had pymunk's own "
                "friction; raise max_contacts"
            )
        return None

    def prepare(self, dt: float) -> None:
        """Find the largest stable load for steps of ``dt`` [s]; the callbacks ask for it when ``dt`` is new."""
        if self._clock[r.CHECKED_STEP] != dt:
            self._clock[r.CHECKED_STEP] = dt
            self._clock[r.LARGEST_LOAD] = largest_load(self.friction.law, dt)

    def remove(self) -> None:
        """Take the friction away: the handlers and pymunk's own friction are as they were before."""
        detach(self.space, self)

    def _touching(self) -> npt.NDArray[np.intp]:
        now = lib.cpSpaceGetTimestamp(self.space._space)
        return np.flatnonzero(self._pairs[: self.table[r.USED], r.STAMP] == now)


def add_friction(
    space: pymunk.Space,
    a: Shapes,
    b: Shapes,
    friction: Law | Friction,
    *,
    seed: int = 0,
    sample: int = 0,
    max_contacts: int = 1024,
    beyond_limit: str = "raise",
) -> ContactFriction:
    """Let a friction law act where ``a`` touches ``b``, instead of pymunk's own friction; the handle that undoes it.

    Nothing else changes: call ``space.step(dt)`` as before. pymunk's steps are first order in position (off by a t dt/2,
    friction or not); `start` before the first makes them second order. The time of the coefficients starts at 0, and each
    contact has a path of its own: contact i len(b) + j between the shapes a[i] and b[j] where both are listed, otherwise
    contacts are numbered by first touch. A contact that opens and closes again starts anew on the same path.

    Laws with true stick (coulomb, karnopp, stribeck) set the cap of pymunk's own friction solver; all others are
    applied as forces while they stick. Where several frictions fit a contact, the one added first acts. The user's
    collision handlers go on working; their exceptions are raised by ``space.step``.

    Args:
        space: the space.
        a: the bodies: a shape, shapes, a collision type, or ``"*"`` for any shape.
        b: the counter-surfaces, likewise.
        friction: a law, or a law with random coefficients.
        seed: first part of the address of the coefficient paths.
        sample: second part.
        max_contacts: most pairs of shapes that may touch at a time.
        beyond_limit: what becomes of a contact whose law is too stiff for the step, at its load and effective mass. "raise": a
            `StabilityError`; "cap": for that step pymunk's own solver holds it, with the law's steady friction as its cap
            (the largest while it holds). Such a contact sticks rigidly: elastic deflection and creep are lost, what it takes to
            break away and what friction does while it slides are kept.

    Raises:
        InputError: shapes that are not in the space, or sensors; "cap" with a law that carries effects.
        SimulationError: this build of pymunk has an unknown layout.
    """
    friction = as_friction(friction)
    capacity = int(require_number("max_contacts", max_contacts, low=1.0))
    require_name("beyond_limit", beyond_limit, BEYOND_LIMIT)
    if beyond_limit == "cap" and friction.law.with_effects:
        raise InputError(
            f'beyond_limit = "cap" needs the steady friction of the law {friction.law.kind}, which effects change as it runs; '
            'use "raise" and a step within its limit'
        )
    handle = ContactFriction(space, friction, friction.path(seed, sample), capacity, beyond_limit)
    listed = [_fill_side(handle, r.SIDE_A, space, a), _fill_side(handle, r.SIDE_B, space, b)]
    if all(listed) and not any(x.body is not y.body for x in listed[0] for y in listed[1]):
        raise InputError("a and b hold no two shapes on different bodies; nothing could touch")
    attach(space, handle)
    return handle


def largest_load(law: Law, dt: float) -> float:
    """Return the largest normal force per effective mass [N/kg] at which steps of ``dt`` [s] are stable, by bisection.

    A force N f(u, v) on a mass m depends on N/m alone, and so does the limit.
    """
    if law.needs_holding_force or not dt > 0.0 or law.step_limit(1.0e12, 1.0) >= dt:
        return math.inf
    low, high = -12.0, 12.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if law.step_limit(10.0**middle, 1.0) >= dt else (low, middle)
    return 10.0**low


def _peak_speed(law: Law, table: npt.NDArray[np.int64]) -> float:
    """Return the speed [m/s], up to a hundred stick speeds, at which the law's steady friction first has a maximum."""
    s = np.zeros(r.SLOT)
    s[[r.MU_S, r.MU_K, r.EFFECTIVE_MASS]] = law.mu_s, law.mu_k, 1.0
    speeds = law.stick_speed * np.sort(np.append(np.geomspace(1.0e-6, 1.0e2, 241), 1.0 + 1.0e-9))  # a switch lies just beyond 1
    friction = np.array([steady_force(table, s, v, 0.0, 1.0) for v in speeds])
    falls = np.flatnonzero(np.diff(friction) <= 0.0)
    return float(speeds[falls[0] if len(falls) else -1])


def _table(friction: Friction, path: CoefficientPath, capacity: int) -> npt.NDArray[np.int64]:
    law = friction.law
    functions = native_law(law.kind)
    table = np.zeros(r.TABLE, dtype=np.int64)
    table[r.CAPACITY] = capacity
    table[[r.INIT, r.FORCE_LAW, r.COMMIT, r.GUARD]] = functions.init, functions.force, functions.commit, functions.guards
    table[r.DESCRIPTOR_SIZE] = len(path.descriptor)
    table[[r.SEED, r.SAMPLE]] = path.seed, path.sample
    table[r.HAS_MODE] = law.state_names[:1] == ("mode",)
    table[r.PER_EVENT] = isinstance(friction.process, PerEvent)
    table[r.HOLDING] = law.needs_holding_force
    table[r.STATEFUL], table[r.N_STATE] = bool(law.state_names), functions.n_state
    table[r.LAYOUT :] = layout()
    return table


def _fill_side(handle: ContactFriction, side: int, space: pymunk.Space, which: Shapes) -> list[pymunk.Shape]:
    """Enter which shapes belong to a side; return those that are listed."""
    table = handle.table
    if isinstance(which, str):
        if which != ALL_SHAPES:
            raise InputError(f"{which!r} names no shapes; give a shape, shapes, a collision type, or {ALL_SHAPES!r} for all")
        table[side + r.SIDE_KIND] = r.ANY
        return []
    if isinstance(which, int):
        table[side + r.SIDE_KIND] = r.TYPE
        table[side + r.SIDE_TYPE] = which
        return []
    given = which if isinstance(which, Sequence | Set) else [which]
    shapes = list(dict.fromkeys(given))
    if not shapes:
        raise InputError("a and b must hold at least one shape each; the list is empty")
    for shape in shapes:
        _require_solid(shape, space)
    if isinstance(which, Set):  # such as body.shapes, in no order
        shapes.sort(key=_number)
    addresses = np.array([address_of(s._shape) for s in shapes], dtype=np.int64)
    numbers = np.argsort(addresses)
    addresses = addresses[numbers]
    handle._sides.append((shapes, addresses, numbers))
    table[side + r.SIDE_KIND] = r.LISTED
    table[side + r.SIDE_SIZE] = len(shapes)
    table[side + r.SIDE_ADDRESSES] = addresses.ctypes.data
    table[side + r.SIDE_NUMBERS] = numbers.ctypes.data
    return shapes


def _require_solid(shape: pymunk.Shape, space: pymunk.Space) -> None:
    if not isinstance(shape, pymunk.Shape):  # pyright: ignore[reportUnnecessaryIsInstance]  # callers may not be typed
        raise InputError(
            f"{shape!r} is no pymunk shape; friction acts where shapes touch: give a shape, shapes (body.shapes), a collision "
            f"type, or {ALL_SHAPES!r}"
        )
    if shape.space is not space:
        raise InputError(f"shape {shape!r} is not in this space; add it to the space before its friction")
    if shape.sensor:
        raise InputError(f"shape {shape!r} is a sensor and feels no contact force; set shape.sensor = False")


@functools.cache
def _number_offset() -> int:
    return int(layout()[NAMES.index("shape.number")])


def _number(shape: pymunk.Shape) -> int:
    """Return the number that the space gave to a shape."""
    return int(ffi.cast("int64_t *", address_of(shape._shape) + _number_offset())[0])


def _reading(
    pair: npt.NDArray[np.int64], slot: npt.NDArray[np.float64], shapes: dict[int, pymunk.Shape]
) -> ContactReading | None:
    """Return a contact's reading, None if one of its shapes was removed since the step."""
    a, b = shapes.get(int(pair[r.NUMBER_A])), shapes.get(int(pair[r.NUMBER_B]))
    if a is None or b is None:
        return None
    return ContactReading(
        contact=int(pair[r.CONTACT]),
        a=a,
        b=b,
        force=float(slot[r.FORCE]),
        normal_force=float(slot[r.NORMAL]),
        velocity=float(slot[r.VELOCITY]),
        displacement=float(slot[r.DISPLACEMENT]),
        mu_s=float(slot[r.MU_S]),
        mu_k=float(slot[r.MU_K]),
        stick=bool(slot[r.STICK]),
        rigid=bool(slot[r.CAPPED]),
        stick_phases=int(slot[r.EVENTS]),
        effective_mass=float(slot[r.EFFECTIVE_MASS]),
        direction=(float(slot[r.NORMAL_Y]), -float(slot[r.NORMAL_X])),
    )
