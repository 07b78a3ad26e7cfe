"""Directional derivatives of the friction element: the law's own source with numbers that carry their derivative."""

import ctypes
import dataclasses
import math
import re
import zipfile

import numpy as np
import pytest

from stochfric_mb.coefficients import Spatial
from stochfric_mb.compile import compiled
from stochfric_mb.effects import make_effect
from stochfric_mb.export.exported import Exported, exported_scenario
from stochfric_mb.export.fmu import fmu_source
from stochfric_mb.laws import LAWS, make_law
from stochfric_mb.laws import tanh as tanh_module

from .fmus import Driven, built, table_1

INPUTS = ("relative_displacement[1]", "relative_displacement[2]", "relative_velocity[1]", "relative_velocity[2]",
          "normal_force", "holding_force[1]", "holding_force[2]", "effective_mass")  # fmt: skip
OUTPUTS = ("friction_force[1]", "friction_force[2]", "mu")
SIZES = np.array([1e-6, 1e-6, 1e-4, 1e-4, 1.0, 1.0, 1.0, 1.0])
"""Sizes of the inputs, by which directions are drawn."""


def offered(path):
    """Return how many interfaces say in the description that they offer derivatives."""
    with zipfile.ZipFile(path) as archive:
        text = archive.read("modelDescription.xml").decode()
    return len(re.findall(r'providesDirectionalDerivatives?="true"', text))


def slopes(fmu, unknown, known, direction):
    """Return the directional derivatives of variables by name."""
    u, k = ([fmu.variables[n].valueReference for n in names] for names in (unknown, known))
    if fmu.fmi == 3:
        return np.array(fmu.fmu.getDirectionalDerivative(u, k, list(direction)))
    out = (ctypes.c_double * len(u))()
    fmu.fmu.fmi2GetDirectionalDerivative(
        fmu.fmu.component, (ctypes.c_uint * len(u))(*u), len(u), (ctypes.c_uint * len(k))(*k), len(k),
        (ctypes.c_double * len(k))(*direction), out,
    )  # fmt: skip
    return np.array(out)


def outputs(fmu, x):
    for name, value in zip(INPUTS, x, strict=True):
        fmu.set(name, float(value))
    return np.array([fmu.get(n) for n in OUTPUTS])


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("kind", [k for k in LAWS if k != "augmented"])
def test_they_are_the_slopes_of_the_outputs(rng, kind, fmi):
    """Against central differences, with coefficients that vary along the displacement, wherever the law is smooth there."""
    law = make_law(kind, mu_s=0.8, mu_k=0.46)
    path = built(Exported(law, Spatial(sigma_s=0.02, sigma_k=0.02, spacing=1.0e-3)), fmi, False)
    assert offered(path) == 2
    fmu = Driven(path, seed=3, normal_force=13.0, effective_mass=6.0, relative_velocity=(1.0e-3, 0.0))
    met = large = 0
    u = np.zeros(2)
    for i in range(60):
        v = np.array([1.5e-3 * np.sin(0.3 * i) + 2e-4, 3e-4 * np.cos(0.2 * i)])
        u = u + 1.0e-3 * v
        hold = 6.0 * rng.standard_normal(2)
        x = np.array([*u, *v, 13.0 + rng.standard_normal(), *hold, 6.0])
        outputs(fmu, x)
        fmu.step(1.0e-3)
        x[:2] += 4.0e-7, 2.0e-7  # at the place of the commit itself a bristle has a kink: it gives way to both sides
        outputs(fmu, x)
        direction = SIZES * rng.standard_normal(8)
        h = 1.0e-5
        here = slopes(fmu, OUTPUTS, INPUTS, direction)
        ahead, behind = outputs(fmu, x + h * direction), outputs(fmu, x - h * direction)
        middle = outputs(fmu, x)
        slope, curvature = (ahead - behind) / (2.0 * h), np.abs(ahead - 2.0 * middle + behind) / h
        # where the curvature over h makes itself felt there is a kink between; rounding of 10 N over h is 1e-10
        smooth = curvature <= 1e-3 * (np.abs(slope) + 1.0)
        np.testing.assert_allclose(here[smooth], slope[smooth], rtol=1e-6, atol=1e-7)
        met += np.count_nonzero(smooth)
        large += np.count_nonzero(np.abs(here) > 1e-3)
    assert met > 120
    assert large > 60
    fmu.end()


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("kind", [k for k in LAWS if k != "augmented"])
def test_those_of_the_belt_box_are_the_slopes_of_its_rates(rng, kind, fmi):
    """In model exchange, along states and external force, against central differences where the law is smooth there."""
    scenario = dataclasses.replace(
        table_1(kind), process=Spatial(sigma_s=0.02, sigma_k=0.02, spacing=1.0e-3), law=make_law(kind, mu_s=0.8, mu_k=0.46)
    )
    path = built(exported_scenario(scenario), fmi, True)
    assert offered(path) == 2
    fmu = Driven(path, co_simulation=False, seed=3)
    (fmu.fmu.newDiscreteStates if fmi == 2 else fmu.fmu.updateDiscreteStates)()
    fmu.fmu.enterContinuousTimeMode()
    states = [n for n in ("position", "velocity", "bristle_deflection") if n in fmu.variables]
    unknown = [*(f"der({n})" for n in states), "friction_force", "mu"]
    known = [*states, "external_force"]
    sizes = np.array([*[1e-6, 1e-5, 1e-7][: len(states)], 0.1])
    n = len(states)

    def rates(x):
        fmu.fmu.setContinuousStates((ctypes.c_double * n)(*x[:n]), n)
        fmu.set("external_force", float(x[n]))
        return np.array([fmu.get(name) for name in unknown])

    met = large = 0
    for i in range(40):
        t, v = 1.0e-3 * i, 2.5e-3 + 1.0e-3 * np.sin(0.3 * i + 0.1)  # never at rest: see below
        x = np.array([*[2.5e-3 * t + 2e-5 * np.sin(0.2 * i), v, 3e-6 * np.cos(0.3 * i)][:n], 2.0 * rng.standard_normal()])
        fmu.fmu.setTime(t)
        rates(x)
        fmu.fmu.completedIntegratorStep()
        x[0] += 4.0e-7  # away from the kink at the place of the commit
        direction, h = sizes * rng.standard_normal(n + 1), 1.0e-3
        rates(x)
        here = slopes(fmu, unknown, known, direction)
        ahead, middle, behind = rates(x + h * direction), rates(x), rates(x - h * direction)
        slope, curvature = (ahead - behind) / (2.0 * h), np.abs(ahead - 2.0 * middle + behind) / h
        # where the curvature over h makes itself felt there is a kink between; rounding of 10 N over h is 1e-12
        smooth = curvature <= 1e-3 * np.abs(slope) + 1e-11
        np.testing.assert_allclose(here[smooth], slope[smooth], rtol=1e-5, atol=1e-10)
        met += np.count_nonzero(smooth)
        large += np.count_nonzero(np.abs(here) > 1e-6)
    assert met > 80
    assert large > 60
    fmu.end()


