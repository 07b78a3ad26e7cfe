"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there.

Each says why no name can be defended, or what speaks for the further ones.
"""

from dataclasses import replace

import numpy as np
from scipy.signal import bilinear, lfilter

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import LINES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place
from tests.discovery.joint_generator.unseen_thirteenth.nameless import accelerations, step_of
from tests.discovery.joint_generator.unseen_twelfth.nameless import place_of, undeclared
from tests.discovery.joint_generator.unseen_twelfth.sensor import speed_of

from .enter import form

TURN = 2.0 * np.pi


def stored(flow: Array, fed: float, step: float) -> Array:
    """Share that an accumulator holds, at first all: it is drawn on by a flow and fed by a steady one [shares a second]."""
    left, shares = 1.0, np.empty_like(flow)
    for i, drawn in enumerate(flow):
        left = min(1.0, max(0.0, left + step * (fed - drawn)))
        shares[i] = left
    return shares


@form("unknown")
def accumulator_is_drawn_on(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rabie 2009 (a hydraulic axis on an accumulator and a small pump: what it draws beyond the pump's flow costs pressure).

    The pressure goes as the inverse of the gas's volume, so the valve opens by the way gone less what was pumped. The gain
    falls after quick motion and is back after slow one: at no place, and in each run at other times.
    """
    grows, holds, spare = 1.6 * strength, 0.8 * bench.reach, rng.uniform(1.05, 1.25)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        flow = np.abs(speed_of(record[place_of(record, bench)], record["time [s]"])) / holds
        left = stored(flow, spare * float(np.mean(flow)), step_of(record))
        return record | {name: record[name] * (1.0 + grows * (1.0 - left))}

    return Effect({"grows": grows, "holds": holds, "spare": spare}, rig=undeclared, measure=measure)


def folded(square: Array, step: float, time: float, high: float, low: float) -> Array:
    """Whether an amplifier holds back: from when its square, averaged over a time, is above `high`, until it is below `low`."""
    kept, heat, on, states = float(np.exp(-step / time)), 0.0, False, np.empty(square.size, dtype=bool)
    for i, x in enumerate(square):
        heat = x + (heat - x) * kept
        on = heat > (low if on else high)
        states[i] = on
    return states


