"""Effects: what a model may lack. A new effect is a new file in `kinds` and one line in the registry `EFFECTS`.

Effects of other packages join by an entry point in the group `GROUP`, name = kind, value = "module:Class".
"""

from __future__ import annotations

import functools
import importlib
import importlib.metadata
from collections.abc import Mapping
from typing import Any

from stochfric_mb.effects.contract import GROUPS, Effect
from stochfric_mb.errors import InputError, require_fields, require_name

GROUP = "stochfric_mb.effects"
"""Group of the entry points by which other packages bring effects."""

EFFECTS: dict[str, str | type[Effect]] = {
    "random_coefficients": "RandomCoefficients",
    "correlated_coefficients": "CorrelatedCoefficients",
    "velocity_weakening": "VelocityWeakening",
    "viscous_friction": "ViscousFriction",
    "dwell_ageing": "DwellAgeing",
    "frictional_lag": "FrictionalLag",
    "direction_asymmetry": "DirectionAsymmetry",
    "load_dependence": "LoadDependence",
    "presliding_compliance": "PreslidingCompliance",
    "position_dependent_friction": "PositionDependentFriction",
    "position_dependent_force": "PositionDependentForce",
    "friction_drift": "FrictionDrift",
    "distance_drift": "DistanceDrift",
    "temperature_drift": "TemperatureDrift",
    "normal_load_ripple": "NormalLoadRipple",
    "belt_speed_ripple": "BeltSpeedRipple",
    "nonlinear_stiffness": "NonlinearStiffness",
    "quadratic_damping": "QuadraticDamping",
    "backlash": "Backlash",
    "second_mode": "SecondMode",
    "joint_compliance": "JointCompliance",
    "effective_area": "EffectiveArea",
    "drive_gain_change": "DriveGainChange",
    "harmonic_force": "HarmonicForce",
    "impacts": "Impacts",
    "sensor_drift": "SensorDrift",
    "sensor_step": "SensorStep",
    "sensor_clipping": "SensorClipping",
    "sensor_outliers": "SensorOutliers",
    "sensor_delay": "SensorDelay",
    "stale_samples": "StaleSamples",
    "unnamed": "Unnamed",
}
"""Kind of an effect -> the name of its class in the module of that name in `kinds`, or a user's own class."""

__all__ = [
    "EFFECTS",
    "GROUP",
    "GROUPS",
    "Effect",
    "effect_class",
    "effect_from_dict",
    "effect_kinds",
    "kind_with_signature",
    "kinds_with",
    "make_effect",
    "register_effect",
    "words_of",
]


def effect_kinds() -> list[str]:
    """Return the kinds of all effects, those of installed packages included."""
    return list(dict.fromkeys([*EFFECTS, *_entry_points()]))


def words_of(kind: str) -> str:
    """Return the kind of an effect as words: ``dwell_ageing`` is dwell ageing."""
    return kind.replace("_", " ")


def effect_class(kind: str) -> type[Effect]:
    """Return the class of an effect by its kind.

    Raises:
        InputError: the kind is unknown; the message lists the known ones.
    """
    if kind in EFFECTS:
        entry = EFFECTS[kind]
        return getattr(importlib.import_module(f"{__name__}.kinds.{kind}"), entry) if isinstance(entry, str) else entry
    require_name("effect", kind, effect_kinds())
    cls = _entry_points()[kind].load()
    if not (isinstance(cls, type) and issubclass(cls, Effect) and cls.kind == kind):
        raise InputError(f"the entry point {kind!r} of {GROUP} is {cls!r}; it must be a class derived from Effect of that kind")
    return register_effect(cls)


def make_effect(kind: str, **values: Any) -> Effect:
    """Return an effect from its kind and the parameters of its class.

    >>> make_effect("dwell_ageing", rate=0.02).appears()
    ('dwell', 'the force at break-away depends on how long the contact has stuck')

    Raises:
        InputError: unknown kind, unknown or missing parameter, or a value out of range.
    """
    cls = effect_class(kind)
    require_fields(f"effect {kind}", cls, values)
    if cls.needs_one_of and not any(name in values for name in cls.needs_one_of):
        raise InputError(f"effect {kind} has no size; give {' or '.join(cls.needs_one_of)}")
    return cls(**values)


def kind_with_signature(signature: str) -> str:
    """Return the kind that a signature means, such as `stochfric_mb.effects.traits.JUMP`.

    Raises:
        InputError: no effect says so.
    """
    for kind in effect_kinds():
        if signature in effect_class(kind).signatures:
            return kind
    raise InputError(f"no effect has the signature {signature!r}; add it to the signatures of one of them")


def kinds_with(trait: str) -> tuple[str, ...]:
    """Return the kinds that have a trait, such as `stochfric_mb.effects.traits.SHAPES_SLIPS`."""
    return tuple(kind for kind in effect_kinds() if trait in effect_class(kind).traits)


def effect_from_dict(table: Mapping[str, Any]) -> Effect:
    """Return the effect of an ``[[effects]]`` table.

    Raises:
        InputError: no kind, or what `make_effect` raises.
    """
    if "kind" not in table:
        raise InputError("an [[effects]] table has no kind; add one, such as kind = 'dwell_ageing'")
    return make_effect(str(table["kind"]), **{str(k): v for k, v in table.items() if k != "kind"})


def register_effect(cls: type[Effect]) -> type[Effect]:
    """Add a user's own effect class to the registry (usable as a class decorator); its module holds its functions."""
    EFFECTS[cls.kind] = cls
    return cls


@functools.cache
def _entry_points() -> dict[str, importlib.metadata.EntryPoint]:
    return {point.name: point for point in importlib.metadata.entry_points(group=GROUP)}
