"""What all friction contacts in an Exudyn system share: their memory, and what happens to it around the steps."""

from __future__ import annotations

import contextlib
import math
import warnings
from collections.abc import Iterator
from typing import Any

import exudyn
import numpy as np
import numpy.typing as npt
from exudyn.itemInterface import SensorUserFunction

from stochfric_mb.coefficients.path import CoefficientPath
from stochfric_mb.errors import InputError, SimulationError, require_number
from stochfric_mb.exudyn import layout as at
from stochfric_mb.exudyn.contact_force import kinematics
from stochfric_mb.exudyn.location import FINE, SHORTEST, locate
from stochfric_mb.exudyn.mass import effective_masses
from stochfric_mb.exudyn.normal import NO_REACTION, Normal, TimedNormal
from stochfric_mb.exudyn.stepping import FETCH, LOST, RECORDED, RESTARTED, WATCH, advance, proceed
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law
from stochfric_mb.laws.abi import MAX_STATE, native_law

OUTPUT = exudyn.OutputVariableType
INITIAL = exudyn.ConfigurationType.Initial
TOO_LARGE, MOST_COORDINATES = 4.0, 200
"""Factor by which a given mass may be above the system's own, which doubles the limit of the step; and coordinates up to
which a given one is compared at all."""
REACTION_TOLERANCE, SMALL_REACTION, REPEATS = 1.0e-6, 1.0e-3, 4
"""How near the normal force of a step must be to the reaction that comes out, of the reaction; of which part of the largest one
so far where it is smaller; and how often a step is repeated for it."""
SENSOR_NAMES = ("friction_force", "normal_force", "stick", "mu_s", "mu_k")
"""Entries of a contact's sensor: force [N] (its size where it slides in a plane), normal force [N], 1 or 0, [-], [-]."""


class JumpWarning(UserWarning):
    """A normal force jumps within a step, and steps do not end there."""


