"""C made from the package's sources gives what the compiled Python gives."""

import ctypes
import dataclasses
import math

import numpy as np
import pytest

from stochfric_mb.c import Translation, UntranslatableError
from stochfric_mb.c.dispatch import EFFECT_FUNCTIONS
from stochfric_mb.c.types import DOUBLE
from stochfric_mb.coefficients import PROCESSES, CoefficientPath, Empirical, Lognormal, TruncatedNormal, Uniform
from stochfric_mb.coefficients.path import CURSOR
from stochfric_mb.effects import contract as e
from stochfric_mb.effects import effect_class, effect_kinds, make_effect
from stochfric_mb.effects.augmented_law import Augmented, augmented_law
from stochfric_mb.laws import LAWS, law_class, make_law
from stochfric_mb.laws.abi import MAX_STATE
from stochfric_mb.mechanisms import BeltBox

from .conftest import pointer

SAME = 1.0e-15
"""The same operations in the same order, and the same libm: what is left is nothing; a rounding is 1.1e-16."""
N = 2000


def motions(rng, n=N):
    """Draw t, u, v, N, mu_s, mu_k, effective mass and hold over many sizes, on lines and in planes."""
    size = 10.0 ** rng.uniform(-7.0, 0.0, (n, 11)) * rng.choice([-1.0, 1.0], (n, 11))
    motion = size.copy()
    motion[:, 0] = rng.uniform(0.0, 20.0, n)
    motion[:, 5] = 10.0 ** rng.uniform(-1.0, 3.0, n)
    motion[:, 6] = rng.uniform(0.3, 1.0, n)
    motion[:, 7] = motion[:, 6] * rng.uniform(0.2, 1.0, n)
    motion[:, 8] = 10.0 ** rng.uniform(-1.0, 2.0, n)
    motion[:, 9:] *= motion[:, 5, None]
    motion[rng.random(n) < 0.4, 2] = 0.0
    flat = rng.random(n) < 0.4
    motion[np.ix_(flat, [2, 4, 10])] = 0.0
    motion[rng.random(n) < 0.1, 3:5] = 0.0
    return motion


def states(rng, cls, motion):
    """Draw states: modes where there is one, places near the contact's, directions."""
    n = len(motion)
    state = np.zeros((n, MAX_STATE))
    for i, name in enumerate(cls.state_names):
        if name == "mode":
            state[:, i] = rng.integers(0, 3, n)
        elif name == "t":
            state[:, i] = motion[:, 0] - 10.0 ** rng.uniform(-5.0, -2.0, n)
        elif name in ("ux", "ax"):
            state[:, i] = motion[:, 1] + 1.0e-5 * rng.standard_normal(n)
        elif name in ("uy", "ay"):
            state[:, i] = motion[:, 2] + np.where(motion[:, 2] == 0.0, 0.0, 1.0e-5 * rng.standard_normal(n))
        elif name in ("dx", "dy"):
            state[:, i] = rng.standard_normal(n)
        else:
            state[:, i] = 1.0e-5 * rng.standard_normal(n)
    return state


def assert_same(ours, theirs):
    np.testing.assert_allclose(ours, theirs, rtol=SAME, atol=0.0)


@pytest.mark.parametrize("kind", [k for k in LAWS if k != "augmented"])
def test_laws(in_c, rng, kind):
    cls = law_class(kind)
    functions, numbers = cls.functions(), in_c.dispatch.law(cls)
    motion = motions(rng)
    state = states(rng, cls, motion)
    p = make_law(kind, mu_s=0.8, mu_k=0.46).parameters()
    for name in ("init", "force", "commit", "guards"):
        theirs, ours = [], []
        for m, s in zip(motion, state, strict=True):
            given = (*m[:6], *m[6:], p) if name == "init" else (*m[:6], s, *m[6:], p)
            theirs.append(getattr(functions, name)(*given))
            out = np.zeros(MAX_STATE)
            in_c.law(getattr(numbers, name), m, s, p, out)
            ours.append(out[: len(theirs[-1])])
        assert_same(np.array(ours), np.array(theirs))
        assert len(np.unique(np.array(ours), axis=0)) > 1 or cls.state_names == () or kind == "smooth"
    if cls.has_flow:
        for m in motion:
            x, out = np.array([m[3], m[4], m[5], 1e-5 * m[1], 1e-5 * m[2], m[6], m[7]]), np.zeros(4)
            getattr(in_c.library, f"test_flow_{kind}")(pointer(x), pointer(p), pointer(out))
            assert_same(out, functions.flow(*x, p))


DISTRIBUTIONS = [
    {},
    {"distribution_s": TruncatedNormal(0.7, 0.9), "distribution_k": Uniform()},
    {"distribution_s": Lognormal(), "distribution_k": Empirical(tuple(np.linspace(0.4, 0.5, 37)))},
]


