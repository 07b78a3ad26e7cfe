"""Forms that no effect of the vocabulary describes, from workshops, railways, the field and the instrument bench.

Each says why no name can be defended, or which can where one speed and one load are known.
"""

from __future__ import annotations

import numpy as np
from scipy.signal import cont2discrete, lfilter

from tests.discovery.unseen_forms.forms import UNKNOWN, arrivals
from tests.discovery.unseen_forms.motion import State, World

from .enter import form

ALIKE = ("nonlinear_stiffness", "position_dependent_friction")
"""Of one speed and one load, what each slip repeats may as well hang on the place."""


def filtered(t: np.ndarray, x: np.ndarray, numerator: list[float], denominator: list[float]) -> np.ndarray:
    """Return what a linear instrument, at rest before, shows of x, which is straight between samples."""
    b, a, _ = cont2discrete((numerator, denominator), t[1] - t[0], method="foh")
    return lfilter(np.ravel(b), a, x)


@form(UNKNOWN, source="Gautschi 2002 (a piezoelectric gauge whose charge leaks away: no steady reading)", rig="brush")
def charge_of_the_gauge_leaks(w: World, a: float) -> None:
    """A high pass of less than a cycle: rides bend over, alike in each cycle and about zero, which no drift does."""
    rate = a / (0.4 * w.nominal.period)
    w.sensor = lambda t, motion, rng: filtered(t, motion.position, [1.0, 0.0], [1.0, rate])


@form(
    UNKNOWN, source="Morrison 1998 (a loop through the earth: the mains hum in the gauge, with a third harmonic)", rig="finger"
)
def mains_hum_in_the_gauge(w: World, a: float) -> None:
    """In rides as much as in slips, where no force moves a box that sticks to an even belt."""
    size, turn = 40.0 * a * w.nominal.noise, 2 * np.pi * 50.0

    def sensor(t, motion, rng):
        u = turn * t + 2 * np.pi * rng.random()
        return motion.position + size * (np.sin(u) + 0.3 * np.sin(3.0 * u + 1.0))

    w.sensor = sensor


@form(UNKNOWN, source="Doebelin 1990 (play in the linkage that drives the gauge: it is dragged along)", rig="bolt")
def play_in_the_linkage_of_the_gauge(w: World, a: float) -> None:
    """After each turn nothing moves until the play is taken up; the box itself knows no play."""
    half = 0.05 * a * w.nominal.slip_length

    def sensor(t, motion, rng):
        shown, y = np.empty(t.size), 0.0
        for i, x in enumerate(motion.position):
            shown[i] = y = min(max(y, x - half), x + half)
        return shown

    w.sensor = sensor


@form(UNKNOWN, source="ISO 18431-1 2005 (a logger that samples at another rate than its file says)", rig="pallet")
def logger_has_another_rate(w: World, a: float) -> None:
    """All is slower by the same part, rides and slips alike, over the same ways: no force does that, and no belt."""
    w.sensor = lambda t, motion, rng: np.interp(t * (1.0 - 0.06 * a), t, motion.position)


@form(UNKNOWN, source="Harris and Piersol 2002, chapter 12 (the arm that holds the gauge's target rings)", rig="furnace")
def arm_of_the_target_rings(w: World, a: float) -> None:
    """At three times the box's frequency, with little damping, and on into the rides, where the box cannot swing."""
    turn, zeta = 3.0 * w.nominal.pulsation, 0.03

    def sensor(t, motion, rng):
        swings = [2.0 * zeta * turn, turn**2]
        return (1.0 - a) * motion.position + a * filtered(t, motion.position, swings, [1.0, *swings])

    w.sensor = sensor


@form(UNKNOWN, source="Machlup 1954 (burst noise of a bad junction: a telegraph with two levels)", rig="barn")
def telegraph_in_the_amplifier(w: World, a: float) -> None:
    """The reading jumps to and fro by chance, dozens of times: no single step, nothing held, no single samples."""
    flips = arrivals(w.rng, w.duration, 1.3 / w.nominal.period)
    begins = w.rng.integers(2)
    size = 50.0 * a * w.nominal.noise
    w.sensor = lambda t, motion, rng: motion.position + size * ((begins + np.searchsorted(flips, t)) % 2)


@form(
    UNKNOWN, source="Zener 1948; Lindley 1964 (a rubber spring that relaxes as the belt draws it)", rig="finger", also_one=ALIKE
)
def rubber_spring_gives_with_time(w: World, a: float) -> None:
    """A Maxwell branch beside the spring: stiff in slips, soft in rides, so slips are quick and short."""
    k, more, tau = w.rig.stiffness, 0.3 * a * w.rig.stiffness, 0.25 * w.nominal.period
    w.q0 = (0.0,)  # stretch of the branch's spring
    w.rates = lambda s: (s.v - s.q[0] / tau,)
    w.spring = lambda s: k * s.x + more * s.q[0]


@form(
    UNKNOWN,
    source="VDI 2700 2004 (load securing: freight that slides on its pallet when it is jerked)",
    rig="pallet",
    also_one=ALIKE,
)
def freight_slides_on_the_box(w: World, a: float) -> None:
    """Three tenths of the mass lie loose on the box, and slide where it speeds up: slips begin and end more briskly."""
    share, full = 0.3 * a, w.rig.mass
    most, soft = 0.35 * 0.5 * w.nominal.slip_length * w.nominal.pulsation**2, 0.02 * w.nominal.peak_speed

    def drag(s: State):
        """Acceleration of the freight by friction under it."""
        return most * np.tanh((s.v - s.q[0]) / soft)

    w.q0 = (0.0,)  # velocity of the freight
    w.rates = lambda s: (drag(s),)
    w.mass = lambda t: full * (1.0 - share)
    w.load = lambda s: -share * full * drag(s)


