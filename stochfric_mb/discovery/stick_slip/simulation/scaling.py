"""Rigs of all sizes: a data set is brought to the size of the rig for which the method's numbers were set, and back.

Grids, first steps and limits of the method (a slip of millimetres, a tenth of a second, some newtons) are those of the rig of
Kang, Choi and Yoo 2015, Table 1. Another rig is studied in units of force, length and time of its own, in which it is
about as large. The units are powers of four of the SI ones: so a rig within a factor of two is left as it is, and
changing units and back is exact.
"""

from __future__ import annotations

import dataclasses
import math
import re
from typing import Any, TypeVar

from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.effects import Effect
from stochfric_mb.measurement.dataset import Dataset, Run
from stochfric_mb.mechanisms import BeltBox

FORCE, DEFLECTION, ANGULAR_FREQUENCY = 13.0, 13.0 / 3956.0, 25.5
"""Normal force [N], its deflection of the spring [m] and natural angular frequency [rad/s] of that rig."""
STEP = 4.0
"""Ratio of one unit of a quantity to the next [-]."""
BASE: dict[str, tuple[int, int, int]] = {
    "N": (1, 0, 0), "m": (0, 1, 0), "s": (0, 0, 1), "kg": (1, -1, 2), "Hz": (0, 0, -1),
}  # fmt: skip
"""Unit -> exponents of force, length and time; other units (rad, K) change with none of them."""
UNITS = {
    "mass": "kg", "damping": "N s/m", "stiffness": "N/m", "normal_force": "N", "belt_velocity": "m/s",
    "excitation_amplitude": "m", "excitation_angular_frequency": "rad/s", "initial_position": "m", "initial_velocity": "m/s",
    "e_lim": "m", "v_s": "m/s", "decay_velocity": "m/s", "stribeck_velocity": "m/s", "correlation_time": "s",
    "duration": "s", "output_step": "s", "sample_interval": "s", "position": "m", "velocity": "m/s", "acceleration": "m/s^2",
    "force": "N", "friction_force": "N", "belt_position": "m",
}  # fmt: skip
"""Numbers of mechanisms, laws, processes, scenarios and runs, and channels -> unit."""
_FACTOR = re.compile(r"([A-Za-z°%]+)\^?([+-]?\d+)?")

T = TypeVar("T")


def exponents(unit: str) -> tuple[int, int, int]:
    """Return the exponents of force, length and time in a unit such as ``N s^2/m^2``."""
    total = [0, 0, 0]
    for place, part in enumerate(unit.split("/")):
        for name, power in _FACTOR.findall(part):
            for i, exponent in enumerate(BASE.get(name, (0, 0, 0))):
                total[i] += (1 if place == 0 else -1) * exponent * int(power or 1)
    return total[0], total[1], total[2]


@dataclasses.dataclass(frozen=True)
class Scaling:
    """Units in which a rig is studied, in SI units."""

    force: float
    """Unit of force [N]."""
    length: float
    """Unit of length [m]."""
    time: float
    """Unit of time [s]."""

    @classmethod
    def of_rig(cls, box: BeltBox) -> Scaling:
        """Return the units in which a rig is about as large as the reference."""
        frequency = math.sqrt(box.stiffness / box.mass)
        ratios = (
            box.normal_force / FORCE, box.normal_force / box.stiffness / DEFLECTION, ANGULAR_FREQUENCY / frequency
        )  # fmt: skip
        return cls(*(STEP ** round(math.log(r, STEP)) for r in ratios))

    @property
    def usual(self) -> bool:
        """Whether they are the SI units."""
        return self.force == self.length == self.time == 1.0

    def of(self, unit: str) -> float:
        """Return the unit in which a quantity is studied, over its SI unit [-]."""
        force, length, time = exponents(unit)
        return self.force**force * self.length**length * self.time**time

    def reduced(self, dataset: Dataset) -> Dataset:
        """Return a data set in these units."""
        if self.usual:
            return dataset
        scenario = dataset.scenario
        scenario = dataclasses.replace(
            self._reduced(scenario),
            mechanism=self._reduced(scenario.mechanism),
            law=self._reduced(scenario.law),
            process=None if scenario.process is None else self._reduced(scenario.process),
            effects=tuple(self._reduced(e) for e in scenario.effects),
        )
        return dataclasses.replace(dataset, scenario=scenario, runs=tuple(self._run(r) for r in dataset.runs))

    def restored(self, model: Model) -> Model:
        """Return a model in SI units."""
        back = Scaling(1.0 / self.force, 1.0 / self.length, 1.0 / self.time)
        own = {
            run: tuple(
                {name: value * self.of(_unit(effect, name)) for name, value in values.items()}
                for effect, values in zip(model.effects, effects, strict=True)
            )
            for run, effects in model.own.items()
        }
        return dataclasses.replace(
            model,
            law=back._reduced(model.law),
            effects=tuple(back._reduced(e) for e in model.effects),
            process=None if model.process is None else back._reduced(model.process),
            own=own,
        )

    def _run(self, run: Run) -> Run:
        return dataclasses.replace(
            self._reduced(run),
            time=run.time / self.time,
            channels={name: values / self.of(UNITS.get(name, "")) for name, values in run.channels.items()},
            settings={name: value / self.of(UNITS.get(name, "")) for name, value in run.settings.items()},
        )

    def _reduced(self, given: T) -> T:
        """Return a dataclass whose numbers are in these units."""
        whole: Any = given
        numbers = {f.name: getattr(whole, f.name) for f in dataclasses.fields(whole)}
        changed = {
            name: value / self.of(_unit(whole, name))
            for name, value in numbers.items()
            if isinstance(value, float) and self.of(_unit(whole, name)) != 1.0
        }
        return dataclasses.replace(whole, **changed)


USUAL = Scaling(1.0, 1.0, 1.0)
"""SI units."""


def _unit(whole: Any, name: str) -> str:
    """Return the unit of a number of a mechanism, law, process, scenario, run or effect."""
    if isinstance(whole, Effect):
        return whole.unit_of(name)
    about = next(f.metadata for f in dataclasses.fields(whole) if f.name == name)
    if name == "spacing" and "unit" not in about:
        return "m" if whole.kind == "spatial" else "s"
    return about.get("unit", UNITS.get(name, ""))
