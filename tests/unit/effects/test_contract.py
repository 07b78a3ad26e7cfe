import dataclasses
import math
import tomllib

import numpy as np
import pytest
import tomli_w

from stochfric_mb.effects import EFFECTS, GROUPS, contract, effect_class, effect_from_dict, make_effect
from stochfric_mb.effects.kinds.velocity_weakening import friction
from stochfric_mb.errors import InputError
from tests.unit.effects.examples import EXAMPLES, NOTHING, example


def test_examples_cover_all_effects() -> None:
    assert set(EXAMPLES) == set(EFFECTS)
    assert set(NOTHING) == {k for k in EFFECTS if effect_class(k).group != "randomness"}


@pytest.mark.parametrize("kind", EFFECTS)
def test_every_effect_says_what_it_is(kind: str) -> None:
    cls = effect_class(kind)
    assert cls.kind == kind
    assert cls.group in GROUPS
    assert cls.equation
    assert cls.source
    for field in dataclasses.fields(cls):
        about = field.metadata
        assert about["unit"]
        assert about["meaning"]
        if "choices" not in about:
            assert about["low"] <= about["scale"] <= about["high"]


@pytest.mark.parametrize("kind", EFFECTS)
def test_tables_come_back(kind: str) -> None:
    effect = example(kind)
    table = tomllib.loads(tomli_w.dumps(effect.to_dict()))
    assert effect_from_dict(table) == effect
    assert len(effect.parameters()) == len(dataclasses.fields(effect))


@pytest.mark.parametrize("kind", EFFECTS)
def test_values_out_of_range_are_refused_by_name(kind: str) -> None:
    for field in dataclasses.fields(effect_class(kind)):
        about = field.metadata
        wrong: list[object] = [math.nan, "three"]
        if "choices" not in about:
            wrong += [about["low"] - 1.0] if about["low"] > -math.inf else []
            wrong += [about["high"] + 1.0] if about["high"] < math.inf else []
            wrong += [about["low"]] if about["strict"] and about["low"] > -math.inf else []
            wrong += [] if about["infinite"] else [math.inf]
        for value in wrong:
            with pytest.raises(InputError, match=rf"{kind}\.{field.name}"):
                make_effect(kind, **(EXAMPLES[kind] | {field.name: value}))


def test_unknown_names_list_the_known_ones() -> None:
    with pytest.raises(InputError, match="did you mean 'dwell_ageing'"):
        make_effect("dwell_aging", rate=0.02)
    with pytest.raises(InputError, match="unknown parameter of effect dwell_ageing 'speed'"):
        make_effect("dwell_ageing", rate=0.02, speed=1.0)
    with pytest.raises(InputError, match="lacks frequency; give a number"):
        make_effect("harmonic_force", amplitude=0.1)
    with pytest.raises(InputError, match="no kind"):
        effect_from_dict({"rate": 0.02})


def test_rules_between_parameters() -> None:
    with pytest.raises(InputError, match="not below high"):
        make_effect("sensor_clipping", high=1.0e-3, low=2.0e-3)
    with pytest.raises(InputError, match="above 1/rate"):
        make_effect("impacts", rate=100.0, impulse=0.01, duration=0.02)


def test_sensors() -> None:
    t = np.arange(0.0, 5.0, 0.01)
    x = np.sin(t)
    rng = np.random.default_rng(0)

    def reading(kind: str, **values: float) -> np.ndarray:
        return make_effect(kind, **values).measure(t, x, rng)

    np.testing.assert_array_equal(reading("sensor_drift", rate=0.1), x + 0.1 * t)
    step = reading("sensor_step", size=0.2, time=2.0) - x
    assert set(np.round(step, 12)) == {0.0, 0.2}
    assert t[np.argmax(step > 0.1)] == pytest.approx(2.0)
    clipped = reading("sensor_clipping", high=0.5, low=-0.25)
    assert (clipped.min(), clipped.max()) == (-0.25, 0.5)
    np.testing.assert_allclose(reading("sensor_delay", delay=0.05)[5:], x[:-5], atol=1.0e-15)
    assert reading("sensor_delay", delay=0.05)[0] == x[0]
    hit = reading("sensor_outliers", fraction=0.1, size=3.0) != x
    assert abs(hit.mean() - 0.1) < 4.0 * math.sqrt(0.1 * 0.9 / len(t))  # 4 standard errors
    np.testing.assert_array_equal(example("dwell_ageing").measure(t, x, rng), x)


