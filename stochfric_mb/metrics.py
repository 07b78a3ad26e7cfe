"""Numbers that describe one trajectory, and numbers that compare two."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from stochfric_mb.coefficients.processes import EVENT, POSITION
from stochfric_mb.laws.contract import Law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.scenario import Scenario
from stochfric_mb.trajectory import Trajectory

Array = npt.NDArray[np.float64]

SLIP_SHARE = 0.1
"""Least travel of a counted slip over that of an undamped slip, 2 (mu_s - mu_k) N/k [-]."""
DEFLECTION_SHARE = 0.01
"""Least travel of a counted slip over the static deflection mu_s N/k [-]; decides where mu_s = mu_k."""


def relative_velocity(trajectory: Trajectory, mechanism: BeltBox) -> Array:
    """Return the relative velocity v_rel = v_b - x' [m/s], shape (n,)."""
    return mechanism.belt_velocity - trajectory.velocity


def relative_displacement(trajectory: Trajectory, mechanism: BeltBox) -> Array:
    """Return the relative displacement u = v_b t - x [m], shape (n,): where on the belt the box stands."""
    return mechanism.belt_velocity * trajectory.time - trajectory.position


def stick_fraction(trajectory: Trajectory, law: Law, mechanism: BeltBox) -> float:
    """Return the share of samples with abs(v_rel) <= the law's stick speed [-]; samples are evenly spaced."""
    return float(np.mean(np.abs(relative_velocity(trajectory, mechanism)) <= law.stick_speed))


def least_slip(law: Law, mechanism: BeltBox) -> float:
    """Return the travel [m] from which a slip counts: max(0.1 * 2 (mu_s - mu_k), 0.01 mu_s) N/k.

    An undamped slip of the belt-box oscillator travels at least 2 (mu_s - mu_k) N/k, so that a tenth of it distinguishes
    slips from the ringing of a contact that has just stuck again.
    """
    shares = max(SLIP_SHARE * 2.0 * (law.mu_s - law.mu_k), DEFLECTION_SHARE * law.mu_s)
    return shares * mechanism.normal_force / mechanism.stiffness


def break_aways(trajectory: Trajectory, law: Law, mechanism: BeltBox) -> Array:
    """Return the times of the break-aways [s], shape (n_break_aways,).

    A break-away is where abs(v_rel) rises through the law's stick speed after a sample that sticks, if the slip that
    begins there travels at least `least_slip` before it sticks or turns over. It is located between two samples (see
    `_crossing`). A stick phase that falls between two samples is not seen.
    """
    v = relative_velocity(trajectory, mechanism)
    speed = np.abs(v)
    slips = speed > law.stick_speed
    travelled = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(trajectory.time))])
    enough = least_slip(law, mechanism)
    slope = -_acceleration(trajectory, mechanism) * np.sign(v)
    times: list[float] = []
    for start in np.flatnonzero(slips[1:] & ~slips[:-1]) + 1:
        over = np.flatnonzero(~slips[start:] | (v[start:] * v[start] < 0.0))
        end = start + over[0] if over.size else len(v) - 1
        if travelled[end] - travelled[start - 1] >= enough:
            rates = slope[start - 1] * np.sign(v[start - 1] * v[start]), slope[start]
            bracket = trajectory.time[start - 1], trajectory.time[start]
            times.append(_crossing(bracket, (speed[start - 1], speed[start]), rates, law.stick_speed))
    return np.array(times)


def resolves_slips(trajectory: Trajectory, mechanism: BeltBox) -> bool:
    """Return whether no slip fits between two samples: none is shorter than half a natural period, pi sqrt(m/k)."""
    longest = float(np.diff(trajectory.time).max(initial=0.0))
    return longest <= math.pi * math.sqrt(mechanism.mass / mechanism.stiffness)


def period(trajectory: Trajectory, law: Law, mechanism: BeltBox) -> float:
    """Return the mean interval between break-aways [s], NaN where there are fewer than two, or samples may miss a slip.

    >>> from stochfric_mb import load_scenario, run
    >>> scenario = load_scenario("kang2015_table1", law="coulomb")
    >>> f"{period(run(scenario), scenario.law, scenario.mechanism):.3f} s"
    '0.992 s'
    """
    if not resolves_slips(trajectory, mechanism):
        return float("nan")
    times = break_aways(trajectory, law, mechanism)
    return float((times[-1] - times[0]) / (len(times) - 1)) if len(times) > 1 else float("nan")


