"""What every form of a set for a report must keep, for the test files of the sets; nothing here asks the method judged."""

import numpy as np

from .forms import Form
from .motion import World, simulate
from .records import UNCERTAINTY, Case, effect_sizes, make_runs, points, rig_of

SHARE = 0.3
"""Part of a record that is made: seven cycles of each run at least."""


def stated(form: Form) -> dict[str, float]:
    """Relative standard deviations of what is stated of the rig."""
    return form.options.get("uncertainty", UNCERTAINTY)


def assert_preconditions(form: Form) -> None:
    """The record keeps what the pages on discovery and datasets ask of one."""
    rig, sd = rig_of(form), stated(form)
    stiffest = 1.0 + sd["stiffness"] + sd["mass"]  # of two standard deviations each, half in the root
    assert rig.rate * 2 * np.pi / rig.pulsation / stiffest > 40.0
    assert rig.rate * rig.period > 60.0
    assert 50.0 < rig.slip_length / rig.noise < 1e4  # a real sensor has noise, and sees the slips
    fall = rig.mu_s * (1.0 - 2.0 * sd["mu_s"]) - rig.mu_k * (1.0 + 2.0 * sd["mu_k"])
    assert fall > 0.4 * rig.gap  # it sticks and slips, however wrong the stated numbers are
    for design in form.designs:
        assert min(cycles for _, _, role, cycles in points(Case(form, design, 1.0)) if role == "fit") >= 20.0


def sizes_moved(form: Form) -> tuple[dict[str, float], dict[str, float]]:
    """How many floors a form moves what is shown by, at full strength and at half, feature by feature."""
    case = Case(form, form.designs[0], 1.0)
    runs, halves, twins = (make_runs(case, 3, strength=strength, share=SHARE) for strength in (1.0, 0.5, 0.0))
    assert all(np.all(np.isfinite(run.reading)) and len(run.motion.sticks) > 4 for run in runs)
    whole, half = (effect_sizes(moved, twins, rig_of(form)) for moved in (runs, halves))
    return whole, half


def assert_stick_slip(form: Form, seed: int, *, share: float, sticks: int) -> None:
    """Each run of the last design sticks and slips."""
    runs = make_runs(Case(form, form.designs[-1], 1.0), seed, share=share)
    assert all(np.all(np.isfinite(run.reading)) and len(run.motion.sticks) > sticks for run in runs)


def assert_no_strength_is_no_form(form: Form, *, share: float) -> None:
    """At strength 0 the record is that of the rig alone."""
    for run in make_runs(Case(form, form.designs[0], 1.0), 3, strength=0.0, share=share):
        world = run.world
        plain = World(world.rig, world.nominal, world.belt_velocity, world.normal_force, world.duration, world.rng)
        motion = simulate(plain, run.motion.time)
        assert np.abs(motion.position - run.reading).max() < 0.1 * world.nominal.noise


def assert_repeatable(form: Form, design: str = "one") -> None:
    """The same seed makes the same record, and another one does not."""
    case = Case(form, design, 1.0)
    first, again, other = (make_runs(case, seed, share=0.1)[0].reading for seed in (3, 3, 4))
    np.testing.assert_array_equal(first, again)
    assert np.std(first - other) > 10.0 * rig_of(form).noise
