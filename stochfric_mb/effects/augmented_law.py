"""A law with effects, under the laws' own contract: engines that take a law by its addresses take it like any other.

The law inside sees the relative motion, the normal force and the coefficients as the effects change them. Loads on the
box ride along with the friction force (`stochfric_mb.effects.columns` takes them out of what is reported), which is the
same where the counter-surface moves as prescribed; each of several contacts under one box carries its share. Sliding is
along the first tangent direction, x. Everything but mu_s and mu_k is in one array of numbers, the *model*, whose
address is the law's third parameter.
"""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.effects import contract as e
from stochfric_mb.effects.abi import call_effect, native_effect
from stochfric_mb.effects.combine import moving
from stochfric_mb.effects.contract import Effect
from stochfric_mb.errors import InputError
from stochfric_mb.laws import Law
from stochfric_mb.laws.abi import MAX_STATE, call_law, native_law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.numerics.cubic import hermite, slope, value
from stochfric_mb.numerics.memory import as_doubles
from stochfric_mb.numerics.runge_kutta import RK4, advance

# Entries of the model.
(INIT, FORCE, COMMIT, GUARD, INNER_P, MODED, STICK_SPEED, M, C, K, FOOT, W, VB, SEED, SAMPLE, RESOLUTION, N_AROUND,
 N_FRICTION, N_MEMORY, N) = range(20)  # fmt: skip
REST = 20
"""The memories at the start."""
MAX_MEMORY = 4
TABLE = REST + MAX_MEMORY
"""Rows (address, place of p, place of the memory) of the effects around the contact, then of those on friction."""

# Entries of the state; the law inside has those before.
SINCE, BROKE_AT, DWELL, LAST, X, V = range(6, 12)
"""Time of the last re-stick, belt coordinate at break-away, duration of the last stick (-1 within one); time, x and x' at
the commit."""
MEMORY = 12
"""The effects' memories at the commit."""
RK4_A, RK4_B, RK4_C = RK4.a, RK4.b, RK4.c
INNER = 6
"""Most state entries of the law inside."""


@dataclasses.dataclass(frozen=True)
class Augmented(Law):
    """A law with effects; made by `augmented_law`, valid in this process."""

    model: float = 0.0
    """Number of the model."""

    kind: ClassVar[str] = "augmented"
    equation: ClassVar[str] = "the law inside, with motion, normal force and coefficients as the effects change them"
    source: ClassVar[str] = "the sources of the law inside and of the effects"
    state_names: ClassVar[tuple[str, ...]] = tuple(f"state_{i}" for i in range(MAX_STATE))
    with_effects: ClassVar[bool] = True

    def __post_init__(self) -> None:
        super().__post_init__()
        if int(self.model) >= len(_MODELS):
            raise InputError(f"law 'augmented' has no model {self.model:g} in this process; build the scenario again")
        inner, _ = _MODELS[int(self.model)]
        moded = inner.state_names[:1] == ("mode",)
        object.__setattr__(self, "state_names", ("mode" if moded else "state_0", *type(self).state_names[1:]))
        object.__setattr__(self, "needs_effective_mass", inner.needs_effective_mass)
        object.__setattr__(self, "step_limit_formula", inner.step_limit_formula)

    @property
    def inner(self) -> Law:
        """The law inside."""
        return _MODELS[int(self.model)][0]

    @property
    def model_numbers(self) -> Any:
        """The model's numbers, shape (n,)."""
        return _MODELS[int(self.model)][1]

    @property
    def stick_speed(self) -> float:
        """That of the law inside [m/s]."""
        return self.inner.stick_speed

    def step_limit(self, normal_force: float, effective_mass: float) -> float:
        """Return that of the law inside [s]."""
        return self.inner.step_limit(normal_force, effective_mass)

    def parameters(self) -> Any:
        """Return (mu_s, mu_k, address of the model)."""
        return np.array([self.mu_s, self.mu_k, float(_MODELS[int(self.model)][1].ctypes.data)])


_MODELS: list[tuple[Law, Any]] = []
_numbers: dict[bytes, int] = {}
_parameters: dict[Law, Any] = {}


