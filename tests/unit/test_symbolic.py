"""A law's source as an expression: equal to the compiled law, small, and refused where it cannot be made."""

# ruff: noqa: E402  (the expressions can be imported only where exudyn is)

from __future__ import annotations

import math

import numpy as np
import pytest

exudyn = pytest.importorskip("exudyn", reason="exudyn is not installed")

from exudyn.advancedUtilities import CreateSymbolicUserFunction

from stochfric_mb.coefficients import CoefficientPath, Knots, PerEvent, Spatial
from stochfric_mb.compile import compiled
from stochfric_mb.errors import InputError
from stochfric_mb.exudyn.expression import Expression, apply, choose, evaluate, hypot, size, variable, variables
from stochfric_mb.exudyn.symbolic import coefficients, force_expression, live_names, lower, symbolic, zero_entries
from stochfric_mb.exudyn.trace import trace
from stochfric_mb.laws import LAWS, law_class, make_law

FORCE_LAWS = [kind for kind in LAWS if not law_class(kind).needs_holding_force]
N, MASS = 13.0, 6.08
x, y = variable("x"), variable("y")


def walk(law, n: int, seed: int):
    """States that the law passes through along a random motion: (t, u, v, state, force)."""
    f, p = law.functions(), law.parameters()
    rng = np.random.default_rng(seed)
    state = f.init(0.0, 0.0, 0.0, 0.0, 0.0, N, law.mu_s, law.mu_k, MASS, 0.0, 0.0, p)
    for i in range(n):
        t, u = 1e-4 * i, 2e-5 * rng.normal()
        v = rng.choice([0.0, 1.0], p=[0.05, 0.95]) * rng.normal() * 10 ** rng.uniform(-6, -1)
        rest = (law.mu_s, law.mu_k, MASS, 0.0, 0.0, p)
        yield t, u, v, state, f.force(t, u, 0.0, v, 0.0, N, state, *rest)[0]
        state = f.commit(t, u, 0.0, v, 0.0, N, state, *rest)


@pytest.mark.parametrize("kind", FORCE_LAWS)
def test_symbolic_force_is_the_compiled_force(kind: str) -> None:
    law = make_law(kind, mu_s=0.8, mu_k=0.46)
    found = force_expression(law, None, N, MASS)
    live = {name: symbolic.Real(name, 0.0) for name in found.names}
    mbs = exudyn.SystemContainer().AddSystem()

    def user_function(mbs, t, itemNumber, displacement, velocity, stiffness, damping, offset):
        return lower(found.force, {**live, "t": t, "u": displacement, "v": velocity})

    engine = CreateSymbolicUserFunction(
        mbs, user_function, "springForceUserFunction", itemTypeName="ObjectConnectorCoordinateSpringDamper"
    )
    slips = 0
    for t, u, v, state, force in walk(law, 2000, seed=1):
        values = {f"state_{i}": s for i, s in enumerate(state)}
        for name, symbol in live.items():
            symbol.SetValue(values[name])
        # the same operations in the same order: roundings of a clipped force, and of spring against damper (1e-15 mu_s N)
        tolerance = 1e-13 * abs(force) + 1e-15 * law.mu_s * N
        assert abs(engine.Evaluate(mbs, t, 0, u, v, 0.0, 0.0, 0.0) - force) <= tolerance
        assert abs(evaluate(found.force, {**values, "t": t, "u": u, "v": v}) - force) <= tolerance
        slips += abs(v) > 1e-3
    assert 100 < slips < 1900  # both branches were visited


@pytest.mark.parametrize("kind", LAWS)
def test_expressions_are_small_and_leave_out_what_is_zero(kind: str) -> None:
    law = make_law(kind, mu_s=0.8, mu_k=0.46)
    found = force_expression(law, None, N, MASS)
    assert size(found.force) < 300  # lugre's; a node costs about 3 ns, four times a step
    assert variables(found.force) <= {"t", "u", "v", *found.names}
    assert not variables(found.force) & {f"state_{i}" for i in zero_entries(law, N, MASS)}


def test_entries_of_the_second_direction_stay_zero() -> None:
    law = make_law("elastic_stick", mu_s=0.8, mu_k=0.46)
    names = [law.state_names[i] for i in zero_entries(law, N, MASS)]
    assert sorted(names) == ["ay", "dy"]
    for *_, state, _ in walk(law, 500, seed=2):
        assert state[2] == state[4] == 0.0


