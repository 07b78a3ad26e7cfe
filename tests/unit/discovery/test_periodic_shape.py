"""Forces at a joint that come back with any shape: frequency, shape and begins, from what a fit leaves."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint.fit.fitting import fit
from stochfric_mb.discovery.driven_joint.fit.gains import predicted_left
from stochfric_mb.discovery.driven_joint.fit.periodic_shape import returning_waves, shaped_starts
from stochfric_mb.discovery.driven_joint.fit.wave_scan import waves_left, with_phases
from stochfric_mb.discovery.driven_joint.source import source_of
from stochfric_mb.effects import effect_class
from tests.discovery.joints.test_parts import coulomb, pair, sine_run

SIZE, WIDTH = 1.5, 0.08
"""Of the pushes [N], and their width over a period [-]: two of sixteen pieces."""


def push(turns):
    """A push in the middle of each turn, and its mean over a turn."""
    return np.exp(-(((turns % 1.0 - 0.5) / WIDTH) ** 2)), WIDTH * np.sqrt(np.pi)


def pushed(begin, size, frequency, **keys):
    """A run whose body is pushed, so that its drive is less by as much."""
    run = sine_run(coulomb, **keys)
    force = run.channels["force"] - size * push(frequency * run.time + begin)[0]
    return dataclasses.replace(run, channels=dict(run.channels) | {"force": force})


def seen(size=SIZE, frequency=2.3, begins=(0.1, 0.45), seed=1):
    fitted = (pushed(b, size, frequency, seed=seed + i) for i, b in enumerate(begins))
    runs = *fitted, pushed(0.7, size, frequency, seed=seed + 2, role="test", start=20.0)
    source = source_of(dataclasses.replace(pair(coulomb), runs=runs))
    balances = source.balances("", "fit", 0.0)
    return source, balances, fit(source.stated(""), balances, source.nuisances(""), noise=0.2)


def starts_of(balances, current, pieces=16):
    scans = [f.scan for f in effect_class("harmonic_force").at_joint(span()) if f.scan.pieces == pieces]
    waves = waves_left(scans[0], current, balances)
    return shaped_starts(scans[0], returning_waves(scans[0], waves, current, balances), current, balances)


def span():
    from stochfric_mb.effects.joints import JointSpan

    return JointSpan(
        speed=0.5, stroke=0.2, lowest=-0.1, duration=8.0, load=0.0, both_ways=True, friction=2.0, distance=2.0,
        temperature=None, contact=False, stated_load=20.0, window=0.01,
    )  # fmt: skip


def test_what_a_start_would_leave_knows_where_each_run_begins():
    _, balances, current = seen()
    (start, *_) = starts_of(balances, current)
    left = predicted_left(current.model, start, balances, current)
    assert np.sqrt(np.mean(left**2)) < 0.25 * current.rms  # half a turn off in one run it would leave half of the square
    together = dataclasses.replace(start, own={})
    assert np.sqrt(np.mean(predicted_left(current.model, together, balances, current) ** 2)) > 0.5 * current.rms


# one of another draw ended at half the frequency, and one far from the shape, while the shape stayed as fits began with it
@pytest.mark.parametrize(
    ("frequency", "begins", "seed"), [(2.3, (0.1, 0.45), 1), (2.39525, (0.943, 0.511), 18), (2.34196, (0.781, 0.606), 52)]
)
def test_frequency_shape_and_begins_are_those_of_the_pushes(frequency, begins, seed):
    source, balances, current = seen(frequency=frequency, begins=begins, seed=seed)
    fits = [
        fit(start.added_to(current.model), balances, source.nuisances(""), noise=0.2) for start in starts_of(balances, current)
    ]
    fitted = min(fits, key=lambda f: f.rms)
    effect, owner = fitted.model.effects[-1], len(fitted.model.effects) - 1
    # four standard deviations: chance takes one number of 16,000 beyond
    assert abs(effect.frequency - frequency) < 4.0 * fitted.deviation(owner, "frequency")
    assert fitted.deviation(owner, "frequency") < 1.0e-3  # a piece of sixteen, over a record of 8 s and some hundred windows
    along = np.linspace(0.0, 1.0, 321)
    largest = np.max(np.abs(effect.course * effect.shape(along)))
    assert largest == pytest.approx(SIZE * (1.0 - push(0.5)[1]), rel=0.1)  # splines of a push of two pieces cut its top
    apart = np.diff([fitted.model.own["harmonic_force", b.run, "phase"] for b in balances])[0] / (2.0 * np.pi)
    assert abs((apart - (begins[1] - begins[0]) + 0.5) % 1.0 - 0.5) < 0.02  # a third of a piece
    assert fitted.rms < 0.2 * current.rms

    # a further run begins elsewhere, and its own record says where
    held_out = source.balances("", "test", 0.0)
    model = with_phases(fitted.model, held_out, source.nuisances(""))
    rest = [np.std(m.remainder(held_out[0], ())[held_out[0].sliding]) for m in (current.model, model)]
    assert rest[1] < 0.25 * rest[0]


def test_a_course_that_comes_back_does_so_when_a_weight_is_changed():
    """Its end stays its begin, to the slope, and its mean 0, without which a fit would move a zero."""
    weights = np.random.default_rng(1).standard_normal(15)
    effect = effect_class("harmonic_force")(**effect_class("harmonic_force").returning(weights, 16, 2.0))
    other = effect.changed(course_1=3.0, course_9=-2.0, frequency=2.5)
    assert (other.course_1, other.course_9, other.frequency, other.course) == (3.0, -2.0, 2.5, effect.course)
    turn = other.shape(np.linspace(0.0, 1.0, 1601))
    assert turn[0] == pytest.approx(turn[-1], abs=1.0e-12)  # rounding
    # no more than from one step of 1/1600 to the next within the turn, but for 1 % since curvature is largest at nodes;
    # a kink would be some 100 times that
    assert abs(np.diff(turn)[0] - np.diff(turn)[-1]) <= 1.05 * np.max(np.abs(np.diff(turn, 2)))
    assert np.mean(turn[:-1]) == pytest.approx(0.0, abs=1.0e-3 * np.ptp(turn))  # a mean over other places than its own 320


def test_where_nothing_comes_back_no_fit_begins():
    _, balances, current = seen(size=0.0)
    assert starts_of(balances, current) == []
