"""A run: one record in SI units on a uniform time grid, with what is known about how it was taken."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError, require_name, require_number

if TYPE_CHECKING:
    from stochfric_mb.scenario import Scenario

Array = npt.NDArray[np.float64]
Role = Literal["fit", "test"]


@dataclasses.dataclass(frozen=True, kw_only=True)
class Run:
    """One record: channels in SI units over a uniform time."""

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
    """Unit of each channel and covariate; empty: the file does not say it."""
    file_units: Mapping[str, str] = dataclasses.field(default_factory=dict[str, str])
    """Unit of time and of each channel as its file (or the dataset) says it."""
    constants: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Single numbers that the file holds beside its columns, in its own units."""
    sample_interval: float
    """Distance between samples [s]."""
    source: str = ""
    """File that the run, or the record of which it is a piece, was read from; empty: none."""
    notes: tuple[str, ...] = ()
    """What a reader of results should know: interpolation, constant channels, columns left out."""

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
