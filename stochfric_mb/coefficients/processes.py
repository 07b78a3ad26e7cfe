"""Coefficient processes: how mu_s and mu_k vary along time, belt position or events."""

from __future__ import annotations

import dataclasses
import math
import warnings
from typing import Any, ClassVar, cast

import numpy as np
import numpy.typing as npt

from stochfric_mb.coefficients.distributions import Distribution, Normal
from stochfric_mb.errors import InputError, require_number
from stochfric_mb.laws.contract import Law


class FeasibilityWarning(UserWarning):
    """Random pairs often violate 0 <= mu_k < mu_s, so that rejection (or clipping) changes their distributions."""


INDEPENDENT, ORNSTEIN_UHLENBECK, MATERN = 1.0, 2.0, 3.0
TIME, POSITION, EVENT = 0.0, 1.0, 2.0
NORMAL = Normal()
HEADER = 20
"""Entries of a descriptor before the quantile tables."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Process:
    """A random path of feasible pairs (mu_s, mu_k) around the means of a law."""

    sigma_s: float
    """Standard deviation of mu_s [-], >= 0."""
    sigma_k: float
    """Standard deviation of mu_k [-], >= 0."""
    distribution_s: Distribution = NORMAL
    """Marginal distribution of mu_s."""
    distribution_k: Distribution = NORMAL
    """Marginal distribution of mu_k."""
    cross_correlation: float = 0.0
    """Correlation of the standard normals that mu_s and mu_k are drawn from [-], -1 to 1: 1, both scatter together."""

    kind: ClassVar[str]
    """Name in scenario files."""
    equation: ClassVar[str]
    """The process in one line."""
    source: ClassVar[str]
    """Where it comes from."""
    code: ClassVar[float] = INDEPENDENT
    """Number of the process in compiled code."""
    clock: ClassVar[float] = TIME
    """What the path runs along: time, relative displacement (belt position) or the number of stick phases."""
    linear: ClassVar[bool] = True
    """Whether the path is linear between knots (otherwise it holds the knot's value)."""

    def __post_init__(self) -> None:
        require_number("sigma_s", self.sigma_s, low=0.0)
        require_number("sigma_k", self.sigma_k, low=0.0)
        require_number("cross_correlation", self.cross_correlation, low=-1.0, high=1.0)

    @property
    def knot_spacing(self) -> float:
        """Distance between knots [s, m or 1]."""
        return 1.0

    @property
    def correlation(self) -> float:
        """Correlation time or length [s or m], 0 where draws are independent."""
        return 0.0

    def descriptor(self, law: Law) -> npt.NDArray[np.float64]:
        """Return the numbers that compiled code needs, shape (HEADER + tables,).

        Raises:
            InputError: infeasible pairs (mu_k >= mu_s or mu_k < 0) are beyond reason.

        Warns:
            FeasibilityWarning: below d = (mu_s - mu_k)/sigma = 2, sigma being the standard deviation of mu_s - mu_k.
        """
        self._check_feasible(law)
        tables = [self.distribution_s.quantile_table(), self.distribution_k.quantile_table()]
        head = np.zeros(HEADER)
        head[:16] = (
            self.code, self.clock, float(self.linear), self.knot_spacing, law.mu_s, law.mu_k, self.sigma_s, self.sigma_k,
            self.distribution_s.code, self.distribution_k.code, self.distribution_s.low, self.distribution_s.high,
            self.distribution_k.low, self.distribution_k.high, self.correlation, len(tables[0]),
        )  # fmt: skip
        head[16:18] = len(tables[1]), self.cross_correlation
        return np.concatenate([head, *tables])

    def to_dict(self) -> dict[str, Any]:
        """Return the process as the ``[coefficients]`` table of a scenario."""
        table: dict[str, Any] = {"process": self.kind}
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if value == field.default:
                continue
            table[field.name] = value
            if isinstance(value, Distribution):
                table[field.name] = {"kind": value.kind} | {
                    k: list(cast(tuple[float, ...], v)) if isinstance(v, tuple) else v
                    for k, v in dataclasses.asdict(value).items()
                }
        return table

    def _check_feasible(self, law: Law) -> None:
        both = self.sigma_s**2 + self.sigma_k**2 - 2.0 * self.cross_correlation * self.sigma_s * self.sigma_k
        spread = math.sqrt(max(both, 0.0))
        if spread == 0.0:
            return
        d = (law.mu_s - law.mu_k) / spread
        infeasible = 0.5 * math.erfc(d / math.sqrt(2.0))
        text = (
            f"mu_s = {law.mu_s:g} and mu_k = {law.mu_k:g} are {d:.2f} joint standard deviations apart: about "
            f"{100 * infeasible:.2g} % of the pairs have mu_k >= mu_s"
        )
        if d < 0.25:
            raise InputError(f"{text}; give smaller sigma_s, sigma_k or means further apart (d >= 2)")
        if d < 2.0:
            what = "redrawn" if self.code == INDEPENDENT else "clipped"
            warnings.warn(f"{text} and are {what}, which shifts their means", FeasibilityWarning, stacklevel=3)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Knots(Process):
    """Independent pairs at a fixed physical spacing in time, linear between: the path does not know any step size."""

    spacing: float
    """Distance between knots [s], > 0."""

    kind: ClassVar[str] = "knots"
    equation: ClassVar[str] = "independent pairs every `spacing` seconds, linear between"
    source: ClassVar[str] = "Kang, Choi and Yoo 2015, section 2.2, with the spacing made a physical parameter"

    def __post_init__(self) -> None:
        super().__post_init__()
        require_number("spacing", self.spacing, above=0.0, unit="s")

    @property
    def knot_spacing(self) -> float:
        """Distance between knots [s]."""
        return self.spacing


@dataclasses.dataclass(frozen=True, kw_only=True)
class OutputStep(Knots):
    """The paper's own process: one pair per output step. Its response depends on the output step; for comparison only.

    ``spacing`` is the scenario's output step.
    """

    kind: ClassVar[str] = "output_step"
    equation: ClassVar[str] = "independent pairs every output step, linear between (results depend on the output step)"
    source: ClassVar[str] = "Kang, Choi and Yoo 2015, section 2.2"


@dataclasses.dataclass(frozen=True, kw_only=True)
class OrnsteinUhlenbeck(Process):
    """A stationary Ornstein-Uhlenbeck process, sampled exactly every ``spacing`` and linear between."""

    correlation_time: float
    """Time in which the correlation falls to 1/e [s], > 0."""
    spacing: float | None = None
    """Distance between knots [s], > 0; correlation_time/20 if not given."""

    kind: ClassVar[str] = "ornstein_uhlenbeck"
    equation: ClassVar[str] = "f' = a f + sqrt(1 - a^2) z, a = exp(-spacing/correlation_time); mu = F(f)"
    source: ClassVar[str] = "Uhlenbeck and Ornstein 1930; exact discretisation"
    code: ClassVar[float] = ORNSTEIN_UHLENBECK

    def __post_init__(self) -> None:
        super().__post_init__()
        require_number("correlation_time", self.correlation_time, above=0.0, unit="s")
        if self.spacing is not None:
            require_number("spacing", self.spacing, above=0.0, unit="s")

    @property
    def knot_spacing(self) -> float:
        """Distance between knots [s]."""
        return self.correlation_time / 20.0 if self.spacing is None else self.spacing

    @property
    def correlation(self) -> float:
        """Correlation time [s]."""
        return self.correlation_time


@dataclasses.dataclass(frozen=True, kw_only=True)
class Matern(OrnsteinUhlenbeck):
    """A stationary Gaussian process with the Matern-3/2 correlation, sampled exactly every ``spacing``."""

    kind: ClassVar[str] = "matern"
    equation: ClassVar[str] = "correlation (1 + l) exp(-l), l = sqrt(3) abs(dt)/correlation_time; exact state space"
    source: ClassVar[str] = "Hartikainen and Sarkka 2010, doi 10.1109/MLSP.2010.5589113"
    code: ClassVar[float] = MATERN


@dataclasses.dataclass(frozen=True, kw_only=True)
class Spatial(Process):
    """A field along the belt: independent pairs at fixed belt positions, linear between."""

    spacing: float
    """Distance between knots [m], > 0: the field's correlation length."""

    kind: ClassVar[str] = "spatial"
    equation: ClassVar[str] = "independent pairs every `spacing` metres of relative displacement, linear between"
    source: ClassVar[str] = "a field mu(belt position)"
    clock: ClassVar[float] = POSITION

    def __post_init__(self) -> None:
        super().__post_init__()
        require_number("spacing", self.spacing, above=0.0, unit="m")

    @property
    def knot_spacing(self) -> float:
        """Distance between knots [m]."""
        return self.spacing


@dataclasses.dataclass(frozen=True, kw_only=True)
class PerEvent(Process):
    """One pair for each stick phase and the slip that ends it."""

    kind: ClassVar[str] = "per_event"
    equation: ClassVar[str] = "one independent pair per stick phase, kept until the contact sticks again"
    source: ClassVar[str] = "a new junction for every stick phase"
    clock: ClassVar[float] = EVENT
    linear: ClassVar[bool] = False


PROCESSES: dict[str, type[Process]] = {p.kind: p for p in (Knots, OutputStep, OrnsteinUhlenbeck, Matern, Spatial, PerEvent)}
"""Kind of a process -> its class."""
