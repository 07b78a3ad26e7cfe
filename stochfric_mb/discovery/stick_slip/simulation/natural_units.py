"""A rig's own units: its normal force, how far that stretches the spring, and the time in which it swings by one radian.

Numbers of the method that would have a dimension count in them; they were set on the rig of Kang, Choi and Yoo 2015, Table 1,
where these units are 13 N, 3.29 mm and 39.2 ms.
"""

from __future__ import annotations

import dataclasses
import re

from stochfric_mb.discovery.stick_slip.records.record import Record

_BASE: dict[str, tuple[int, int, int]] = {
    "N": (1, 0, 0), "m": (0, 1, 0), "s": (0, 0, 1), "kg": (1, -1, 2), "Hz": (0, 0, -1),
}  # fmt: skip
"""Unit -> exponents of force, length and time; other units (rad, K) have none of them."""
_FACTOR = re.compile(r"([A-Za-z°%]+)\^?([+-]?\d+)?")


def exponents(unit: str) -> tuple[int, int, int]:
    """Return the exponents of force, length and time in a unit such as ``N s^2/m^2``."""
    total = [0, 0, 0]
    for place, part in enumerate(unit.split("/")):
        for name, power in _FACTOR.findall(part):
            for i, exponent in enumerate(_BASE.get(name, (0, 0, 0))):
                total[i] += (1 if place == 0 else -1) * exponent * int(power or 1)
    return total[0], total[1], total[2]


@dataclasses.dataclass(frozen=True)
class NaturalUnits:
    """Units in which all rigs are alike, and how long they were recorded."""

    force: float
    """Normal force N [N]."""
    length: float
    """Deflection N/k of the spring under it [m]."""
    time: float
    """Time sqrt(m/k) in which the natural oscillation turns by one radian [s]."""
    duration: float = 0.0
    """Length of the record [s]: a wave in it is known to one over it; 0: not known."""
    belt_velocity: float = 0.0
    """Belt velocity [m/s], positive."""

    @classmethod
    def of_run(cls, record: Record) -> NaturalUnits:
        """Return the units of the rig of a run."""
        box, time = record.mechanism, 1.0 / record.angular_frequency
        return cls(box.normal_force, record.deflection, time, record.duration, box.belt_velocity)

    def of(self, unit: str) -> float:
        """Return the natural unit of a quantity, over its SI unit [-]; 1 for numbers, angles and temperatures."""
        force, length, time = exponents(unit)
        return self.force**force * self.length**length * self.time**time
