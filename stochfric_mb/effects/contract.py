"""The contract of an effect: something that a model may lack, as frozen parameters and small pure functions.

An effect is a module with one class derived from `Effect` and, where it acts on the motion, one or both of::

    surroundings(world, memory, rates, p)   changes what is around the contact: belt, normal force, loads
    friction(world, memory, rates, p)       changes the coefficients and the viscous part of friction

written in plain Python with `math` alone, so that the same source is compiled once (`stochfric_mb.effects.abi`) and
called from compiled and from interpreted solvers. All four arguments are arrays of floats:

- ``world``: the numbers below. ``surroundings`` of all effects come first, then the ``friction`` of all, in rising
  `Effect.order`; each reads what stands there and adds to it or multiplies it. Among ``surroundings`` those with unknowns
  of their own come last.
- ``memory``, ``rates``: the effect's own `Effect.n_memory` unknowns of a differential equation, and where it writes
  their derivatives.
- ``p``: its parameters in the order of the class's fields (a choice as its index).

Signs as everywhere: friction acts on the body along v_rel, counter-surface minus body. The belt-box reads
m x'' + c x' + k x = F + k u_0 cos(W t) + load.
"""

from __future__ import annotations

import dataclasses
import importlib
import math
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
import numpy.typing as npt

from stochfric_mb.effects.traits import AT_JOINTS, JOINTS_ALONE, RANDOM
from stochfric_mb.errors import InputError, require_name, require_number

if TYPE_CHECKING:
    from stochfric_mb.coefficients import Process
    from stochfric_mb.effects.joints import JointSpan
    from stochfric_mb.effects.load_side import MotorMotion
    from stochfric_mb.effects.marks import Hypothesis, Slips, Wave

Array = npt.NDArray[np.float64]

PHASES = ("phase", "phase_2", "phase_3")
"""Parameters of effects that hang on where their zero of time or place is."""
OF_MECHANISM = "mechanism"
"""The group of effects that are no friction but forces of their own, whose form mechanics gives."""
OF_FRICTION = ("friction law", "friction varies")
"""The groups of laws of friction, which are empirical: real friction departs from them by a few per cent."""
GROUPS = ("randomness", *OF_FRICTION, OF_MECHANISM, "sensor")
"""What effects are grouped by."""

