"""Forms that no effect of the vocabulary describes. Each says why no name can be defended."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.signal import butter, lfilter, lsim, sosfiltfilt

from tests.discovery.unseen_forms.forms import UNKNOWN
from tests.discovery.unseen_forms.motion import Motion, State, World

from .enter import form

OF_THE_PLACE = ("position_dependent_friction",)
"""Right as well where all slips begin at one place: what hangs on the way slid then hangs on the place."""


def ride(w: World, place: Callable, speed: Callable) -> None:
    """Let the box ride as place and speed say of (time since it stuck, where); in slips the belt runs evenly."""
    v, since = w.belt_velocity, {"t": 0.0, "travel": 0.0, "x": None}

    def travel(t):
        tau, x = t - since["t"], since["x"]
        return since["travel"] + (v * tau if x is None else place(tau, x) - x)

    def belt(t):
        return v + 0.0 * t if since["x"] is None else speed(t - since["t"], since["x"])

    def set_out(s: State, x: float | None) -> None:
        since.update(travel=float(travel(s.t)), t=s.t, x=x)

    w.travel, w.belt = travel, belt
    w.on_stick, w.on_break = lambda s: set_out(s, float(s.x)), lambda s: set_out(s, None)


def slow_part(x: np.ndarray, steps: float) -> np.ndarray:
    """Return what a first-order lag of so many steps makes of x, from 0 on."""
    decay = np.exp(-1.0 / steps)
    return lfilter([1.0 - decay], [1.0, -decay], x)


def friction_in(motion: Motion, w: World) -> np.ndarray:
    """Return the force of friction [N]: what holds the box in rides, the kinetic one in slips."""
    begun, ended = (np.searchsorted(rows[:, 0], motion.time, "right") for rows in (motion.breaks, motion.sticks))
    held = w.rig.stiffness * motion.position + w.rig.damping * motion.velocity
    return np.where(begun >= ended, w.rig.mu_k * w.normal_force, held)


@form(
    UNKNOWN,
    source="Zener 1948 (a standard linear solid: rubber that relaxes while it is pulled)",
    also_one=OF_THE_PLACE,
)
def rubber_spring_relaxes(w: World, a: float) -> None:
    """A third more stiffness that forgets within half a cycle: slips are quick and short, and long rests reach further."""
    k, more, tau = w.rig.stiffness, 0.3 * a * w.rig.stiffness, 0.5 * w.nominal.period
    w.q0 = (0.0,)  # what is forgotten
    w.rates = lambda s: ((s.x - s.q[0]) / tau,)
    w.spring = lambda s: k * s.x + more * (s.x - s.q[0])


@form(
    UNKNOWN,
    source="Fancher, Ervin, MacAdam and Winkler 1980 (leaf springs of lorries and wagons: leaves rub on each other)",
    also_one=OF_THE_PLACE,
)
def leaves_of_the_spring_rub(w: World, a: float) -> None:
    """A force that turns round over a fifth of a slip after each turn of the box: no viscous one, and none of the place."""
    most, way = 0.15 * a * w.nominal.gap * w.nominal.normal_force, 0.2 * w.nominal.slip_length
    w.q0 = (0.0,)  # force between the leaves
    w.rates = lambda s: ((most * s.v - s.q[0] * abs(s.v)) / way,)
    w.load = lambda s: -s.q[0]


@form(
    UNKNOWN,
    source="Rice 1975; Segall and Rice 1995 (wet gouge that dilates in slip: the pores suck, until water has come in)",
    also_one=OF_THE_PLACE,
)
def wet_gouge_dilates(w: World, a: float) -> None:
    """The load grows with the way slid and is itself again before the next slip: slips are short, break-away is as stated."""
    load, tau = w.normal_force, 0.2 * w.nominal.period
    rise = 0.4 * a * w.nominal.gap / w.nominal.mu_k * w.nominal.normal_force / w.nominal.slip_length
    w.q0 = (0.0,)  # suction
    w.rates = lambda s: (rise * abs(s.w) - s.q[0] / tau,)
    w.normal = lambda s: load + s.q[0]


@form(UNKNOWN, source="Heslot, Baumberger, Perrin, Caroli and Caroli 1994 (creep before slip, exponential in the force)")
def box_creeps_before_it_slips(w: World, a: float) -> None:
    """Rides bend down ahead of break-away, down to a tenth of the belt's speed; the force there is as stated."""
    if a <= 0.0:
        return
    v, rig, share, size = w.belt_velocity, w.rig, 0.9 * a, 0.06 * w.nominal.slip_length
    top = (rig.mu_s * w.normal_force - rig.damping * v * (1.0 - share)) / rig.stiffness  # creep: share v exp((x - top)/size)

    def log(tau, x):
        far = (top - x) / size
        return np.logaddexp(np.log(share), far + np.log1p(-share * np.exp(-far)) - v * tau / size)

    ride(w, lambda tau, x: top - size * log(tau, x), lambda tau, x: v * (1.0 - share * np.exp(-log(tau, x))))


@form(UNKNOWN, source="Hughes 1990 (an unregulated motor gives way as it is loaded; stated is its speed at the mean load)")
def motor_gives_way_under_load(w: World, a: float) -> None:
    """Each ride begins a quarter too quick and ends a quarter too slow, whatever its length: no ripple, which keeps time."""
    if a <= 0.0:
        return
    v, rig = w.belt_velocity, w.rig
    middle, half = rig.mu_k * w.normal_force / rig.stiffness, rig.gap * w.normal_force / rig.stiffness
    rate = 0.25 * a * v / half
    ride(
        w,
        lambda tau, x: x + (v / rate + middle - x) * -np.expm1(-rate * tau),
        lambda tau, x: (v - rate * (x - middle)) * np.exp(-rate * tau),
    )


