"""Forces at a joint that come back with any shape: frequency, shape and begins, from what a fit leaves."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint.fit.fitting import fit
from stochfric_mb.discovery.driven_joint.fit.periodic_shape import returning_waves, shaped_starts
from stochfric_mb.discovery.driven_joint.fit.wave_scan import waves_left, with_phases
from stochfric_mb.discovery.driven_joint.source import source_of
from stochfric_mb.effects import effect_class
from tests.discovery.joints.test_parts import coulomb, pair, sine_run

FREQUENCY, SIZE, WIDTH = 2.3, 1.5, 0.08
"""Of the pushes [Hz], their size [N], and their width over a period: two of sixteen pieces."""


def push(turns):
    """A push in the middle of each turn, and its mean over a turn."""
    return np.exp(-(((turns % 1.0 - 0.5) / WIDTH) ** 2)), WIDTH * np.sqrt(np.pi)


def pushed(begin, size=SIZE, **keys):
    """A run whose body is pushed, so that its drive is less by as much."""
    run = sine_run(coulomb, **keys)
    force = run.channels["force"] - size * push(FREQUENCY * run.time + begin)[0]
    return dataclasses.replace(run, channels=dict(run.channels) | {"force": force})


def seen(size=SIZE):
    runs = pushed(0.1, size, seed=1), pushed(0.45, size, seed=2), pushed(0.7, size, seed=3, role="test", start=20.0)
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


def test_frequency_shape_and_begins_are_those_of_the_pushes():
    source, balances, current = seen()
    (start,) = starts_of(balances, current)
    # a push of two pieces tells the frequency to a piece in 16 over the record of 8 s: 0.008 Hz
    assert start.effect.frequency == pytest.approx(FREQUENCY, abs=0.01)
    top = 1.0 - push(0.5)[1]  # a constant force is the joint's zero
    assert start.effect.course == pytest.approx(SIZE * top, rel=0.1)  # splines of a width of WIDTH cut its top
    begins = [start.own["harmonic_force", b.run, "phase"] / (2.0 * np.pi) for b in balances]
    assert (begins[1] - begins[0]) % 1.0 == pytest.approx(0.35, abs=0.03)  # a piece is 0.06

    fitted = fit(start.added_to(current.model), balances, source.nuisances(""), noise=0.2)
    assert fitted.model.effects[-1].frequency == pytest.approx(FREQUENCY, abs=1.0e-3)
    assert fitted.rms < 0.2 * current.rms

    # a further run begins elsewhere, and its own record says where
    held_out = source.balances("", "test", 0.0)
    model = with_phases(fitted.model, held_out, ())
    rest = [np.std(m.remainder(held_out[0], ())[held_out[0].sliding]) for m in (current.model, model)]
    assert rest[1] < 0.25 * rest[0]


def test_where_nothing_comes_back_no_fit_begins():
    _, balances, current = seen(size=0.0)
    assert starts_of(balances, current) == []
