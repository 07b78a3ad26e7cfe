"""An effect of another package is found at a driven joint by what it says of itself."""

import dataclasses
import sys
from typing import ClassVar

import numpy as np
import pytest

from stochfric_mb import effects
from stochfric_mb.discovery import discover
from stochfric_mb.effects.contract import MU_K, POSITION, Effect, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.measurement import Dataset
from tests.discovery.joints.test_parts import coulomb, scenario, sine_run

PLACE, HEIGHT, WIDTH = 0.03, 0.6, 0.012


@dataclasses.dataclass(frozen=True, kw_only=True)
class Burr(Effect):
    """mu_k times 1 + height exp(-((x - place)/width)^2/2)."""

    height: float = parameter("-", "relative height", scale=0.1)
    place: float = parameter("m", "where it is", scale=0.01)
    width: float = parameter("m", "its width", scale=0.01, low=0.0, strict=True)

    kind: ClassVar[str] = "burr"
    equation: ClassVar[str] = "mu_k times 1 + height exp(-((x - place)/width)^2/2)"
    source: ClassVar[str] = "this test"
    group: ClassVar[str] = "friction varies"
    order: ClassVar[int] = 3

    @classmethod
    def at_joint(cls, span: JointSpan) -> JointSignature:
        """Return bumps over the stroke."""
        places = span.stroke * np.linspace(-0.4, 0.4, 9)
        return JointSignature(tuple(cls(height=0.1, place=float(p), width=0.08 * span.stroke) for p in places), "position", 3)


def friction(world, memory, rates, p):
    away = (world[POSITION] - p[1]) / p[2]
    world[MU_K] *= 1.0 + p[0] * 2.718281828459045 ** (-0.5 * away * away)


@pytest.fixture
def registered():
    assert sys.modules[Burr.__module__] is not None
    effects.register_effect(Burr)
    yield
    effects.EFFECTS.pop("burr")


@pytest.mark.usefixtures("registered")
def test_it_is_found_with_its_place_and_height():
    def force(q, v):
        return coulomb(q, v) * (1.0 + HEIGHT * np.exp(-0.5 * ((q - PLACE) / WIDTH) ** 2))

    runs = tuple(sine_run(force, seed=s, role=role) for s, role in ((1, "fit"), (2, "test")))
    result = discover(Dataset(title="", scenario_path=None, scenario=scenario(), runs=runs)).result
    assert [e.kind for e in result.effects] == ["burr"]
    parameters = result.effects[0].parameters
    assert parameters["place"].value == pytest.approx(PLACE, abs=1.0e-3)  # a tenth of its width
    assert parameters["height"].value == pytest.approx(HEIGHT, rel=0.05)
