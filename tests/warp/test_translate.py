"""Warp functions made of the package's own sources give what numba gives."""

import math

import numpy as np
import pytest
import warp as wp

from stochfric_mb.coefficients import CoefficientPath, Empirical, Knots, Lognormal, Matern, OrnsteinUhlenbeck, Uniform
from stochfric_mb.laws import LAWS, law_class, make_law
from stochfric_mb.laws.stribeck import slip_coefficient
from stochfric_mb.scalar_function import UntranslatableError
from stochfric_mb.warp.law import coefficient_functions, slide_function, spring_function
from stochfric_mb.warp.translate import REAL, Translator

SPEEDS = np.concatenate([[0.0], np.geomspace(1e-7, 10.0, 400)])
CAPS = [kind for kind in LAWS if law_class(kind).rest != "bristle"]


def own_coefficient(law, speeds):
    """Return what the law's numba function gives for a contact that slides."""
    return np.array([law.functions().sliding_coefficient(v, law.mu_s, law.mu_k, law.parameters()) for v in speeds])


def warp_coefficient(law, speeds, real):
    slide = slide_function(law.kind, real)

    @wp.kernel(module="unique", enable_backward=False)
    def kernel(speed: wp.array[real], p: wp.array[real], mu_s: real, mu_k: real, out: wp.array[real]):
        i = wp.tid()
        out[i] = slide(speed[i], mu_s, mu_k, p)

    out = wp.zeros(len(speeds), dtype=real)
    given = [wp.array(speeds, dtype=real), wp.array(law.parameters(), dtype=real), law.mu_s, law.mu_k]
    wp.launch(kernel, dim=len(speeds), inputs=given, outputs=[out])
    return out.numpy()


@pytest.mark.parametrize("kind", CAPS)
def test_sliding_coefficient_is_numbas(kind):
    law = make_law(kind, mu_s=0.8, mu_k=0.46)
    expected = own_coefficient(law, SPEEDS)
    assert np.abs(warp_coefficient(law, SPEEDS, wp.float64) - expected).max() < 1e-13  # a libm's last bits
    # float32 holds speed and result to 6e-8 each; a law multiplies the speed's error by abs(v dmu/dv), below 1.5 (havsin)
    assert np.abs(warp_coefficient(law, SPEEDS, wp.float32) - expected).max() < 1e-6


def test_all_forms_of_stribeck_have_their_own_curve():
    for form in ("exponential", "gaussian", "lorentzian"):
        law = make_law("stribeck", mu_s=0.8, mu_k=0.46, stribeck_velocity=0.01, form=form)
        assert np.abs(warp_coefficient(law, SPEEDS, wp.float64) - own_coefficient(law, SPEEDS)).max() < 1e-13


@pytest.mark.parametrize(("real", "tolerance"), [(wp.float64, 1e-13), (wp.float32, 1e-6)])
def test_stick_spring_is_numbas(real, tolerance):
    law = make_law("elastic_stick", mu_s=0.8, mu_k=0.46)
    spring = spring_function(law.kind, real)

    @wp.kernel(module="unique", enable_backward=False)
    def kernel(load: wp.array[real], mass: wp.array[real], mu_s: real, p: wp.array[real], out: wp.array2d[real]):
        i, j = wp.tid()
        a, b, c = spring(load[i], mass[j], mu_s, p)
        k = i * mass.shape[0] + j
        out[k, 0] = a
        out[k, 1] = b
        out[k, 2] = c

    loads, masses = np.geomspace(1e-3, 1e4, 20), np.geomspace(1e-4, 1e3, 20)
    out = wp.zeros((400, 3), dtype=real)
    given = [wp.array(loads, dtype=real), wp.array(masses, dtype=real), 0.75, wp.array(law.parameters(), dtype=real)]
    wp.launch(kernel, dim=(20, 20), inputs=given, outputs=[out])
    expected = [law.functions().stick_spring(n, m, 0.75, law.parameters()) for n in loads for m in masses]
    assert np.abs(out.numpy() / np.array(expected) - 1.0).max() < tolerance