@form(UNKNOWN, source="Torricelli 1644 (a tank on the box leaks through a hole in its floor; the box is pressed from the side)")
def tank_on_the_box_runs_dry(w: World, a: float) -> None:
    """Slips are over sooner and sooner, over the same ways; friction that drifts would change the ways."""
    mass, end = w.rig.mass, 30.0 * w.nominal.period
    w.mass = lambda t: mass * (1.0 - 0.4 * a * (1.0 - np.maximum(1.0 - t / end, 0.0) ** 2))


@form(UNKNOWN, source="Harris and Piersol 2002 (the arm of a feeler on the box, with a resonance of its own)")
def arm_of_the_feeler_rings(w: World, a: float) -> None:
    """Its tip swings after each slip begins and ends, in rides too, where nothing can move a box that is held."""

    def sensor(t, motion, rng):
        if a <= 0.0:
            return motion.position
        turn = 3.0 * w.nominal.pulsation / np.sqrt(a)
        arm = ([2 * 0.03 * turn, turn**2], [1.0, 2 * 0.03 * turn, turn**2])
        return lsim(arm, motion.position, t)[1]

    w.sensor = sensor


@form(UNKNOWN, source="Butterworth 1930; Gustafsson 1996 (somebody has filtered the record, forwards and backwards)")
def record_was_filtered_both_ways(w: World, a: float) -> None:
    """Turns are round, before as after, and overshoot: no delay, nothing is held."""

    def sensor(t, motion, rng):
        if a <= 0.0:
            return motion.position
        low = butter(2, w.nominal.pulsation / np.pi / np.sqrt(a), fs=1.0 / (t[1] - t[0]), output="sos")
        return sosfiltfilt(low, motion.position)

    w.sensor = sensor


@form(UNKNOWN, source="Gautschi 2002 (a charge amplifier whose charge leaks away; its mean is put back)")
def charge_leaks_from_the_amplifier(w: World, a: float) -> None:
    """What is far from the mean fades within two cycles: rides bend, and no drift remains."""
    mean = w.rig.mu_k * w.normal_force / w.rig.stiffness

    def sensor(t, motion, rng):
        step = a * (t[1] - t[0]) / (2.0 * w.nominal.period)
        return motion.position - (slow_part(motion.position - mean, 1.0 / step) if step > 0.0 else 0.0)

    w.sensor = sensor


@form(UNKNOWN, source="Prandtl 1928; Ishlinskii 1944; Kuhnen 2003 (hysteresis of a strain gauge: three stops, side by side)")
def strain_gauge_has_hysteresis(w: World, a: float) -> None:
    """Other readings on the way up than on the way down, whatever the speed: no curve of the place, no delay."""
    limits = w.nominal.slip_length * np.array([0.1, 0.2, 0.3])

    def sensor(t, motion, rng):
        stops, off = np.zeros(3), np.empty(t.size)
        for i, moved in enumerate(np.diff(motion.position, prepend=motion.position[0])):
            stops = np.minimum(np.maximum(stops + moved, -limits), limits)
            off[i] = stops.sum()
        return motion.position - 0.07 * a * off

    w.sensor = sensor


@form(UNKNOWN, source="Labrosse 1999 (buffers that overrun: a block is lost now and then, and samples are counted on)", end=1.4)
def buffers_overrun(w: World, a: float) -> None:
    """The record leaps ahead at uneven times, in rides and slips alike, and nothing is ever made up."""
    usual, block = 2.5 * w.nominal.period, 0.05 * a * w.nominal.period
    at = np.cumsum(usual * w.rng.uniform(0.5, 1.5, int(2.0 * w.duration / usual) + 4))
    w.sensor = lambda t, motion, rng: np.interp(t + block * np.searchsorted(at, t), t, motion.position)


@form(UNKNOWN, source="Abbe 1890; Bryan 1979 (the gauge sits above the contact, and friction tilts the box)")
def box_nods_as_friction_pulls(w: World, a: float) -> None:
    """Too quick in rides, and a leap back as each slip begins and forth as it ends: no gain is that, and no step stays."""
    mean, lag = w.rig.mu_k * w.normal_force, 0.2 / w.nominal.pulsation

    def sensor(t, motion, rng):
        tilt = slow_part(friction_in(motion, w) - mean, lag / (t[1] - t[0]))
        return motion.position + 0.15 * a * tilt / w.rig.stiffness

    w.sensor = sensor


@form(UNKNOWN, source="Morrison 1969; Kalata 1984 (a tracker that takes speed for constant: alpha and beta of a fading memory)")
def tracker_overshoots(w: World, a: float) -> None:
    """Late as a slip begins, too far as it ends, and right in the ride after a while: a delay would be late there as well."""

    def sensor(t, motion, rng):
        steps = 0.3 * np.sqrt(a) / w.nominal.pulsation / (t[1] - t[0])
        fades = np.exp(-1.0 / max(steps, 1.0e-3))
        alpha, beta = 1.0 - fades**2, (1.0 - fades) ** 2
        return lfilter([alpha, beta - alpha], [1.0, -2.0 * fades, fades**2], motion.position)

    w.sensor = sensor


@form(UNKNOWN, source="Gordon 1991 (floors of laboratories: the gauge stands on a tripod that sways with a fan)")
def stand_of_the_gauge_sways(w: World, a: float) -> None:
    """A wave on the reading alone: a rippling belt would leave break-away in place, a force would leave rides straight."""
    size, turn, phase = 0.04 * a * w.nominal.slip_length, 2 * np.pi * 2.3 / w.nominal.period, w.rng.uniform(0.0, 2 * np.pi)
    w.sensor = lambda t, motion, rng: motion.position + size * np.cos(turn * t + phase)
