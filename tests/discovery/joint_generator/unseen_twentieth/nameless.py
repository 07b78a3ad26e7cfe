"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there.

Each says why no name can be defended, or what speaks for the further ones.
"""

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array, Plant
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_fourteenth.nameless import felt
from tests.discovery.joint_generator.unseen_nineteenth.nameless import stretched
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place
from tests.discovery.joint_generator.unseen_thirteenth.nameless import accelerations, step_of
from tests.discovery.joint_generator.unseen_twelfth.nameless import place_of, undeclared
from tests.discovery.joint_generator.unseen_twelfth.sensor import speed_of

from .enter import form

TURN = 2.0 * np.pi


def lagging(x: Array, step: float, time: float) -> Array:
    """What a first-order lag makes of a signal that is held between rows; nothing before the first."""
    kept = float(np.exp(-step / time)) if np.isfinite(time) else 1.0
    return lfilter([0.0, 1.0 - kept], [1.0, -kept], x)


def without_end(full: float, strength: float) -> float:
    """A time or a speed that is the longer or quicker the less the strength is."""
    return full / strength if strength else np.inf


def usual(bench: Bench) -> float:
    """What a single joint is usually driven with [N or N m]."""
    held = bench.numbers.get("gravity", 0.0) * np.sin(min(bench.reach, 0.5 * np.pi))
    return bench.level + held + 0.5 * bench.inertia * bench.speed**2 / bench.reach


def along(v: Array, bench: Bench) -> Array:
    """Sign of the motion, smooth through rest."""
    return np.tanh(v / (0.02 * bench.speed))


def command_of(force: Array, bent: float, most: float) -> Array:
    """Command for a force that is partly its square, over that force: 1 at `most`, and more below."""
    return 2.0 / (1.0 - bent + np.sqrt((1.0 - bent) ** 2 + 4.0 * bent * np.abs(force) / most))


@form("unknown", also=("drive_gain",), on=SINGLES)
def two_solenoids_pull_in_turn(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Woodson and Melcher 1968 (solenoids that pull to either side with little bias: their force goes as the current's square).

    The current that is taken for the force is too large for small forces, and right for the usual one: one gain has the mean
    of that, and none by time or place has any.
    """
    bent, most = 0.7 * strength, usual(bench) * rng.uniform(0.9, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        return record | {name: record[name] * command_of(record[name] * bench.gain, bent, most)}

    return Effect({"bent": bent, "most": most}, measure=measure)


@form("unknown", on=("arm",))
def elbow_is_driven_from_the_base(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Spong and Vidyasagar 1989 (an elbow driven through the shoulder, read at its motor: it shows some of the shoulder's).

    The elbow is shown where it is not by where the other joint is: nothing is late, drifts or slips, and no friction errs.
    """
    share, side = 0.03 * strength, either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        shoulder, elbow = (record[name] for name in positions(record))
        return record | {positions(record)[1]: elbow + side * share * shoulder}

    return Effect({"share": share, "side": side}, measure=measure)


@form("unknown", also=("payload",), on=LINES)
def cart_goes_full_and_comes_back_empty(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Khalil and Dombre 2002 (a carriage that is laden at one turn and emptied at the other: heavier one way alone).

    Inertia by the direction: a mass that is always there has half of it, and no friction asks for an acceleration.
    """
    load, side = 1.3 * strength * felt(bench), either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q = drive_of_the_place(record, bench), record[place_of(record, bench)]
        laden = 0.5 + 0.5 * along(side * speed_of(q, record["time [s]"]), bench)
        return record | {name: record[name] + load * laden * accelerations(q, step_of(record)) / bench.gain}

    return Effect({"load": load, "side": side}, rig=undeclared, measure=measure)


@form("unknown", also=("position_dependent_force",), on=("arm",))
def spring_over_both_joints(rng: Generator, strength: float, bench: Bench) -> Effect:
    """van Ingen Schenau 1989 (a spring that runs over shoulder and elbow, as a muscle of two joints: it pulls at both alike).

    A force by the sum of both angles: by one joint's place alone it has its half, and the other half errs.
    """
    size, rest = 0.8 * strength * bench.level, bench.reach * rng.uniform(-0.3, 0.3)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        pull = size * (sum(record[name] for name in positions(record)) - rest) / bench.reach
        return record | {name: record[name] + pull for name in drives(record)}

    return Effect({"size": size, "rest": rest}, rig=undeclared, measure=measure)


@form("unknown", also=("correlated_coefficients",), on=HINGES)
def draught_buffets_the_link(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Dryden 1943 (gusts on a link: a force by chance, alike within a part of a second, whichever way the link goes).

    It pushes along the motion as often as against it, so no friction that varies by chance is it; that has the chance right.
    """
    size, time = 0.7 * strength * bench.level, rng.uniform(0.25, 0.45)

    def measure(record: Record, rng: Generator) -> Record:
        name, step = drive_of_the_place(record, bench), step_of(record)
        before = round(10.0 * time / step)  # the draught blows before the record begins
        gusts = lagging(rng.standard_normal(before + record[name].size), step, time)[before:]
        return record | {name: record[name] + size * gusts / np.sqrt(0.5 * step / time) / bench.gain}

    return Effect({"size": size, "time": time}, rig=undeclared, measure=measure)


@form("unknown", also=("position_dependent_friction", "friction_drift", "distance_drift"), on=LINES)
def wheel_sparks_out(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Malkin 1989 (a grinding wheel that is fed no further: its cut goes with the way ground, at the part alone).

    Friction in one stretch that fades by the way gone in it: a place alone or a fading alone has its half.
    """
    size, half, passes = 2.0 * strength * bench.level, 0.35 * bench.reach, rng.uniform(4.0, 7.0)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q = drive_of_the_place(record, bench), record[place_of(record, bench)]
        v = speed_of(q, record["time [s]"])
        touch = 0.5 - 0.5 * np.tanh((np.abs(q) - half) / (0.06 * bench.reach))
        ground = np.cumsum(touch * np.abs(v)) * step_of(record) / (2.0 * half)
        cut = size * touch * np.exp(-ground / passes) * along(v, bench)
        return record | {name: record[name] + cut / bench.gain}

    return Effect({"size": size, "half": half, "passes": passes}, rig=undeclared, measure=measure)


@form("unknown", also=("viscous_friction",), on=SINGLES)
def field_is_weakened_beyond_a_speed(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Leonhard 1985 (a motor above its base speed, whose field is weakened: its current gives less as one over the speed).

    The gain goes by the speed, for braking as for driving: a drag has what it costs while friction alone is driven.
    """
    base = without_end(0.24 * bench.speed * rng.uniform(0.9, 1.1), np.sqrt(strength))

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.with_extra(base_speed=base)

    return Effect({"base": base}, alter=alter)


@form("unknown", also=("frictional_lag",), on=SINGLES)
def piezo_cell_discharges(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gautschi 2002 (a piezoelectric cell whose charge leaks away: what it shows of a force that stays fades to nothing).

    A high pass of the drive: weight and inertia fade as friction does, which a lag of friction after each turn has alone.
    """
    time = without_end(rng.uniform(0.8, 1.2), strength)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        return record | {name: record[name] - lagging(record[name], step_of(record), time)}

    return Effect({"time": time}, measure=measure)


@form("unknown", on=SINGLES)
def load_cell_has_a_loop(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Krasnoselskii and Pokrovskii 1989 (a load cell with hysteresis: it shows less while its load rises, more while it falls).

    It remembers the turns of the load, and not those of the motion: no gain has two values at a force, and nothing is late.
    """
    share, most = 0.7 * strength, usual(bench) * np.array([0.2, 0.45, 0.8]) * rng.uniform(0.9, 1.1)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        return record | {name: record[name] - share * stretched(record[name], most / bench.gain).mean(axis=1)}

    return Effect({"share": share, "least": float(most[0])}, measure=measure)


@form("unknown", also=("friction_drift", "velocity_weakening"), on=SINGLES)
def pad_fades_and_recovers(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Newcomb and Spurr 1967 (a brake pad that fades by the heat of the last seconds, and recovers while it is slow).

    Friction by the speeds of a while ago: a drift has its first fading, the speed of now a part, and neither the recovery.
    """
    size, time = 0.65 * strength * bench.level, rng.uniform(1.0, 2.0)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name = record["time [s]"], drive_of_the_place(record, bench)
        v = speed_of(record[place_of(record, bench)], t)
        heat = lagging(np.abs(v) / bench.speed, step_of(record), time)
        return record | {name: record[name] - size * (1.0 - np.exp(-heat / 0.2)) * along(v, bench) / bench.gain}

    return Effect({"size": size, "time": time}, rig=undeclared, measure=measure)


@form("unknown", also=("quadratic_damping", "position_dependent_friction"), on=LINES)
def metering_pin_of_a_recoil_brake(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Blackburn, Reethof and Shearer 1960 (oil past a tapered pin: the speed over what is left open there, squared).

    By speed and place at once, sixfold from end to end: a drag has the mean of it, a place no speed.
    """
    size, side = 2.0 * strength * bench.level, either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q = drive_of_the_place(record, bench), record[place_of(record, bench)]
        v = speed_of(q, record["time [s]"]) / bench.speed
        opened = 1.0 - 0.6 * np.clip(0.5 + 0.5 * side * q / bench.reach, 0.0, 1.0)
        return record | {name: record[name] + size * v * np.abs(v) / (2.0 * opened**2) / bench.gain}

    return Effect({"size": size, "side": side}, rig=undeclared, measure=measure)


def steps_of(t: Array, x: Array) -> tuple[Array, Array]:
    """Rows at which a load point changes its speed, and by how many decades."""
    decades = np.log10(np.diff(x) / np.diff(t))
    jumps = np.diff(decades, prepend=decades[0])
    rows = np.flatnonzero(np.abs(jumps) > 0.1)
    return rows, jumps[rows]


@form("unknown", also=("second_mode",), on=("slider",))
def servo_of_the_ram_overshoots(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ogata 1970 (a servo of the ram with too little damping: the force rings some seconds after each step of the speed).

    It swings to both sides of the level, by the step's size and sign; memory of contacts comes back from one side.
    """
    size, often, time = 0.025 * strength, rng.uniform(0.6, 0.9), 3.0

    def law(_: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            total = np.zeros_like(t)
            for row, jump in zip(*steps_of(t, x), strict=True):
                since = t[row:] - t[row]
                total[row:] += size * jump * np.exp(-since / time) * np.sin(TURN * often * since)
            return total

        return RateAndState(0.6, 0.0, added=added)

    return Effect({"size": size, "often": often, "time": time}, law=law)


@form("unknown", also=("position_dependent_friction",), on=("slider",))
def small_slips_of_a_gouge(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Karner and Marone 2000 (a gouge that slips a little each few micrometres: the drop falls with the decades of the speed).

    Teeth of a saw along the way, lower when quick: a place has the teeth, and not how they shrink.
    """
    size, apart = 0.03 * strength, rng.uniform(3.5e-6, 4.5e-6)

    def law(_: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            decades = np.log10(np.diff(x, append=2.0 * x[-1] - x[-2]) / np.diff(t, append=2.0 * t[-1] - t[-2])) + 6.0
            return size * np.clip(1.0 - 0.4 * decades, 0.2, 1.0) * (x / apart % 1.0 - 0.5)

        return RateAndState(0.6, 0.0, added=added)

    return Effect({"size": size, "apart": apart}, law=law)


@form("unknown", also=("viscous_friction", "position_dependent_friction"), on=("thrown",))
def magnets_under_a_stretch_of_the_rail(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Wouterse 1991 (magnets beside one stretch of the way: eddies drag there by the speed, ever less so up to a peak).

    By the speed in one stretch alone: slow ones hardly feel it, and none does beyond it.
    """
    size, peak, begin = 0.4 * strength, rng.uniform(1.4, 1.8), rng.uniform(0.03, 0.06)

    def mu(v: float, x: float) -> float:
        over = 0.5 * (np.tanh((x - begin) / 0.005) - np.tanh((x - begin - 0.1) / 0.005))
        return 0.25 + size * over * 2.0 * v * peak / (v * v + peak * peak)

    return Effect({"size": size, "peak": peak}, law=lambda _: Throw(mu, starts=(1.0, 1.6)))
