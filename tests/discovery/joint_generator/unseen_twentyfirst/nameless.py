"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there.

Each says why no name can be defended, or what speaks for the further ones.
"""

from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import FORCE_OF_TIME, MASS_OF_TIME, Array, Plant
from tests.discovery.joint_generator.slider import RATE, RateAndState
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place
from tests.discovery.joint_generator.unseen_thirteenth.nameless import step_of
from tests.discovery.joint_generator.unseen_twelfth.nameless import place_of, undeclared
from tests.discovery.joint_generator.unseen_twelfth.sensor import speed_of
from tests.discovery.joint_generator.unseen_twentieth.nameless import along, usual, without_end

from .enter import form

TURN = 2.0 * np.pi
RIM = np.cos(TURN * (np.arange(64) + 0.5) / 64), np.sin(TURN * (np.arange(64) + 0.5) / 64)
"""Points of a ring that a disc stands on."""


def restless(bench: Bench) -> Bench:
    """A joint that goes to and fro quickly, under a controller of which nothing is said."""
    return replace(undeclared(bench), motion="sines")


def in_the_cushions(q: Array, v: Array, bench: Bench) -> Array:
    """Drag of a tapered spear over the square of the speed: from half the reach outwards, and free on the way back."""
    depth = np.clip(np.abs(q) / bench.reach - 0.5, 0.0, 0.6) / 0.5
    return np.where(q * v > 0.0, depth * np.sign(v) * (v / bench.speed) ** 2, 0.0)


def asked_of_a_weak_supply(force: Array, v: Array, share: float) -> Array:
    """u of u (1 - share u v) = force, in shares of the usual; where there is no more power, twice what it gives."""
    return 2.0 * force / (1.0 + np.sqrt(np.maximum(1.0 - 4.0 * share * force * v, 0.0)))


def first_order(x: Array, step: float, time: float) -> Array:
    """A signal behind a first-order low pass that is settled at its first value."""
    kept = float(np.exp(-step / time)) if time > 0.0 else 0.0
    return lfilter([1.0 - kept], [1.0, -kept], x, zi=[kept * x[0]])[0]


def ring_slows(v: float, rim: float) -> tuple[float, float]:
    """Shares of mu g by which a ring's speed and the speed of its rim fall: friction against each point's own motion."""
    ahead, across = v - rim * RIM[1], rim * RIM[0]
    size = np.maximum(np.hypot(ahead, across), 1e-12)
    return float(np.mean(ahead / size)), float(np.mean((across * RIM[0] - ahead * RIM[1]) / size))


def suction(t: Array, x: Array, way: float, time: float) -> Array:
    """What pores lack after changes of speed: they open by its logarithm over a way, and water comes in over a time."""
    speed = np.diff(x, append=2.0 * x[-1] - x[-2]) * RATE
    target, gone, kept = np.log10(speed), 1.0 - np.exp(-speed / (RATE * way)), float(np.exp(-1.0 / (RATE * time)))
    opened, lacks, out = target[0], 0.0, np.zeros_like(t)
    for i in range(1, t.size):
        opens = gone[i - 1] * (target[i - 1] - opened)
        opened, lacks = opened + opens, kept * lacks + opens
        out[i] = lacks
    return out


@form("unknown", also=("quadratic_damping", "position_dependent_friction"), on=SINGLES)
def cushioned_cylinder_ends(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merritt 1967 (a cylinder with cushions: tapered spears throttle the oil by the speed's square, and check valves free it).

    By place, speed and side at once: a drag that is only where the piston goes outwards, and none where it comes back.
    """
    size = 20.0 * strength * bench.level

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q = drive_of_the_place(record, bench), record[place_of(record, bench)]
        drag = size * in_the_cushions(q, speed_of(q, record["time [s]"]), bench)
        return record | {name: record[name] + drag / bench.gain}

    return Effect({"size": size}, rig=restless, measure=measure)


