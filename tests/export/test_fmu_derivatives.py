"""Directional derivatives of the friction element: the law's own source with numbers that carry their derivative."""

import ctypes
import re
import zipfile

import numpy as np
import pytest

from stochfric_mb.coefficients import Spatial
from stochfric_mb.export.exported import Exported
from stochfric_mb.laws import LAWS, make_law

from .fmus import Driven, built, table_1_fmu

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


def derivatives(fmu, direction):
    unknown = [fmu.variables[n].valueReference for n in OUTPUTS]
    known = [fmu.variables[n].valueReference for n in INPUTS]
    if fmu.fmi == 3:
        return np.array(fmu.fmu.getDirectionalDerivative(unknown, known, direction.tolist()))
    out = (ctypes.c_double * len(unknown))()
    fmu.fmu.fmi2GetDirectionalDerivative(
        fmu.fmu.component, (ctypes.c_uint * len(unknown))(*unknown), len(unknown), (ctypes.c_uint * len(known))(*known),
        len(known), (ctypes.c_double * len(known))(*direction), out,
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
        here = derivatives(fmu, direction)
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
def test_the_belt_box_has_none_and_says_so(fmi):
    assert offered(table_1_fmu(fmi=fmi, mechanism=True)) == 0
