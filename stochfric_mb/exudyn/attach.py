"""Friction between two coordinate markers of any Exudyn system."""

from __future__ import annotations

import math
from typing import Any

import exudyn
import numpy as np
import numpy.typing as npt
from exudyn.advancedUtilities import CreateSymbolicUserFunction
from exudyn.itemInterface import CoordinateSpringDamper

from stochfric_mb.coefficients.path import CoefficientPath
from stochfric_mb.errors import InputError, SimulationError, require_number
from stochfric_mb.exudyn import stepping as at
from stochfric_mb.exudyn.hooks import Hooks
from stochfric_mb.exudyn.symbolic import DISPLACEMENT, TIME, VELOCITY, force_expression, live_names, lower, symbolic
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law
from stochfric_mb.laws.abi import MAX_STATE, native_law

_OUTPUT = exudyn.OutputVariableType
_INITIAL = exudyn.ConfigurationType.Initial


def add_friction(
    mbs: Any,
    marker0: Any,
    marker1: Any,
    friction: Law | Friction,
    *,
    normal_force: float,
    seed: int = 0,
    sample: int = 0,
    contact: int = 0,
    effective_mass: float | None = None,
    surface_velocity: float = 0.0,
) -> FrictionContact:
    """Return the contact that now acts between two coordinate markers of an Exudyn system.

    The friction force on ``marker1``'s coordinate acts along ``surface_velocity - (velocity1 - velocity0)``; marker 0 gets
    the opposite one. A symbolic user function evaluates the law, so that it runs without Python in every solver; the
    state is committed after each accepted step, in the system's PostStep function, which calls the one that was there.
    A simulation that starts again starts with fresh friction.

    Args:
        mbs: the system.
        marker0: coordinate marker of the counter-surface.
        marker1: coordinate marker of the body.
        friction: a law, or a law with the process of its coefficients.
        normal_force: normal force [N], > 0 (normal torque over radius for a rotation).
        seed: seed of the path of coefficients.
        sample: number of the sample.
        contact: number of the contact: contacts with different numbers have independent paths.
        effective_mass: mass that the contact feels [kg], for laws that need it.
        surface_velocity: velocity of the counter-surface on top of marker 0's [m/s].

    Raises:
        InputError: a law that needs the holding force, a missing effective mass, or a number out of range.
    """
    friction = as_friction(friction)
    law = friction.law
    if law.needs_holding_force:
        raise InputError(
            f"law {law.kind} needs the force that would hold the contact still, which Exudyn does not give; use "
            "stochfric_mb.laws.substitute.elastic_substitute(law, dt, normal_force, effective_mass)"
        )
    if law.needs_effective_mass and effective_mass is None:
        raise InputError(f"law {law.kind} needs effective_mass [kg], the mass that the contact feels; pass it")
    mass = require_number("effective_mass", 1.0 if effective_mass is None else effective_mass, above=0.0, unit="kg")
    numbers, words = _arrays(law, friction.path(seed, sample, contact))
    numbers[at.NORMAL_FORCE] = require_number("normal_force", normal_force, above=0.0, unit="N")
    numbers[at.MASS] = mass
    numbers[at.SURFACE_VELOCITY] = require_number("surface_velocity", surface_velocity, unit="m/s")
    return FrictionContact(mbs, (marker0, marker1), friction, numbers, words)


