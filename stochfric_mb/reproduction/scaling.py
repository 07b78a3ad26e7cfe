"""How the cost of an ensemble grows with the number of samples and with the time simulated."""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false, reportUnknownArgumentType=false
# (SciPy is partly typed)

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import stats

from stochfric_mb import ensemble
from stochfric_mb.reproduction.claims import Number, of_estimate
from stochfric_mb.reproduction.settings import Settings
from stochfric_mb.scenario import Scenario
from stochfric_mb.statistics import Estimate

Array = npt.NDArray[np.float64]

SAMPLES, TIME = "samples", "time"
SMALLEST: Mapping[str, tuple[int, int]] = {"coulomb": (6400, 1), "havsin": (64, 1), "elastic_stick": (64, 1)}
"""Law -> samples and time [s] of its smallest ensemble: some ms of work, beside which preparation is little."""
REPEATED_UP_TO = 30
"""Multiple of the smallest ensemble up to which the best of three timings counts (short ones are the most disturbed)."""


@dataclasses.dataclass(frozen=True)
class Scaling:
    """Cost of one law along one direction."""

    law: str
    """Law."""
    along: str
    """What grows: `SAMPLES` or `TIME`."""
    size: Array
    """Samples, or time simulated [s]; shape (n,)."""
    fixed: float
    """The other of the two."""
    seconds: Array
    """Processor time of the whole ensemble on one core [s], shape (n,)."""

    def exponent(self) -> Estimate:
        """Return p of cost ~ size^p, by least squares on logarithms, with Student's interval; linear cost has p = 1."""
        fit: Any = stats.linregress(np.log(self.size), np.log(self.seconds))
        half = float(fit.stderr) * float(stats.t.ppf(0.975, len(self.size) - 2))
        return Estimate(float(fit.slope), float(fit.slope) - half, float(fit.slope) + half, 0.95)

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON."""
        return {
            "law": self.law,
            "along": self.along,
            "size": self.size.tolist(),
            "fixed": self.fixed,
            "seconds": self.seconds.tolist(),
        }


def measure(scenarios: Mapping[str, Scenario], settings: Settings, seed: int, tick: Callable[[int], None]) -> list[Scaling]:
    """Return the cost of each law's ensembles of Table 1, along samples and along time."""
    items: list[Scaling] = []
    for law, scenario in scenarios.items():
        n, t = SMALLEST[law]
        _seconds(scenario, n, t, seed)  # loads compiled code
        for along in (SAMPLES, TIME):
            sizes = [(n * m, t) if along == SAMPLES else (n, t * m) for m in settings.cost_multiples]
            taken = [
                min(_seconds(scenario, *size, seed) for _ in range(3 if m <= REPEATED_UP_TO else 1))
                for m, size in zip(settings.cost_multiples, sizes, strict=True)
            ]
            grows, fixed = (0, t) if along == SAMPLES else (1, n)
            items.append(Scaling(law, along, np.array([float(size[grows]) for size in sizes]), fixed, np.array(taken)))
            tick(len(items))
    return items


def numbers(scalings: list[Scaling]) -> tuple[Number, ...]:
    """Return the exponents as numbers of a claim."""
    return tuple(
        of_estimate(f"exponent_{s.along}_{s.law}", f"p of cost ~ {s.along}^p, {s.law}", s.exponent(), n=len(s.size),
                    group="Growth of the cost")
        for s in scalings
    )  # fmt: skip


def _seconds(scenario: Scenario, n: int, end: int, seed: int) -> float:
    longer = dataclasses.replace(scenario, duration=float(end))
    before = time.process_time()
    ensemble.run(longer, n, seed=seed, output_times=[float(end)])
    return time.process_time() - before
