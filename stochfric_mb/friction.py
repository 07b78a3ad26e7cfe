"""A friction law with the process of its coefficients: the one object that every engine takes."""

from __future__ import annotations

import dataclasses

from stochfric_mb.coefficients import CoefficientPath, Process
from stochfric_mb.errors import InputError
from stochfric_mb.laws import Law


@dataclasses.dataclass(frozen=True)
class Friction:
    """A law and, if its coefficients are random, their process.

    >>> from stochfric_mb import Coulomb, Knots
    >>> friction = Friction(Coulomb(mu_s=0.8, mu_k=0.46), Knots(spacing=0.01, sigma_s=0.015, sigma_k=0.023))
    >>> friction.path(seed=1).at(0.0) == friction.path(seed=1, contact=1).at(0.0)  # contacts are independent
    False
    """

    law: Law
    """The friction law; its mu_s and mu_k are the means."""
    process: Process | None = None
    """How the coefficients vary; None: they are constant."""

    def path(self, seed: int, sample: int = 0, contact: int = 0) -> CoefficientPath:
        """Return the coefficient path for (seed, sample, contact)."""
        return CoefficientPath(self.process, self.law, seed=seed, sample=sample, contact=contact)


def as_friction(friction: Law | Friction) -> Friction:
    """Return ``friction`` as a `Friction`, a law alone with constant coefficients.

    Raises:
        InputError: it is neither a law nor a `Friction`.
    """
    if isinstance(friction, Friction):
        return friction
    if isinstance(friction, Law):  # pyright: ignore[reportUnnecessaryIsInstance]  # callers may not be typed
        return Friction(friction)
    raise InputError(f"friction = {friction!r} is neither a law nor a Friction; pass e.g. ElasticStick(mu_s=0.8, mu_k=0.46)")
