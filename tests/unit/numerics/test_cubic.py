"""A cubic through two points and slopes is the cubic it was taken from."""

import math

import pytest

from stochfric_mb.numerics.cubic import hermite, sign_change, slope, turning_point, value

ROUNDING = 1.0e-14
"""Some roundings of numbers of order one."""


def test_a_cubic_is_found_again():
    h, t_0 = 0.25, 1.5
    u = lambda t: 0.3 - 2.0 * t + 0.7 * t**2 + 1.1 * t**3  # noqa: E731
    v = lambda t: -2.0 + 1.4 * t + 3.3 * t**2  # noqa: E731
    c = hermite(h, u(t_0), v(t_0), u(t_0 + h), v(t_0 + h))
    for s in (0.0, 0.2, 0.5, 0.9, 1.0):
        assert value(c, s) == pytest.approx(u(t_0 + s * h), abs=ROUNDING)
        assert slope(c, s) / h == pytest.approx(v(t_0 + s * h), abs=10 * ROUNDING)


def test_the_error_falls_with_the_fourth_power_of_the_interval():
    def error(h):
        return abs(value(hermite(h, 0.0, 1.0, math.sin(h), math.cos(h)), 0.5) - math.sin(0.5 * h))

    assert error(0.1) / error(0.05) == pytest.approx(2.0**5, rel=0.01)  # h^4/384 times sin's slope, which grows with h


def test_sign_changes():
    c = (-0.006, 0.11, -0.6, 1.0)  # (s - 0.1)(s - 0.2)(s - 0.3)
    assert sign_change(c, 0.0, 0.15) == pytest.approx(0.1, abs=ROUNDING)
    assert sign_change(c, 0.15, 0.25) == pytest.approx(0.2, abs=ROUNDING)
    assert sign_change(c, 0.25, 1.0) == pytest.approx(0.3, abs=ROUNDING)
    assert sign_change(c, 0.12, 0.18) == math.inf


def test_turning_point_of_a_parabola():
    def g(t):
        return 2.0 * (t - 0.3) ** 2 - 0.05

    assert turning_point(0.0, g(0.0), 0.5, g(0.5), 1.1, g(1.1)) == pytest.approx((0.3, -0.05), abs=ROUNDING)
    assert turning_point(0.0, 1.0, 0.5, 2.0, 1.0, 3.0) == (math.inf, 2.0)