def coefficient_paths(process, law, times, seed, contact, worlds):
    path = coefficient_functions()[0]

    @wp.kernel(module="unique", enable_backward=False)
    def kernel(
        numbers: wp.array[wp.float64], cursors: wp.array2d[wp.float64], t: wp.array[wp.float64], seed: wp.int64,
        contact: wp.int64, out: wp.array3d[wp.float64],
    ):  # fmt: skip
        w = wp.tid()
        for i in range(t.shape[0]):
            a, b = path(numbers, cursors[w], seed, wp.int64(w), contact, t[i], wp.float64(0.0), wp.float64(0.0))
            out[w, i, 0] = a
            out[w, i, 1] = b

    out = wp.zeros((worlds, len(times), 2), dtype=wp.float64)
    given = [wp.array(process.descriptor(law), dtype=wp.float64), wp.zeros((worlds, 10), dtype=wp.float64)]
    wp.launch(kernel, dim=worlds, inputs=[*given, wp.array(times, dtype=wp.float64), seed, contact], outputs=[out])
    return out.numpy()


@pytest.mark.parametrize(
    "process",
    [
        Knots(sigma_s=0.015, sigma_k=0.023, spacing=0.01),
        Knots(sigma_s=0.015, sigma_k=0.023, spacing=0.01, cross_correlation=0.7),
        Knots(sigma_s=0.05, sigma_k=0.05, spacing=0.01, distribution_s=Lognormal(), distribution_k=Uniform()),
        Knots(sigma_s=0.0, sigma_k=0.02, spacing=0.1, distribution_s=Empirical(tuple(np.linspace(0.7, 0.9, 31)))),
        OrnsteinUhlenbeck(sigma_s=0.015, sigma_k=0.023, correlation_time=0.05),
        Matern(sigma_s=0.015, sigma_k=0.023, correlation_time=0.05),
    ],
    ids=["knots", "cross_correlated", "lognormal", "empirical", "ornstein_uhlenbeck", "matern"],
)
def test_coefficient_paths_are_the_cpus(process):
    law = make_law("coulomb", mu_s=0.8, mu_k=0.46)
    times = np.arange(0.0, 1.0, 1e-3)
    result = coefficient_paths(process, law, times, 7, 3, 4)
    for world in range(4):
        expected = CoefficientPath(process, law, seed=7, sample=world, contact=3).at_times(times)
        assert np.abs(result[world] - expected).max() < 1e-14  # plain IEEE operations; exp, log and erfc are libm's


def test_mixed_types_follow_numbas_rules():
    def mixed(x):
        n = int(x)
        total = 0.0
        for i in range(n):
            if i % 2 == 0:
                total += i / 2
            else:
                total -= 0.25 * i**2
        a, b = total, x
        a, b = b, a
        return a - b if 0.0 < x < 100.0 else math.copysign(1.0, -b)

    translator = Translator(wp.float64)
    (function,) = translator.functions(translator.add(mixed, (REAL,)))

    @wp.kernel(module="unique", enable_backward=False)
    def kernel(x: wp.array[wp.float64], out: wp.array[wp.float64]):
        i = wp.tid()
        out[i] = function(x[i])

    x = np.array([0.5, 3.7, 8.0, 120.0])
    out = wp.zeros(4, dtype=wp.float64)
    wp.launch(kernel, dim=4, inputs=[wp.array(x, dtype=wp.float64)], outputs=[out])
    assert np.abs(out.numpy() - [mixed(v) for v in x]).max() < 1e-12


def test_what_has_no_counterpart_is_refused_with_its_line():
    def worse(x):
        return [x, x]

    line = worse.__code__.co_firstlineno + 1  # of this file
    with pytest.raises(UntranslatableError, match=rf"worse, line {line}: List cannot run in Warp"):
        Translator().add(worse, (REAL,))
    with pytest.raises(UntranslatableError, match="5 arguments, but 1 are given"):
        Translator().add(slip_coefficient, (REAL,))
