"""Elastic stick: a spring and a damper while stuck, an exponentially falling coefficient while sliding."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

from stochfric_mb.compile import compiled
from stochfric_mb.errors import InputError, require_number
from stochfric_mb.laws.contract import Law
from stochfric_mb.laws.plane import clipped, length, slip_direction

STICK = 0.0
SLIP_PEAK = 1.0
"""Sliding, not yet faster than v_s since break-away."""
SLIP = 2.0
"""Sliding, faster than v_s."""


@dataclasses.dataclass(frozen=True)
class ElasticStick(Law):
    """Stick as a spring and damper, slip with a coefficient that decays from mu_s to mu_k.

    Stuck (eqs. 3-5): F = k z + c v, never beyond mu_s N, with dz/dt = v, k = mu_s N/e_lim (of the mean mu_s) and
    c = 2 zeta sqrt(k m_eff). Sliding (eq. 6): mu = mu_s up to v_s, beyond it
    mu = mu_k + (mu_s - mu_k) exp(-(v - v_s)/decay_velocity). Break-away when abs(k z) reaches mu_s N with z v > 0
    (with z v <= 0, z is clipped: return mapping); back to stick when v falls to v_s, or turns over before it reached
    v_s, with the z that keeps the force continuous. Up to v_s the force runs along z, which follows the motion like a trailer
    of length e_lim (on a line: along v); beyond v_s along v.

    >>> ElasticStick(mu_s=0.8, mu_k=0.9)
    Traceback (most recent call last):
    ...
    stochfric_mb.errors.InputError: mu_k = 0.9 is above mu_s = 0.8; a law needs mu_k <= mu_s: swap them or lower mu_k

    Reference: Kang, Choi and Yoo 2015, eqs. 3-6, doi 10.1007/s12206-015-0808-4. Misprints: eq. 5 lost its root and
    eq. 6 its superscript; eq. 6 reads mu = a^-(v + b) + mu_k with ln a = 1/decay_velocity and
    b = -ln(mu_s - mu_k)/ln a - v_s.
    """

    e_lim: float = 1.0e-5
    """Deflection at break-away [m], > 0."""
    zeta: float = 0.3
    """Damping ratio of the stuck contact [-], >= 0."""
    v_s: float = 1.0e-4
    """Velocity up to which a sliding contact keeps mu_s, and below which it sticks again [m/s], > 0."""
    decay_velocity: float = 1.0e-3
    """Velocity scale of the fall from mu_s to mu_k [m/s], >= 0 (0: at once); 1/decay_velocity is ln a of eq. 6."""

    kind: ClassVar[str] = "elastic_stick"
    rest: ClassVar[str] = "elastic"
    equation: ClassVar[str] = (
        "stuck: F = k z + c v, abs(F) <= mu_s N, k = mu_s N/e_lim, c = 2 zeta sqrt(k m_eff); "
        "sliding: mu = mu_k + (mu_s - mu_k) exp(-(v - v_s)/decay_velocity)"
    )
    source: ClassVar[str] = "Kang, Choi and Yoo 2015, eqs. 3-6"
    state_names: ClassVar[tuple[str, ...]] = ("mode", "ax", "ay", "dx", "dy")
    needs_effective_mass: ClassVar[bool] = True
    exceptions: ClassVar[dict[str, str]] = {
        "passive": "re-stick starts with a loaded spring (that keeps the force continuous): a body slower than "
        "e_lim omega can return faster than it came, by at most mu_s N e_lim/2 of energy, whether N changes or not"
    }
    step_limit_formula: ClassVar[str] = "2 (sqrt(1 + zeta^2) - zeta)/omega, omega^2 = mu_s N/(e_lim m_eff)"

    def __post_init__(self) -> None:
        super().__post_init__()
        require_number("e_lim", self.e_lim, above=0.0, unit="m")
        require_number("zeta", self.zeta, low=0.0)
        require_number("v_s", self.v_s, above=0.0, unit="m/s")
        require_number("decay_velocity", self.decay_velocity, low=0.0, unit="m/s")
        if self.zeta > 10.0:
            raise InputError(f"zeta = {self.zeta:g} is beyond 10; a damping ratio is usually between 0.1 and 1")

    def step_limit(self, normal_force: float, effective_mass: float) -> float:
        """Return 2 (sqrt(1 + zeta^2) - zeta)/omega [s] with omega^2 = mu_s N/(e_lim m_eff)."""
        omega = math.sqrt(self.mu_s * normal_force / (self.e_lim * effective_mass))
        return 2.0 * (math.sqrt(1.0 + self.zeta**2) - self.zeta) / omega if omega > 0.0 else math.inf


@compiled
def slip_coefficient(speed, mu_s, mu_k, v_s, decay_velocity):
    """Return the sliding coefficient [-], eq. 6: mu_s up to v_s, then an exponential fall to mu_k."""
    if speed <= v_s:
        return mu_s
    if decay_velocity <= 0.0:
        return mu_k
    return mu_k + (mu_s - mu_k) * math.exp(-(speed - v_s) / decay_velocity)


@compiled
def stick_stiffness(normal_force, p):
    """Return k_stick = mu_s N/e_lim [N/m], of the mean mu_s (eq. 4)."""
    return p[0] * normal_force / p[2]


@compiled
def stick_damping(normal_force, effective_mass, p):
    """Return c_stick = 2 zeta sqrt(k_stick m_eff) [N s/m] (eq. 5 with its root)."""
    return 2.0 * p[3] * math.sqrt(stick_stiffness(normal_force, p) * effective_mass)


@compiled
def deflection_limit(mu_s, p):
    """Return the deflection at which k_stick z reaches mu_s N [m]; e_lim at the mean mu_s, whatever N."""
    return p[2] * (mu_s / p[0])


@compiled
def init(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the state at the start: sliding if abs(v) > v_s, otherwise stuck with z = 0."""
    speed = length(vx, vy)
    if speed > p[4]:
        return SLIP, ux, uy, vx / speed, vy / speed
    return STICK, ux, uy, 0.0, 0.0


