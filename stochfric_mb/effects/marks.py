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
    def slips(self) -> tuple[Any, ...]:
        """The slips run by run, each with its ``record``, which holds ``mechanism`` and ``angular_frequency``."""
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
    def slid_before(self) -> Array:
        """Distance slid at the break-away since the record began [m]."""
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

    def temperature(self, time: Array) -> Array | None:
        """Return the measured temperature [degC] at times in the slips [s], shape (n,) or (n, nodes); None: a run has none."""
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


WAVE = "wave"
"""Variant of the hypothesis of a wave, see `Wave`."""
COURSE_OF_ANY_SHAPE = "course of any shape"
"""Variant of that of a course in time that is not held to a form."""
RETURNING = "course that comes back"
"""Variant of that of a wave of any smooth shape, the same in all runs but for where it begins."""
ENTRAINED = "entrained wave"
"""Variant of that of a wave to which the slips keep, so that it shapes all of them alike."""


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


@dataclasses.dataclass(frozen=True)
class Wave:
    """Where a wave runs and what it modulates."""

    place: Array
    """Time, or belt coordinate over the slowest belt velocity, at the break-away and at the nodes [s], (n, 1 + N_NODES)."""
    weight: Array
    """Force that is modulated there [N], shape (n, 1 + N_NODES)."""
    setting: Callable[[float], float]
    """From the frequency [Hz] to the parameter of the effect."""
    pace: float = 1.0
    """How much faster a typical run passes the place than the slowest one [-]."""
    returning: Callable[..., dict[str, Any]] | None = None
    """From ``weights`` of a course that comes back with each wave (`stochfric_mb.effects.shapes.splines.returning`), its
    ``pieces`` and its `setting` to values of the effect's parameters; None: it has no such form."""
    turned: bool = False
    """Whether a mirrored run passes it the other way."""


def apart(
    kind: str, static: Array, kinetic: Array, slips: Slips, name: str, more: dict[str, float], unit: float = 1.0
) -> list[Hypothesis]:
    """Return a change of both coefficients by the same share, and one of each by its own.

    Args:
        kind: the effect.
        static: change of the onset force for a unit of the parameter [N], shape (n,).
        kinetic: change of the force in slip [N], shape (n,).
        slips: the slips.
        name: the parameter.
        more: further parameters.
        unit: parameter for a coefficient of one.
    """

    def alike(b: Array) -> dict[str, float]:
        return more | {name: float(b[0] * unit)}

    def each(b: Array) -> dict[str, float]:
        kinetic_share = b[1] if abs(b[1]) > 0.01 * abs(b[0]) else 0.01 * abs(b[0]) + 1.0e-9
        return more | {name: float(kinetic_share * unit), "static_share": float(b[0] / kinetic_share)}

    return [
        Hypothesis(kind, [slips.column(static, kinetic)], (), alike),
        Hypothesis(kind, [slips.column(static, None), slips.column(None, kinetic)], (), each, variant="apart"),
    ]


def levels(slips: Slips) -> tuple[Array, Array]:
    """Return static and kinetic friction where the same coefficients hold in all runs [N], shape (n,).

    Were they each run's own, a course that is there at once and stays would stand for whatever differs between the runs.
    """
    load = slips.normal_force
    return load * float(np.median(slips.static / load)), load * float(np.median(slips.kinetic / load))


def drifting(kind: str, at_onset: Array, inside: Array, last: float, slips: Slips, settles: str) -> list[Hypothesis]:
    """Return friction that drifts along a quantity that grows in each run, linearly or towards a limit.

    Args:
        kind: the effect, with the parameter ``rate``.
        at_onset: the quantity at the break-away, shape (n,).
        inside: the same in the middle of the slip, shape (n,).
        last: its largest value.
        slips: the slips.
        settles: parameter in which the drift settles.
    """
    held, rubbing = levels(slips)
    result = apart(kind, held * at_onset / last, rubbing * inside / last, slips, "rate", {}, 1.0 / last)
    # neighbours differ by a fifth: a coarser grid would leave a clear record to what names no physics
    for tau in map(float, np.geomspace(0.03, 1.0, 22) * last):
        static, kinetic = (level * -np.expm1(-s / tau) for level, s in ((held, at_onset), (rubbing, inside)))
        result += apart(kind, static, kinetic, slips, "rate", {settles: tau}, 1.0 / tau)
    return result


def times(slips: Slips) -> Array:
    """Return the times of break-away and nodes [s], shape (n, 1 + nodes)."""
    return np.concatenate([slips.onset_time[:, None], slips.node_time], axis=1)


def friction_at(slips: Slips) -> Array:
    """Return the typical force at break-away and in slip [N], shape (n, 1 + nodes)."""
    return np.concatenate([slips.static[:, None], np.repeat(slips.kinetic[:, None], slips.node_time.shape[1], axis=1)], axis=1)