def max_abs_difference(a: npt.ArrayLike, b: npt.ArrayLike) -> float:
    """Return max abs(a - b)."""
    return float(np.max(np.abs(np.asarray(a, dtype=np.float64) - np.asarray(b, dtype=np.float64))))


def rms_difference(a: npt.ArrayLike, b: npt.ArrayLike) -> float:
    """Return the root mean square of a - b."""
    return float(np.sqrt(np.mean((np.asarray(a, dtype=np.float64) - np.asarray(b, dtype=np.float64)) ** 2)))


def coefficient_path_difference(trajectory: Trajectory, reference: Trajectory, scenario: Scenario, *, seed: int) -> float:
    """Return how far the coefficients that a run used are from the ones it should have used, at most [-].

    Along time the two trajectories must have used equal coefficients. A field along the belt and a sequence of draws
    are equal as such, not as functions of time: for ``spatial`` each pair is compared with the field at the run's own
    belt position, for ``per_event`` the pairs used, in order, with the draws they are (see `draws_used`).
    """
    process = scenario.coefficient_process
    if process is not None and process.clock == POSITION:
        return max_abs_difference(_pairs(trajectory), _field(trajectory, scenario, seed))
    if process is not None and process.clock == EVENT:
        used = _distinct(_pairs(trajectory))
        return max_abs_difference(used, scenario.path(seed).pairs(_horizon(used))[draws_used(trajectory, scenario, seed=seed)])
    return max_abs_difference(_pairs(trajectory), _pairs(reference))


def draws_used(trajectory: Trajectory, scenario: Scenario, *, seed: int) -> npt.NDArray[np.intp]:
    """Return which draws of a ``per_event`` path a run used, in order, shape (m,): for each the nearest that follows.

    A draw whose stick phase falls between two samples leaves no trace and is passed over.
    """
    used = _distinct(_pairs(trajectory))
    draws = scenario.path(seed).pairs(_horizon(used))
    values = np.empty(len(used), dtype=np.intp)
    first = 0
    for number, pair in enumerate(used):
        values[number] = first + np.argmin(np.max(np.abs(draws[first:] - pair), axis=1))
        first = min(int(values[number]) + 1, len(draws) - 1)
    return values


def _horizon(used: Array) -> int:
    """Return how many draws are searched for the pairs used."""
    return 4 * len(used) + 64


def _pairs(trajectory: Trajectory) -> Array:
    return np.column_stack([trajectory.mu_s, trajectory.mu_k])


def _field(trajectory: Trajectory, scenario: Scenario, seed: int) -> Array:
    path = scenario.path(seed)
    places = relative_displacement(trajectory, scenario.mechanism)
    return np.array([path.at(float(t), float(u)) for t, u in zip(trajectory.time, places, strict=True)])


def _distinct(pairs: Array) -> Array:
    """Return the pairs without those that repeat the one before, shape (m, 2)."""
    new = np.any(np.diff(pairs, axis=0) != 0.0, axis=1)
    return pairs[np.concatenate([[True], new])]


def _acceleration(trajectory: Trajectory, mechanism: BeltBox) -> Array:
    """Return x'' [m/s^2] from the forces, shape (n,)."""
    foot = mechanism.excitation_amplitude * np.cos(mechanism.excitation_angular_frequency * trajectory.time)
    spring = mechanism.stiffness * (foot - trajectory.position)
    return (trajectory.friction_force + spring - mechanism.damping * trajectory.velocity) / mechanism.mass


def _crossing(bracket: tuple[float, float], speeds: tuple[float, float], rates: tuple[float, float], level: float) -> float:
    """Return the time [s] in ``bracket`` at which the speed rises through ``level``.

    At break-away the speed is a convex function of time, smooth or with a kink: it lies above its tangents at both
    ends and below its chord. The tangents' crossing is exact for a kink (dry friction) and to second order otherwise.
    """
    (t0, t1), (v0, v1), (a0, a1) = bracket, speeds, rates
    chord = t0 + (t1 - t0) * (level - v0) / (v1 - v0)
    ahead = t0 + (level - v0) / a0 if a0 > 0.0 else t1
    back = t1 - (v1 - level) / a1 if a1 > 0.0 else t0
    return float(min(max(min(ahead, back), chord), t1))
