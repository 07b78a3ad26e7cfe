"""What an effect leaves in the slips of a record: the regressors by which it is screened for."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Columns = list[Array]


class Slips(Protocol):
    """The slips of all runs of a data set one after the other; arrays have shape (n,) unless said otherwise."""

    @property
    def run(self) -> npt.NDArray[np.int64]:
        """Number of the run."""
        ...

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        ...

    @property
    def duration(self) -> float:
        """Length of the longest record [s]."""
        ...

    @property
    def onset_time(self) -> Array:
        """Break-away [s], since the start of the record."""
        ...

    @property
    def restick_time(self) -> Array:
        """Re-stick [s]."""
        ...

    @property
    def node_time(self) -> Array:
        """Times in the slip at which forces are wanted [s], shape (n, nodes)."""
        ...

    @property
    def mean_time(self) -> Array:
        """Middle of the slip [s]."""
        ...

    @property
    def typical_onset(self) -> Array:
        """The run's median break-away position [m]."""
        ...

    @property
    def typical_position(self) -> Array:
        """Position in the run's median slip, scaled to this slip's onset [m], shape (n, nodes)."""
        ...

    @property
    def node_velocity(self) -> Array:
        """Velocity of the box [m/s], shape (n, nodes)."""
        ...

    @property
    def node_acceleration(self) -> Array:
        """Its acceleration [m/s^2], shape (n, nodes)."""
        ...

    @property
    def relative_velocity(self) -> Array:
        """Speed of the box relative to the belt [m/s], shape (n, nodes)."""
        ...

    @property
    def slip_distance(self) -> Array:
        """Relative displacement since break-away [m], shape (n, nodes)."""
        ...

    @property
    def dwell(self) -> Array:
        """Time in stick before the break-away, predicted from where the last slip ended [s]."""
        ...

    @property
    def normal_force(self) -> Array:
        """Normal force [N]."""
        ...

    @property
    def belt_velocity(self) -> Array:
        """Belt velocity [m/s], positive."""
        ...

    @property
    def direction(self) -> Array:
        """-1 in runs with a reversed belt, otherwise 1."""
        ...

    @property
    def static(self) -> Array:
        """The run's median force at break-away [N]."""
        ...

    @property
    def kinetic(self) -> Array:
        """The run's median friction force in slip [N]."""
        ...

    def column(self, at_onset: Array | None, in_slip: Array | None) -> Array:
        """Return a regressor from its force at break-away and its force in the slip.

        Args:
            at_onset: change of the break-away force for a unit of the effect [N], shape (n,); None: none.
            in_slip: change of the friction force in slip [N], shape (n,) or (n, nodes); None: none.
        """
        ...

    def per_run(self, value: Callable[[Any], float]) -> Array:
        """Return a number of each run, repeated for its slips."""
        ...


@dataclasses.dataclass(frozen=True)
class Hypothesis:
    """One way in which an effect may be present."""

    kind: str
    """The effect."""
    columns: Columns
    """Its regressors, made by `Slips.column`; the first-order change when the effect is switched on."""
    setting: tuple[float, ...] = ()
    """Values of the parameters that enter nonlinearly; one hypothesis a point of their grid."""
    start: Callable[[Array], dict[str, Any]] = lambda _: {}
    """From the fitted coefficients to values of the effect's parameters, where a fit may start."""
    variant: str = ""
    """Which of several forms of the effect; the best of each form is followed up."""