def augmented_law(
    law: Law,
    mechanism: BeltBox,
    effects: Sequence[Effect],
    *,
    seed: int = 0,
    sample: int = 0,
) -> Law:
    """Return the law with the effects that act on the motion; the law itself if there are none.

    Args:
        law: the law inside; one that does without the holding force, and whose memory is no differential equation.
        mechanism: the belt-box that the contact belongs to.
        effects: the effects.
        seed: first part of the address of random numbers.
        sample: second part.

    Raises:
        InputError: a law that cannot carry effects, or effects with more memory than there is room for.
    """
    acting = moving(effects)
    if not acting:
        return law
    if law.has_flow or law.needs_holding_force or len(law.state_names) > INNER:
        why = "its memory is a differential equation of its own" if law.has_flow else "it needs the holding force"
        raise InputError(f"law {law.kind!r} cannot carry effects here: {why}; use law elastic_stick or coulomb")
    model = _model(law, mechanism, acting, (seed, sample))
    key = repr(law).encode() + model.tobytes()
    if key not in _numbers:
        _numbers[key] = len(_MODELS)
        _MODELS.append((law, model))
    return Augmented(law.mu_s, law.mu_k, float(_numbers[key]))


def _model(law: Law, mechanism: BeltBox, effects: Sequence[Effect], address: tuple[int, int]) -> Any:
    native = native_law(law.kind)
    inner_p = _parameters.setdefault(law, law.parameters())
    # order (below 0: around, unknowns last, since they follow what others do there), address, place of p, of the memory
    rows: list[tuple[int, float, float, float]] = []
    p: list[float] = []
    rest: list[float] = []
    start = np.array([mechanism.initial_position]), np.array([mechanism.initial_velocity])
    for effect in effects:
        functions = native_effect(type(effect))
        place, memory = len(p), len(rest)
        if functions.surroundings:
            rows.append((-1 if effect.n_memory else -2, functions.surroundings, place, memory))
        if functions.friction:
            rows.append((effect.order, functions.friction, place, memory))
        p += effect.parameters().tolist()
        rest += effect.rest(*start)[0].tolist()
    if len(rest) > MAX_MEMORY:
        kinds = ", ".join(effect.kind for effect in effects if effect.n_memory)
        raise InputError(f"the effects {kinds} have {len(rest)} unknowns of their own; engines have room for {MAX_MEMORY}")
    rows.sort(key=lambda row: row[0])
    first_p = TABLE + 3 * len(rows)
    around = sum(row[0] < 0 for row in rows)
    shortest = min(effect.shortest_time(abs(mechanism.belt_velocity)) for effect in effects)
    header = [
        native.init, native.force, native.commit, native.guards, inner_p.ctypes.data,
        law.state_names[:1] == ("mode",), law.stick_speed, mechanism.mass, mechanism.damping, mechanism.stiffness,
        mechanism.excitation_amplitude, mechanism.excitation_angular_frequency, mechanism.belt_velocity, *address,
        min(0.01 * shortest, 1.0e-3), around, len(rows) - around, len(rest), mechanism.normal_force,
        *rest, *[0.0] * (MAX_MEMORY - len(rest)),
    ]  # fmt: skip
    table = [value for _, address, place, memory in rows for value in (address, first_p + place, memory)]
    return np.array([float(value) for value in header + table + p])


# --- compiled -----------------------------------------------------------------------------------------------------------


@compiled
def _surround(q, where, t, x, v, w, memory, rates):
    """Find what is around the contact."""
    w[e.TIME], w[e.POSITION], w[e.VELOCITY] = t, x, v
    w[e.MASS], w[e.STIFFNESS], w[e.MEAN_BELT_VELOCITY], w[e.SEED], w[e.SAMPLE] = q[M], q[K], q[VB], q[SEED], q[SAMPLE]
    w[e.BELT_VELOCITY], w[e.BELT_ACCELERATION], w[e.BELT_TRAVEL] = q[VB], 0.0, q[VB] * t
    w[e.NORMAL_FORCE], w[e.LOAD] = q[N], 0.0
    for i in range(int(q[N_AROUND])):
        row = TABLE + 3 * i
        offset = 8 * int(q[row + 2])
        call_effect(
            int(q[row]), w.ctypes.data, memory.ctypes.data + offset, rates.ctypes.data + offset, where + 8 * int(q[row + 1])
        )


