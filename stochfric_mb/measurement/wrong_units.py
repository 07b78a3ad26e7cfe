"""Refusal of records that cannot be right: dead channels, velocities that are not those of the positions, wrong units."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from stochfric_mb.errors import InputError
from stochfric_mb.measurement.run import Run
from stochfric_mb.measurement.sampling import FROZEN, longest_still
from stochfric_mb.measurement.scales import FACTORS, IN_DEGREES, SPEED_FITS, Array, Cause, Shown, inertia, likeliest, shown
from stochfric_mb.measurement.signs import turned_round
from stochfric_mb.measurement.units import ALONG_AN_ARC
from stochfric_mb.mechanisms import BeltBox, HingePendulum, PrismaticJoint
from stochfric_mb.scenario import Scenario

CHANNEL_UNITS: dict[str, dict[str, float]] = {
    "position": {"m": 1.0, "mm": 1e-3, "um": 1e-6, "cm": 1e-2, "in": 0.0254},
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0},
    "force": {"N": 1.0, "kN": 1e3, "mN": 1e-3},
    "torque": {"N m": 1.0, "mN m": 1e-3, "kN m": 1e3, "N cm": 1e-2},
    "angle": {"rad": 1.0, "deg": math.pi / 180.0},
    "belt_velocity": {"m/s": 1.0, "mm/s": 1e-3, "um/s": 1e-6, "cm/s": 1e-2, "mm/min": 1e-3 / 60.0},
}
"""Channel -> units in which it may really be, with their size in SI units."""
STATED_UNITS: dict[str, dict[str, float]] = {
    "belt_velocity": CHANNEL_UNITS["belt_velocity"],
    "stiffness": {"N/m": 1.0, "N/mm": 1e3, "N/um": 1e6},
    "mass": {"kg": 1.0, "g": 1e-3, "t": 1e3},
    "normal_force": {"N": 1.0, "kN": 1e3, "mN": 1e-3},
    "length": {"m": 1.0, "mm": 1e-3},
    "inertia": {"kg m^2": 1.0, "g m^2": 1e-3, "kg cm^2": 1e-4, "kg mm^2": 1e-6, "g cm^2": 1e-7},
}
"""Key of ``[mechanism]`` -> units in which it may have been written, its SI unit first."""
ALIKE = 0.9
"""Correlation of a measured velocity with the rate of the position from which the two are of one motion [-]."""
RATE_FITS = 5.0
"""Largest factor by which it may be the smaller one: filters cost less, the nearest wrong unit is off by 6."""
RATE_EXCEEDS = 1.5
"""Largest factor by which it may be the larger one: filters take away, and noise adds one in ten where the two are alike."""
SWAPPED = 0.95
"""Correlation from which on two columns that are not alike are alike once they are swapped [-]: noise costs less.
Position and acceleration of an oscillation are as alike, but for a factor of its squared frequency, which is asked, too."""
MASS_FITS = 1.5
"""|log10| of force over acceleration over the stated mass from which units are looked at: payloads double a mass."""
STILL = 20.0
"""Steps of a sensor by which the belt runs on while a dead position stays at one number."""
SAME_FACTOR = math.log10(2.0)
"""Largest difference of its log10 from that of a factor between units: what a stated mass may be wrong by besides."""
FRICTION_FITS = 1.0
"""Largest |log10| of friction over mu_k N, once a unit is corrected: friction is known to an order of magnitude."""
POWERS_ALONG: dict[str, tuple[float, float]] = {
    "position": (-1.0, 0.0), "time": (2.0, 0.0), "mass": (-1.0, 0.0), "force": (1.0, 1.0),
}  # fmt: skip
"""What may have a wrong unit at a slide -> powers of its factor in force over acceleration over mass, and in friction."""
POWERS_ABOUT: dict[str, tuple[float, float]] = {
    "angle": (-1.0, 0.0), "time": (2.0, 0.0), "mass": (-1.0, 0.0), "length": (-2.0, 0.0), "torque": (1.0, 1.0),
    "inertia": (-1.0, 0.0),
}  # fmt: skip
"""The same at a hinge, whose inertia is m l^2 and some of its own: the larger part is asked about."""
PAGE = 'docs/datasets.md, "A rig that turns"'
"""Where arcs are explained."""
ROUGHLY = 3.0
"""Factor within which a motion fits the stated friction and stiffness, once a unit is corrected [-]."""
HALF_WIDTH = 8
"""Half the length of the window over which a position changes [samples]."""


def require_plausible(run: Run, scenario: Scenario[Any], stated_in: str) -> str:
    """Return what of a record does not fit the model although no single unit explains it, empty if all fits.

    Args:
        run: the record, in SI units.
        scenario: the model stated.
        stated_in: where the model is stated, for messages.

    Raises:
        InputError: a dead channel, a velocity that is not the rate of the position, a wrong unit, or a damping with which
            nothing slips again; names file, column or key, factor and remedy.
    """
    doubt = ""
    _require_alive(run)
    _require_rate(run)
    mechanism = run.mechanism(scenario)
    if isinstance(mechanism, PrismaticJoint | HingePendulum):
        _require_inertia(run, mechanism, float(scenario.law.mu_k), stated_in)
    if isinstance(mechanism, BeltBox) and (seen := shown(run, mechanism, scenario.law.mu_s)) is not None:
        cause = likeliest(seen)
        if cause is not None:
            raise InputError(_wrong_unit(run, mechanism, seen, cause, stated_in))
        _require_swinging(run, mechanism, stated_in)
        if not seen.fits():
            doubt = f"the record does not fit the stated model: {_evidence(seen)}; two units or numbers may be wrong"
    if isinstance(mechanism, BeltBox):
        _require_as_stated(run, mechanism, stated_in)
        _require_riding(run, mechanism)
    return doubt


def _require_swinging(run: Run, box: BeltBox, stated_in: str) -> None:
    """Require damping below the critical one of a box that sticks and slips.

    Overdamped, m x'' + c x' + k x = mu_k N goes to rest without turning back: it never reaches the belt's speed again.
    """
    critical = 2.0 * math.sqrt(box.stiffness * box.mass)
    if box.damping >= critical:
        raise InputError(
            f"{_stated_as(run, 'damping', stated_in)} = {box.damping:g} N s/m is {box.damping / critical:.3g} times the "
            f"critical damping 2 sqrt(k m) = {critical:.3g} N s/m, with which a box does not stick again after a slip; run "
            f"{run.name} sticks and slips: correct damping, mass or stiffness"
        )


def _require_alive(run: Run) -> None:
    """Require that position and velocity change; a velocity may be constant where the position agrees."""
    position, velocity = run.channels.get("position"), run.channels.get("velocity")
    if position is not None and np.ptp(position) == 0.0:
        raise InputError(_dead(run, "position", position, "the run"))
    if velocity is not None and np.ptp(velocity) == 0.0 and not _moves_at(position, float(velocity[0]), run.sample_interval):
        raise InputError(_dead(run, "velocity", velocity, "the column"))


def _require_riding(run: Run, box: BeltBox) -> None:
    """Require that a position does not stay at one number while the belt runs on by many steps of the sensor."""
    position = run.channels.get("position")
    if position is None or position.size < 2:
        return
    first, last = longest_still(position)
    changes = np.abs(np.diff(position))
    travel = abs(box.belt_velocity) * (last - first) * run.sample_interval
    steps = travel / float(changes[changes > 0.0].min(initial=math.inf))
    if steps > STILL and last - first >= FROZEN * (position.size - 1):  # a clipped sensor stays for parts of cycles
        a, b = (float(run.time[i]) for i in (first, last))
        raise InputError(
            f"{run.source}: position stays at {position[first]:g} {run.units.get('position', '')} from {a:.4g} to {b:.4g} s, "
            f"while the belt runs on by {travel:.3g} m: the channel is dead there; leave it out, such as "
            f"time_range = [{run.time[0]:.4g}, {a:.4g}]"
        )


def _dead(run: Run, name: str, values: Array, what: str) -> str:
    return (
        f"{run.source}: {name} is {values[0]:g} {run.units.get(name, '')} in all {values.size} samples: a dead channel, or a "
        f"rig at rest; repair the channel, or leave {what} out"
    )


def _moves_at(position: Array | None, speed: float, interval: float) -> bool:
    """Return whether a position, if there is one, moves at a constant speed [m/s] that is not 0."""
    if speed == 0.0 or position is None:
        return speed != 0.0
    travel = speed * (position.size - 1) * interval
    return bool(abs(position[-1] - position[0] - travel) <= 0.1 * abs(travel))


def _require_rate(run: Run) -> None:
    """Require that a measured velocity is the rate at which the position changes, as far as the two are of one motion.

    The position's change over a window is compared with the velocity's integral: no window is too long for that.
    """
    position, velocity = run.channels.get("position"), run.channels.get("velocity")
    if position is None or velocity is None or position.size < 4 * HALF_WIDTH:
        return
    likeness, factor = _as_integral(position, velocity, run.sample_interval)
    turned = likeness < -ALIKE and _may_be(factor)
    likeness_swapped, factor_swapped = _as_integral(velocity, position, run.sample_interval)
    if likeness < ALIKE and not turned and abs(likeness_swapped) > SWAPPED and _may_be(factor_swapped):
        raise InputError(
            f"{run.source}: column velocity changes as the integral of column position does: the two are swapped; give each "
            "its own column, columns = { position = ..., velocity = ... }"
        )
    if likeness < -ALIKE:
        raise InputError(
            f"{run.source}: velocity is negative where position rises, and positive where it falls (correlation "
            f"{likeness:.2f}): turn one of the two: {turned_round(run, 'velocity')}"
        )
    if likeness > ALIKE and not _may_be(factor):
        raise InputError(
            f"{run.source}: velocity is {_times(factor)} the rate at which position changes: one of the two columns has a "
            "wrong unit or scale; correct its header, or give units = { velocity = ... } or { position = ... }"
        )


def _may_be(factor: float) -> bool:
    """Return whether a velocity so many times the rate may be a filtered or noisy one in the right unit."""
    return 1.0 / RATE_FITS <= factor <= RATE_EXCEEDS


def _as_integral(position: Array, velocity: Array, interval: float) -> tuple[float, float]:
    """Return the correlation of a position's changes with what a velocity makes of them, and the size of that over theirs."""
    travelled = np.r_[0.0, np.cumsum(0.5 * interval * (velocity[1:] + velocity[:-1]))]
    moved, expected = (x[2 * HALF_WIDTH :] - x[: -2 * HALF_WIDTH] for x in (position, travelled))
    if not (moved.std() > 0.0 and expected.std() > 0.0):
        return 0.0, 1.0
    return float(np.corrcoef(moved, expected)[0, 1]), float(expected.std() / moved.std())


