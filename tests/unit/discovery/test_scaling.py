"""Units of a rig's own size: what they are, and that nothing is lost on the way there and back."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.scaling import USUAL, Scaling, exponents
from stochfric_mb.effects import effect_class, effect_kinds, make_effect
from stochfric_mb.laws import make_law
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.scenario import Scenario

KANG = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
LARGE = Scaling(force=64.0, length=4.0, time=0.25)


@pytest.mark.parametrize(
    ("unit", "expected"),
    [
        ("-", (0, 0, 0)), ("rad", (0, 0, 0)), ("N s/m", (1, -1, 1)), ("N s^2/m^2", (1, -2, 2)), ("N/m^3", (1, -3, 0)),
        ("Hz", (0, 0, -1)), ("1/s", (0, 0, -1)), ("kg", (1, -1, 2)), ("m/s", (0, 1, -1)), ("N s", (1, 0, 1)),
    ],
)  # fmt: skip
def test_units_are_read(unit, expected):
    assert exponents(unit) == expected


def test_every_unit_of_an_effect_is_known():
    words = {"N", "m", "s", "kg", "Hz", "rad", "K", "degC", "1", "-"}
    units = {f.metadata["unit"] for kind in effect_kinds() for f in dataclasses.fields(effect_class(kind))}
    parts = {part.partition("^")[0] for unit in units for part in unit.replace("/", " ").split()}
    assert parts <= words


def test_the_reference_rig_and_rigs_like_it_are_left_alone():
    assert Scaling.of_rig(KANG) == USUAL
    assert Scaling.of_rig(dataclasses.replace(KANG, normal_force=20.0, mass=10.0)).usual


def rig(size):
    return dataclasses.replace(
        KANG,
        mass=KANG.mass * size.force / size.length * size.time**2,
        damping=KANG.damping * size.force / size.length * size.time,
        stiffness=KANG.stiffness * size.force / size.length,
        normal_force=KANG.normal_force * size.force,
        belt_velocity=KANG.belt_velocity * size.length / size.time,
    )


def test_a_large_rig_is_studied_as_if_it_were_the_reference():
    assert Scaling.of_rig(rig(LARGE)) == LARGE
    time = np.arange(100.0)
    run = Run(
        name="run", role="fit", time=LARGE.time * time, channels={"position": LARGE.length * time},
        settings={"belt_velocity": 4.0 * LARGE.length / LARGE.time}, sample_interval=LARGE.time,
    )  # fmt: skip
    law = make_law("elastic_stick", mu_s=0.8, mu_k=0.46, e_lim=4.0e-5)
    drift = make_effect("friction_drift", rate=4.0e-3, time_constant=7.0)
    scenario = Scenario(mechanism=rig(LARGE), law=law, effects=(drift,), duration=10.0, output_step=1.0e-3)
    reduced = LARGE.reduced(Dataset(title="", scenario_path=None, scenario=scenario, runs=(run,)))
    assert reduced.scenario.mechanism == KANG
    assert reduced.scenario.law == dataclasses.replace(
        law, e_lim=1.0e-5, v_s=law.v_s / 16.0, decay_velocity=law.decay_velocity / 16.0
    )
    assert reduced.scenario.effects == (make_effect("friction_drift", rate=1.0e-3, time_constant=28.0),)
    assert reduced.scenario.output_step == 4.0e-3
    assert np.array_equal(reduced.runs[0].time, time)
    assert np.array_equal(reduced.runs[0].channels["position"], time)
    assert reduced.runs[0].settings == {"belt_velocity": 4.0}


def test_a_model_comes_back_in_si_units():
    effects = (make_effect("viscous_friction", coefficient=5.0), make_effect("sensor_step", size=1.0e-4, time=3.0))
    own = {"run": ({}, {"size": 2.0e-4, "time": 4.0})}
    model = Model(make_law("coulomb", mu_s=0.8, mu_k=0.46), {"mass": 0.01}, effects, None, own)
    restored = LARGE.restored(model)
    viscous, step = restored.effects
    assert viscous == make_effect("viscous_friction", coefficient=5.0 * 64.0 * 0.25 / 4.0)
    assert step == make_effect("sensor_step", size=4.0e-4, time=0.75)
    assert restored.own == {"run": ({}, {"size": 8.0e-4, "time": 1.0})}
    assert (restored.law, restored.corrections) == (model.law, model.corrections)
