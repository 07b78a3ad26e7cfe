"""What is exported: a friction law with its coefficients, and the mechanism and effects around it where there are any."""

from __future__ import annotations

import dataclasses
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from stochfric_mb.coefficients import Process
from stochfric_mb.effects import Effect
from stochfric_mb.effects.augmented_law import Augmented
from stochfric_mb.effects.carry import running_law
from stochfric_mb.effects.combine import combined_process, moving, on_sensor
from stochfric_mb.errors import InputError, require_name
from stochfric_mb.laws import Law
from stochfric_mb.mechanisms import BeltBox, Mjcf
from stochfric_mb.scenario import SCHEMA as SCENARIO
from stochfric_mb.scenario import law_from_dict, load_any_scenario, process_from_dict

SCHEMA = "stochfric.friction/1"
"""Schema of a file that holds friction alone: ``[law]`` and, where coefficients are random, ``[coefficients]``."""
OF_FRICTION = ("friction law", "friction varies")
"""Groups of effects that change friction alone, so that a friction element carries them anywhere."""
NEEDS_SIDE = ("direction_asymmetry",)
"""Effects that must know to which side a stuck contact is loaded, which a friction element does not."""
STAND_IN_STEP = 1.0e-4
"""Step [s] for which an elastic law is chosen where effects act on a law with true stick."""


@dataclasses.dataclass(frozen=True)
class Exported:
    """What is exported."""

    law: Law
    """The law that runs; one with effects inside where there are effects."""
    process: Process | None = None
    """How its coefficients vary."""
    mechanism: BeltBox | None = None
    """The belt-box that it belongs to; None: a friction element alone."""
    effects: tuple[Effect, ...] = ()
    """The effects that act on the motion."""
    load: float | None = None
    """The normal force that the scenario states [N, at a hinge N m]; None: it states none, or several."""
    title: str = ""
    """A line for people."""
    notes: tuple[str, ...] = ()
    """What stands in for what, and what was left out."""

    @property
    def inner(self) -> Law:
        """The law without effects."""
        return self.law.inner if isinstance(self.law, Augmented) else self.law


def load_exported(source: str | Path, *, law: str | None = None, overrides: Sequence[str] = ()) -> Exported:
    """Read what is to be exported from a friction file or a scenario.

    Args:
        source: path of a TOML file, or the name of a bundled scenario.
        law: kind of law that replaces the file's.
        overrides: ``table.key=value`` settings that replace the file's.

    Raises:
        InputError: a file that cannot be used, or friction that cannot be exported; says which part.
    """
    path = Path(source)
    if path.is_file():
        try:
            tables = tomllib.loads(path.read_text(encoding="utf-8"))
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise InputError(f"{path}: not a TOML file: {error}") from None
        if tables.get("schema") == SCHEMA:
            return _from_friction(tables, path, law=law, overrides=overrides)
        if tables.get("schema") != SCENARIO:
            raise InputError(f"{path}: schema = {tables.get('schema')!r}; an export reads {SCHEMA!r} and {SCENARIO!r}")
    return exported_scenario(load_any_scenario(source, law=law, overrides=overrides))


def _from_friction(tables: dict[str, Any], path: Path, *, law: str | None, overrides: Sequence[str]) -> Exported:
    """Return what a friction file describes, read as the scenario of which it is a part."""
    for key in tables:
        require_name("key of a friction file", key, ("schema", "title", "law", "coefficients"))
    if law is not None or overrides:
        raise InputError(f"{path}: --law and --set change scenarios; edit the friction file instead")
    try:
        table = tables.get("law")
        if not isinstance(table, Mapping):
            raise InputError(f"law = {table!r}: a friction file needs the table [law]; write [law]")
        process = process_from_dict(tables["coefficients"], 1.0e-3, path.parent) if tables.get("coefficients") else None
        made = law_from_dict(table)
        return Exported(made, process, title=str(tables.get("title", "")), notes=tuple(_mass_note(made)))
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _mass_note(law: Law) -> list[str]:
    """Return what to say of a law that uses a mass which nobody has given."""
    if not law.needs_effective_mass:
        return []
    return [f"law {law.kind} uses the mass that the contact feels: 1 kg unless effective_mass is given"]


def exported_scenario(scenario: Any) -> Exported:
    """Return what of a scenario is exported: law, coefficients, belt-box and effects.

    Raises:
        InputError: effects that need another mechanism than a belt-box, or a law that cannot carry them.
    """
    process = combined_process(scenario.effects, scenario.process)
    effects = moving(scenario.effects)
    notes = [f"{effect.kind} acts on the sensor, not on the motion: left out" for effect in on_sensor(scenario.effects)]
    mechanism = scenario.mechanism if isinstance(scenario.mechanism, BeltBox) else None
    if mechanism is None:
        notes.append(f"the {scenario.mechanism.kind} is left out: the friction element alone")
        notes += _mass_note(scenario.law)
    law = scenario.law
    around = mechanism if mechanism is not None else _fixed_surface(scenario.mechanism, effects)
    if around is not None:
        law, more = running_law(law, around, scenario.effects, STAND_IN_STEP, substitute=False, seed=0, sample=0)
        notes += more
    for effect in effects:
        _check_carried(effect, belt_box=mechanism is not None)
    return Exported(law, process, mechanism, effects, _load(scenario.mechanism), scenario.title, tuple(notes))


def _load(mechanism: Any) -> float | None:
    """Return the one load on which friction acts [N, at a hinge N m]; None where there are several."""
    if isinstance(mechanism, Mjcf):
        loads = set(mechanism.friction.values())
        return loads.pop() if len(loads) == 1 else None
    return mechanism.normal_force


def _check_carried(effect: Effect, *, belt_box: bool) -> None:
    """Return if an effect can be exported.

    Raises:
        InputError: it reads what only a rig measures, or acts on another mechanism than a belt-box.
    """
    if effect.reads:
        raise InputError(
            f"effect {effect.kind!r} reads a measured {effect.reads[0]}, which an exported friction does not have; leave "
            "it out, or let friction change with time: friction_drift"
        )
    if not belt_box and (effect.group not in OF_FRICTION or effect.kind in NEEDS_SIDE):
        raise InputError(
            f"effect {effect.kind!r} acts on more than the friction of a joint, which alone is exported; remove its "
            "[[effects]] table, or export a belt_box"
        )


def _fixed_surface(mechanism: Any, effects: tuple[Effect, ...]) -> BeltBox | None:
    """Return a body on a surface at rest with the load and mass of a joint, for effects on friction; None without any.

    Raises:
        InputError: effects on a mechanism that has no normal force of its own.
    """
    if not effects:
        return None
    load = getattr(mechanism, "normal_force", 0.0)
    if not load > 0.0:
        raise InputError(
            f"effect {effects[0].kind!r} acts on a {mechanism.kind}, which has no normal force of its own; remove the "
            "[[effects]] tables to export the law alone"
        )
    mass = getattr(mechanism, "mass", 0.0) or getattr(mechanism, "inertia", 0.0) or 1.0
    return BeltBox(mass=mass, damping=0.0, stiffness=load, normal_force=load, belt_velocity=0.0)