@compiled
def _recall(q, where, t, x, v, state, w, memory):
    """Bring the memories from the last commit to t, the box moving on a cubic between the two."""
    for j in range(MAX_MEMORY):
        memory[j] = state[MEMORY + j]
    h = t - state[LAST]
    if q[N_MEMORY] == 0.0 or h <= 0.0:
        return
    n = math.ceil(h / q[RESOLUTION])
    k = np.zeros((len(RK4_B), MAX_MEMORY))
    start = memory.copy()
    path = hermite(h, state[X], state[V], x, v)
    for i in range(n):
        for s in range(len(RK4_B)):
            theta = (i + RK4_C[s]) / n
            advance(RK4_A[s], s, h / n, start, k, 0, MAX_MEMORY, memory)
            _surround(q, where, state[LAST] + theta * h, value(path, theta), slope(path, theta) / h, w, memory, k[s])
        advance(RK4_B, len(RK4_B), h / n, start, k, 0, MAX_MEMORY, start)
    for j in range(MAX_MEMORY):
        memory[j] = start[j]


@compiled
def _see(t, ux, vx, state, mu_s, mu_k, p, begins, w, memory):
    """Find out how the effects change what the law inside sees; return its u, v, mu_s, mu_k."""
    where = int(p[2])
    q = as_doubles(where)
    rates = np.zeros(MAX_MEMORY)
    x, v = q[VB] * t - ux, q[VB] - vx
    if begins:
        for j in range(MAX_MEMORY):
            memory[j] = q[REST + j]
    else:
        _recall(q, where, t, x, v, state, w, memory)
    _surround(q, where, t, x, v, w, memory, rates)
    u, speed = w[e.BELT_TRAVEL] - x, w[e.BELT_VELOCITY] - v
    stuck = abs(speed) <= q[STICK_SPEED] if begins or q[MODED] == 0.0 else state[0] == 0.0
    if stuck:
        drive = q[K] * q[FOOT] * math.cos(q[W] * t) if q[FOOT] != 0.0 else 0.0
        needed = q[C] * v + q[K] * x + q[M] * w[e.BELT_ACCELERATION] - drive - w[e.LOAD]
        w[e.DIRECTION], w[e.SPEED] = 1.0 if needed >= 0.0 else -1.0, 0.0
    else:
        w[e.DIRECTION], w[e.SPEED] = 1.0 if speed >= 0.0 else -1.0, abs(speed)
    stuck_before = state[DWELL] < 0.0  # dwell and slip follow commits, so that the force has no jump within a step
    w[e.DWELL] = 0.0 if begins else t - state[SINCE] if stuck_before else state[DWELL]
    w[e.SLIP] = 0.0 if begins or stuck_before else abs(u - state[BROKE_AT])
    w[e.SLIP_TIME] = 0.0 if begins or stuck_before else max(t - state[SINCE] - state[DWELL], 0.0)
    w[e.BELT_POSITION], w[e.MU_S], w[e.MU_K], w[e.VISCOUS_FORCE] = u, mu_s, mu_k, 0.0
    for i in range(int(q[N_AROUND]), int(q[N_AROUND] + q[N_FRICTION])):
        row = TABLE + 3 * i
        call_effect(int(q[row]), w.ctypes.data, 0, 0, where + 8 * int(q[row + 1]))
    w[e.MU_K] = max(w[e.MU_K], 0.0)  # friction takes energy, whatever factors effects multiply it by
    return u, speed, max(w[e.MU_S], w[e.MU_K]), w[e.MU_K]


@compiled
def _ask(which, t, u, v, normal_force, mu_s, mu_k, effective_mass, state, p, out):
    """Call a function of the law inside; its answer is in ``out``."""
    inside = np.empty(INNER)
    for i in range(INNER):
        inside[i] = state[i]
    _call(as_doubles(int(p[2])), which, t, u, v, normal_force, mu_s, mu_k, effective_mass, inside, out)


