"""The data sets of the net, by name: belt-boxes on rigs of four sizes, driven joints, spring sliders, measured sets."""

from __future__ import annotations

import functools
import importlib.util
from collections.abc import Callable
from pathlib import Path

from stochfric_mb.measurement import Dataset, load_dataset
from stochfric_mb.measurement.entries import data_folder
from stochfric_mb.scenario import load_any_scenario
from tests.discovery.generator.case import Case
from tests.discovery.net.joints import hinge, slide, slider
from tests.discovery.net.rigs import belt_box

ROOT = Path(__file__).parents[3]
MEASURED = (
    "emps", "seal_o_ring", "seal_napn", "swing_up_ddp", "swing_up_collocation", "rock_basalt", "rock_sepiolite",
    "servo_pendulum",
)  # fmt: skip
BELT_BOX = (
    ("none.wrong_parameters", "one_free", 1.0, "bench"),
    ("none.coloured_noise", "belt_speeds", 1.0, "bench"),
    ("none.declared_scatter", "one_forced", 1.0, "bench"),
    ("none.slow_noise", "one_forced_fast", 1.0, "bench"),
    ("none.loud_sensor", "several", 1.0, "bench"),
    ("velocity_weakening.exponential", "several", 0.5, "bench"),
    ("velocity_weakening.rational", "one_free", 1.0, "bench"),
    ("viscous_friction.proportional", "normal_loads", 1.0, "bench"),
    ("viscous_friction.thinning", "one_forced_fast", 0.5, "bench"),
    ("dwell_ageing.log_of_dwell", "belt_speeds", 1.0, "bench"),
    ("dwell_ageing.saturating", "several", 0.5, "bench"),
    ("frictional_lag.slip_distance", "one_free", 0.5, "bench"),
    ("frictional_lag.relaxation", "belt_speeds", 1.0, "bench"),
    ("direction_asymmetry.both_coefficients", "reversed_belt", 0.5, "bench"),
    ("load_dependence.power_of_load", "normal_loads", 1.0, "bench"),
    ("presliding_compliance.linear", "one_free", 1.0, "bench"),
    ("presliding_compliance.hardening", "belt_speeds", 0.5, "bench"),
    ("normal_load_ripple.square", "belt_speeds", 1.0, "bench"),
    ("normal_load_ripple.sinusoidal", "one_free", 1.0, "bench"),
    ("belt_speed_ripple.belt_sinusoidal", "one_forced", 0.5, "bench"),
    ("harmonic_force.sine", "one_free", 1.0, "bench"),
    ("harmonic_force.fast_sine", "belt_speeds", 0.5, "bench"),
    ("impacts.random_kicks", "one_free", 1.0, "bench"),
    ("impacts.hammer", "belt_speeds", 0.5, "bench"),
    ("random_coefficients.per_slip", "one_free", 1.0, "bench"),
    ("random_coefficients.knots", "normal_loads", 0.5, "bench"),
    ("correlated_coefficients.first_order", "one_free", 1.0, "bench"),
    ("correlated_coefficients.belt_field", "belt_speeds", 0.5, "bench"),
    ("position_dependent_friction.sinusoidal", "belt_speeds", 1.0, "bench"),
    ("position_dependent_friction.worn_stroke", "one_free", 1.0, "bench"),
    ("friction_drift.linear", "one_forced", 1.0, "bench"),
    ("friction_drift.running_in", "normal_loads", 0.5, "bench"),
    ("sensor_drift.linear", "one_free", 1.0, "bench"),
    ("sensor_step.one_step", "one_free", 0.5, "bench"),
    ("sensor_clipping.top", "belt_speeds", 1.0, "bench"),
    ("sensor_outliers.spikes", "one_free", 1.0, "bench"),
    ("sensor_delay.pure_delay", "one_forced", 1.0, "bench"),
    ("nonlinear_stiffness.cubic", "one_free", 1.0, "bench"),
    ("nonlinear_stiffness.yielding", "reversed_belt", 0.5, "bench"),
    ("quadratic_damping.drag", "several", 1.0, "bench"),
    ("backlash.dead_zone", "reversed_belt", 1.0, "bench"),
    ("second_mode.attached", "belt_speeds", 1.0, "bench"),
    ("unknown.two_states", "one_free", 1.0, "bench"),
    ("unknown.belt_stalls", "belt_speeds", 1.0, "bench"),
    ("unknown.stiffness_steps", "one_free", 1.0, "bench"),
    ("unknown.slip_count", "one_forced", 1.0, "bench"),
    ("unknown.hum", "normal_loads", 1.0, "bench"),
    ("position_dependent_friction.sinusoidal+viscous_friction.proportional", "belt_speeds", 1.0, "bench"),
    ("harmonic_force.sine+velocity_weakening.rational", "several", 1.0, "bench"),
    ("none.wrong_parameters", "several", 1.0, "gauge"),
    ("velocity_weakening.power", "one_free", 1.0, "gauge"),
    ("friction_drift.warming", "belt_speeds", 0.5, "gauge"),
    ("none.quiet_sensor", "one_free", 1.0, "axis"),
    ("viscous_friction.sublinear", "several", 1.0, "axis"),
    ("random_coefficients.uniform_knots", "one_free", 0.5, "axis"),
    ("none.wrong_parameters", "one_forced", 1.0, "press"),
    ("position_dependent_friction.square", "one_free", 1.0, "press"),
    ("sensor_drift.square_root", "normal_loads", 1.0, "press"),
)
"""Forms, design, strength, size of the rig."""
SEED = 17
"""A tuning seed."""


def known() -> dict[str, Callable[[], Dataset]]:
    """Return what makes each data set, by its name; measured ones only where their files are."""
    made: dict[str, Callable[[], Dataset]] = {}
    for forms, design, strength, size in BELT_BOX:
        made[f"{forms}-{design}-{strength:g}-{size}"] = functools.partial(belt_box, Case(forms, design, strength, SEED), size)
    for i, hidden in enumerate(("nothing", "viscous", "asymmetry", "stribeck", "wave", "warming", "drag", "two")):
        made[f"slide-{hidden}"] = functools.partial(slide, hidden, i)
    made["slide-viscous-slow"] = functools.partial(slide, "viscous", 9, rate=200.0, noise=0.2)
    for i, hidden in enumerate(("nothing", "viscous", "stribeck")):
        made[f"hinge-{hidden}"] = functools.partial(hinge, hidden, i)
    made["hinge-late"] = functools.partial(hinge, "nothing", 4, late=0.01)
    made["slider-constant"] = functools.partial(slider, 1.0e-4, 0.0, 1)
    made["slider-memory"] = functools.partial(slider, 0.01, 0.015, 2)
    for hidden in ("nothing", "grease", "wave"):
        made[f"arm-{hidden}"] = functools.partial(_arm, hidden)
    if data_folder() is not None:
        for name in MEASURED:
            made[f"measured-{name}"] = functools.partial(load_dataset, ROOT / "models" / name)
    return made


def _arm(hidden: str) -> Dataset:
    file = ROOT / "examples" / "discover_in_an_arm.py"
    spec = importlib.util.spec_from_file_location("discover_in_an_arm", file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    runs = (module.measured(getattr(module, hidden), seed=s, role=r, duration=8.0) for s, r in ((5, "fit"), (1005, "test")))
    scenario = load_any_scenario(ROOT / "models" / "two_joint_arm" / "scenario.toml")
    return Dataset(title="arm", scenario_path=None, scenario=scenario, runs=tuple(runs))