@form(
    UNKNOWN, source="Tolstoi 1967 (the box jumps up as it breaks away, and bounces on the contact)", rig="bolt", also_one=ALIKE
)
def box_bounces_after_break_away(w: World, a: float) -> None:
    """Friction in slip falls first, and swings with the load on the contact: it dies out, and starts anew in each slip."""
    turn, mu_k = 3.0 * w.nominal.pulsation, w.rig.mu_k
    w.mu_k = lambda s: mu_k * (1.0 - 0.4 * a * np.exp(-0.1 * turn * s.slip_time) * np.sin(turn * s.slip_time))


@form(UNKNOWN, source="Peukert 1897 (a drive on a battery that runs down: the belt slows)", rig="brush")
def battery_of_the_drive_runs_down(w: World, a: float) -> None:
    """By a fifth in the end, with a time constant of fifteen cycles: rides are ever flatter, and nothing comes back."""
    v, tau, share = w.belt_velocity, 15.0 * w.nominal.period, 0.2 * a
    w.belt = lambda t: v * (1.0 - share * (1.0 - np.exp(-t / tau)))
    w.travel = lambda t: v * ((1.0 - share) * t + share * tau * (1.0 - np.exp(-t / tau)))
    w.belt_acceleration = lambda t: -v * share / tau * np.exp(-t / tau)


@form(UNKNOWN, source="Beeler, Tullis and Weeks 1994 (slide, hold, slide: the drive pauses and goes on)", rig="barn")
def drive_pauses(w: World, a: float) -> None:
    """The belt stands still now and then, for up to a cycle, at uneven times: no ripple. Friction does not mind."""
    v, usual, soft = w.belt_velocity, w.nominal.period, 0.02 * w.nominal.period
    begins = 1.5 * usual + np.cumsum(usual * w.rng.uniform(1.5, 4.5, int(w.duration / usual) + 2))
    begins = begins[begins < w.duration]
    ends = begins + a * usual * w.rng.uniform(0.3, 1.0, begins.size)

    def gates(t):
        return sum(
            (0.5 * (np.tanh((t - b) / soft) - np.tanh((t - e) / soft)) for b, e in zip(begins, ends, strict=True)), 0.0 * t
        )

    w.set_belt(lambda t: v * (1.0 - gates(t)))


@form(UNKNOWN, source="Marone, Scholz and Bilham 1991 (afterslip: the box creeps on once its slip is over)", rig="furnace")
def box_creeps_after_each_slip(w: World, a: float) -> None:
    """By the logarithm of time, now more and now less, against the ride: places are as stated, rests last longer."""
    v, tau = w.belt_velocity, 4.0 / w.nominal.pulsation
    usual = 0.12 * a * np.sign(v) * w.nominal.slip_length / np.log(w.nominal.period / tau)
    since = {"time": 0.0, "travel": 0.0, "creep": 0.0}

    def travel(t):
        past = t - since["time"]
        return since["travel"] + v * past - 0.5 * since["creep"] * np.log1p((past / tau) ** 2)

    def set_out(s: State, creep: float) -> None:
        since.update(travel=float(travel(s.t)), time=s.t, creep=creep)

    def belt(t):
        past = t - since["time"]
        return v - since["creep"] * past / (tau**2 + past**2)

    def acceleration(t):
        past = t - since["time"]
        return -since["creep"] * (tau**2 - past**2) / (tau**2 + past**2) ** 2

    w.travel, w.belt, w.belt_acceleration = travel, belt, acceleration
    w.on_stick = lambda s: set_out(s, usual * w.rng.uniform(0.4, 1.6))
    w.on_break = lambda s: set_out(s, 0.0)


@form(
    UNKNOWN,
    source="Rice 1975; Segall and Rice 1995 (dilatancy: wet gouge opens in slip, sucks, and fills again)",
    rig="barn",
    also_one=ALIKE,
)
def wet_gouge_opens_and_sucks(w: World, a: float) -> None:
    """Suction grows with what is slid and leaks away in the rides: friction rises in each slip, and remembers the last ones."""
    grows, tau, load = 0.2 * a / w.nominal.slip_length, 0.5 * w.nominal.period, w.normal_force
    w.q0 = (0.0,)  # suction over the load
    w.rates = lambda s: (grows * abs(s.w) - s.q[0] / tau,)
    w.normal = lambda s: load * (1.0 + s.q[0])


@form(UNKNOWN, source="Lewis 1932 (a machine next door runs up: unbalance that sweeps through frequencies)", rig="brush")
def machine_next_door_runs_up(w: World, a: float) -> None:
    """From a quarter of a cycle's frequency to five quarters within forty cycles, its force like the frequency; then even."""
    low, high, sweep = 0.25 / w.nominal.period, 1.25 / w.nominal.period, 40.0 * w.nominal.period
    size, begins = 0.5 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi * w.rng.random()

    def load(s: State):
        run = np.minimum(s.t, sweep)
        frequency = low + (high - low) * run / sweep
        turns = low * run + 0.5 * (high - low) * run**2 / sweep + high * (s.t - run)
        return size * frequency / high * np.cos(2 * np.pi * turns + begins)

    w.load = load