@form("unknown", also=("viscous_friction", "position_dependent_force"))
def trapped_air_leaks_out(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bachrach and Rivin 1983 (air that a piston shuts in behind a small orifice: a spring which relaxes as it leaks).

    To quick strokes a spring about where they began, to slow ones a drag; to those in between neither.
    """
    size, time = 2.0 * strength * bench.level, rng.uniform(0.8, 1.5) * bench.reach / bench.speed
    stiffness = size / bench.reach
    return Effect(
        {"stiffness": stiffness, "time": time},
        alter=lambda plant, _: plant.with_extra(relaxing_stiffness=stiffness, relaxing_time=time),
    )


@form("unknown", also=("viscous_friction", "load_dependence"), on=HINGES)
def battery_sags_under_power(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rahn and Wang 2013 (a battery with an inner resistance: the drive lacks a share that goes as the power drawn).

    The gain falls by force times speed, and rises while the motor brakes: no place, time or temperature tells it. A drag
    has its speed and a friction by the load its square, neither both.
    """
    share, most = 0.36 * strength, usual(bench)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, v = drive_of_the_place(record, bench), speed_of(record[place_of(record, bench)], record["time [s]"])
        force = record[name] * bench.gain / most
        more = asked_of_a_weak_supply(force, v / bench.speed, share) - force
        return record | {name: record[name] + more * most / bench.gain}

    return Effect({"share": share}, rig=restless, measure=measure)


@form("unknown", also=("drive_gain_change",), on=SINGLES)
def teeth_saturate_at_high_current(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Krishnan 2010 (a motor whose teeth saturate: torque by the current at first, and by its root beyond).

    The gain falls with the drive itself, whatever place, time or temperature is; along the drive and not the motion.
    """
    bend = without_end(0.9 * usual(bench), strength)
    return Effect({"bend": bend}, alter=lambda plant, _: plant.with_extra(bend=bend))


@form("unknown", on=LINES)
def lands_overlap_the_ports(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merritt 1967; Bu and Yao 2000 (a spool whose lands overlap the ports: a small command to either side does nothing).

    It takes from the drive along the drive: with friction while it pushes, and against friction while it brakes.
    """
    zone = 0.6 * strength * bench.level
    return Effect({"zone": zone}, alter=lambda plant, _: plant.with_extra(dead_zone=zone))


@form("unknown", on=SINGLES)
def clocks_of_two_loggers_differ(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sundararaman, Buy and Kshemkalyani 2005 (two loggers, one on a poor clock, laid over each other to fit on the whole).

    The position is early at first, right amidst and late at last: in the mean there is no delay.
    """
    skew = 0.006 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t = record["time [s]"]
        return record | {name: np.interp(t - skew * (t - 0.5 * t[-1]), t, record[name]) for name in positions(record)}

    return Effect({"skew": skew}, measure=measure)


@form("unknown", also=("load_dependence",), on=("arm",))
def elbow_tendon_wraps_the_shoulder(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Townsend and Salisbury 1987; Kaneko, Yamashita and Tanie 1991 (the elbow's tendon slides on a pulley at the shoulder).

    Friction at the shoulder by what the elbow is driven with: a load, but none of the shoulder's own.
    """
    share = 0.3 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        (name, other), v = drives(record), speed_of(record[positions(record)[0]], record["time [s]"])
        return record | {name: record[name] + share * np.abs(record[other]) * along(v, bench)}

    return Effect({"share": share}, rig=lambda bench: replace(undeclared(bench), place=0), measure=measure)


@form("unknown", on=("arm",))
def shoulder_shows_in_the_elbow_gauge(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Uchiyama, Bayo and Palma-Villalon 1991 (gauges with crosstalk: the elbow's shows a little of the shoulder's torque).

    Weight, inertia and friction of another joint in a reading: no load, place or speed of the elbow tells it.
    """
    share = either_sign(rng) * 0.05 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        other, name = drives(record)
        return record | {name: record[name] + share * record[other]}

    return Effect({"share": share}, rig=lambda bench: replace(undeclared(bench), place=1), measure=measure)


@form("unknown", on=("arm",))
def other_joint_shakes_it_loose(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Fridman and Levesque 1959 (vibration takes friction away: here that of the other joint's gears, by how quick it is).

    Friction falls with the speed of another joint, and with nothing of its own.
    """
    share = 0.55 * strength
    return Effect({"share": share}, alter=lambda plant, _: plant.with_extra(other_speed=-share / bench.speed))


@form("unknown", also=("payload",), on=SINGLES)
def hopper_runs_empty(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Cveticanin 1998 (a hopper on rollers that runs empty on the way: the mass falls evenly, from too much to too little).

    In the mean the mass is right, and friction stays: a payload would be wrong at both ends.
    """
    share = 0.9 * strength
    return Effect(
        {"share": share},
        alter=lambda plant, _: plant.times_in_time(MASS_OF_TIME, lambda t: 1.0 + share * (0.5 - t / bench.duration)),
        rig=restless,
    )


@form("unknown", also=("harmonic_force",))
def unbalance_runs_up(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lewis 1932 (a rotor out of balance that runs up beside the joint: it shakes ever quicker, by the square of that).

    No frequency lasts: a harmonic force has one, and has this one right for a moment alone.
    """
    size, first, last = 2.0 * strength * bench.level, rng.uniform(1.5, 2.5), rng.uniform(8.0, 11.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        rise, phase = (last - first) / bench.duration, rng.uniform(0.0, TURN)

        def shakes(t: Array) -> Array:
            return size * ((first + rise * t) / last) ** 2 * np.cos(TURN * (first * t + 0.5 * rise * t**2) + phase)

        return plant.add_in_time(FORCE_OF_TIME, shakes)

    return Effect({"size": size, "first": first, "last": last}, alter=alter)


@form("unknown", also=("sensor_delay",), on=SINGLES)
def load_cell_behind_a_low_pass(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Doebelin 2004 (a force that is shown behind an amplifier's low pass of a few hertz).

    The drive is late, not the position, and its steps at the turns are rounded: what would be a delay is a negative one.
    """
    time = 0.05 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        return record | {name: first_order(record[name], step_of(record), time)}

    return Effect({"time": time}, rig=undeclared, measure=measure)


@form("unknown", also=("frictional_lag",), on=("slider",))
def dilating_gouge_draws_water_in(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Segall and Rice 1995 (a wet gouge that opens where it slides quicker: its pores lack pressure until water comes in).

    It is stronger after a step up and weaker after one down, by a way and a time in turn: a large peak after quick steps
    and next to nothing after slow ones. A memory of contacts has a way or a time, and the same size for both.
    """
    size, way, time = 0.03 * strength, rng.uniform(6e-6, 1.2e-5), rng.uniform(2.0, 4.0)
    return Effect(
        {"size": size, "way": way, "time": time},
        law=lambda _: RateAndState(0.6, 0.0, added=lambda t, x: size * suction(t, x, way, time)),
    )


@form("unknown", also=("velocity_weakening", "random_coefficients"), on=("thrown",))
def puck_spins_as_it_slides(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Farkas, Bartels, Unger and Wolf 2003 (a disc on a rim that spins as it slides: friction is shared between both motions).

    By how quick it spins beside how quick it slides, which differs from throw to throw: no speed tells it, and no chance.
    """
    mu, spin = 0.25, 1.6 * strength

    def law(rng: Generator) -> Throw:
        start, rim = rng.uniform(1.1, 1.5), spin * rng.uniform(0.4, 1.0)

        def rates(_: float, y: Array) -> Array:
            return -mu * GRAVITY * np.array(ring_slows(*y))

        def slow(_: float, y: Array) -> float:
            return float(y[0]) - 0.02

        slow.terminal = True
        t = solve_ivp(rates, (0.0, 5.0), [start, rim * start], rtol=1e-7, atol=1e-9, max_step=0.01, events=slow)
        v, rims = t.y[:, ::-1]
        shares = np.array([ring_slows(*pair)[0] for pair in zip(v, rims, strict=True)])
        return Throw(lambda u, _: mu * float(np.interp(u, v, shares)), starts=(start, start))

    return Effect({"spin": spin}, law=law)