@pytest.mark.parametrize(
    "process",
    [Knots(sigma_s=0.015, sigma_k=0.023, spacing=0.01), Spatial(sigma_s=0.01, sigma_k=0.01, spacing=1e-4)],
)
def test_coefficients_are_the_path_on_both_sides_of_a_knot(process) -> None:
    law = make_law("elastic_stick", mu_s=0.8, mu_k=0.46)
    path, h = CoefficientPath(process, law, seed=3), process.knot_spacing
    knot = 7
    before, at, after = path.pairs(3, first=knot - 1)
    segment = (knot * h, *before, *((at - before) / h), *((after - at) / h), *at)
    values = dict(zip(live_names(law)[-10:-1], segment, strict=True))
    pair = coefficients(law, process)
    for r in np.linspace(knot - 1.0, knot + 1.0, 41)[1:-1]:
        now = {**values, "t": r * h, "u": r * h}
        exact = path.at(r * h, r * h)
        assert [evaluate(e, now) for e in pair] == pytest.approx(exact, rel=1e-13)  # rounding of a line


def test_coefficients_per_event_are_two_numbers() -> None:
    law = make_law("havsin", mu_s=0.8, mu_k=0.46)
    assert coefficients(law, PerEvent(sigma_s=0.01, sigma_k=0.01)) == (variable("mu_s"), variable("mu_k"))
    assert coefficients(law, None) == (0.8, 0.46)


def test_neutral_elements_disappear() -> None:
    assert apply("add", x, 0.0) is x
    assert apply("mul", 1.0, x) is x
    assert apply("mul", 0.0, x) == 0.0
    assert apply("sub", 0.0, x) is apply("neg", x)
    assert apply("div", x, 1.0) is x
    assert apply("mul", 2.0, 3.0) == 6.0
    assert hypot(x, 0.0) is apply("abs", x)
    assert evaluate(hypot(x, y), {"x": 3.0, "y": 4.0}) == pytest.approx(5.0)


def test_equal_expressions_are_one_object() -> None:
    assert apply("add", x, y) is apply("add", x, y)
    assert apply("add", x, 1.0) is not apply("add", x, 2.0)


def test_a_choice_between_equals_is_no_choice() -> None:
    condition = apply("gt", x, 0.0)
    assert choose(condition, y, y) is y
    assert choose(True, x, y) is x
    assert choose(condition, choose(condition, x, y), y) is choose(condition, x, y)


def test_truth_of_an_expression_is_not_guessed() -> None:
    with pytest.raises(TypeError, match="choose"):
        bool(apply("gt", x, 0.0))


@compiled
def branches(a, b, p):
    """Every kind of statement that can be traced."""
    c: float = max(a, b, 0.0) if a > 0.0 else -b
    c += p[0]
    if 0.0 < b <= 1.0 and not a > 3.5:
        d = math.sin(c)
    elif a > 1.0 or b > 3.0:
        d = 2.0
    else:
        d = abs(c) ** 2
    if d > 1.5:
        return d, LIMIT
    e, f = d * math.pi, c
    return e, f


LIMIT = 4.0


def test_traced_branches_equal_the_function() -> None:
    pair = trace(branches, x, y, [0.25])
    rng = np.random.default_rng(0)
    for a, b in rng.uniform(-2.0, 4.0, (500, 2)):
        mine = [evaluate(e, {"x": a, "y": b}) for e in pair]
        assert mine == pytest.approx(branches(a, b, np.array([0.25])), rel=1e-13)


def test_known_arguments_give_numbers() -> None:
    assert trace(branches, 2.0, 0.5, [0.25]) == pytest.approx(branches(2.0, 0.5, np.array([0.25])), rel=1e-15)


def with_loop(a):
    for _ in range(3):
        a = a + 1.0
    return a


def without_return(a):  # noqa: RET503  (that is the point)
    if a > 0.0:
        return a


def with_index(a, p):
    return p[a]


@pytest.mark.parametrize(
    ("function", "arguments", "message"),
    [
        (with_loop, (x,), "for _ in range"),
        (without_return, (x,), "without_return"),
        (with_index, (x, [1.0, 2.0]), r"p\[a\]"),
        (with_loop, (), "takes 1 arguments"),
        (eval("lambda a: a"), (x,), "file"),
    ],
)
def test_what_cannot_be_traced_is_refused(function, arguments, message: str) -> None:
    with pytest.raises(InputError, match=message):
        trace(function, *arguments)


def test_nodes_read_as_formulas() -> None:
    assert repr(apply("add", x, 2.0)) == "add(x, 2.0)"
    assert isinstance(x, Expression)
