"""The contract of a friction law: frozen parameters, and three pure compiled functions that travel together.

A law is a module with one class, derived from `Law`, and these functions at module level, each compiled once and
used by the reference, by every engine and by Python::

    init  (t, ux, uy, vx, vy, normal_force, mu_s, mu_k, effective_mass, hx, hy, p)        -> state
    force (t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p) -> (fx, fy)
    commit(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p) -> state
    guards(...as commit...)                                                               -> GUARDS numbers

- ``u``, ``v``: relative displacement [m] and velocity [m/s] in the tangent plane, *counter-surface minus body*
  (belt minus box). The origin of ``u`` is arbitrary but must not jump while the contact lives. One-dimensional
  sliding is ``uy = vy = hy = 0``.
- **Sign of friction, stated once**: the force [N] that comes out acts on the body, along ``+v``.
- ``mu_s``, ``mu_k``: the coefficients at this instant [-]; ``p[0]``, ``p[1]`` hold their means and ``p[2:]`` the
  law's further parameters in the order of the class's fields.
- ``effective_mass`` [kg]: mass that the contact feels (used by laws with ``needs_effective_mass``).
- ``hx, hy`` [N]: friction force that would hold the contact still (used by laws with ``needs_holding_force``).
- ``state``: floats; ``force`` never changes it, ``commit`` returns the next one and is called **once per accepted
  step**, nowhere else.
- ``guards``: numbers that fall from positive to negative where the law switches or has a kink; the event-located
  reference stops there, on the strictly negative side, where ``commit`` switches. Unused entries are 1.

A law whose force in sliding is a cap (`Law.rest` is not "bristle") also has::

    sliding_coefficient(speed, mu_s, mu_k, p) -> mu [-] at a sliding speed >= 0 [m/s]

and one that is elastic at rest::

    stick_spring(normal_force, effective_mass, mu_s, p) -> stiffness [N/m], damping [N s/m], largest deflection [m]

A law whose memory is a differential equation also has::

    flow(vx, vy, normal_force, zx, zy, mu_s, mu_k, p) -> (fx, fy, dzx/dt, dzy/dt)
"""

from __future__ import annotations

import dataclasses
import importlib
import math
from collections.abc import Mapping
from types import ModuleType
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError, require_number

GUARDS = 6
"""Number of values that every ``guards`` function returns."""

AXIOMS: Mapping[str, str] = {
    "dissipative": "in steady sliding the force never feeds the motion: F . v >= 0",
    "bounded": "abs(F) <= mu_s N",
    "odd": "F(-u, -v) = -F(u, v)",
    "continuous": "F is a continuous function of v at a fixed state",
    "sticks": "a load below mu_s N is held with no lasting creep",
    "passive": "a body that slides freely never gains kinetic energy while N changes by +-30 %",
}
"""The axioms of dry friction, each tested on every law that does not list it among its exceptions."""


@dataclasses.dataclass(frozen=True)
class Law:
    """A friction law with valid parameters; the base of `Coulomb`, `Havsin`, `ElasticStick`, ..."""

    mu_s: float
    """Mean static coefficient of friction [-], >= mu_k."""
    mu_k: float
    """Mean kinetic coefficient of friction [-], >= 0."""

    kind: ClassVar[str]
    """Name of the law in scenario files."""
    equation: ClassVar[str]
    """The law in one line."""
    source: ClassVar[str]
    """Where it was published."""
    state_names: ClassVar[tuple[str, ...]] = ()
    """Names of the state's entries; the first one is the mode where there is one."""
    needs_effective_mass: ClassVar[bool] = False
    """Whether ``force`` uses the effective mass."""
    needs_holding_force: ClassVar[bool] = False
    """Whether ``force`` uses the holding force; stuck contacts of such a law have zero relative velocity."""
    rest: ClassVar[str] = "bristle"
    """What holds a contact at rest: "rigid" (true stick), "elastic" (a spring), "creep" (nothing: mu rises with speed from
    0), or "bristle" (a memory of its own, which no cap on the force describes)."""
    has_flow: ClassVar[bool] = False
    """Whether the memory is a differential equation, given by ``flow``."""
    with_effects: ClassVar[bool] = False
    """Whether effects change what it does as it runs."""
    exceptions: ClassVar[Mapping[str, str]] = {}
    """Axioms that do not hold, each with its reason."""

    def __post_init__(self) -> None:
        require_number("mu_k", self.mu_k, low=0.0)
        require_number("mu_s", self.mu_s, above=0.0)
        if self.mu_k > self.mu_s:
            raise InputError(
                f"mu_k = {self.mu_k:g} is above mu_s = {self.mu_s:g}; a law needs mu_k <= mu_s: swap them or lower mu_k"
            )

    def parameters(self) -> npt.NDArray[np.float64]:
        """Return the parameter vector ``p``, shape (n_fields,): mu_s, mu_k, then the further fields in order."""
        return np.array([_as_float(getattr(self, f.name), f) for f in dataclasses.fields(self)], dtype=np.float64)

    def to_dict(self) -> dict[str, Any]:
        """Return the law as the ``[law]`` table of a scenario."""
        return {"kind": self.kind} | {f.name: getattr(self, f.name) for f in dataclasses.fields(self)}

    @property
    def stick_speed(self) -> float:
        """Relative speed [m/s] below which a contact counts as stuck in metrics (v_s where the law has one)."""
        return float(getattr(self, "v_s", 1.0e-4))

    def step_limit(self, normal_force: float, effective_mass: float) -> float:
        """Return the largest stable explicit (Euler-like) step [s], infinite where the law sets none.

        Args:
            normal_force: normal force [N].
            effective_mass: mass that the contact feels [kg].
        """
        return math.inf

    @property
    def peak_speed(self) -> float:
        """Return the speed [m/s] at which a law that creeps at rest has its largest coefficient; 0 for other laws."""
        return 0.0

    step_limit_formula: ClassVar[str] = "none"
    """The formula behind `step_limit`."""

    @classmethod
    def functions(cls) -> ModuleType:
        """Return the module that holds the law's compiled functions."""
        return importlib.import_module(cls.__module__)


def _as_float(value: Any, field: dataclasses.Field[Any]) -> float:
    if isinstance(value, str):
        return float(tuple(field.metadata["choices"]).index(value))
    return float(value)