class FrictionContact:
    """A contact in an Exudyn system; made by `add_friction` and its like."""

    def __init__(
        self,
        mbs: Any,
        friction: Law | Friction,
        normal: Normal,
        *,
        hooks: Any,
        seed: int,
        sample: int,
        contact: int | None,
        effective_mass: float | None,
    ) -> None:
        """Prepare the memory; the kinds of contact say what the force acts on, then call `_begin`.

        ``hooks`` are those of the system; `add_friction` and its like say what the rest is.
        """
        self.friction = as_friction(friction)
        """The law and the process of its coefficients."""
        law = self.friction.law
        if not self.true_stick:
            _require_no_holding_force(law)
        self.given_mass = (
            None if effective_mass is None else require_number("effective_mass", effective_mass, above=0.0, unit="kg")
        )
        """The mass that the contact feels as the user gave it [kg]; None: it is taken from the system."""
        self._mbs, self._normal = mbs, normal
        self._hooks = hooks
        number: int = hooks.join()
        self._name = f"stochfric_mb friction {number}"
        contact = number if contact is None else contact
        self._numbers, self._words = _arrays(law, self.friction.path(seed, sample, contact))
        self._numbers[[at.MASS, at.RADIUS]] = self.given_mass or 1.0, 1.0
        self._numbers[at.NORMAL_FORCE] = self._numbers[at.GIVEN_NORMAL] = 0.0 if normal.changes else normal.at(0.0)
        self._records = np.empty((0, at.RECORD_COLUMNS))
        self._words[at.HELD] = int(self.true_stick)
        self._unsure = self._after_jump = self._warned = False
        self._refined = (math.nan, 0)
        self.where = int(self._words.ctypes.data)
        """Address of the contact for compiled code."""
        self._markers: tuple[Any, ...] = ()
        self.object: Any = None
        """Index of the object (or load) that carries the force."""

    true_stick = False
    """Whether a constraint holds the contact while it sticks."""
    route = "Python"
    """What evaluates the law within a step: "compiled" code, or "Python" that calls it."""
    is_load = False
    """Whether the force is a load, which implicit solvers differentiate only where they are told to."""

    _on_load = False
    """Whether a load carries the force."""

    # what the kinds of contact differ in

    def _read_motion(self) -> None:
        """Take the relative motion from the engine."""
        raise NotImplementedError

    def _forces(self) -> tuple[float, float]:
        """Return the friction force [N] on the body in both directions, as the engine applies it now."""
        raise NotImplementedError

    def connect(self) -> None:
        """Find out where the engine keeps what the contact needs (again, whenever a simulation starts)."""

    @property
    def force(self) -> Any:
        """The friction force [N] on marker 1 that the engine applies now."""
        return self._forces()[0]

    @property
    def address(self) -> tuple[int, int, int]:
        """Address of the path of coefficients: seed, sample, contact."""
        return tuple(int(w) for w in self._words[[at.SEED, at.SAMPLE, at.CONTACT]])  # type: ignore[return-value]

    @property
    def time(self) -> float:
        """Time of the last accepted step [s]; not a number before the first."""
        return float(self._numbers[at.T]) if self._words[at.STARTED] else math.nan

    @property
    def normal_force(self) -> float:
        """The normal force [N] after the last step."""
        return float(self._numbers[at.NORMAL_FORCE])

    @property
    def mu_s(self) -> float:
        """The static coefficient [-] after the last step."""
        return float(self._numbers[at.MU_S])

    @property
    def mu_k(self) -> float:
        """The kinetic coefficient [-] after the last step."""
        return float(self._numbers[at.MU_K])

    @property
    def stick(self) -> bool:
        """Whether the contact sticks after the last step."""
        return bool(self._numbers[at.STUCK])

    @property
    def state(self) -> npt.NDArray[np.float64]:
        """The law's committed state, shape (n_state,)."""
        return self._numbers[at.STATE : at.STATE + self._words[at.N_STATE]].copy()

    @property
    def needs_reactions(self) -> bool:
        """Whether the normal force is a reaction, which explicit solvers do not compute."""
        return self._normal.reaction

    @property
    def refines(self) -> bool:
        """Whether trial steps tell what friction needs: one before the first step, and steps that are repeated."""
        return self._normal.reaction

    def add_sensor(self, **options: Any) -> Any:
        """Return the number of a new sensor with the entries `SENSOR_NAMES`; options are those of Exudyn's sensors."""

        def values(mbs: Any, t: float, sensorNumbers: Any, factors: Any, configuration: Any) -> Any:
            force = self._forces()
            return [math.hypot(*force) if self._words[at.PLANE] else force[0], *self._values()]

        return self._mbs.AddSensor(SensorUserFunction(sensorNumbers=[], factors=[], sensorUserFunction=values, **options))

    def step_limit(self) -> tuple[float, str]:
        """Return the largest step [s] of an explicit solver at the largest normal force so far, and the formula behind it.

        The mass is the one given, or the system's own as of the last start.
        """
        law, numbers = self.friction.law, self._numbers
        mass, n = float(numbers[at.MASS]), float(max(numbers[at.LARGEST_NORMAL], numbers[at.NORMAL_FORCE]))
        limit, formula = law.step_limit(n, mass) if n > 0.0 else math.inf, f"law {law.kind}: {law.step_limit_formula}"
        if self._words[at.PENALTY]:
            omega = math.sqrt(numbers[at.STIFFNESS] / mass)
            zeta = numbers[at.DAMPING] / (2.0 * mass * omega)
            press = 2.0 * (math.sqrt(1.0 + zeta**2) - zeta) / omega
            if press < limit:
                limit, formula = press, "normal contact: 2 (sqrt(1 + zeta^2) - zeta)/omega, omega^2 = contact_stiffness/m_eff"
        return float(limit), formula

    def reset(self, start: float = 0.0) -> None:
        """Start the contact afresh, at the system's initial displacement and velocity and the time ``start`` [s]."""
        if self._mbs.systemIsConsistent and len(self._mbs.systemData.GetODE2Coordinates(INITIAL)):  # assembled as it is
            with self._initial_motion():
                self._read_motion()
        self._words[at.STARTED] = 0
        if self._normal.changes and not self._normal.reaction:  # implicit solvers ask for the force before the first step
            self._read_normal(start)
        proceed(start, self.where)
        locate(start, self.where)  # compiled now rather than in the middle of a run
        advance(start, self.where)
        self._words[[at.STARTED, at.NEXT_RECORD]] = 0

    def record(self, times: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return an array that the next simulation fills, shape (n, 11), a row for each time.

        Columns: time [s], relative displacement [m] and velocity [m/s] (counter-surface minus body), friction force [N],
        mu_s, mu_k [-], stick (1 or 0), normal force [N]; then displacement, velocity and friction force in the second
        direction of a tangent plane. Rows are taken at the end of the first step that reaches each time.
        """
        times = np.asarray(times, dtype=np.float64)
        self._records = np.full((len(times), at.RECORD_COLUMNS), math.nan)
        self._records[:, 0] = times
        self._words[[at.RECORDS, at.N_RECORDS, at.NEXT_RECORD]] = self._records.ctypes.data, len(times), 0
        return self._records

    def settle(self, t: float, bits: int) -> bool:
        """Do what `stepping.advance` asks for at time t [s]; return whether a step may have to be watched, or no more."""
        was_unsure = self._unsure
        if bits & FETCH:
            if not self._words[at.STARTED] or not 0.0 < t - self._numbers[at.T] <= self._numbers[at.REACH]:
                self.connect()
            if self._words[at.ASK_FIRST]:
                self._read_motion()
            if self._normal.changes:
                self._read_normal(t)
            bits = proceed(t, self.where)
            self._unsure = bool(bits & RESTARTED) and self._normal.reaction
        if bits & LOST:
            raise SimulationError(
                f"a step that ends at t = {t:g} s crosses more than one knot of the coefficients; "
                "use a step below their spacing"
            )
        if bits & RECORDED:
            row = self._words.item(at.NEXT_RECORD) - 1
            self._records[row, 3], self._records[row, 10] = self._forces()
        return bool(bits & (WATCH | RESTARTED)) or was_unsure

    def refine(self, t: float) -> bool:
        """Let a reaction that is the normal force be the one of the trial step to t [s]; return whether to repeat the step.

        The first step has it constant, all others have it on a line from the reaction at their start.
        """
        if not self._normal.reaction:
            return False
        now, numbers = self._normal.at(t), self._numbers
        at_t, count = self._refined
        count = count + 1 if t == at_t else 1
        self._refined = (t, count)
        used = max(numbers[at.LINE] + numbers[at.LINE + 1] * t, 0.0)
        settled = abs(now - used) <= REACTION_TOLERANCE * max(now, used, SMALL_REACTION * numbers[at.LARGEST_NORMAL])
        if settled or count > REPEATS:
            return False
        h = t - numbers[at.T]
        if self._unsure or h <= 0.0:
            self.guess_normal(now)
        else:
            rate = (now - numbers[at.NORMAL_FORCE]) / h
            numbers[[at.LINE, at.LINE + 1]] = now - rate * t, rate
        return True

    def take_trial(self) -> None:
        """Take what a trial step at the start tells: the reaction, as the normal force of the first step."""
        self.guess_normal(self._normal.at(0.0))

    def guess_normal(self, force: float) -> None:
        """Let the step to come have a constant normal force [N]."""
        self._numbers[[at.NORMAL_FORCE, at.GIVEN_NORMAL, at.GIVEN_RATE, at.LINE, at.LINE + 1]] = force, force, 0.0, force, 0.0

    def recommended_step(self, t: float) -> float:
        """Return the step [s] that ends at the law's next switch or the next grid point, or -1 to accept this one."""
        if self._words[at.ASK_FIRST]:
            self._read_motion()
        return locate(t, self.where)

    @property
    def watched(self) -> bool:
        """Whether the next step may contain a switch."""
        return bool(self._words[at.WATCHING])

    def prepare(self, dt: float, start: float) -> None:
        """Start afresh with the solver's step [s], whose grid located steps keep to, at the time ``start`` [s]."""
        self._numbers[at.STEP] = dt
        if self._normal.reaction:
            self.guess_normal(0.0)
        self.reset(start)
        self._take_mass()
        self.reset(start)

    def _take_mass(self) -> None:
        """Take the mass that the contact feels from the system, or compare the given one with it.

        Raises:
            InputError: the given one is too large by more than `TOO_LARGE`, or the law needs one and nothing moves.
        """
        if self.given_mass is not None and len(self._mbs.systemData.GetODE2Coordinates()) > MOST_COORDINATES:
            return
        with self._hooks.in_progress():
            masses = effective_masses(self._mbs, self._relative_velocities)
        if len(masses) == 0:  # nothing moves it, or it is at a dead centre
            if self.given_mass is None and self.friction.law.needs_effective_mass:
                raise InputError(
                    f"law {self.friction.law.kind} needs effective_mass [kg], the mass that the contact feels, and by the "
                    "system's mass matrix nothing moves it in the initial configuration; pass effective_mass"
                )
            return
        if self.given_mass is None:
            self._numbers[at.MASS] = masses[0]
        elif self.given_mass > TOO_LARGE * masses[-1]:
            raise InputError(
                f"effective_mass = {self.given_mass:g} kg, but this contact feels {masses[-1]:.4g} kg by the system's mass "
                "matrix: step limits and damping would be wrong; leave it out, and it is taken from there"
            )

    def _relative_velocities(self) -> tuple[float, ...]:
        """Return the relative velocity [m/s] along both directions of a plane, or along the line, as the system is now."""
        self._read_motion()
        _, _, vx, vy = kinematics(0.0, self._numbers, self._words)
        return (vx, vy) if self._words[at.PLANE] else (vx,)

    def begin(self, dt: float, start: float) -> bool:
        """Start afresh, unless a simulation goes on where it has stopped at the time ``start`` [s]; return which."""
        if self._words[at.STARTED] and start == self._numbers[at.T]:
            return False
        self.prepare(dt, start)
        return True

    def find(self) -> bool:
        """Find the contact's item in the system again, which others that are deleted renumber; False: it is gone."""
        mbs = self._mbs
        number = (mbs.GetLoadNumber if self._on_load else mbs.GetObjectNumber)(self._name)
        if int(number) < 0:
            return False
        self.object = number
        entry = (mbs.GetLoad if self._on_load else mbs.GetObject)(number)
        markers = entry["markerNumbers"] if "markerNumbers" in entry else [entry["markerNumber"]]
        if list(map(int, markers)) != list(map(int, self._markers)):
            self._markers = tuple(markers)
            self._follow_markers()
        return True

    def _follow_markers(self) -> None:
        """Take up new numbers of the markers."""

    def require_friction_at_rest(self) -> None:
        """Do nothing if the law gives friction without motion.

        Raises:
            InputError: it gives none: a static solution would have no friction.
        """
        law = self.friction.law
        if not law.state_names:
            raise InputError(
                f"law {law.kind} gives friction to a moving contact alone, and a static solution has no velocities: it would "
                "have no friction; use elastic_stick, lugre or dahl, or let the motion come to rest with SolveDynamic"
            )

    def locate(self, on: bool) -> None:
        """Say whether steps are to end where the law switches."""
        self._words[at.LOCATING] = int(on)

    def _begin(self) -> None:
        """Join the system's hooks."""
        self._words[at.ASK_FIRST] |= int(self._normal.changes)
        (self._mbs.SetLoadParameter if self._on_load else self._mbs.SetObjectParameter)(self.object, "name", self._name)
        self._hooks.contacts.append(self)
        self._hooks.install(locate=False)
        self.reset()

    def _read_normal(self, t: float) -> None:
        """Take the normal force at the end of the step, and the rate at which it is likely to change in the next one."""
        if self._normal.reaction and self._hooks.explicit:
            raise InputError(NO_REACTION)
        numbers, now = self._numbers, self._normal.at(t)
        started, behind = self._words[at.STARTED], t - numbers[at.T]
        rate = 0.0
        if self._normal.reaction:
            if started and behind > 0.0:
                rate = (now - numbers[at.NORMAL_FORCE]) / max(behind, FINE * numbers[at.STEP])
        elif (ahead := numbers[at.STEP] or (behind if started else 0.0)) > 0.0:
            before, after = math.inf, math.inf
            at_jump = not self._after_jump and abs(t - numbers[at.JUMP]) <= SHORTEST * numbers[at.STEP]
            self._after_jump = at_jump and not self._hooks.explicit
            if self._after_jump:  # implicit solvers begin the step with the acceleration before it: a short one
                after = t + SHORTEST * numbers[at.STEP]
            elif isinstance(self._normal, TimedNormal):
                before, after = self._normal.jump(t, ahead)
                if after < math.inf and not self._words[at.LOCATING]:
                    self._warn_of_jump(after)
                    before, after = math.inf, math.inf
            ahead = min(ahead, before - t)
            rate = (self._normal.at(t + ahead) - now) / ahead if ahead > 0.0 else 0.0
            numbers[at.JUMP] = after
        numbers[[at.GIVEN_NORMAL, at.GIVEN_RATE]] = now, rate

    def _warn_of_jump(self, t: float) -> None:
        if not self._warned:
            self._warned = True
            warnings.warn(
                f"{self._name}: normal_force jumps at t = {t:g} s, within a step, which then has an error of first order; let "
                "steps end there: solve_dynamic(..., locate=True)",
                JumpWarning,
                stacklevel=2,
            )

    @contextlib.contextmanager
    def _initial_motion(self) -> Iterator[None]:
        """Let the system's state be the one at the start of a simulation; connectors tell the current one only."""
        data = self._mbs.systemData
        x, v = data.GetODE2Coordinates(), data.GetODE2Coordinates_t()
        data.SetODE2Coordinates(data.GetODE2Coordinates(INITIAL))
        data.SetODE2Coordinates_t(data.GetODE2Coordinates_t(INITIAL))
        try:
            yield
        finally:
            data.SetODE2Coordinates(x)
            data.SetODE2Coordinates_t(v)

    def _values(self) -> list[float]:
        return self._numbers[[at.NORMAL_FORCE, at.STUCK, at.MU_S, at.MU_K]].tolist()


def _require_no_holding_force(law: Law) -> None:
    """Do nothing if Exudyn can run the law.

    Raises:
        InputError: the law needs the holding force.
    """
    if law.needs_holding_force:
        raise InputError(
            f"law {law.kind} needs the force that would hold the contact still, which is not sought for loads and where the "
            "plane or the body turns; use add_friction between coordinates or points, add_joint_friction, or "
            "stochfric_mb.laws.substitute.elastic_substitute(law, dt, normal_force, effective_mass)"
        )


def _arrays(law: Law, path: CoefficientPath) -> tuple[Any, Any]:
    """Return the two arrays of a contact, with law and path in place."""
    parameters, native = law.parameters(), native_law(law.kind)
    numbers, words = at.blank(len(parameters), len(path.descriptor))
    numbers[at.LAW : at.LAW + len(parameters)] = parameters
    numbers[at.LAW + len(parameters) :] = path.descriptor
    numbers[at.HAS_MODE] = float(law.state_names[:1] == ("mode",))
    numbers[at.STICK_SPEED], numbers[at.JUMP], numbers[at.PAIR] = law.stick_speed, math.inf, math.nan
    words[[at.COMMIT, at.GUARD, at.INIT, at.FORCE]] = native.commit, native.guards, native.init, native.force
    words[[at.N_STATE, at.N_LAW]] = native.n_state, len(parameters)
    words[[at.SEED, at.SAMPLE, at.CONTACT]] = path.seed, path.sample, path.contact
    assert native.n_state <= MAX_STATE
    return numbers, words
