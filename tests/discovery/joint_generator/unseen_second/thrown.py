"""Friction of short slides."""

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import Effect, Generator
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

THROWN, MU = ("thrown",), 0.26


@form("random_coefficients", on=THROWN)
def skewed_throws(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Johnson, Kotz and Balakrishnan 1994 (a gamma distribution, a new draw each slide)."""
    spread = 0.1 * strength

    def law(rng: Generator) -> Throw:
        mu = MU * rng.gamma(1.0 / spread**2, spread**2)
        return Throw(lambda v, x: mu)

    return Effect({"spread": spread}, law=law)


@form("position_dependent_friction", also=("velocity_weakening", "frictional_lag"), on=THROWN)
def ramp_of_paint(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Yu, Bauza, Fazeli and Rodriguez 2016 (a table whose friction changes along it)."""
    slope = 0.9 * strength
    return Effect({"slope": slope}, law=lambda _: Throw(lambda v, x: MU * (1.0 + slope * (x - 0.15)), starts=(0.7, 1.5)))


@form("unknown", also=("impacts", "position_dependent_friction"), on=THROWN)
def hops(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Stronge 2000 (a block that hops: without friction over 40 mm, at another place each time)."""
    share = 1.0 * strength

    def law(rng: Generator) -> Throw:
        at = rng.uniform(0.05, 0.2)
        return Throw(lambda v, x: MU * (1.0 - share * (at < x < at + 0.04)))

    return Effect({"share": share}, law=law)


@form("none", on=THROWN)
def any_start(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Starts from 0.8 to 1.8 m/s, read three times as badly."""
    return Effect(law=lambda _: Throw(lambda v, x: MU, starts=(0.8, 1.8), noise=2.4e-4))
