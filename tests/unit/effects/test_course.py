"""A course of any shape: the splines that effects sum, in compiled friction, in readings and in what discovery looks for."""

import math

import numpy as np
import pytest

from stochfric_mb.compile import compiled
from stochfric_mb.effects import contract, make_effect
from stochfric_mb.effects.kinds import (
    belt_speed_ripple,
    distance_drift,
    friction_drift,
    harmonic_force,
    load_dependence,
    normal_load_ripple,
    position_dependent_friction,
    temperature_drift,
)
from stochfric_mb.effects.shapes.splines import COARSER, COURSE, PIECES, returning, returning_course, sized, splines
from stochfric_mb.errors import InputError


def test_a_course_begins_at_zero():
    """A zero that began elsewhere would be another zero, which the coefficients would take for friction."""
    assert not splines(np.zeros(1), PIECES).any()
    rng = np.random.default_rng(3)
    effect = make_effect("sensor_drift", **sized(rng.standard_normal(PIECES + 2), PIECES, 20.0))
    assert effect.measure(np.zeros(1), np.zeros(1), rng)[0] == 0.0
    reached = effect.measure(np.linspace(0.0, 20.0, 321), np.zeros(321), rng)
    assert np.abs(reached).max() == pytest.approx(abs(effect.change))


@pytest.mark.parametrize("pieces", [4, 8, 16])
def test_a_course_that_comes_back_is_smooth_across_turns_and_changes_no_mean(pieces):
    weights = np.random.default_rng(pieces).standard_normal(pieces - 1)
    numbers = returning_course(weights, pieces)
    effect = make_effect("position_dependent_friction", wavelength=0.3, phase=0.7, axis="belt", **numbers)
    multiplied = compiled(position_dependent_friction.friction)

    def factor(place):
        world, p, none = np.zeros(contract.WORLD), effect.parameters(), np.zeros(1)
        world[contract.MU_S] = world[contract.MU_K] = 1.0
        world[contract.BELT_POSITION] = place
        multiplied(world, none, none, p)
        assert world[contract.MU_S] == world[contract.MU_K]
        return world[contract.MU_K]

    turns = np.linspace(-1.0, 2.0, 961)
    seen = np.array([factor(0.3 * (u - 0.7 / (2.0 * math.pi))) for u in turns])
    raw = returning(turns, pieces) @ weights
    np.testing.assert_allclose(seen, 1.0 + raw - raw[:320].mean(), atol=1e-9)
    np.testing.assert_allclose(seen[:320], seen[320:640], atol=1e-9)
    # the slope at a seam is that between seams: of a jump or a kink of 1 the second difference would be 1 or h, not h^2
    assert np.abs(np.diff(seen, 2)[315:325]).max() < 3.0 * np.abs(np.diff(seen, 2)[:300]).max()
    assert np.abs(seen - 1.0).max() == pytest.approx(abs(effect.course), rel=1e-3)
    assert effect.shortest_time(0.1) == pytest.approx(2.0 * 0.3 / pieces / 0.1)


@pytest.mark.parametrize(("kind", "module", "where"), [
    ("normal_load_ripple", normal_load_ripple, contract.NORMAL_FORCE),
    ("harmonic_force", harmonic_force, contract.LOAD),
])  # fmt: skip
def test_a_wave_in_time_may_have_any_shape_beside_a_cosine(kind, module, where):
    weights = np.random.default_rng(3).standard_normal(7)
    numbers = returning_course(weights, 8) | {"frequency": 0.5, "phase": 0.9}
    numbers["course"] *= 0.2
    effect = make_effect(kind, amplitude=0.1, **numbers)
    acts = compiled(module.surroundings)

    def value(time):
        world, p, none = np.zeros(contract.WORLD), effect.parameters(), np.zeros(1)
        world[contract.NORMAL_FORCE], world[contract.TIME] = 13.0, time
        acts(world, none, none, p)
        return world[where]

    time = np.linspace(-1.0, 3.0, 801)
    raw = returning(0.5 * time + 0.9 / (2.0 * math.pi), 8) @ weights
    change = 0.1 * np.cos(math.pi * time + 0.9) + 0.2 * (raw - raw[:400].mean())
    expected = 13.0 * (1.0 + change) if where == contract.NORMAL_FORCE else change
    np.testing.assert_allclose([value(t) for t in time], expected, atol=1e-9)
    assert effect.shortest_time(1.0) == pytest.approx(2.0 * 2.0 / 8)
    assert make_effect(kind, amplitude=0.1, frequency=0.5).shortest_time(1.0) == 2.0


