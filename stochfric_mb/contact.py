"""Friction of one contact for a solver of one's own: the law, its state and its coefficients behind three calls.

>>> from stochfric_mb import Contact, ElasticStick
>>> contact = Contact(ElasticStick(mu_s=0.8, mu_k=0.46), effective_mass=2.0, dt=1e-4)
>>> contact.start(0.0, u=0.0, v=1.0, normal_force=10.0)  # once
>>> round(contact.force(0.0, u=0.0, v=1.0, normal_force=10.0), 6)  # as often as the solver likes
4.6
>>> contact.commit(1e-4, u=1e-4, v=1.0, normal_force=10.0)  # once per accepted step, nowhere else

``u`` and ``v`` are relative displacement [m] and velocity [m/s], counter-surface minus body; the force [N] that comes
out acts on the body, along ``+v``.
"""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import math
from typing import Any, NoReturn

import numpy as np

from stochfric_mb.coefficients.path import CURSOR, canonical_time, evaluate
from stochfric_mb.compile import compiled
from stochfric_mb.errors import InputError, SimulationError, require_number
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law
from stochfric_mb.laws.abi import MAX_STATE, call_law, native_law

ALIVE, EVENTS, MU_S, MU_K, STUCK, MASS, HALF_STEP, STICK_SPEED, MODED = range(9)
"""Entries of a contact's book: whether it has a state, times it has come to stick, the coefficients and whether it
sticks as of the last commit, effective mass [kg], half the step [s], stick speed [m/s], whether the state has a mode."""
BOOK = 9
Pair = tuple[float, float]


class _Contact:
    """What contacts along a line and in a plane share."""

    def __init__(
        self,
        friction: Law | Friction,
        *,
        effective_mass: float | None = None,
        seed: int = 0,
        sample: int = 0,
        contact: int = 0,
        dt: float = 0.0,
    ) -> None:
        """Make a contact that has no state yet; `start`, or its first `commit` with a normal force, gives it one.

        Args:
            friction: the law, or the law with the process of its coefficients.
            effective_mass: mass that the contact feels [kg], > 0; for laws that use it.
            seed: first part of the address of the coefficient path.
            sample: second part.
            contact: third part, different for each contact of a model.
            dt: the solver's step [s], 0 if it varies: frees times summed step by step of their rounding, so that the
                coefficients are those of every other engine to the bit.

        Raises:
            InputError: a value out of range, or a law that needs the effective mass without one.
        """
        self._friction = as_friction(friction)
        law = self._friction.law
        if law.needs_effective_mass and effective_mass is None:
            raise InputError(f"law {law.kind} needs effective_mass [kg]; give the mass that the contact feels")
        path = self._friction.path(seed, sample, contact)
        self._address = np.array([path.seed, path.sample, path.contact], dtype=np.int64)
        self._descriptor, self._cursor = path.descriptor, np.zeros(CURSOR)
        self._parameters = law.parameters()
        self._state, self._out, self._book = np.zeros(MAX_STATE), np.zeros(MAX_STATE), np.zeros(BOOK)
        self._book[MU_S], self._book[MU_K] = law.mu_s, law.mu_k
        self._book[HALF_STEP] = 0.5 * require_number("dt", dt, low=0.0, unit="s")
        self._book[STICK_SPEED] = law.stick_speed
        self._book[MODED] = bool(law.state_names) and law.state_names[0] == "mode"
        self.effective_mass = 1.0 if effective_mass is None else effective_mass
        self._functions = _functions(law)

    @property
    def law(self) -> Law:
        """The friction law."""
        return self._friction.law

    @property
    def effective_mass(self) -> float:
        """Mass that the contact feels [kg]; may be set at any time."""
        return float(self._book[MASS])

    @effective_mass.setter
    def effective_mass(self, mass: float) -> None:
        self._book[MASS] = require_number("effective_mass", mass, above=0.0, unit="kg")

    @property
    def mu_s(self) -> float:
        """Static coefficient [-] as of the last commit."""
        return float(self._book[MU_S])

    @property
    def mu_k(self) -> float:
        """Kinetic coefficient [-] as of the last commit."""
        return float(self._book[MU_K])

    @property
    def stick(self) -> bool:
        """Whether the contact sticks, as of the last commit."""
        return bool(self._book[STUCK])

    @property
    def state(self) -> dict[str, float]:
        """The law's state by name, empty before the contact has begun."""
        return dict(zip(self.law.state_names, self._state.tolist(), strict=False)) if self._book[ALIVE] else {}

    def _call(self, function: Any, *numbers: float) -> None:
        if not math.isfinite(sum(numbers)):
            self._broken("what the solver gives is not finite", numbers)
        function(
            self._functions, self._address, self._descriptor, self._cursor, self._parameters, self._state, self._book,
            self._out, *numbers,
        )  # fmt: skip

    def _force(self, *numbers: float) -> Pair:
        self._call(_compute, *numbers)
        fx, fy = float(self._out[0]), float(self._out[1])
        if not math.isfinite(fx + fy):
            self._broken("the force is not finite", numbers)
        return fx, fy

    def _broken(self, what: str, numbers: tuple[float, ...]) -> NoReturn:
        names = ("t", "ux", "uy", "vx", "vy", "normal_force", "hx", "hy")
        given = ", ".join(f"{name} = {value:g}" for name, value in zip(names, numbers, strict=True))
        raise SimulationError(f"law {self.law.kind}: {what}: {given}; the motion has broken down: use a smaller step")

    def __getstate__(self) -> dict[str, Any]:
        return {k: v for k, v in vars(self).items() if k != "_functions"}  # addresses belong to this process

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._functions = _functions(self._friction.law)