@pytest.mark.parametrize("kind", PROCESSES)
@pytest.mark.parametrize("distributions", DISTRIBUTIONS, ids=["normal", "truncated-uniform", "lognormal-empirical"])
def test_coefficient_paths(in_c, rng, kind, distributions):
    cls = PROCESSES[kind]
    own = {f.name for f in dataclasses.fields(cls)}
    given = {"sigma_s": 0.05, "sigma_k": 0.06, "spacing": 0.01, "correlation_time": 0.2} | distributions
    process = cls(**{k: v for k, v in given.items() if k in own})
    path = CoefficientPath(process, make_law("coulomb", mu_s=0.8, mu_k=0.46), seed=4294967295, sample=7, contact=3)
    address = np.array([path.seed, path.sample, path.contact], dtype=np.int64)
    cursor, out = np.zeros(CURSOR), np.zeros(2)
    for t in rng.uniform(-2.0 if cls.clock == 1.0 else 0.0, 5.0, 400):
        place = map(ctypes.c_double, (t, t, math.floor(t)))
        in_c.library.test_path(pointer(path.descriptor), pointer(cursor), pointer(address), *place, pointer(out))
        assert_same(out, path.at(t, t, math.floor(t)))


def own_effects():
    for kind in effect_kinds():
        module = effect_class(kind).functions()
        yield from ((kind, name) for name in EFFECT_FUNCTIONS if hasattr(module, name))


def example(kind):
    """Return an effect with typical parameters."""
    values = {}
    for field in dataclasses.fields(effect_class(kind)):
        about = field.metadata
        values[field.name] = (
            about["choices"][-1] if "choices" in about else np.clip(about["scale"], about["low"], about["high"])
        )
    if "course_16" in values:
        values["course_16"] = 0.0  # of 16 pieces with the other weights alike, so that it goes on where it comes back
    if kind == "impacts":
        values["duration"] = 1.0 / values["rate"]  # so long that a few hundred moments meet some
    return make_effect(kind, **values)


@pytest.mark.parametrize(("kind", "name"), list(own_effects()))
def test_effects(in_c, rng, kind, name):
    effect = example(kind)
    function, p = getattr(effect.functions(), name), effect.parameters()
    number = in_c.dispatch.effect(type(effect), name)
    changed = 0
    for _ in range(300):
        world = rng.uniform(0.0, 3.0, e.WORLD)
        world[e.SEED], world[e.SAMPLE], world[e.DIRECTION] = 5.0, 2.0, rng.choice([-1.0, 1.0])
        world[[e.POSITION, e.VELOCITY, e.SLIP, e.SLIP_TIME]] *= 1.0e-3
        memory, rates = 1.0e-3 * rng.standard_normal(4), np.zeros(4)
        ours, our_rates = world.copy(), rates.copy()
        in_c.library.test_effect(ctypes.c_int64(number), pointer(ours), pointer(memory), pointer(our_rates), pointer(p))
        before = world.copy()
        function(world, memory, rates, p)
        assert_same(ours, world)
        assert_same(our_rates, rates)
        changed += not np.array_equal(world, before)
    assert changed > 0


def test_a_law_with_effects(in_c, rng):
    effects = [example(k) for k in ("second_mode", "belt_speed_ripple", "normal_load_ripple", "dwell_ageing", "impacts")]
    mechanism = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
    inner = make_law("elastic_stick", mu_s=0.8, mu_k=0.46)
    law = augmented_law(inner, mechanism, effects, seed=3, sample=1)
    assert isinstance(law, Augmented)
    functions, numbers = Augmented.functions(), in_c.dispatch.law(Augmented)
    p = law.parameters()
    model, address = in_c_model(in_c, law, effects, inner)
    ours_p = np.array([p[0], p[1], float(address)])
    theirs = state = None
    for i in range(300):
        t = 1.0e-3 * i
        m = np.array(
            [t, 2.5e-3 * t + 1e-5 * rng.standard_normal(), 0.0, rng.normal(2.5e-3, 2e-3), 0.0, 13.0, 0.8, 0.46, 6.08, 0, 0]
        )
        out = np.zeros(MAX_STATE)
        if state is None:
            theirs = functions.init(*m, p)
            in_c.law(numbers.init, m, out, ours_p, out)
        else:
            in_c.law(numbers.force, m, state, ours_p, out)
            assert_same(out[:2], functions.force(*m[:6], state, *m[6:], p))
            in_c.law(numbers.guards, m, state, ours_p, out)
            assert_same(out[:6], functions.guards(*m[:6], state, *m[6:], p))
            theirs = functions.commit(*m[:6], state, *m[6:], p)
            in_c.law(numbers.commit, m, state, ours_p, out)
        assert_same(out, theirs)
        state = np.array(theirs)
    assert model is not None


def in_c_model(in_c, law, effects, inner):
    """Return the model of a law with effects, with the numbers of C in the place of addresses."""
    from stochfric_mb.c.model import numbered_model

    model = numbered_model(law, effects, in_c.dispatch)
    return model, model.ctypes.data


def test_the_same_source_gives_the_same_text():
    first, second = Translation(), Translation()
    for translation in (first, second):
        translation.add(law_class("elastic_stick").functions().slip_coefficient, [DOUBLE] * 5)
    assert first.text == second.text
    assert "elastic_stick_slip_coefficient" in first.text


def uses_a_list(x):
    values = [x, x]
    return values[0]


def reads_a_file(x):
    with open("numbers.txt") as file:  # noqa: PTH123
        return float(file.read()) * x


def falls_into_itself(x):
    return falls_into_itself(x) if x > 0.0 else 0.0


@pytest.mark.parametrize("function", [uses_a_list, reads_a_file, falls_into_itself], ids=lambda f: f.__name__)
def test_what_cannot_be_translated_is_refused_by_name(function):
    with pytest.raises(UntranslatableError, match=rf"test_translation\.{function.__name__}"):
        Translation().add(function, [DOUBLE])