@pytest.mark.parametrize("pieces", [4, 8, 16])
def test_a_belt_of_any_shape_moves_as_far_as_its_speed_says(pieces):
    """Velocity is the derivative of the travel, and the acceleration that of the velocity, across turns as well."""
    numbers = returning_course(np.random.default_rng(pieces).standard_normal(pieces - 1), pieces)
    numbers |= {"frequency": 0.5, "phase": -2.9, "course": 0.2, "at_begin": numbers["at_begin"] + 0.3}  # its mean is not 0
    effect = make_effect("belt_speed_ripple", amplitude=0.1, **numbers)
    acts = compiled(belt_speed_ripple.surroundings)
    wanted = [contract.BELT_TRAVEL, contract.BELT_VELOCITY, contract.BELT_ACCELERATION]

    def values(time):
        world, p, none = np.zeros(contract.WORLD), effect.parameters(), np.zeros(1)
        world[contract.MEAN_BELT_VELOCITY], world[contract.TIME] = -0.4, time
        acts(world, none, none, p)
        return world[wanted]

    step = 1e-3
    time = step * np.arange(-1000, 5000)
    travel, velocity, acceleration = np.array([values(t) for t in time]).T
    assert travel[1000] == 0.0  # at t = 0
    # central differences: errors of h^2/6 of the third derivatives
    np.testing.assert_allclose((travel[2:] - travel[:-2]) / (2.0 * step), velocity[1:-1], atol=3e-5 * np.ptp(velocity))
    np.testing.assert_allclose(
        (velocity[2:] - velocity[:-2]) / (2.0 * step), acceleration[1:-1], atol=3e-3 * np.ptp(acceleration)
    )
    assert travel[3000] == pytest.approx(-0.4 * 2.0 * 0.2 * 0.3, rel=1e-9)  # a turn leaves the mean alone
    shape = effect.course * effect.shape((0.5 * time - 2.9 / (2.0 * math.pi)) % 1.0)
    np.testing.assert_allclose(velocity, -0.4 * (0.1 * np.cos(math.pi * time - 2.9) + shape), atol=1e-12)


@pytest.mark.parametrize(
    ("kind", "given"),
    [
        ("belt_speed_ripple", {"frequency": 2.0}),
        ("normal_load_ripple", {"frequency": 2.0}),
        ("harmonic_force", {"frequency": 2.0, "phase": 1.0}),
        ("position_dependent_friction", {"wavelength": 0.1}),
    ],
)
def test_a_wave_without_a_size_is_refused(kind, given):
    with pytest.raises(InputError, match=f"effect {kind} has no size; give amplitude or .*course"):
        make_effect(kind, **given)


@pytest.mark.parametrize(
    ("kind", "given"),
    [
        ("normal_load_ripple", {"frequency": 2.0}),
        ("harmonic_force", {"frequency": 2.0}),
        ("position_dependent_friction", {"wavelength": 0.1, "axis": "belt"}),
    ],
)
def test_a_course_that_comes_back_goes_on_where_it_began(kind, given):
    with pytest.raises(InputError, match=r"kink.* course_18 = 1; of 16 pieces give .*course_18 = course_2"):
        make_effect(kind, **given, course=0.1, course_3=1.0, course_18=1.0)
    with pytest.raises(InputError, match=r"kink there: course_8 = 1,"):
        make_effect(kind, **given, course=0.1, course_8=1.0, pieces=8)
    make_effect(kind, **given, course=0.1, course_2=1.0, course_18=1.0)


