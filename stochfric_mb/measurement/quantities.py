"""The quantities a measured channel can be, and the SI unit in which each is kept."""

from __future__ import annotations

import dataclasses
import re


@dataclasses.dataclass(frozen=True)
class Quantity:
    """A known quantity; what moves decides whether it is one of translation or of rotation."""

    name: str
    """Name of the channel."""
    translation: str
    """SI unit where the friction acts along a line."""
    rotation: str
    """SI unit where it acts about an axis."""
    also: tuple[str, ...] = ()
    """Other units that a file may use, for messages."""

    def units_of(self, rotational: bool | None) -> tuple[str, ...]:
        """Return the SI unit, for a mechanism that rotates or one that does not; None: for either motion, each once."""
        both = tuple(dict.fromkeys((self.translation, self.rotation)))
        return both if rotational is None else (self.rotation if rotational else self.translation,)


_ANGLE = ("deg",)
_LENGTH = ("mm", "um")
KNOWN: dict[str, Quantity] = {
    q.name: q
    for q in (
        Quantity("time", "s", "s", ("ms", "us", "min")),
        Quantity("position", "m", "rad", _LENGTH + _ANGLE),
        Quantity("velocity", "m/s", "rad/s", ("mm/s", "deg/s", "rpm")),
        Quantity("acceleration", "m/s^2", "rad/s^2", ("g_0 for multiples of gravity", "deg/s^2")),
        Quantity("force", "N", "N", ("kN", "mN")),
        Quantity("torque", "N m", "N m", ("mN m",)),
        Quantity("friction_force", "N", "N m", ("kN", "mN m")),
        Quantity("normal_force", "N", "N", ("kN", "mN")),
        Quantity("belt_velocity", "m/s", "rad/s", ("mm/s", "rpm")),
        Quantity("belt_position", "m", "rad", _LENGTH + _ANGLE),
        Quantity("temperature", "degC", "degC", ("K",)),
        Quantity("voltage", "V", "V", ("mV",)),
        Quantity("current", "A", "A", ("mA",)),
        Quantity("pressure", "Pa", "Pa", ("bar", "MPa")),
    )
}
"""Name of a quantity -> what it is; a column of any other name is a covariate. Temperatures in K stay in K."""


def split_header(header: str) -> tuple[str, str | None]:
    """Return the name and the unit in a header such as ``position [mm]`` or ``position (mm)``; None: it has no unit.

    >>> split_header("position [mm]"), split_header("stroke")
    (('position', 'mm'), ('stroke', None))
    """
    match = re.fullmatch(r"\s*(.*?)\s*[\[(]\s*([^\])]*?)\s*[\])]\s*", header)
    return (match.group(1), match.group(2) or None) if match and match.group(1) else (header.strip(), None)


def known_name(name: str) -> str | None:
    """Return the known quantity that a column's name means (``Normal force`` is ``normal_force``), or None.

    >>> known_name("Normal force"), known_name("colour")
    ('normal_force', None)
    """
    plain = re.sub(r"[\s\-]+", "_", name.strip().lower())
    return plain if plain in KNOWN else None