def _require_as_stated(run: Run, box: BeltBox, stated_in: str) -> None:
    """Require that columns of belt speed and normal force are of the size stated: discovery takes the stated numbers."""
    for name in ("belt_velocity", "normal_force"):
        stated = abs(float(getattr(box, name)))
        if name not in run.channels or stated == 0.0:
            continue
        seen = abs(float(np.median(run.channels[name])))
        if seen == 0.0 or abs(math.log10(seen / stated)) > SPEED_FITS:
            unit = run.units.get(name, "")
            raise InputError(
                f"{run.source}: the median of column {name} is {seen:.4g} {unit}, but {_stated_as(run, name, stated_in)} = "
                f"{stated:.4g} {unit}: correct the one that is wrong, or give the column's unit in units = {{ {name} = ... }}"
            )


def _stated_as(run: Run, name: str, stated_in: str) -> str:
    """Return the key that states a number of the mechanism, and where."""
    return f"set.{name} of run {run.name}" if name in run.settings else f"{stated_in}: mechanism.{name}"


def _require_inertia(run: Run, joint: PrismaticJoint | HingePendulum, mu_k: float, stated_in: str) -> None:
    """Require that force over acceleration is of the size of the stated mass, where one wrong unit explains that it is not."""
    hinge = isinstance(joint, HingePendulum)
    stated = joint.mass * joint.length**2 + joint.inertia if isinstance(joint, HingePendulum) else joint.mass
    if stated == 0.0:
        return
    seen = inertia(run, joint)
    if seen is not None and abs(math.log10(seen[0] / stated)) < MASS_FITS:
        return
    if seen is None and not hinge:
        return
    powers = _powers_about(joint) if isinstance(joint, HingePendulum) else POWERS_ALONG
    causes: list[tuple[str, float]] = []
    for name, (of_mass, of_friction) in powers.items():
        for factor in FACTORS[name]:
            # an angle in another unit is no angle to gravity: it is corrected before one looks
            look = inertia(run, joint, 1.0 / factor) if name == "angle" else seen
            if look is None:
                continue
            off = math.log10(look[0] / stated) - (0.0 if name == "angle" else of_mass * math.log10(factor))
            level = math.log10(look[1] / (mu_k * joint.normal_force)) - of_friction * math.log10(factor)
            if abs(off) < SAME_FACTOR and abs(level) < FRICTION_FITS:
                causes.append((name, factor))
    through = _through(run, joint)
    if not causes and through and seen is not None:  # a bare number may be off by any factor
        off, level = seen[0] / stated, seen[1] / (mu_k * joint.normal_force)
        causes += [("torque" if hinge else "force", off)] if abs(math.log10(level / off)) < FRICTION_FITS else []
    remedies = [text for cause in causes if (text := _in_unit(run, joint, *cause, stated_in))]
    if remedies:
        unit, drive, motion = ("kg m^2", "torque", "angular acceleration") if hinge else ("kg", "force", "acceleration")
        what = (
            f"the {drive} follows neither the stated inertia, {stated:.4g} {unit}, nor the weight of the arm"
            if seen is None
            else f"the {drive} is {seen[0]:.3g} {unit} times the {motion}, not {stated:.4g} {unit} as stated"
        )
        lever = (
            f"; or a gear, a lead or a lever is left out, which scale = {{ {drive} = ... }} holds"
            if drive in run.channels
            else ""
        )
        raise InputError(f"{run.source}: {what}. Probably {', or '.join(remedies)}{lever}")