def test_a_load_of_any_shape_pulls_at_no_time():
    """Cosine and course are each smaller than the load, and so is no weight that is given by hand."""
    ends = {"course_1": 1.0, "course_17": 1.0}
    for given in ({"course": 0.8, "amplitude": 0.7, **ends}, {"course": 0.8, "course_5": -9.0}):
        with pytest.raises(InputError, match=r"falls to -[0-9.]+ of what it is, and no contact pulls; give a smaller"):
            make_effect("normal_load_ripple", frequency=2.0, **given)
    make_effect("normal_load_ripple", frequency=2.0, course=0.3, amplitude=0.7, **ends)
    make_effect("harmonic_force", frequency=2.0, course=0.8, course_5=-9.0)


def test_a_course_needs_a_stretch_or_a_wavelength():
    with pytest.raises(InputError, match="wavelength"):
        make_effect("position_dependent_friction", course=0.1, course_1=1.0)


def test_a_smooth_course_is_followed():
    place = np.linspace(0.0, 1.0, 500)
    course = place * np.exp(1.0 - 4.0 * place)
    design = np.column_stack([np.ones(500), splines(place, PIECES)])
    rest = course - design @ np.linalg.lstsq(design, course, rcond=None)[0]
    # the error of cubic splines is h^4/384 times the fourth derivative (de Boor, chapter V), here 1024 at most
    assert np.abs(rest).max() < 1024.0 / PIECES**4 / 384.0


@pytest.mark.parametrize("pieces", [*COARSER, 1])
@pytest.mark.parametrize(
    ("module", "along", "begin", "more"),
    [
        (friction_drift, contract.TIME, 0.0, {}),
        (distance_drift, contract.TRAVELLED, 0.0, {}),
        (temperature_drift, contract.TEMPERATURE, 18.0, {"reference_temperature": 18.0}),
    ],
)
def test_friction_follows_the_course(module, along, begin, more, pieces):
    weights = np.sin(np.arange(pieces + 2))
    kind = module.__name__.rsplit(".", 1)[1]
    effect = make_effect(kind, **sized(weights, pieces, 30.0), static_share=0.5, **more)
    world, nothing, p = np.zeros(contract.WORLD), np.zeros(1), effect.parameters()
    for function in (module.friction, compiled(module.friction)):
        for t in (0.0, 3.0, 15.0, 29.9, 30.0, 45.0):
            world[along], world[contract.MU_S], world[contract.MU_K] = begin + t, 1.0, 1.0
            function(world, nothing, nothing, p)
            expected = float(splines(np.array([t / 30.0]), pieces)[0] @ weights)
            assert world[contract.MU_K] == pytest.approx(1.0 + expected, abs=1e-14)
            assert world[contract.MU_S] == pytest.approx(1.0 + 0.5 * expected, abs=1e-14)


@pytest.mark.parametrize(
    ("kind", "acts_on", "expected"),
    [
        ("position_dependent_friction", contract.MU_K, lambda c: 0.4 * (1.0 + c)),
        ("position_dependent_force", contract.LOAD, lambda c: c),
        ("drive_gain_change", contract.LOAD, lambda c: 7.0 * c),
        ("effective_area", contract.LOAD, lambda c: -3.0e5 * c),
    ],
)
@pytest.mark.parametrize("pieces", COARSER)
def test_what_the_stroke_decides_follows_the_course(kind, acts_on, expected, pieces):
    numbers = sized(np.cos(np.arange(pieces + 2)), pieces, 0.3)
    size = numbers.pop("change")
    more = {"axis": "position"} if kind == "position_dependent_friction" else {}
    effect = make_effect(kind, **numbers, course=size, begin=-0.1, at_begin=0.2, **more)
    module = effect.functions()
    function = getattr(module, "friction" if acts_on == contract.MU_K else "surroundings")
    nothing, p = np.zeros(1), effect.parameters()
    for one in (function, compiled(function)):
        for x in (-0.2, -0.1, 0.02, 0.15, 0.2, 0.3):
            world = np.zeros(contract.WORLD)
            world[contract.POSITION], world[contract.MU_S], world[contract.MU_K] = x, 0.5, 0.4
            world[contract.DRIVE], world[contract.PRESSURE] = 7.0, 3.0e5
            one(world, nothing, nothing, p)
            course = size * float(effect.shape(np.array([(x + 0.1) / 0.3]))[0])
            assert world[acts_on] == pytest.approx(expected(course), abs=1e-9)
    alike, largest = effect.normalised(), effect.normalised().shape(np.linspace(0.0, 1.0, 321))
    assert np.abs(largest).max() == pytest.approx(1.0)
    np.testing.assert_allclose(alike.course * largest, effect.course * effect.shape(np.linspace(0.0, 1.0, 321)), atol=1e-12)


