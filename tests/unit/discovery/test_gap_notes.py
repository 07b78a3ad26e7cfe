"""A model that gets worse on held-out runs must be said to."""

import dataclasses
from types import SimpleNamespace

import pytest

from stochfric_mb.discovery.result import Gap
from stochfric_mb.discovery.stick_slip.belt_speed import BeltSpeed
from stochfric_mb.discovery.stick_slip.notes import _of_one_pace, _of_several_tones
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.effects import make_effect

GAP = Gap("crps_one_cycle", "m", True, 3.0e-5, 2.0e-5, 1.0e-5, 5.0e-6)


def test_nothing_is_said_of_a_model_that_gets_better():
    assert GAP.notes == ()


@pytest.mark.parametrize(("unit", "said"), [("m", "(2.5e-05 m)"), ("-", "(2.5e-05)")])
def test_it_is_said_that_a_model_gets_worse(unit, said):
    (note,) = dataclasses.replace(GAP, augmented=2.5e-5, unit=unit).notes
    assert said in note
    assert "off by more" in note


@pytest.mark.parametrize(("baseline", "said"), [(1.99e-5, False), (1.9e-5, True)])
def test_it_is_said_that_stated_numbers_were_better(baseline, said):
    notes = dataclasses.replace(GAP, baseline=baseline).notes
    assert notes == (("on the held-out runs the recalibrated model is off by more (2e-05 m) than the stated one (1.9e-05 m)",)
                     if said else ())  # fmt: skip


def test_ripples_of_one_frequency_may_have_one_cause():
    belt = make_effect("belt_speed_ripple", amplitude=0.07, frequency=0.1692)
    load, other = (make_effect("normal_load_ripple", amplitude=0.02, frequency=f) for f in (0.1693, 0.25))
    study = SimpleNamespace(pool=SimpleNamespace(duration=300.0))

    def said(*effects):
        return _of_one_pace(Model(law=None, corrections={}, effects=effects), study)

    (note,) = said(belt, load, other)
    assert note.startswith("belt_speed_ripple and normal_load_ripple have one frequency, 0.169 Hz")
    assert said(belt, other) == said(load, load) == []  # another frequency; tones of one kind


def test_tones_beside_the_first_one_are_spoken_of():
    """A table with the first of six tones looked like all of a belt's ripple."""
    tones = [make_effect("belt_speed_ripple", amplitude=0.1 / k, frequency=3.57 * k) for k in (1, 2)]
    alone = make_effect("normal_load_ripple", amplitude=0.02, frequency=0.25)
    (note,) = _of_several_tones(Model(law=None, corrections={}, effects=(*tones, alone)))
    assert note.startswith("belt_speed_ripple is a wave of 2 tones, 3.57, 7.14 Hz")
    assert _of_several_tones(Model(law=None, corrections={}, effects=(tones[0], alone))) == []


@pytest.mark.parametrize(("ratio", "said"), [(0.9, "measure the belt's speed"), (0.077, "slides on without sticking")])
def test_a_box_that_rests_says_nothing_of_the_belt(ratio, said):
    """Kicks that keep a box sliding for a while gave the advice to state a belt 13 times slower."""
    seen = BeltSpeed("run_3", ratio, 2.547e-3)
    assert said in seen.advice
    assert ("check the belt velocity" in seen.note) is not seen.rests