# Entries of ``world``.
TIME = 0
"""Time since the start of the record [s]."""
POSITION = 1
"""Position x of the body [m]."""
VELOCITY = 2
"""Its velocity x' [m/s]."""
MASS = 3
"""Its mass [kg]."""
STIFFNESS = 4
"""Stiffness of its spring [N/m]."""
MEAN_BELT_VELOCITY = 5
"""Belt velocity of the mechanism [m/s]."""
SEED = 6
"""First part of the address of random numbers."""
SAMPLE = 7
"""Second part."""
BELT_VELOCITY = 8
"""Belt velocity [m/s]; changed by ``surroundings``."""
BELT_ACCELERATION = 9
"""Its derivative [m/s^2]; changed by ``surroundings``."""
BELT_TRAVEL = 10
"""Integral of the belt velocity from t = 0 [m]; changed by ``surroundings``."""
NORMAL_FORCE = 11
"""Normal force [N]; changed by ``surroundings``."""
LOAD = 12
"""Further force on the body along x [N]; changed by ``surroundings``."""
DIRECTION = 13
"""Sign of v_rel, or in stick of the friction force needed: 1 or -1. From here on known to ``friction`` alone."""
SPEED = 14
"""abs(v_rel) [m/s], 0 in stick."""
BELT_POSITION = 15
"""Belt coordinate under the body, belt travel - x [m]."""
DWELL = 16
"""Duration of the present or, in slip, of the last stick [s]."""
SLIP = 17
"""Distance slid since break-away [m], 0 in stick."""
MU_S = 18
"""Static coefficient [-]; changed by ``friction``."""
MU_K = 19
"""Kinetic coefficient [-]; changed by ``friction``."""
VISCOUS_FORCE = 20
"""Friction force beside mu_k N, along v_rel [N]; changed by ``friction``."""
SLIP_TIME = 21
"""Time since break-away [s], 0 in stick."""
TRAVELLED = 22
"""Distance slid since the record began, whichever way [m]: measured, or kept by the effect that asks for it."""
TEMPERATURE = 23
"""Temperature [degC], where one was measured."""
DRIVE = 24
"""Driving force of a joint, with its gain as stated [N or N m], where one was measured. Known to ``surroundings``."""
PRESSURE = 25
"""Pressure on the piston of a joint [Pa], where one was measured. Known to ``surroundings``."""
WORLD = 26
"""Number of entries."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Effect:
    """Something that a model may lack, with valid parameters; the base of `DwellAgeing`, `Backlash`, ..."""

    kind: ClassVar[str]
    """Name of the effect in scenario files."""
    equation: ClassVar[str]
    """The effect in one line."""
    source: ClassVar[str]
    """Where it was published."""
    group: ClassVar[str]
    """One of `GROUPS`."""
    order: ClassVar[int] = 0
    """Place of ``friction`` among effects: 1 adds to mu_s or mu_k, 2 mixes them, 3 multiplies both."""
    n_memory: ClassVar[int] = 0
    """Number of unknowns of the effect's own differential equation."""
    forgets: ClassVar[bool] = True
    """Whether what its unknowns held some slips ago says nothing of them now; otherwise they count from the record's begin."""
    reads: ClassVar[tuple[str, ...]] = ()
    """Measured channels without which the effect means nothing."""
    shows_on: ClassVar[str] = ""
    """Where in a record it shows, in a word or two, such as "relative velocity"."""
    shows: ClassVar[str] = ""
    """What it does there, as a sentence without a full stop."""

    traits: ClassVar[frozenset[str]] = frozenset()
    """What holds of it, of the first names in `stochfric_mb.effects.traits`."""
    signatures: ClassVar[tuple[str, ...]] = ()
    """What in a record means this effect, of the names there from ``BELT_RIPPLE`` on."""
    answers_to: ClassVar[str] = ""
    """Condition of an experiment without whose change it cannot be seen, or that may be confounded with others."""
    frees: ClassVar[tuple[str, ...]] = ()
    """Numbers of mechanism and law whose priors are widened beside it."""
    needs_one_of: ClassVar[tuple[str, ...]] = ()
    """Parameters of which at least one has to be given; empty where those without a default are all that it needs."""
    form_axis: ClassVar[str] = ""
    """Axis of the unnamed term that carries what another form of the effect would add; empty where there is none."""
    separated_by: ClassVar[Mapping[str, str]] = {}
    """Other kind that looks like it -> the experiment that tells the two apart."""

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if value is not field.default:  # defaults are valid, and fits make effects by the thousand
                _check(f"{self.kind}.{field.name}", value, field)

    @property
    def own_to_run(self) -> tuple[str, ...]:
        """Parameters that each run has its own value of: phases, since records start anywhere."""
        return tuple(f.name for f in dataclasses.fields(self) if f.name in PHASES)

    def parameters(self) -> Array:
        """Return the parameter vector ``p``, shape (n_fields,), in the order of the fields."""
        return np.array([_as_float(getattr(self, f.name), f) for f in dataclasses.fields(self)], dtype=np.float64)

    def given(self) -> dict[str, Any]:
        """Return kind and numbers as `to_dict` does, less those that the effect lacks."""
        return {name: value for name, value in self.to_dict().items() if name == "kind" or not self.lacks(name)}

    def to_dict(self) -> dict[str, Any]:
        """Return the effect as an ``[[effects]]`` table of a scenario."""
        return {"kind": self.kind} | {f.name: getattr(self, f.name) for f in dataclasses.fields(self)}

    def appears(self) -> tuple[str, str]:
        """Return the axis on which this effect, with its parameters, shows in a record, and a sentence that says how."""
        return self.shows_on or self.kind, self.shows or f"{self.kind} explains the disagreement"

    def coefficient_process(self) -> Process | None:
        """Return the coefficient process that the effect sets; None if it sets none."""
        return None

    def measure(self, time: Array, position: Array, rng: np.random.Generator) -> Array:
        """Return what the sensor shows [m], shape (n,).

        Args:
            time: time since the start of the record [s], shape (n,), increasing.
            position: true position [m], shape (n,).
            rng: where random errors come from.
        """
        return position

    def rest(self, position: Array, velocity: Array) -> Array:
        """Return the memory of an effect that moves along with the body, shape (n, n_memory).

        Args:
            position: position of the body [m], shape (n,).
            velocity: its velocity [m/s], shape (n,).
        """
        return np.zeros((len(position), self.n_memory))

    def left_open(self) -> Mapping[str, tuple[float, float]]:
        """Return how far each of the numbers that the effect `frees` may be off beside it, relative to what is stated [-].

        Lowest and highest deviation by name; infinite where the effect says nothing of it.
        """
        return dict.fromkeys(self.frees, (-math.inf, math.inf))

    def fitted_together(self) -> tuple[tuple[str, ...], Array]:
        """Return parameters whose priors in a fit hang together, and the covariance in units of these priors, shape (k, k)."""
        return (), np.zeros((0, 0))

    def load_force(self, motor: MotorMotion) -> Array | None:
        """Return the further force of a joint's load that moves by itself [N or N m], shape (count,); None: none does.

        It acts against the motor's positive direction. The load's motion is an auxiliary state, which follows from that of the
        motor; `stochfric_mb.effects.load_side` has the equations.

        Args:
            motor: the measured motion of the motor.
        """
        return None

    def shortest_time(self, speed: float) -> float:
        """Return the shortest period [s] that the effect brings in while the contact moves at ``speed`` [m/s]."""
        return math.inf

    def unit_of(self, name: str) -> str:
        """Return the unit of a parameter."""
        return str(self.__dataclass_fields__[name].metadata["unit"])

    def lacks(self, name: str) -> bool:
        """Return whether a parameter belongs to a form of the effect that this one has not."""
        field = self.__dataclass_fields__[name]
        return bool(field.metadata.get("optional")) and getattr(self, name) == field.default

    @property
    def late(self) -> float:
        """By how much it makes the reading late [s]."""
        return 0.0

    @property
    def linear_damping(self) -> float:
        """Force per relative speed [N s/m], where that is all that the effect does."""
        return 0.0

    @property
    def moves_load(self) -> bool:
        """Whether the load of a joint moves by itself with it, so that friction along the motor's motion is not all of it."""
        return False

    @property
    def random(self) -> bool:
        """Whether it is drawn at random."""
        return self.coefficient_process() is not None or RANDOM in self.traits

    def draws(self, duration: float, slips: int) -> float:
        """Return of how many independent draws of it ``duration`` seconds with ``slips`` slips tell."""
        return float(slips)

    def deviations(self, draws: float) -> dict[str, float]:
        """Return the standard deviations of its random numbers, estimated from independent draws.

        Of sigmas s/sqrt(2 n), of correlations (1 - r^2 + 1/n)/sqrt(n): n draws do not tell 1 from 1 - 1/n.
        """
        values = {f.name: getattr(self, f.name) for f in dataclasses.fields(self)}
        sigmas = {name: value / math.sqrt(2.0 * draws) for name, value in values.items() if name.startswith("sigma")}
        r = values.get("cross_correlation")
        return sigmas if r is None else sigmas | {"cross_correlation": (1.0 - r * r + 1.0 / draws) / math.sqrt(draws)}

    def changed(self, **numbers: float) -> Self:
        """Return the effect with some of its numbers changed, and those that hang on them."""
        return dataclasses.replace(self, **numbers)

    def kept_at_joints(self, contact: bool) -> tuple[str, ...]:
        """Return the parameters that a fit at a driven joint leaves alone; ``contact``: its normal force is known."""
        return ()

    @classmethod
    def at_joint(cls, span: JointSpan) -> JointSignature | tuple[JointSignature, ...] | None:
        """Return what it does at a driven joint that moves so, in one form or several; None: it is not looked for there.

        A number that is at its default where a fit begins stays there: it is no part of that form.
        """
        return None

    def seen_at_joint(self, span: JointSpan) -> bool:
        """Return whether a joint that moves so shows the effect as it is; what it does not show stands for something else."""
        return True

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return the ways in which the effect may have marked the slips; none: discovery does not look for it there."""
        return []

    @classmethod
    def wave(cls, slips: Slips) -> Wave | None:
        """Return where a periodic effect runs and what it modulates; None: it is not periodic."""
        return None

    @classmethod
    def searched_in_slips(cls) -> bool:
        """Return whether discovery looks for it in stick-slip."""
        return cls._has_own("hypotheses", "wave") or bool(set(cls.signatures) - JOINTS_ALONE)

    @classmethod
    def searched_at_joints(cls) -> bool:
        """Return whether discovery looks for it at driven joints."""
        return cls._has_own("at_joint") or bool(AT_JOINTS & set(cls.signatures))

    @classmethod
    def _has_own(cls, *methods: str) -> bool:
        return any(getattr(cls, m).__func__ is not getattr(Effect, m).__func__ for m in methods)

    @classmethod
    def functions(cls) -> ModuleType:
        """Return the module that holds ``surroundings`` and ``friction``."""
        return importlib.import_module(cls.__module__)


@dataclasses.dataclass(frozen=True)
class Scan:
    """A wave, among whose wave numbers fits begin where a cosine and a sine explain most of the residual."""

    axis: str
    """``time`` or ``position``: what it is a wave in."""
    signed: bool
    """Whether it turns with the direction of the motion, as friction does."""
    low: float
    """Fewest waves per second, metre or radian."""
    high: float
    """Most of them."""
    begin: Callable[[float, float, float], Effect]
    """Wave number k, a and b of the force a cos(2 pi k x) + b sin(2 pi k x) against the motion [N or N m] -> effect."""
    pieces: int = 0
    """Pieces of a shape that comes back with each wave; 0: it is a sine."""
    shaped: Callable[[float, Array], Effect] | None = None
    """Wave number and weights, shape (pieces - 1,), of such a force against the motion (`course.returning`) -> effect."""


@dataclasses.dataclass(frozen=True)
class JointSignature:
    """What an effect does at a driven joint."""

    starts: tuple[Effect, ...]
    """Where fits begin: the grid over numbers that enter nonlinearly."""
    axis: str
    """Axis along which it shows."""
    parameters: int
    """Numbers that it adds to a fit; those that each run has its own of count once a run."""
    scan: Scan | None = None
    """Further starting points, found in the residual."""


def parameter(
    unit: str,
    meaning: str,
    *,
    scale: float,
    low: float = -math.inf,
    high: float = math.inf,
    strict: bool = False,
    infinite: bool = False,
    default: Any = dataclasses.MISSING,
    fit_low: float | None = None,
    fit_high: float | None = None,
    fit_prior: float = math.inf,
    optional: bool = False,
) -> Any:
    """Return a dataclass field of an effect.

    Args:
        unit: SI unit, "-" if there is none.
        meaning: what it is, for people.
        scale: a typical size, in that unit.
        low: lower bound.
        high: upper bound.
        strict: whether the bounds themselves are forbidden.
        infinite: whether infinity may be given.
        default: default value; none if not given.
        fit_low: lower bound of fits, where it is another.
        fit_high: upper one.
        fit_prior: standard deviation by which a fit may move it from where it begins; 0: not at all.
        optional: whether it belongs to some forms of the effect alone; those without it have it at its default.
    """
    metadata: dict[str, Any] = {"unit": unit, "meaning": meaning, "scale": scale, "low": low, "high": high}
    metadata |= {"strict": strict, "infinite": infinite}
    metadata |= {"fit_low": low if fit_low is None else fit_low, "fit_high": high if fit_high is None else fit_high}
    metadata |= {"fit_prior": fit_prior, "optional": optional}
    return dataclasses.field(metadata=metadata, default=default)


def choice(meaning: str, choices: tuple[str, ...]) -> Any:
    """Return a dataclass field that is one of ``choices``, the first by default."""
    return dataclasses.field(metadata={"unit": "-", "meaning": meaning, "choices": choices}, default=choices[0])


def _check(name: str, value: Any, field: dataclasses.Field[Any]) -> None:
    about = field.metadata
    if "choices" in about:
        require_name(name, value, about["choices"])
        return
    if about["infinite"] and isinstance(value, float) and math.isinf(value):
        if not about["low"] <= value <= about["high"]:
            raise InputError(f"{name} = {value} is out of range; give a value between {about['low']:g} and {about['high']:g}")
        return
    bounds = (
        {"above": about["low"], "below": about["high"]} if about["strict"] else {"low": about["low"], "high": about["high"]}
    )
    require_number(name, value, unit=about["unit"], **bounds)


def _as_float(value: Any, field: dataclasses.Field[Any]) -> float:
    if isinstance(value, str):
        return float(tuple(field.metadata["choices"]).index(value))
    return float(value)