@pytest.mark.parametrize("pieces", COARSER)
def test_friction_follows_a_course_along_the_load(pieces):
    numbers = sized(np.cos(np.arange(pieces + 2)), pieces, 30.0)
    size = numbers.pop("change")
    more = {"exponent": -0.2, "reference_load": 12.0, "static_share": 0.5}
    effect = make_effect("load_dependence", **numbers, course=size, begin=5.0, at_begin=0.1, **more)
    nothing, p = np.zeros(1), effect.parameters()
    for function in (load_dependence.friction, compiled(load_dependence.friction)):
        for load in (2.0, 5.0, 11.0, 20.0, 35.0, 40.0):
            world = np.zeros(contract.WORLD)
            world[contract.NORMAL_FORCE], world[contract.MU_S], world[contract.MU_K] = load, 1.0, 1.0
            function(world, nothing, nothing, p)
            course = 1.0 + size * float(effect.shape(np.array([(load - 5.0) / 30.0]))[0])
            assert world[contract.MU_K] == pytest.approx(course * (load / 12.0) ** -0.2, rel=1e-12)
            assert world[contract.MU_S] == pytest.approx(course * (load / 12.0) ** -0.1, rel=1e-12)


def test_friction_along_a_place_needs_a_wave_or_a_course():
    for given in ({"amplitude": 0.1}, {"amplitude_2": 0.1}):
        with pytest.raises(InputError, match="wavelength"):
            make_effect("position_dependent_friction", **given)


def test_a_reading_follows_the_course():
    weights = 1e-4 * np.cos(np.arange(PIECES + 2))
    effect = make_effect("sensor_drift", **sized(weights, PIECES, 20.0))
    t = np.linspace(0.0, 25.0, 100)
    shown = effect.measure(t, np.zeros(100), np.random.default_rng(0))
    np.testing.assert_allclose(shown, splines(t / 20.0, PIECES) @ weights, atol=1e-18)


@pytest.mark.parametrize("pieces", [0, 2.5, 17])
def test_pieces_are_a_whole_number_up_to_what_has_weights(pieces):
    with pytest.raises(InputError, match=r"pieces = .*(from 1 to 16|>= 1 and <= 16)"):
        make_effect("friction_drift", change=0.1, span=9.0, course_1=1.0, pieces=pieces)


def test_a_weight_beyond_the_pieces_is_refused():
    with pytest.raises(InputError, match="course_10 = 1 counts for nothing in a course of 4 pieces; give more pieces"):
        make_effect("friction_drift", change=0.1, span=9.0, course_1=1.0, course_10=1.0, pieces=4)


def test_a_form_without_a_course_lacks_its_numbers():
    line = make_effect("friction_drift", rate=0.01)
    assert math.isinf(line.time_constant)
    assert all(line.lacks(name) for name in ("change", "span", *COURSE))
    assert not line.lacks("rate")
    assert make_effect("friction_drift", change=0.1, span=9.0, course_1=1.0).lacks("rate")


@pytest.mark.parametrize(
    ("given", "remedy"),
    [({"span": 9.0}, "give course_1 to course_18"), ({"course_1": 1.0}, "give span"), ({}, "give course_1")],
)
@pytest.mark.parametrize("kind", ["friction_drift", "distance_drift", "temperature_drift", "sensor_drift"])
def test_a_size_without_a_course_is_refused(kind, given, remedy):
    with pytest.raises(InputError, match=rf"{kind}.change = 0.1, but .*{remedy}"):
        make_effect(kind, change=0.1, **given)