def test_impacts_are_a_poisson_process() -> None:
    """Numbers in disjoint intervals: mean and variance are the mean rate, and impulses have the stated spread."""
    effect = make_effect("impacts", rate=5.0, impulse=0.02, duration=1.0e-4)
    from stochfric_mb.effects import contract as e
    from stochfric_mb.effects.kinds.impacts import MOST, surroundings  # noqa: F401

    world, nothing = np.zeros(e.WORLD), np.zeros(1)
    world[e.SEED] = 3
    # one impact lasts 1e-4 s: sampled every 0.25e-4 s, each shows up in 4 or 5 samples in a row
    dt = 2.5e-5
    force = np.empty(800_000)
    p = effect.parameters()
    from stochfric_mb.compile import compiled

    act = compiled(surroundings)
    for i in range(len(force)):
        world[e.TIME], world[e.LOAD] = i * dt, 0.0
        act(world, nothing, nothing, p)
        force[i] = world[e.LOAD]
    on = force != 0.0
    starts = np.flatnonzero(on[1:] & ~on[:-1]) * dt
    seconds = len(force) * dt
    n = len(starts)
    assert abs(n - 5.0 * seconds) < 4.0 * math.sqrt(5.0 * seconds)  # 4 standard deviations of the count
    impulse_spread = math.sqrt(np.sum(np.add.reduceat(force, np.flatnonzero(on[1:] & ~on[:-1]) + 1) ** 2) / n) * dt
    assert abs(impulse_spread / 0.02 - 1.0) < 4.0 / math.sqrt(2.0 * n)  # relative error of a standard deviation


@pytest.mark.parametrize(
    ("kind", "in_slips", "at_joints"),
    [
        ("random_coefficients", True, True),
        ("backlash", True, True),
        ("joint_compliance", False, True),
        ("normal_load_ripple", True, False),
        ("stale_samples", False, True),
        ("temperature_drift", True, True),
        ("effective_area", False, True),
        ("drive_gain_change", False, True),
        ("unnamed", False, False),
    ],
)
def test_where_discovery_looks_for_an_effect(kind: str, in_slips: bool, at_joints: bool) -> None:
    cls = effect_class(kind)
    assert (cls.searched_in_slips(), cls.searched_at_joints()) == (in_slips, at_joints)


@pytest.mark.parametrize("tail", [1e-15, 1e-9, 1e-3])
def test_a_fall_with_speed_has_the_exponential_as_the_limit_of_its_tail(tail):
    """(1 + tail s)^(-1/tail) = exp(-s) (1 + tail s^2/2 + ...), without the rounding that a power of 1/tail would make of it."""
    speed = np.array([0.0, 1e-3, 5e-3, 2e-2])
    plain, tailed = (make_effect("velocity_weakening", amplitude=0.05, decay_velocity=5e-3, tail=x) for x in (0.0, tail))
    s = speed / 5e-3
    # the next order is (tail s^2)^2, and s is 4 at most
    assert tailed.curve(speed) == pytest.approx(plain.curve(speed) * (1.0 + 0.5 * tail * s**2), rel=1e-12 + (16.0 * tail) ** 2)
    world = np.zeros(contract.WORLD)
    for v, rise in zip(speed, tailed.curve(speed), strict=True):
        world[contract.SPEED], world[contract.MU_K] = v, 0.3
        friction(world, np.zeros(4), np.zeros(4), (0.05, 5e-3, 1.0, tail))
        assert world[contract.MU_K] == pytest.approx(0.3 + rise, rel=1e-14)


@pytest.mark.parametrize(("process", "said"), [("knots", True), ("per_event", False), ("per_run", False)])
def test_only_knots_have_a_spacing(process, said):
    effect = make_effect("random_coefficients", process=process, sigma_s=0.01, sigma_k=0.01, spacing=0.02)
    assert ("spacing" in effect.given()) is said
    assert make_effect(**effect.given()).coefficient_process() == effect.coefficient_process()