@compiled
def force(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the friction force [N]: spring and damper within mu_s N while stuck, mu(abs(v)) N while sliding.

    The deflection counts within its limit, which a falling mu_s lowers between commits (continuous return mapping).
    """
    if state[0] == STICK:
        k = stick_stiffness(normal_force, p)
        c = stick_damping(normal_force, effective_mass, p)
        zx, zy = clipped(ux - state[1], uy - state[2], deflection_limit(mu_s, p))
        return clipped(k * zx + c * vx, k * zy + c * vy, mu_s * normal_force)
    if state[0] == SLIP_PEAK:
        ex, ey = trailing_direction(ux, uy, state)
    else:
        ex, ey = slip_direction(vx, vy, state[3], state[4])
    speed = max(vx * ex + vy * ey, 0.0)
    f = slip_coefficient(speed, mu_s, mu_k, p[4], p[5]) * normal_force
    return f * ex, f * ey


@compiled
def trailing_direction(ux, uy, state):
    """Return the unit vector along z = u - a, which follows the motion; the committed direction where z is zero."""
    zx = ux - state[1]
    zy = uy - state[2]
    z = length(zx, zy)
    if z > 0.0:
        return zx / z, zy / z
    return state[3], state[4]


@compiled
def commit(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the state after an accepted step: break-away, clip or re-stick as the class docstring says."""
    if normal_force <= 0.0:
        return init(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, effective_mass, hx, hy, p)
    speed = length(vx, vy)
    if state[0] == STICK:
        return _commit_stick(ux, uy, vx, vy, speed, state, mu_s, p)
    ex, ey = state[3], state[4]
    if state[0] == SLIP_PEAK:
        ex, ey = trailing_direction(ux, uy, state)
    ahead = vx * ex + vy * ey
    if ahead > 0.0 and speed > p[4]:
        return SLIP, ux, uy, vx / speed, vy / speed
    if ahead > 0.0 and state[0] == SLIP_PEAK:
        limit = deflection_limit(mu_s, p)
        return SLIP_PEAK, ux - limit * ex, uy - limit * ey, ex, ey
    if state[0] == SLIP:
        ex, ey = slip_direction(vx, vy, ex, ey)
    return _restick(ux, uy, vx, vy, normal_force, ex, ey, mu_s, effective_mass, p)


@compiled
def _commit_stick(ux, uy, vx, vy, speed, state, mu_s, p):
    """Return the state of a contact that was stuck: still stuck, clipped, or broken away along z."""
    zx = ux - state[1]
    zy = uy - state[2]
    z = length(zx, zy)
    limit = deflection_limit(mu_s, p)
    if z < limit:
        return STICK, state[1], state[2], 0.0, 0.0
    ax, ay = ux - zx * (limit / z), uy - zy * (limit / z)
    if zx * vx + zy * vy > 0.0:
        if speed > p[4]:
            return SLIP, ux, uy, zx / z, zy / z
        return SLIP_PEAK, ax, ay, zx / z, zy / z
    return STICK, ax, ay, 0.0, 0.0


@compiled
def _restick(ux, uy, vx, vy, normal_force, ex, ey, mu_s, effective_mass, p):
    """Return the stuck state whose deflection keeps the force continuous: k z = mu_s N e - c v, within the limit."""
    k = stick_stiffness(normal_force, p)
    c = stick_damping(normal_force, effective_mass, p)
    cap = mu_s * normal_force
    zx, zy = clipped((cap * ex - c * vx) / k, (cap * ey - c * vy) / k, deflection_limit(mu_s, p))
    return STICK, ux - zx, uy - zy, 0.0, 0.0


@compiled
def sliding_coefficient(speed, mu_s, mu_k, p):
    """Return mu(speed) [-], eq. 6."""
    return slip_coefficient(speed, mu_s, mu_k, p[4], p[5])


@compiled
def stick_spring(normal_force, effective_mass, mu_s, p):
    """Return k_stick [N/m], c_stick [N s/m] and the deflection at break-away [m]."""
    return stick_stiffness(normal_force, p), stick_damping(normal_force, effective_mass, p), deflection_limit(mu_s, p)


@compiled
def guards(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the distances to break-away and to the cap (stuck), to v_s and to turning over (sliding)."""
    speed = length(vx, vy)
    if state[0] == STICK:
        zx = ux - state[1]
        zy = uy - state[2]
        k = stick_stiffness(normal_force, p)
        c = stick_damping(normal_force, effective_mass, p)
        limit = deflection_limit(mu_s, p)
        wx, wy = clipped(zx, zy, limit)
        cap = mu_s * normal_force - length(k * wx + c * vx, k * wy + c * vy)
        return limit - length(zx, zy), cap, -cap, 1.0, 1.0, 1.0
    if state[0] == SLIP_PEAK:
        ex, ey = trailing_direction(ux, uy, state)
        return vx * ex + vy * ey, p[4] - speed, 1.0, 1.0, 1.0, 1.0
    ahead = vx * state[3] + vy * state[4]
    return ahead, speed - p[4], 1.0, 1.0, 1.0, 1.0