def _powers_about(hinge: HingePendulum) -> dict[str, tuple[float, float]]:
    """Return what may be in a wrong unit at a hinge, with its powers: of m l^2 and the inertia beside it the larger one's."""
    smaller = ("mass", "length") if hinge.inertia > hinge.mass * hinge.length**2 else ("inertia",)
    return {name: powers for name, powers in POWERS_ABOUT.items() if name not in smaller}


def _through(run: Run, joint: PrismaticJoint | HingePendulum) -> str:
    """Return the stated number that the recorded drive is multiplied by; empty: it is taken as it is."""
    if joint.drive_factor != 1.0:
        return "drive_factor"
    hinge = isinstance(joint, HingePendulum)
    return "" if ("torque" if hinge else "force") in run.channels else "torque_gain" if hinge else "force_gain"


def _in_unit(run: Run, joint: PrismaticJoint | HingePendulum, name: str, factor: float, stated_in: str) -> str:
    """Return what is in another unit, and what to write; nothing where no unit in use has this size."""
    if name in ("mass", "length", "inertia"):
        value, (si, *_) = float(getattr(joint, name)), STATED_UNITS[name]
        really = _unit_of(STATED_UNITS[name], 1.0 / factor)
        if really == si and name != "inertia":
            return ""
        wrong = f"in {really}" if really != si else f"{_times(factor)} what fits"  # converted twice
        return f"{name} in {stated_in} is {wrong}: write {name} = {value / factor:.6g} ({si})"
    column = "position" if name == "angle" else name
    through = _through(run, joint)
    if column in ("force", "torque") and through:  # a drive in volts, for one
        drive, value = column if column in run.channels else "voltage", float(getattr(joint, through))
        place = f"column {drive} [{run.file_units.get(drive, '')}] with {through} = {value:g} in {stated_in}"
        return f"{place} is {_times(factor)} what fits: correct one of them"
    label, sizes = run.file_units.get(column, ""), CHANNEL_UNITS[name]
    really = _unit_of(sizes, sizes.get(label, 1.0) / factor)
    if really == label or abs(math.log10(sizes[really] * factor / sizes.get(label, 1.0))) > 0.01:  # no unit has this size
        return ""
    return f'column {column} [{label}] is in {really}: write units = {{ {column} = "{really}" }}'


