"""The contract of a dialect: parameters as another code names them, and the coefficient that they give."""

from __future__ import annotations

import dataclasses
from typing import Any, ClassVar, cast

import numpy as np
import numpy.typing as npt

from stochfric_mb.dialects.curve import Curve
from stochfric_mb.errors import InputError, require_fields, require_number, require_text

Array = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True, kw_only=True)
class Dialect:
    """Friction of another code, in its own parameters."""

    kind: ClassVar[str]
    """Name on the command line."""
    title: ClassVar[str]
    """What it is, for people."""
    equation: ClassVar[str]
    """Its equation in one line, v the speed, N the normal force."""
    source: ClassVar[str]
    """Where it is documented."""
    nearest: ClassVar[str]
    """Kind of our law that comes nearest."""
    holds: ClassVar[bool]
    """Whether it holds a load below break-away without creep."""

    def coefficient(self, speed: Array, normal_force: float) -> Array:
        """Return the friction force over the normal force [-] of steady sliding, shape (n,).

        Args:
            speed: speeds [m/s], shape (n,), > 0.
            normal_force: normal force [N].
        """
        raise NotImplementedError

    def break_away(self, normal_force: float) -> float:
        """Return the largest coefficient before sliding [-]."""
        raise NotImplementedError

    @classmethod
    def fitted(cls, curve: Curve) -> Dialect:
        """Return the parameters that come nearest to the friction of a law."""
        raise NotImplementedError

    def lost(self, curve: Curve) -> list[str]:
        """Return what of a law's friction the dialect cannot say."""
        result = [f"random coefficients: {curve.random}"] if curve.random else []
        if curve.holds and not self.holds:
            result.append("true stick: the contact creeps under any load")
        if curve.memory and curve.memory != self.memory:
            result.append(curve.memory)
        return result

    memory: ClassVar[str] = ""
    """What it remembers, in the words of `Curve.memory`."""

    def to_dict(self) -> dict[str, Any]:
        """Return the parameters by name, as TOML takes them."""
        return {f.name: getattr(self, f.name) for f in dataclasses.fields(self)}

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> Dialect:
        """Return the dialect of a table of parameters.

        Raises:
            InputError: an unknown or missing parameter, or one that is not a number.
        """
        require_fields(f"dialect {cls.kind}", cls, values)
        kinds = {f.name: str(f.type) for f in dataclasses.fields(cls)}
        return cls(**{key: _checked(key, kinds[key], value) for key, value in values.items()})


def _checked(key: str, kind: str, value: Any) -> Any:
    """Return a parameter once it is of its kind: a number, a list of numbers, or a text."""
    if kind == "float":
        return require_number(key, value)
    if kind == "str":
        return require_text(key, value)
    if not isinstance(value, list):
        raise InputError(f"{key} = {value!r} is not a list of numbers; write such as {key} = [0.0, 0.1]")
    return [require_number(f"{key}[{i}]", v) for i, v in enumerate(cast("list[Any]", value))]