@compiled
def _call(q, which, t, u, v, normal_force, mu_s, mu_k, effective_mass, inside, out):
    """Call a function of the law inside; arrays that a caller passes live on while addresses of them are in use."""
    call_law(
        int(q[which]), t, u, 0.0, v, 0.0, normal_force, mu_s, mu_k, effective_mass, 0.0, 0.0,
        inside.ctypes.data, int(q[INNER_P]), out.ctypes.data,
    )  # fmt: skip


@compiled
def _share(p, normal_force):
    """Return the part of the normal force that this contact carries [-]: an engine may have several under one box."""
    return normal_force / as_doubles(int(p[2]))[N]


@compiled
def _sticks(p, state, v):
    q = as_doubles(int(p[2]))
    return state[0] == 0.0 if q[MODED] == 1.0 else abs(v) <= q[STICK_SPEED]


@compiled
def init(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the state at the start: that of the law inside, a stick that begins, memories at rest."""
    w, memory, out, nothing = np.zeros(e.WORLD), np.zeros(MAX_MEMORY), np.zeros(MAX_STATE), np.zeros(MAX_STATE)
    u, v, mu_s, mu_k = _see(t, ux, vx, nothing, mu_s, mu_k, p, True, w, memory)
    _ask(INIT, t, u, v, w[e.NORMAL_FORCE] * _share(p, normal_force), mu_s, mu_k, effective_mass, nothing, p, out)
    dwell = -1.0 if _sticks(p, out, v) else 0.0
    return (
        out[0], out[1], out[2], out[3], out[4], out[5], t, u, dwell, t, w[e.POSITION], w[e.VELOCITY],
        memory[0], memory[1], memory[2], memory[3],
    )  # fmt: skip


@compiled
def force(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return friction and loads [N]."""
    w, memory, out = np.zeros(e.WORLD), np.zeros(MAX_MEMORY), np.zeros(MAX_STATE)
    u, v, mu_s, mu_k = _see(t, ux, vx, state, mu_s, mu_k, p, False, w, memory)
    _ask(FORCE, t, u, v, w[e.NORMAL_FORCE] * _share(p, normal_force), mu_s, mu_k, effective_mass, state, p, out)
    return out[0] + (w[e.DIRECTION] * w[e.VISCOUS_FORCE] + w[e.LOAD]) * _share(p, normal_force), out[1]


@compiled
def commit(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the state after an accepted step: that of the law inside, dwell, slip and memories."""
    w, memory, out = np.zeros(e.WORLD), np.zeros(MAX_MEMORY), np.zeros(MAX_STATE)
    u, v, mu_s, mu_k = _see(t, ux, vx, state, mu_s, mu_k, p, False, w, memory)
    _ask(COMMIT, t, u, v, w[e.NORMAL_FORCE] * _share(p, normal_force), mu_s, mu_k, effective_mass, state, p, out)
    since, broke_at, dwell = state[SINCE], state[BROKE_AT], state[DWELL]
    sticks = _sticks(p, out, v)
    if sticks and dwell >= 0.0:
        since, dwell = t, -1.0
    elif dwell < 0.0 and not sticks:
        broke_at, dwell = u, t - since
    return (
        out[0], out[1], out[2], out[3], out[4], out[5], since, broke_at, dwell, t, w[e.POSITION], w[e.VELOCITY],
        memory[0], memory[1], memory[2], memory[3],
    )  # fmt: skip


@compiled
def guards(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the guards of the law inside."""
    w, memory, out = np.zeros(e.WORLD), np.zeros(MAX_MEMORY), np.zeros(MAX_STATE)
    u, v, mu_s, mu_k = _see(t, ux, vx, state, mu_s, mu_k, p, False, w, memory)
    _ask(GUARD, t, u, v, w[e.NORMAL_FORCE] * _share(p, normal_force), mu_s, mu_k, effective_mass, state, p, out)
    return out[0], out[1], out[2], out[3], out[4], out[5]