class FrictionContact:
    """A contact in an Exudyn system; made by `add_friction`."""

    def __init__(self, mbs: Any, markers: tuple[Any, Any], friction: Friction, numbers: Any, words: Any) -> None:
        self.friction = friction
        """The law and the process of its coefficients."""
        self._mbs, self._markers, self._numbers, self._words = mbs, markers, numbers, words
        self._records = np.empty((0, at.RECORD_COLUMNS))
        self._own = np.zeros(4)
        self.where = int(words.ctypes.data)
        """Address of the contact for compiled code."""
        names = live_names(friction.law)
        expression = force_expression(friction.law, friction.process, self.normal_force, float(numbers[at.MASS]))
        self._symbols = {name: symbolic.Real(name, 0.0) for name in expression.names}
        self._live = numbers[at.LIVE : at.LIVE + len(names)]
        self._places = [(names.index(name), symbol) for name, symbol in self._symbols.items()]
        self._given = [math.nan] * len(names)
        self.object = mbs.AddObject(
            CoordinateSpringDamper(markerNumbers=list(markers), springForceUserFunction=self._function(expression.force))
        )
        """Index of the connector that carries the force."""
        hooks = Hooks.of(mbs)
        hooks.contacts.append(self)
        hooks.install(locate=False)
        self.reset()

    @property
    def address(self) -> tuple[int, int, int]:
        """Address of the path of coefficients: seed, sample, contact."""
        return tuple(int(w) for w in self._words[[at.SEED, at.SAMPLE, at.CONTACT]])  # type: ignore[return-value]

    @property
    def force(self) -> float:
        """The friction force [N] on marker 1 that the engine applies now."""
        return -float(self._mbs.GetObjectOutput(self.object, _OUTPUT.Force))

    @property
    def normal_force(self) -> float:
        """The normal force [N]."""
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
        return self._numbers[at.LIVE : at.LIVE + self._words[at.N_STATE]].copy()

    def reset(self) -> None:
        """Start the contact afresh, at the system's initial displacement and velocity."""
        self._own[:] = self._initial()
        self._bind(self._own, self._own[2:])
        self._words[at.STARTED] = 0
        at.proceed(0.0, self.where)
        at.locate(0.0, self.where)  # compiled now rather than in the middle of a run
        at.advance(0.0, self.where)
        self._pass_on()
        self._words[[at.STARTED, at.NEXT_RECORD]] = 0

    def record(self, times: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return an array that the next simulation fills, shape (n, 7), a row for each time.

        Columns: time [s], relative displacement [m] and velocity [m/s] (counter-surface minus body), friction force [N],
        mu_s, mu_k [-], stick (1 or 0). Rows are taken at the end of the first step that reaches each time.
        """
        times = np.asarray(times, dtype=np.float64)
        self._records = np.full((len(times), at.RECORD_COLUMNS), math.nan)
        self._records[:, 0] = times
        self._words[[at.RECORDS, at.N_RECORDS, at.NEXT_RECORD]] = self._records.ctypes.data, len(times), 0
        return self._records

    def connect(self) -> None:
        """Find out where the engine keeps the two coordinates (again, whenever a simulation starts)."""
        position = self._mbs.systemData.GetODE2Coordinates(copy=False)
        velocity = self._mbs.systemData.GetODE2Coordinates_t(copy=False)
        indices = [_coordinate(self._mbs, m) for m in self._markers]
        self._own[:] = 0.0
        self._words[at.ASK_FIRST] = int(None in indices)
        if None in indices:
            self._bind(self._own, self._own[2:])
            return
        for words, array in (((at.POSITION_0, at.POSITION_1), position), ((at.VELOCITY_0, at.VELOCITY_1), velocity)):
            for word, index in zip(words, indices, strict=True):
                assert index is not None
                self._words[word] = self._own.ctypes.data if index < 0 else array.ctypes.data + array.itemsize * index

    def settle(self, t: float, bits: int) -> bool:
        """Do what `stepping.advance` asks for at time t [s]; return whether a step may have to be watched, or no more."""
        if bits & at.FETCH:
            if not self._words[at.STARTED] or not 0.0 < t - self._numbers[at.T] <= self._numbers[at.REACH]:
                self.connect()
            self._read()
            bits = at.proceed(t, self.where)
        if bits & at.LOST:
            raise SimulationError(
                f"a step that ends at t = {t:g} s crosses more than one knot of the coefficients; "
                "use a step below their spacing"
            )
        if bits & at.RECORDED:
            self._records[self._words.item(at.NEXT_RECORD) - 1, 3] = self.force
        if bits & at.CHANGED:
            self._pass_on()
        return bool(bits & (at.WATCH | at.RESTARTED))

    def recommended_step(self, t: float) -> float:
        """Return the step [s] that ends at the law's next switch or the next grid point, or -1 to accept this one."""
        if self._words[at.ASK_FIRST]:
            self._read()
        return at.locate(t, self.where)

    @property
    def watched(self) -> bool:
        """Whether the next step may contain a switch."""
        return bool(self._words[at.WATCHING])

    def prepare(self, dt: float) -> None:
        """Start afresh with the solver's step [s], whose grid located steps keep to."""
        self._numbers[at.STEP] = dt
        self.reset()

    def locate(self, on: bool) -> None:
        """Say whether steps are to end where the law switches."""
        self._words[at.LOCATING] = int(on)

    def _function(self, force: Any) -> Any:
        """Return the symbolic user function: the connector's force is what pulls marker 1 back, minus the friction."""
        surface = float(self._numbers[at.SURFACE_VELOCITY])

        def minus_friction(mbs, t, itemNumber, displacement, velocity, stiffness, damping, offset):
            u = surface * t - displacement if surface else -displacement
            v = surface - velocity if surface else -velocity
            return -lower(force, {**self._symbols, TIME: t, DISPLACEMENT: u, VELOCITY: v})

        return CreateSymbolicUserFunction(
            self._mbs,
            function=minus_friction,
            userFunctionName="springForceUserFunction",
            itemTypeName="ObjectConnectorCoordinateSpringDamper",
        )

    def _pass_on(self) -> None:
        """Set those of the engine's parameters that have changed."""
        wanted, given = self._live.tolist(), self._given
        if wanted == given:
            return
        for place, symbol in self._places:
            if wanted[place] != given[place]:
                symbol.SetValue(wanted[place])
        self._given = wanted

    def _read(self) -> None:
        """Take displacement and velocity from the connector, for markers that are no plain coordinates."""
        if not self._words[at.ASK_FIRST]:
            return
        self._own[1] = self._mbs.GetObjectOutput(self.object, _OUTPUT.Displacement)
        self._own[3] = self._mbs.GetObjectOutput(self.object, _OUTPUT.Velocity)

    def _bind(self, position: Any, velocity: Any) -> None:
        place, size = self._words, position.itemsize
        place[at.POSITION_0], place[at.POSITION_1] = position.ctypes.data, position.ctypes.data + size
        place[at.VELOCITY_0], place[at.VELOCITY_1] = velocity.ctypes.data, velocity.ctypes.data + size

    def _initial(self) -> list[float]:
        """Return initial positions and velocities of the two markers, zero before the system is assembled."""
        data = self._mbs.systemData
        position, velocity = data.GetODE2Coordinates(_INITIAL), data.GetODE2Coordinates_t(_INITIAL)
        if len(position) == 0:
            return [0.0] * 4
        indices = [_coordinate(self._mbs, m) for m in self._markers]
        return [float(a[i]) if i is not None and i >= 0 else 0.0 for a in (position, velocity) for i in indices]


def _arrays(law: Law, path: CoefficientPath) -> tuple[Any, Any]:
    """Return the two arrays of a contact, with law and path in place."""
    parameters, native = law.parameters(), native_law(law.kind)
    numbers, words = at.blank(len(parameters), len(path.descriptor))
    numbers[at.LAW : at.LAW + len(parameters)] = parameters
    numbers[at.LAW + len(parameters) :] = path.descriptor
    numbers[at.HAS_MODE] = float(law.state_names[:1] == ("mode",))
    numbers[at.STICK_SPEED] = law.stick_speed
    words[[at.COMMIT, at.GUARD, at.INIT]] = native.commit, native.guards, native.init
    words[[at.N_STATE, at.N_LAW]] = native.n_state, len(parameters)
    words[[at.SEED, at.SAMPLE, at.CONTACT]] = path.seed, path.sample, path.contact
    assert native.n_state <= MAX_STATE
    return numbers, words


def _coordinate(mbs: Any, marker: Any) -> int | None:
    """Return the place of a marker's coordinate among the system's, -1 on ground, None if it is no plain coordinate."""
    entry = mbs.GetMarker(marker)
    if entry["markerType"] != "NodeCoordinate":
        return None
    if "Ground" in mbs.GetNode(entry["nodeNumber"])["nodeType"]:
        return -1
    return int(mbs.systemData.GetNodeLTGODE2(entry["nodeNumber"])[entry["coordinate"]])
