"""A run: one record in SI units on a uniform time grid, with what is known about how it was taken.

A run read from a file and one made of arrays pass the same checks, here.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError, require_name, require_number
from stochfric_mb.measurement.quantities import KNOWN
from stochfric_mb.measurement.sampling import Places, require_finite, require_growing, require_interval

if TYPE_CHECKING:
    from stochfric_mb.scenario import Scenario

Array = npt.NDArray[np.float64]
Role = Literal["fit", "test"]


@dataclasses.dataclass(frozen=True, kw_only=True)
class Run:
    """One record: channels in SI units over a uniform time; lists and columns of pandas become arrays.

    Raises:
        InputError: columns that are no numbers, of unlike length or not finite, a time that does not grow or is not uniform, a
            channel in another unit, or an unknown role; names run, column and remedy.
    """

    name: str
    """Name of the run, unique in its dataset."""
    role: Role
    """``fit``: models are fitted to it; ``test``: held out, only scored."""
    time: Array
    """Time [s], float64[n], uniform; it starts as in the file."""
    channels: Mapping[str, Array]
    """Known quantities: name -> float64[n] in SI units (see `units`)."""
    settings: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Known operating conditions that differ from the scenario's ``[mechanism]``: key -> value in SI units."""
    covariates: Mapping[str, Array] = dataclasses.field(default_factory=dict[str, Array])
    """Columns of other names: name -> float64[n] in the file's own units."""
    units: Mapping[str, str] = dataclasses.field(default_factory=dict[str, str])
    """Unit of each channel, an SI unit, and of each covariate, of any kind; empty: the file does not say it."""
    file_units: Mapping[str, str] = dataclasses.field(default_factory=dict[str, str])
    """Unit of time and of each channel as its file (or the dataset) says it."""
    turned: tuple[str, ...] = ()
    """Channels that the dataset turns round, by ``sign``."""
    constants: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Single numbers that the file holds beside its columns, in its own units."""
    sample_interval: float
    """Distance between samples [s]."""
    source: str = ""
    """File that the run, or the record of which it is a piece, was read from; empty: none."""
    notes: tuple[str, ...] = ()
    """What a reader of results should know: interpolation, constant channels, columns left out."""

    def __post_init__(self) -> None:
        where = self.source or f"run {self.name!r}"
        require_role(where, self.role)
        time = _numbers(where, "time", self.time)
        places = Places(where, np.arange(time.size, dtype=np.int64), "sample")
        require_growing(time, places)
        require_interval(time, self.sample_interval, places)
        columns = [{k: _numbers(where, k, v) for k, v in group.items()} for group in (self.channels, self.covariates)]
        for name, values in (pair for group in columns for pair in group.items()):
            if values.size != time.size:
                raise InputError(
                    f"{where}: {name} has {values.size} samples but time has {time.size}; give a value at each time"
                )
        channels, covariates = columns
        for name, values in channels.items():
            require_finite(name, values, places)
            _require_si(where, name, self.units.get(name, ""))
        missing = [k for k, v in covariates.items() if not np.isfinite(v).all()]
        notes = (*self.notes, *(f"covariate {k!r} has missing values and is left out" for k in missing))
        kept = {k: v for k, v in covariates.items() if k not in missing}
        for field, value in (("time", time), ("channels", channels), ("covariates", kept), ("notes", notes)):
            object.__setattr__(self, field, value)

    def mechanism(self, scenario: Scenario[Any]) -> Any:
        """Return the scenario's mechanism with the settings of this run.

        Raises:
            InputError: a setting is no number of that mechanism, or out of its range; names run and key.
        """
        return apply_settings(scenario, self.settings, f"run {self.name!r}")

    def between(self, start: float, end: float, *, name: str, role: Role) -> Run:
        """Return the samples with ``start`` <= time < ``end`` [s] as a run of its own."""
        kept = (self.time >= start) & (self.time < end)
        return dataclasses.replace(
            self,
            name=name,
            role=role,
            time=self.time[kept],
            channels={k: v[kept] for k, v in self.channels.items()},
            covariates={k: v[kept] for k, v in self.covariates.items()},
        )


def require_role(where: str, role: object) -> None:
    """Return if a role is one.

    Raises:
        InputError: it is not; begins with ``where``.
    """
    if role not in get_args(Role):
        raise InputError(f'{where}: role = {role!r}; it is "fit" (used to fit) or "test" (held out)')


def _numbers(where: str, name: str, values: object) -> Array:
    """Return a column as float64[n]."""
    try:
        numbers = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(
            f"{where}: {name} is not a column of numbers ({type(values).__name__}); give one number a time"
        ) from None
    if numbers.ndim != 1:
        raise InputError(f"{where}: {name} has shape {numbers.shape}; give one number a time, shape (n,)")
    return numbers


def _require_si(where: str, name: str, unit: str) -> None:
    """Require that the unit of a channel, if it is said, is an SI unit of its quantity, or K, in which temperatures stay."""
    if not unit or name not in KNOWN:
        return
    known = KNOWN[name].units_of(None)
    if unit not in (*known, *(("K",) if name == "temperature" else ())):
        raise InputError(
            f"{where}: units.{name} = {unit!r}, but channels are in SI units, which `units` of a run only names: convert the "
            f"array to {' or '.join(known)}" + (", such as np.radians(degrees)" if "deg" in unit else "")
        )


def apply_settings(scenario: Scenario[Any], settings: Mapping[str, float], where: str) -> Any:
    """Return the scenario's mechanism with ``settings`` in the place of its own numbers.

    Raises:
        InputError: a key is no number of that mechanism, or out of its range; begins with ``where``.
    """
    mechanism = scenario.mechanism
    numbers = [f.name for f in dataclasses.fields(mechanism) if isinstance(getattr(mechanism, f.name), int | float)]
    try:
        values = {
            require_name(f"key of set (mechanism {mechanism.kind})", key, numbers): require_number(f"set.{key}", value)
            for key, value in settings.items()
        }
        return dataclasses.replace(mechanism, **values)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
