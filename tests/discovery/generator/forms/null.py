"""Nothing is missing: the believed model explains the data."""

from tests.discovery.generator.rig import Rig

from .form import Effect, Generator, form


@form("none")
def wrong_parameters(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Only the parameters are off, within their uncertainty, as in every case."""
    del rng, strength, rig
    return Effect({})
