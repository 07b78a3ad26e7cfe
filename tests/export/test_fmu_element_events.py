"""The friction element in model exchange: switches as event indicators, knots as time events, steps that are accepted."""

import numpy as np
import pytest

from stochfric_mb.contact import Contact
from stochfric_mb.export.exported import Exported
from stochfric_mb.export.variables import INDICATORS
from stochfric_mb.friction import Friction
from stochfric_mb.laws import make_law

from .fmus import Driven, built, table_1, table_1_fmu

V = 1.0e-3


def at(fmu, t, u, v):
    fmu.fmu.setTime(t)
    fmu.set("relative_displacement[1]", u)
    fmu.set("relative_velocity[1]", v)


def indicators(fmu):
    if fmu.fmi == 3:
        return np.array([fmu.get(f"event_indicator[{i + 1}]") for i in range(INDICATORS)])
    import ctypes

    z = (ctypes.c_double * INDICATORS)()
    fmu.fmu.getEventIndicators(z, INDICATORS)
    return np.array(z)


def updated(fmu):
    """Leave event mode; return when the next time event is due, None if there is none."""
    new = fmu.fmu.newDiscreteStates if fmu.fmi == 2 else fmu.fmu.updateDiscreteStates
    _, _, _, _, defined, when = new()
    fmu.fmu.enterContinuousTimeMode()
    return when if defined else None


@pytest.mark.parametrize("fmi", [2, 3])
def test_break_away_is_where_an_indicator_passes_zero(fmi):
    """Elastic stick, pulled at a steady speed: it breaks away at e_lim, to the part 1e-10 that an indicator adds."""
    law = make_law("elastic_stick", mu_s=0.8, mu_k=0.46, zeta=0.0, v_s=1.0e-2)
    fmu = Driven(built(Exported(law), fmi, False), co_simulation=False, normal_force=10.0, effective_mass=1.0)
    assert updated(fmu) is None  # constant coefficients have no knots
    assert (indicators(fmu) > 0.0).all()
    low, high = 0.0, 2.0e-5
    for _ in range(60):
        middle = 0.5 * (low + high)
        at(fmu, middle / V, middle, V)
        if (indicators(fmu) < 0.0).any():
            high = middle
        else:
            low = middle
    assert high == pytest.approx(1.0e-5, rel=2e-10)
    at(fmu, high / V, high, V)
    fmu.fmu.enterEventMode()
    assert updated(fmu) is None
    assert not fmu.get("stick")
    assert fmu.get("friction_force[1]") == pytest.approx(8.0)
    fmu.end()


@pytest.mark.parametrize("fmi", [2, 3])
def test_time_events_are_the_knots_of_the_coefficients(fmi):
    fmu = Driven(table_1_fmu(fmi=fmi), co_simulation=False, normal_force=13.0, effective_mass=6.08)
    when = updated(fmu)
    for k in range(1, 40):
        assert when == pytest.approx(0.01 * k, abs=1e-15)
        at(fmu, when, 0.0, 0.0)
        fmu.fmu.enterEventMode()
        when = updated(fmu)
    fmu.end()


@pytest.mark.parametrize("fmi", [2, 3])
def test_an_accepted_step_that_switches_asks_for_event_mode(fmi):
    """Without event location the commit switches all the same, and the forces are those of this process."""
    law, process = table_1().law, table_1().process
    fmu = Driven(table_1_fmu(fmi=fmi), co_simulation=False, seed=2, normal_force=13.0, effective_mass=6.08)
    contact = Contact(Friction(law, process), effective_mass=6.08, seed=2)
    contact.start(0.0, 0.0, 0.0, 13.0)
    updated(fmu)
    asked = []
    for i in range(1, 200):
        t, v = 1.0e-3 * i, 2.0e-3 * np.sin(0.1 * i)
        u = 2.0e-5 * (1.0 - np.cos(0.1 * i))
        at(fmu, t, u, v)
        before = contact.stick
        contact.commit(t, u, v, 13.0)
        event, stop = fmu.fmu.completedIntegratorStep()
        assert not stop
        if event:
            asked.append(contact.stick != before)
            fmu.fmu.enterEventMode()
            updated(fmu)
            contact.commit(t, u, v, 13.0)  # event mode commits once more, at the same instant
        assert fmu.get("friction_force[1]") == pytest.approx(contact.force(t, u, v, 13.0), rel=1e-12, abs=1e-12)
    assert any(asked)
    fmu.end()
