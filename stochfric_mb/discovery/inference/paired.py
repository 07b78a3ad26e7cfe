"""Two models compared on the same held-out parts: windows of forecasts, or strokes and blocks left out of the fits."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.stats import wilcoxon

Array = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Paired:
    """Errors of two models on the same parts."""

    without: float
    """Mean error of the first model."""
    with_: float
    """Mean error of the second one."""
    deviation: float
    """Standard error of the mean difference; nan with fewer than two parts."""
    better: int
    """Parts on which the second model is better."""
    worse: int
    """Parts on which it is worse."""
    parts: int
    """Number of parts."""
    p_value: float
    """Chance of as much better a second model where both are equal: Wilcoxon's signed ranks, parts taken as independent [-]."""

    @property
    def share_better(self) -> float:
        """Share of the parts that the second model makes better [-]."""
        return self.better / self.parts

    @property
    def rms_gain(self) -> float:
        """Part of the root mean square that the second model takes away, where errors are sums of squares [-]."""
        return 1.0 - float(np.sqrt(self.with_ / self.without))


def paired(without: Array, with_: Array) -> Paired:
    """Return the comparison of two models by their errors on the same parts, shape (n,) each, n >= 1."""
    fall = without - with_
    n = len(fall)
    ranked: Any = wilcoxon(fall, alternative="greater") if np.any(fall != 0.0) else None
    return Paired(
        float(without.mean()),
        float(with_.mean()),
        float(np.std(fall, ddof=1) / np.sqrt(n)) if n > 1 else float("nan"),
        int(np.count_nonzero(fall > 0.0)),
        int(np.count_nonzero(fall < 0.0)),
        n,
        1.0 if ranked is None else float(ranked.pvalue),
    )