def _wrong_unit(run: Run, box: BeltBox, seen: Shown, cause: Cause, stated_in: str) -> str:
    """Return where a wrong unit is, what shows it, and what to write."""
    measured = cause.name in ("position", "time") or cause.name in run.channels
    if measured:
        label = run.file_units.get(cause.name, "")
        sizes = CHANNEL_UNITS[cause.name]
        really = _unit_of(sizes, sizes.get(label, 1.0) / cause.factor)
        remedy = f"write its header as '{cause.name} [{really}]', or give units = {{ {cause.name} = \"{really}\" }}"
        place = f"{run.source}: column {cause.name} [{label}]"
        if really == label:  # no unit has this size
            return (
                f"{place} is {_times(cause.factor)} what fits: {_evidence(seen)}. The factor of a sensor may be missing, such "
                f"as scale = {{ {cause.name} = {1.0 / cause.factor:.4g} }}; or its header or another number is wrong"
            )
        if cause.name == "position" and cause.factor == IN_DEGREES:
            really = "deg"
            remedy = f"{ALONG_AN_ARC}: multiply scale.position by pi / 180 ({PAGE})"
    else:
        value = float(getattr(box, cause.name))
        sizes = STATED_UNITS[cause.name]
        really = _unit_of(sizes, 1.0 / cause.factor)
        si = next(iter(sizes))
        remedy = f"write {cause.name} = {value / cause.factor:.6g} ({si})"
        seen_in = "" if cause.name in run.settings else f" (run {run.name})"
        place = f"{_stated_as(run, cause.name, stated_in)} = {value:g} {si}{seen_in}"
    left = 10.0 ** (seen.length - cause.length * math.log10(cause.factor))
    more = (
        f". Positions would still range over {left:.3g} times mu_s N/k: more than one number may be wrong, such as inertia and "
        f"stiffness of a rig that turns, each over the radius squared ({PAGE})"
        if not 1.0 / ROUGHLY < left < ROUGHLY
        else ""
    )
    return f"{place} is {_times(cause.factor)} what fits: {_evidence(seen)}. It is probably in {really}; {remedy}{more}"


def _evidence(seen: Shown) -> str:
    """Return what of a record contradicts the stated model."""
    return (
        f"the stuck box moves at {10.0**seen.speed:.3g} times the belt's speed, positions range over {10.0**seen.length:.3g} "
        f"times mu_s N/k, slips last {10.0**seen.time:.3g} times half a natural period (each should be about 1)"
    )


def _unit_of(sizes: dict[str, float], size: float) -> str:
    """Return the unit of about a size in SI units."""
    return min(sizes, key=lambda name: abs(math.log(sizes[name] / size)))


def _times(factor: float) -> str:
    return f"{factor:.4g} times" if factor >= 1.0 else f"1/{1.0 / factor:.4g} of"
