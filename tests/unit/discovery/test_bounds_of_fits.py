"""What a fit may change, and how far."""

from stochfric_mb.discovery.stick_slip.simulation.model import Model, free_parameters
from stochfric_mb.discovery.stick_slip.simulation.natural_units import NaturalUnits
from stochfric_mb.effects import make_effect
from stochfric_mb.laws import make_law


def test_a_weakening_does_not_become_a_rise():
    """A fit that let friction rise with the speed found a rise of 350 times, too stiff to simulate."""
    weak = make_effect("velocity_weakening", amplitude=0.2, decay_velocity=0.01)
    model = Model(make_law("coulomb", mu_s=0.8, mu_k=0.46), {}).plus(weak)
    (amplitude,) = (k for k in free_parameters(model, {}, NaturalUnits(13.0, 3.3e-3, 0.04)) if k.name == "amplitude")
    assert amplitude.low == 0.0
    assert amplitude.high > 0.2