@pytest.mark.parametrize("kind", ["havsin", "tanh", "smooth", "piecewise_linear"])
def test_a_law_that_is_smooth_in_speed_has_its_slope_at_rest(kind):
    """Where the direction of motion has no value: an implicit solver's Jacobian of a contact that sticks."""
    fmu = Driven(built(Exported(make_law(kind, mu_s=0.8, mu_k=0.46)), 2, False), normal_force=13.0)
    at_rest = np.zeros(8)
    at_rest[4] = 13.0
    for angle in (0.0, 1.0, 2.5):
        direction = np.array([0.0, 0.0, np.cos(angle), np.sin(angle), 0.0, 0.0, 0.0, 0.0])
        outputs(fmu, at_rest)
        here = slopes(fmu, OUTPUTS[:2], INPUTS, direction)
        h = 1.0e-9
        slope = (outputs(fmu, at_rest + h * direction) - outputs(fmu, at_rest - h * direction))[:2] / (2.0 * h)
        # h over the laws' speeds of 1e-4 m/s is 1e-5: the next term of the series is its square, HAVSIN's its first power
        np.testing.assert_allclose(here, slope, rtol=0.0, atol=1e-4 * 0.8 * 13.0 / 1.0e-4)
        assert np.hypot(*here) > 1e3 or kind == "havsin"  # whose slope is 0 at rest
    fmu.end()


@pytest.mark.parametrize("fmi", [2, 3])
def test_with_effects_there_are_none_and_the_fmu_says_so(fmi):
    scenario = dataclasses.replace(table_1(), effects=(make_effect("dwell_ageing", rate=0.01),))
    assert offered(built(exported_scenario(scenario), fmi, True)) == 0


@pytest.mark.parametrize("mechanism", [False, True])
def test_a_law_without_derivatives_is_exported_without_them(monkeypatch, mechanism):
    """A law of one's own may call what has no derivative here; its forces are exported all the same."""
    monkeypatch.setattr(tanh_module, "force", compiled(force_of_erf))
    scenario = dataclasses.replace(table_1("tanh"), process=None)
    fmu = fmu_source(exported_scenario(scenario), mechanism=mechanism)
    assert "erf(" in fmu.files["stochfric.c"]
    assert "stochfric_derivative" not in fmu.files["stochfric.c"] + fmu.files["stochfric.h"]
    assert "Derivative=" not in fmu.description


def force_of_erf(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    return normal_force * mu_k * math.erf(vx / p[2]), 0.0