@form("unknown")
def amplifier_folds_back(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Crowder 2006 (an amplifier that sums up the square of its current: it gives less from a limit on, until it has cooled).

    Of the same command it gives 1 or 1/2, by what was asked for in the last half second: two limits, so that the same sum
    means either. No place, no time and no temperature on a gauge tells which.
    """
    more, time = 1.0 * strength, rng.uniform(0.4, 0.6)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        square = record[name] ** 2 / np.mean(record[name] ** 2)
        return record | {name: record[name] * (1.0 + more * folded(square, step_of(record), time, 1.1, 0.75))}

    return Effect({"more": more, "time": time}, rig=undeclared, measure=measure)


def since_turn(v: Array, step: float, slow: float) -> Array:
    """Time since the joint last began to go the other way, none of which is as slow as noise; none before the first turn."""
    way = np.where(np.abs(v) > slow, np.sign(v), 0.0)
    at = np.maximum.accumulate(np.where(way != 0.0, np.arange(v.size), 0))
    turns = np.flatnonzero(np.diff(way[at]) * way[at][:-1] != 0.0) + 1
    last = np.full(v.size, -np.inf)
    last[turns] = turns
    return step * (np.arange(v.size) - np.maximum.accumulate(last))


@form("unknown", also=("frictional_lag",), on=LINES)
def compensation_comes_late(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tung, Anwar and Tomizuka 1993 (a control that pushes after each turn, against the quadrant's glitch: too late, too much).

    The push enters behind the log, once a turn and for as long, however far and fast the joint has gone by then. Friction
    that lags would be off from the turn on and by an exponential; this is right at first, is off, and is right again.
    """
    size, late, lasts = 2.0 * strength * bench.level, rng.uniform(0.06, 0.1), rng.uniform(0.14, 0.18)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, v = drive_of_the_place(record, bench), speed_of(record[place_of(record, bench)], record["time [s]"])
        u = np.clip((since_turn(v, step_of(record), 0.05 * bench.speed) - late) / lasts, 0.0, 1.0)
        return record | {name: record[name] - size * np.sin(np.pi * u) * np.sign(v) / bench.gain}

    return Effect({"size": size, "late": late, "lasts": lasts}, rig=undeclared, measure=measure)


def void(pulled: Array, step: float, refills: float) -> Array:
    """Way that a piston must go back before it meets oil; pulled: its speed, of which oil refills no more than that."""
    gap, gaps = 0.0, np.empty_like(pulled)
    for i, v in enumerate(pulled):
        gap = max(0.0, gap + step * (max(v - refills, 0.0) if v > 0.0 else v))
        gaps[i] = gap
    return gaps


@form("unknown", also=("viscous_friction", "direction_asymmetry"), on=SINGLES)
def damper_draws_a_void(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Segel and Lang 1981 (a damper whose foot valve is too small: pulled fast it draws a void, and pushed it falls through).

    A drag by the speed, but on the way back only from where the void has closed: after a slow pull at once, after a quick
    one never. A drag has half of it where nothing drags, and no direction's own curve knows of the last stroke.
    """
    size, refills, side = 3.0 * strength * bench.level, 0.25 * bench.speed, either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, v = drive_of_the_place(record, bench), speed_of(record[place_of(record, bench)], record["time [s]"])
        falls = (void(side * v, step_of(record), refills) > 0.0) & (side * v < 0.0)
        return record | {name: record[name] + size * np.where(falls, 0.0, v) / bench.speed / bench.gain}

    return Effect({"size": size, "refills": refills, "side": side}, rig=undeclared, measure=measure)


@form("unknown", also=("viscous_friction",))
def hall_switches_come_late(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hendershot and Miller 1994 (a motor in blocks whose Hall switches are filtered: it is switched on too late by the speed).

    The rotor is ahead of the coils by the lateness, which ends at half of the speed, and by the place within a sixth of a
    turn: the gain ripples by the place the more, the faster it goes, and the other way about on the way back. At rest it
    is right everywhere; in the mean it lacks force by the speed, which is the half of it that a drag has.
    """
    late, sector, start = 0.8 * strength, bench.reach * rng.uniform(0.25, 0.35), rng.uniform(0.0, 1.0)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q = drive_of_the_place(record, bench), record[place_of(record, bench)]
        within = TURN / 6.0 * (np.mod(q / sector + start, 1.0) - 0.5)
        lag = late * np.clip(speed_of(q, record["time [s]"]) / (0.5 * bench.speed), -1.0, 1.0)
        return record | {name: record[name] / (np.cos(lag) - np.sin(lag) * np.tan(within))}

    return Effect({"late": late, "sector": sector, "start": start}, rig=undeclared, measure=measure)


@form("unknown", also=("sensor_delay",), on=SINGLES)
def channels_are_filtered_unlike(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ellin and Dolsak 2008 (an encoder with a sine and a cosine, of which the sine alone has passed a filter: late and small).

    It errs by the speed, by a wave of two a pitch and by half of its crest in the mean. A delay has the mean; no delay
    shows the position early at one place and late at the next one.
    """
    lag, pitch, start = 1.2 * strength, bench.reach * rng.uniform(0.35, 0.45), rng.uniform(0.0, TURN)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        x = record[name]
        late = np.arctan(lag * speed_of(x, record["time [s]"]) / bench.speed)
        angle = TURN * x / pitch + start
        off = np.angle(1.0 + 1j * (np.cos(late) * np.sin(angle - late) - np.sin(angle)) * np.exp(-1j * angle))
        return record | {name: x + pitch / TURN * off}

    return Effect({"lag": lag, "pitch": pitch, "start": start}, measure=measure)


@form("unknown", on=SINGLES)
def teeth_shake_the_housing(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ozguven and Houser 1988 (a gear whose teeth excite its housing: it resonates where they come as often as it swings).

    A wave along the place that is nothing while slow, large at one speed, and later than the teeth when that is past: it
    swings up and dies away in times of its own. No force of the place does so, and in time it has no frequency.
    """
    size, pitch, start = 0.7 * strength * bench.level, bench.reach * rng.uniform(0.12, 0.18), rng.uniform(0.0, TURN)
    often, loses = TURN * bench.speed * rng.uniform(0.45, 0.6) / pitch, 0.08

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q, step = drive_of_the_place(record, bench), record[place_of(record, bench)], step_of(record)
        teeth = np.cos(TURN * q / pitch + start)
        swings = bilinear([-1.0, -2.0 * loses * often, 0.0], [1.0, 2.0 * loses * often, often**2], 1.0 / step)
        return record | {name: record[name] + size * lfilter(*swings, teeth - teeth[0]) / bench.gain}

    return Effect({"size": size, "pitch": pitch, "often": often, "start": start}, rig=undeclared, measure=measure)


@form("unknown", also=("load_dependence",), on=LINES)
def air_pads_touch_when_jerked(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Powell 1970 (a carriage on air pads that is driven above them: from an acceleration on, either way, it tips and touches).

    Friction by the acceleration, beyond a limit and up to another one; along the motion while it speeds up as while it is
    braked. The drive has the acceleration in part, so that a load for it would be defensible; its weight never changes.
    """
    size, usual = 2.0 * strength * bench.level, bench.speed**2 / bench.reach
    touches = rng.uniform(0.5, 0.6) * usual

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q = drive_of_the_place(record, bench), record[place_of(record, bench)]
        tips = np.clip((np.abs(accelerations(q, step_of(record))) - touches) / (0.15 * usual), 0.0, 1.0)
        rubs = size * tips * np.tanh(speed_of(q, record["time [s]"]) / (0.02 * bench.speed))
        return record | {name: record[name] + rubs / bench.gain}

    return Effect({"size": size, "touches": touches}, rig=undeclared, measure=measure)


@form("unknown", also=("position_dependent_friction", "position_dependent_force"), on=("arm",))
def tool_grazes_a_table(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Siciliano, Sciavicco, Villani and Oriolo 2009 (a tool that touches a soft table beneath the arm, and is rubbed by it).

    It presses by the height of the tip, which both joints have, and rubs against the tip's way along the table; both drives
    feel it by their levers. Friction or a force by a joint's own place has a part of it, and errs by the other one's.
    """
    upper, fore, mu = bench.numbers["l1"], bench.numbers["l2"], 0.35
    high = rng.uniform(0.08, 0.12) * (upper + fore)
    most = 2.5 * strength * bench.level / (mu * (upper + fore))

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, (shoulder, elbow) = record["time [s]"], positions(record)
        first, both = record[shoulder], record[shoulder] + record[elbow]
        aside, down = upper * np.sin(first) + fore * np.sin(both), upper * np.cos(first) + fore * np.cos(both)
        presses = most * np.maximum(1.0 - (upper + fore - down) / high, 0.0)
        rubs = mu * presses * np.tanh(speed_of(aside, t) / (0.02 * bench.speed * (upper + fore)))
        asked = (rubs * down - presses * aside, rubs * fore * np.cos(both) - presses * fore * np.sin(both))
        return record | {name: record[name] + more for name, more in zip(drives(record), asked, strict=True)}

    return Effect({"most": most, "high": high, "mu": mu}, rig=undeclared, measure=measure)


def braked(v: Array, step: float, slow: float, closes: float, opens: float) -> Array:
    """Whether a brake is shut: from when the joint has stood for a time, until it has been moving for another one."""
    stood, moved, shut, states = 0.0, opens, False, np.empty(v.size, dtype=bool)
    for i, still in enumerate(np.abs(v) < slow):
        stood, moved = (stood + step, 0.0) if still else (0.0, moved + step)
        shut = (shut or stood > closes) and moved < opens
        states[i] = shut
    return states


@form("unknown", also=("frictional_lag",), on=SINGLES)
def brake_opens_late(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gross, Hamann and Wiegaertner 2001 (a holding brake that shuts after a rest, and opens as the joint already moves).

    Friction for a while after long rests, of full size, and none at all after short ones. Friction that lags would come
    after each rest, and fall from the start on.
    """
    size, closes, opens = 2.2 * strength * bench.level, rng.uniform(0.22, 0.26), rng.uniform(0.2, 0.26)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, v = drive_of_the_place(record, bench), speed_of(record[place_of(record, bench)], record["time [s]"])
        shut = braked(v, step_of(record), 0.02 * bench.speed, closes, opens)
        return record | {name: record[name] + size * shut * np.tanh(v / (0.02 * bench.speed)) / bench.gain}

    def rig(bench: Bench) -> Bench:
        return replace(undeclared(bench), motion="strokes")

    return Effect({"size": size, "closes": closes, "opens": opens}, rig=rig, measure=measure)


def caught(x: Array, v: Array, limit: float) -> Array:
    """Way that a strap is drawn out since its pawls fell in, at a speed beyond a limit; none once it goes back."""
    begin, ways = np.nan, np.zeros_like(x)
    for i, (place, speed) in enumerate(zip(x, v, strict=True)):
        if speed < 0.0:
            begin = np.nan
        elif speed > limit and np.isnan(begin):
            begin = place
        ways[i] = 0.0 if np.isnan(begin) else max(place - begin, 0.0)
    return ways


@form("unknown", also=("direction_asymmetry",), on=SINGLES)
def fall_arrester_locks(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sulowski 1991 (a strap with a fall arrester: drawn out too fast its pawls fall in, and it slips until it goes back).

    It holds from a speed on, one way alone, and then at any speed, until the joint turns: at the same place and speed it
    does before the crest of a stroke and not after, or the other way about. In the mean one way has more friction.
    """
    size, limit, side = 2.0 * strength * bench.level, rng.uniform(0.4, 0.5) * bench.speed, either_sign(rng)
    gives = 0.05 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, x = drive_of_the_place(record, bench), side * record[place_of(record, bench)]
        holds = size * np.minimum(caught(x, speed_of(x, record["time [s]"]), limit) / gives, 1.0)
        return record | {name: record[name] + side * holds / bench.gain}

    def rig(bench: Bench) -> Bench:
        return replace(undeclared(bench), motion="sines")

    return Effect({"size": size, "limit": limit, "side": side, "gives": gives}, rig=rig, measure=measure)


def speeds(t: Array, x: Array) -> Array:
    """From each row to the next one."""
    return np.diff(x, append=2.0 * x[-1] - x[-2]) / np.diff(t, append=2.0 * t[-1] - t[-2])


@form("unknown", on=("slider",))
def jerks_along_when_slow(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Brace and Byerlee 1966 (rock that sticks and slips while slow, by drops of chance; beyond a speed it slides evenly).

    Friction climbs by the way and drops at once, about the level that it has when it is quick: no speed, no way and no time
    is it that has another friction.
    """
    size, apart, limit = 0.03 * strength, 5e-6, 5e-6

    def law(rng: Generator) -> RateAndState:
        drops = rng.uniform(0.6, 1.4, 400)

        def added(t: Array, x: Array) -> Array:
            slow, way = speeds(t, x) < limit, np.diff(x, prepend=x[0])
            total, at, i = np.zeros_like(t), 0.0, 0
            for row, step in enumerate(way):
                at = at + step / apart if slow[row] else 0.5 * drops[i]
                if at > drops[i]:
                    at, i = 0.0, i + 1
                total[row] = size * (at - 0.5 * drops[i]) * slow[row]
            return total

        return RateAndState(0.6, 0.0, added=added)

    return Effect({"size": size, "apart": apart, "limit": limit}, law=law)


@form("unknown", also=("frictional_lag",), on=("slider",))
def answers_to_slowing_alone(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rathbun and Marone 2013 (a gouge that answers to steps down and to steps up unlike; here to those down alone).

    It dips as it is slowed, by the logarithm of the step, and comes back with the way; as it is quickened nothing happens.
    Every friction that lags behind a speed has both.
    """
    size, distance = 0.025 * strength, 8e-6

    def law(_: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            v, total = speeds(t, x), np.zeros_like(t)
            for row in np.flatnonzero(v[1:] < 0.9 * v[:-1]) + 1:
                total[row:] -= size * np.log10(v[row - 1] / v[row]) * np.exp(-(x[row:] - x[row]) / distance)
            return total

        return RateAndState(0.6, 0.0, added=added)

    return Effect({"size": size, "distance": distance}, law=law)


def bounces(start: float, aside: float, rubs: float, wall: float, back: float, apart: float, first: float) -> list[Array]:
    """Place of each blow at either rail, and speed that it takes off; start and aside: speeds along and across.

    Friction takes the same share of both, so that the way to the next rail is straight.
    """
    v, x, far, blows = start, 0.0, first, []
    while v**2 > 2.0 * rubs * GRAVITY * far * v / aside + 0.01:
        slower = np.sqrt(v**2 - 2.0 * rubs * GRAVITY * far * v / aside)
        x, aside, v = x + far * v / aside, aside * slower / v, slower
        lost = wall * (1.0 + back) * aside
        blows.append(np.array([x, lost]))
        v, aside, far = v - lost, back * aside, apart
    return blows


@form("unknown", on=("thrown",))
def zigzags_between_two_rails(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Brach 1991 (a block thrown a little aside between two rails: each blow at a rail takes speed off, less every time).

    It loses speed at once, a few times a throw and at other places each: by no speed and no place, and never evenly as
    when friction is drawn anew.
    """
    rubs, wall, back, apart = 0.24, 0.35 * strength, 0.75, 0.015

    def law(rng: Generator) -> Throw:
        aside, first, wide = rng.uniform(0.15, 0.35), apart * rng.uniform(0.2, 1.0), 4e-3
        blows: list[Array] = []

        def mu(v: float, x: float) -> float:
            if x == 0.0:
                blows[:] = bounces(v, aside, rubs, wall, back, apart, first)
            total = rubs
            for place, lost in blows:
                past = (x - place) / wide
                if abs(past) < 0.5:
                    total += lost * v / (GRAVITY * wide) * (1.0 + np.cos(TURN * past))
            return total

        return Throw(mu, starts=(1.2, 1.6))

    return Effect({"wall": wall, "rubs": rubs, "back": back, "apart": apart}, law=law)
