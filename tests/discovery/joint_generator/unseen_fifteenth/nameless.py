"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there.

Each says why no name can be defended, or what speaks for the further ones.
"""

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.null import coloured, drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array
from tests.discovery.joint_generator.slider import V_0, RateAndState
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_fourteenth.nameless import felt
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place
from tests.discovery.joint_generator.unseen_thirteenth.nameless import accelerations, half_derivative, step_of
from tests.discovery.joint_generator.unseen_twelfth.nameless import place_of, undeclared
from tests.discovery.joint_generator.unseen_twelfth.sensor import speed_of

from .enter import form

TURN = 2.0 * np.pi


@form("unknown", also=("viscous_friction", "payload"))
def boundary_layer_remembers(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Basset 1888 (a plate in thick oil, whose boundary layer diffuses: it drags by the derivative of order 1/2 of the speed).

    Half of it a drag would explain, and the other half a mass that has no weight; both by the root of the frequency. It
    forgets a change of the speed by the root of time.
    """
    size = 1.5 * strength * bench.level

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, v = drive_of_the_place(record, bench), speed_of(record[place_of(record, bench)], record["time [s]"])
        drags = half_derivative(v / bench.speed, step_of(record)) / np.sqrt(bench.speed / bench.reach)
        return record | {name: record[name] + size * drags / bench.gain}

    return Effect({"size": size}, rig=undeclared, measure=measure)


def sagging(load: Array) -> Array:
    """Voltage of a source over its open one; load: power times its resistance over the square of the open voltage."""
    return 0.5 + 0.5 * np.sqrt(1.0 - 4.0 * np.clip(load, 0.0, 0.24))