class Contact(_Contact):
    """Friction of a contact that slides along a line."""

    def start(self, t: float, u: float, v: float, normal_force: float, *, hold: float = 0.0) -> None:
        """Give the contact its state at the start; arguments as in `force`."""
        self._call(_start, t, u, 0.0, v, 0.0, normal_force, hold, 0.0)

    def force(self, t: float, u: float, v: float, normal_force: float, *, hold: float = 0.0) -> float:
        """Return the friction force on the body [N]; changes nothing.

        Args:
            t: time [s].
            u: relative displacement [m], counter-surface minus body.
            v: relative velocity [m/s].
            normal_force: normal force [N]; no friction where it is not positive.
            hold: friction force that would keep v as it is [N], for laws with ``needs_holding_force``.

        Raises:
            SimulationError: an argument or the force is not finite.
        """
        return self._force(t, u, 0.0, v, 0.0, normal_force, hold, 0.0)[0]

    def commit(self, t: float, u: float, v: float, normal_force: float, *, hold: float = 0.0) -> None:
        """Bring the law's state up to the end of an accepted step; without normal force the contact ends."""
        self._call(_commit, t, u, 0.0, v, 0.0, normal_force, hold, 0.0)


class PlaneContact(_Contact):
    """Friction of a contact that slides in a plane; vectors are pairs in a tangent frame that does not turn."""

    def start(self, t: float, u: Pair, v: Pair, normal_force: float, *, hold: Pair = (0.0, 0.0)) -> None:
        """Give the contact its state at the start; arguments as in `force`."""
        self._call(_start, t, *u, *v, normal_force, *hold)

    def force(self, t: float, u: Pair, v: Pair, normal_force: float, *, hold: Pair = (0.0, 0.0)) -> Pair:
        """Return the friction force on the body [N]; arguments as in `Contact.force`, u, v and hold as pairs."""
        return self._force(t, *u, *v, normal_force, *hold)

    def commit(self, t: float, u: Pair, v: Pair, normal_force: float, *, hold: Pair = (0.0, 0.0)) -> None:
        """Bring the law's state up to the end of an accepted step; without normal force the contact ends."""
        self._call(_commit, t, *u, *v, normal_force, *hold)


def _functions(law: Law) -> Any:
    native = native_law(law.kind)
    return np.array([native.init, native.force, native.commit, native.n_state], dtype=np.int64)


@compiled
def _compute(functions, address, descriptor, cursor, p, state, book, out, t, ux, uy, vx, vy, normal_force, hx, hy):
    """Put the force into ``out``; the state is read only."""
    out[0], out[1] = 0.0, 0.0
    if normal_force <= 0.0:
        return
    t = canonical_time(t, book[HALF_STEP])
    mu_s, mu_k = evaluate(descriptor, cursor, address[0], address[1], address[2], t, ux, book[EVENTS])
    here = state
    if book[ALIVE] == 0.0:
        here = np.zeros(MAX_STATE)
        _call(functions[0], t, ux, uy, vx, vy, normal_force, mu_s, mu_k, book[MASS], hx, hy, here, p, here)
    _call(functions[1], t, ux, uy, vx, vy, normal_force, mu_s, mu_k, book[MASS], hx, hy, here, p, out)


@compiled
def _call(function, t, ux, uy, vx, vy, normal_force, mu_s, mu_k, mass, hx, hy, state, p, out):
    """Call a function of the law; arrays that a caller passes live on while addresses of them are in use."""
    call_law(
        function, t, ux, uy, vx, vy, normal_force, mu_s, mu_k, mass, hx, hy, state.ctypes.data, p.ctypes.data, out.ctypes.data
    )


@compiled
def _start(functions, address, descriptor, cursor, p, state, book, out, t, ux, uy, vx, vy, normal_force, hx, hy):
    """Give the contact its first state."""
    book[EVENTS] = 0.0
    book[ALIVE] = 0.0
    _advance(functions, address, descriptor, cursor, p, state, book, out, t, ux, uy, vx, vy, normal_force, hx, hy)


@compiled
def _commit(functions, address, descriptor, cursor, p, state, book, out, t, ux, uy, vx, vy, normal_force, hx, hy):
    """Commit, and count the times that the contact comes to stick."""
    slid = book[ALIVE] == 1.0 and book[STUCK] == 0.0
    _advance(functions, address, descriptor, cursor, p, state, book, out, t, ux, uy, vx, vy, normal_force, hx, hy)
    if slid and book[STUCK] == 1.0:
        book[EVENTS] += 1.0


@compiled
def _advance(functions, address, descriptor, cursor, p, state, book, out, t, ux, uy, vx, vy, normal_force, hx, hy):
    """Set the state: the law's commit, or its init where the contact begins."""
    t = canonical_time(t, book[HALF_STEP])
    mu_s, mu_k = evaluate(descriptor, cursor, address[0], address[1], address[2], t, ux, book[EVENTS])
    book[MU_S], book[MU_K] = mu_s, mu_k
    if normal_force <= 0.0:
        book[ALIVE], book[STUCK] = 0.0, 0.0
        return
    which = 0 if book[ALIVE] == 0.0 else 2
    _call(functions[which], t, ux, uy, vx, vy, normal_force, mu_s, mu_k, book[MASS], hx, hy, state, p, out)
    for i in range(functions[3]):
        state[i] = out[i]
    book[ALIVE] = 1.0
    stuck = state[0] == 0.0 if book[MODED] == 1.0 else math.hypot(vx, vy) <= book[STICK_SPEED]
    book[STUCK] = 1.0 if stuck else 0.0
