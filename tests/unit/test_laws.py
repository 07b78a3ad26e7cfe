"""The registry of laws, their parameters and their errors."""

import dataclasses

import numpy as np
import pytest

import stochfric_mb
from stochfric_mb import InputError, make_law
from stochfric_mb.compile import compiled
from stochfric_mb.laws import GUARDS, LAWS, Law, law_class, register_law
from stochfric_mb.laws.abi import MAX_STATE, call_law, native_law


@compiled
def call(address, state, p, out):
    call_law(
        address,
        0.1,
        2e-6,
        1e-6,
        4e-4,
        -2e-4,
        13.0,
        0.79,
        0.47,
        6.0,
        3.0,
        -1.0,
        state.ctypes.data,
        p.ctypes.data,
        out.ctypes.data,
    )


ARGUMENTS = (0.1, 2e-6, 1e-6, 4e-4, -2e-4, 13.0)


@pytest.mark.parametrize("kind", list(LAWS))
def test_function_pointers_and_python_give_the_same_bits(kind):
    law = make_law(kind, mu_s=0.8, mu_k=0.46)
    functions, native, p = law.functions(), native_law(kind), law.parameters()
    out = np.zeros(MAX_STATE)
    state = functions.init(*ARGUMENTS, 0.79, 0.47, 6.0, 3.0, -1.0, p)
    call(native.init, np.zeros(MAX_STATE), p, out)
    assert tuple(out[: native.n_state]) == state
    state = np.array(state)
    call(native.force, state, p, out)
    assert tuple(out[:2]) == functions.force(*ARGUMENTS, state, 0.79, 0.47, 6.0, 3.0, -1.0, p)
    call(native.commit, state, p, out)
    assert tuple(out[: native.n_state]) == functions.commit(*ARGUMENTS, state, 0.79, 0.47, 6.0, 3.0, -1.0, p)
    call(native.guards, state, p, out)
    assert tuple(out[:GUARDS]) == functions.guards(*ARGUMENTS, state, 0.79, 0.47, 6.0, 3.0, -1.0, p)


@pytest.mark.parametrize("kind", list(LAWS))
def test_every_law_is_exported_and_documented(kind):
    cls = law_class(kind)
    assert getattr(stochfric_mb, cls.__name__) is cls
    assert cls.kind == kind
    assert "Reference" in (cls.__doc__ or "")
    law = make_law(kind, mu_s=0.8, mu_k=0.46)
    assert law.parameters()[:2] == pytest.approx([0.8, 0.46], abs=0.0)
    assert (law.step_limit_formula == "none") == (law.step_limit(13.0, 6.08) == float("inf"))
    assert make_law(**law.to_dict()) == law


@pytest.mark.parametrize("kind", list(LAWS))
def test_more_mass_and_less_load_never_shorten_the_step(kind):
    law = make_law(kind, mu_s=0.8, mu_k=0.46)
    assert law.step_limit(13.0, 2.0) <= law.step_limit(13.0, 4.0)
    assert law.step_limit(26.0, 2.0) <= law.step_limit(13.0, 2.0)


@pytest.mark.parametrize(
    ("kind", "parameters", "words"),
    [
        ("coulomb", {"mu_s": 0.4, "mu_k": 0.5}, "mu_k <= mu_s"),
        ("coulomb", {"mu_s": 0.4, "mu_k": -0.1}, "mu_k must be >= 0"),
        ("coulomb", {"mu_s": float("nan"), "mu_k": 0.1}, "not finite"),
        ("coulomb", {"mu_s": "much", "mu_k": 0.1}, "not a number"),
        ("coulomb", {"mu_k": 0.1}, "lacks mu_s"),
        ("columb", {"mu_s": 0.4, "mu_k": 0.1}, "did you mean 'coulomb'"),
        ("havsin", {"mu_s": 0.4, "mu_k": 0.1, "v_s": 2.0}, "raise v_d or lower v_s"),
        ("elastic_stick", {"mu_s": 0.4, "mu_k": 0.1, "elim": 1.0}, "did you mean 'e_lim'"),
        ("elastic_stick", {"mu_s": 0.4, "mu_k": 0.1, "e_lim": 0.0}, "e_lim must be > 0"),
        ("stribeck", {"mu_s": 0.4, "mu_k": 0.1, "form": "gauss"}, "did you mean 'gaussian'"),
    ],
)
def test_bad_parameters(kind, parameters, words):
    with pytest.raises(InputError, match=words):
        make_law(kind, **parameters)


@pytest.mark.parametrize("kind", ["havsin", "piecewise_linear", "tanh", "smooth"])
def test_a_broken_velocity_shows_in_the_force(kind):
    law = make_law(kind, mu_s=0.8, mu_k=0.46)
    nan = float("nan")
    force = law.functions().force(0.0, 0.0, 0.0, nan, 0.0, 13.0, np.zeros(1), 0.8, 0.46, 6.0, 0.0, 0.0, law.parameters())
    assert np.isnan(force[0])


def test_laws_are_frozen():
    with pytest.raises(dataclasses.FrozenInstanceError):
        make_law("coulomb", mu_s=0.4, mu_k=0.1).mu_s = 0.5


def test_a_users_own_law_joins_the_registry():
    @register_law
    @dataclasses.dataclass(frozen=True)
    class Mine(Law):
        kind = "mine"
        equation = "F = mu_k N v/abs(v)"
        source = "this test"

    try:
        assert make_law("mine", mu_s=0.4, mu_k=0.1) == Mine(0.4, 0.1)
    finally:
        del LAWS["mine"]