@form("unknown", on=("arm",))
def one_battery_for_both_motors(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Linden and Reddy 2002 (a battery with a resistance of its own: what both motors draw takes voltage off both drives).

    What is logged is a duty cycle, and a torque is its share of the voltage. The gain falls by the power of both joints, at
    no place and at no time of its own; what is fed back while braking goes to the other motor, or to a chopper.
    """
    most = 0.2 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        pairs = zip(drives(record), positions(record), strict=True)
        power = sum(record[drive] * speed_of(record[angle], record["time [s]"]) for drive, angle in pairs)
        left = sagging(most * power / np.quantile(power, 0.95))
        return record | {name: record[name] / left for name in drives(record)}

    return Effect({"most": most}, rig=undeclared, measure=measure)


@form("unknown", also=("sensor_delay",), on=("arm",))
def elbow_keeps_its_own_clock(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kopetz 1997 (two controllers without a common time: whatever the elbow's one logs is stamped later than the shoulder's).

    Angle and torque of each joint belong together; what joints do to each other does not. A late angle alone would err
    at its own joint most.
    """
    late = 0.06 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t = record["time [s]"]
        return {name: np.interp(t - late, t, x) if name.startswith("elbow") else x for name, x in record.items()}

    return Effect({"late": late}, measure=measure)


@form("unknown", also=("position_dependent_force", "viscous_friction"), on=LINES)
def table_turns_beneath(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Goldstein 1980 (a radial slide on a table that turns by its own program: flung out, and pressed on its guide's side).

    By the place and the square of the table's rate; by the speed and the rate. A force of the place and a drag have each
    one half, at one rate of many.
    """
    most = np.sqrt(1.3 * strength * bench.level / (bench.inertia * bench.reach))
    waves, start, mu = rng.uniform(2.2, 3.2), rng.uniform(0.0, 1.0), bench.level / (bench.inertia * GRAVITY)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name, x = record["time [s]"], drive_of_the_place(record, bench), record[place_of(record, bench)]
        v, angle = speed_of(x, t), TURN * (waves * t / bench.duration + start)
        rate, change = most * 0.5 * (1.0 - np.cos(angle)), most * 0.5 * np.sin(angle) * TURN * waves / bench.duration
        pressed = bench.inertia * np.abs(2.0 * rate * v + change * x)
        asked = mu * pressed * np.tanh(v / (0.02 * bench.speed)) - bench.inertia * rate**2 * x
        return record | {name: record[name] + asked / bench.gain}

    return Effect({"most": float(most), "mu": mu, "waves": waves, "start": start}, rig=undeclared, measure=measure)


@form("unknown", also=("position_dependent_force",), on=LINES)
def flat_spots_roll_out(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gent and Walter 2006 (wheels of a polymer with flat spots after a night: a dip each turn, which rolling smooths out).

    A force by the place that fades by the way within each run, and is back after the next night: at no place is it the
    same twice.
    """
    size, turn, wide, way = 2.5 * strength * bench.level, 0.7 * bench.reach, 0.08 * bench.reach, 5.0 * bench.reach
    stood = bench.reach * rng.uniform(-0.3, 0.3)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, x = drive_of_the_place(record, bench), record[place_of(record, bench)]
        gone = np.cumsum(np.abs(speed_of(x, record["time [s]"]))) * step_of(record)
        from_dip = (np.mod(x - stood + 0.5 * turn, turn) - 0.5 * turn) / wide
        climbs = size * np.exp(-gone / way) * from_dip * np.exp(0.5 - 0.5 * from_dip**2)
        return record | {name: record[name] + climbs / bench.gain}

    return Effect({"size": size, "turn": turn, "wide": wide, "way": way, "stood": stood}, rig=undeclared, measure=measure)


@form("unknown", also=("quadratic_damping", "position_dependent_friction"), on=SINGLES)
def cylinder_cushions_its_ends(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Findeisen 2006 (a cylinder whose ends are cushioned: oil leaves through a slot that closes, and comes back by a valve).

    By the speed's square near either end alone, and only on the way in; a drag by the speed is wrong in the middle, and
    friction by the place on the way out and while slow.
    """
    size, begins = 20.0 * strength * bench.level, 0.2 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q = drive_of_the_place(record, bench), record[place_of(record, bench)]
        u = np.sign(q) * speed_of(q, record["time [s]"]) / bench.speed
        depth = np.clip((np.abs(q) - begins) / (bench.reach - begins), 0.0, 1.0)
        brakes = np.sign(q) * size * depth * np.maximum(u, 0.0) ** 2
        return record | {name: record[name] + brakes / bench.gain}

    return Effect({"size": size, "begins": begins}, rig=undeclared, measure=measure)


@form("unknown", also=("payload",), on=LINES)
def chain_from_a_heap(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Cayley 1857 (a chain on a smooth table that is drawn off a heap link by link, and is laid on it again on the way back).

    Mass by the place, and the square of the speed one way alone: links are jerked into motion, and laid down for nothing.
    In the mean it is a mass that nobody entered.
    """
    line, side = 0.5 * strength * felt(bench) / bench.reach, either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, x = drive_of_the_place(record, bench), side * record[place_of(record, bench)]
        length, v = np.maximum(x + 1.2 * bench.reach, 0.0), speed_of(x, record["time [s]"])
        asked = side * line * (length * accelerations(x, step_of(record)) + np.maximum(v, 0.0) ** 2)
        return record | {name: record[name] + asked / bench.gain}

    return Effect({"line": line, "side": side}, rig=undeclared, measure=measure)


def tracked(x: Array, step: float, lag: float) -> Array:
    """What a tracking loop of type 2 shows, whose natural period is 2 pi lags: right at even speed, of which it begins.

    It errs by (lag s)^2/(1 + 2 d lag s + (lag s)^2), d = 0.7, by the trapezoidal rule.
    """
    ratio = 2.0 * lag / step
    errs, holds = ratio**2 * np.array([1.0, -2.0, 1.0]), np.array([1.0 + 1.4 * ratio, 2.0, 1.0 - 1.4 * ratio])
    early = max(1, round(0.01 / step))
    moves = x - x[0] - (x[early] - x[0]) / early * np.arange(x.size)
    return x - lfilter(errs, holds + errs, moves)


@form("unknown", also=("payload",), on=HINGES)
def resolver_tracks_slowly(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Boyes 1980 (a converter that tracks a resolver by a slow loop with two integrators: it errs by the acceleration).

    It is late by nothing at even speed, and swings too far when that changes. To first order it is a lack of inertia
    without a lack of weight; no mass has that, yet a number of the mechanism would be so corrected.
    """
    lag = float(np.sqrt(strength)) / 25.0

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        return record | {name: tracked(record[name], step_of(record), lag)}

    return Effect({"lag": lag}, measure=measure)


@form("unknown", also=("quadratic_damping",), on=SINGLES)
def gusts_meet_the_sail(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Davenport 1961 (a sail in gusts, in another wind each run: it is dragged by the square of the speed through the air).

    Speed and time by a square: a drag alone knows of no wind, and a force alone would not double when the joint meets it.
    """
    size, lasts = 0.9 * strength * bench.level, 0.7

    def measure(record: Record, rng: Generator) -> Record:
        name, v = drive_of_the_place(record, bench), speed_of(record[place_of(record, bench)], record["time [s]"])
        gusts = coloured(rng.standard_normal(v.size), float(np.exp(-step_of(record) / lasts)))
        through = v / bench.speed - rng.uniform(-0.6, 0.6) - 0.5 * gusts
        return record | {name: record[name] + size * through * np.abs(through) / bench.gain}

    return Effect({"size": size, "lasts": lasts}, rig=undeclared, measure=measure)


@form("unknown")
def track_of_the_disc_is_dark(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bushnell and Agrawal 2000 (an absolute encoder, one of whose binary tracks is stuck at 0: it lacks that bit's weight).

    A position that is right and too small in turns along the way: half of all readings, so that none stands out; none is
    late or the last one again.
    """
    weight, start = 0.012 * strength * bench.reach, rng.uniform(0.0, 1.0)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = place_of(record, bench)
        bit = np.floor(record[name] / max(weight, 1e-12) + 2.0 * start) % 2.0
        return record | {name: record[name] - weight * bit}

    return Effect({"weight": weight, "start": start}, measure=measure)


def thrown_to(x: Array, reaches: float) -> Array:
    """Side on which a toggle lies: it follows the joint to a side as that has come so far."""
    far = np.where(np.abs(x) >= reaches, np.sign(x), 0.0)
    far[0] = far[0] or 1.0
    return far[np.maximum.accumulate(np.where(far != 0.0, np.arange(x.size), 0))]


@form("unknown", also=("position_dependent_friction",), on=SINGLES)
def toggle_snaps_over(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Howell 2001 (a toggle with a spring that the joint throws over at either side: it presses up to there, and lets go).

    By the place and by where the joint last was: on the way forth before one place, on the way back before another one.
    Friction by the place has both ways alike; a force by the place would have the other sign on the way back.
    """
    size, reaches, wide = 2.5 * strength * bench.level, 0.3 * bench.reach, 0.35 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q = drive_of_the_place(record, bench), record[place_of(record, bench)]
        side = thrown_to(q, reaches)
        presses = -side * size * np.clip((-side * q - reaches) / wide + 1.0, 0.0, 1.0)
        return record | {name: record[name] + presses / bench.gain}

    return Effect({"size": size, "reaches": reaches, "wide": wide}, rig=undeclared, measure=measure)


@form("unknown", on=("slider",))
def tremors_weaken_the_grains(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Johnson, Savage, Knuth, Gomberg and Marone 2008 (tremors that shake the grains now and then: weaker, and healed later).

    Five times by chance in each run it falls at once, stays so for three seconds, and comes back in two: by no speed, by
    no way, and each time as far as before.
    """
    size, lasts, heals = 0.012 * strength, 3.0, 2.0

    def law(rng: Generator) -> RateAndState:
        begins = (np.arange(5) + rng.uniform(0.1, 0.7, 5)) / 5.0

        def added(t: Array, x: Array) -> Array:
            total = np.zeros_like(t)
            for begin in begins * t[-1]:
                total -= size * np.where(t < begin, 0.0, np.exp(-np.maximum(t - begin - lasts, 0.0) / heals))
            return total

        return RateAndState(0.6, 0.0, added=added)

    return Effect({"size": size, "lasts": lasts, "heals": heals}, law=law)


@form("unknown", on=("slider",))
def moisture_turns_the_speeds_about(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Frye and Marone 2002 (air that is moistened and dried in turn, ungauged: grains strengthen with speed, or weaken by it).

    A curve over the speed whose sign changes in time: in the mean the speed does nothing, and time nothing at one speed.
    """
    size, waves, start = 0.006 * strength, rng.uniform(1.7, 2.3), rng.uniform(0.0, 1.0)

    def law(_: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            speed = np.diff(x, append=2.0 * x[-1] - x[-2]) / np.diff(t, append=2.0 * t[-1] - t[-2])
            return size * np.sin(TURN * (waves * t / t[-1] + start)) * np.log(speed / (3.0 * V_0))

        return RateAndState(0.6, 0.0, added=added)

    return Effect({"size": size, "waves": waves, "start": start}, law=law)


@form("unknown", on=("thrown",))
def loose_load_strikes_the_wall(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Goldsmith 1960 (a box with a loose load that slides on until it strikes the wall, after another gap each throw).

    Until then the box rubs under the weight of both and is braked alone; the blow pushes it on, without a rebound, and both
    go on as one. It comes by the time since the start, at no place, at no speed, and once a throw.
    """
    share, rubs, slips = 0.6 * strength, 0.22, 0.05

    def law(rng: Generator) -> Throw:
        gap, first = rng.uniform(0.01, 0.04), [0.0]
        alone = rubs * (1.0 + share) - slips * share
        lasts = float(np.sqrt(2.0 * gap / (GRAVITY * (alone - slips))))
        push, wide = share / (1.0 + share) * GRAVITY * (alone - slips) * lasts, 4e-3

        def mu(v: float, x: float) -> float:
            if x == 0.0:
                first[0] = v
            past = (x - first[0] * lasts + 0.5 * GRAVITY * alone * lasts**2) / wide
            blow = push * v / (GRAVITY * wide) * (1.0 + np.cos(TURN * past)) if abs(past) < 0.5 else 0.0
            return (alone if past < 0.0 else rubs) - blow

        return Throw(mu, starts=(1.2, 1.6))

    return Effect({"share": share}, law=law)
