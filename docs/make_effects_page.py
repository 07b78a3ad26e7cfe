"""Write the tables of docs/effects.md: the effects in the registry, and how far engines are from the reference with each.

Run it as ``python docs/make_effects_page.py``; it takes half a minute.
"""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np

from stochfric_mb import load_scenario
from stochfric_mb.effects import EFFECTS, GROUPS, Effect, effect_class, make_effect
from stochfric_mb.effects.shapes.splines import COURSE, PIECES
from stochfric_mb.engines import adapter

ENGINES = ("mujoco", "exudyn", "pymunk")
PAGE = Path(__file__).parent / "effects.md"
SEED = 1


def example(kind: str) -> Effect:
    """Return an effect of the typical size that its parameters state."""
    values: dict[str, Any] = {
        f.name: f.metadata["scale"] for f in dataclasses.fields(effect_class(kind)) if "choices" not in f.metadata
    }
    if COURSE[PIECES - 1] in values:
        values[COURSE[PIECES - 1]] = 0.0  # the others being alike, what comes back goes on where it began
    values |= {"sensor_clipping": {"low": 0.0, "high": 2.0e-3}, "sensor_step": {"time": 1.0}}.get(kind, {})
    return make_effect(kind, **values)


def effects_table() -> str:
    """Return the table of effects: group, kind, equation, parameters, source."""
    lines = ["| group | kind | equation | parameters | source |", "|---|---|---|---|---|"]
    for cls in sorted(map(effect_class, EFFECTS), key=lambda cls: GROUPS.index(cls.group)):
        fields = [f for f in dataclasses.fields(cls) if f.name not in COURSE[:-1]]
        parameters = ", ".join(_parameter(f) for f in fields).replace(f"`{COURSE[-1]}`", f"`{COURSE[0]}` to `{COURSE[-1]}`")
        lines.append(f"| {cls.group} | `{cls.kind}` | {cls.equation} | {parameters} | {cls.source} |")
    return "\n".join(lines)


def _parameter(field: dataclasses.Field[Any]) -> str:
    if "choices" in field.metadata:
        return f"`{field.name}` ({', '.join(field.metadata['choices'])})"
    default = "" if field.default is dataclasses.MISSING else f" = {field.default:g}"
    return f"`{field.name}` [{field.metadata['unit']}]{default}"


def _of_joints(cls: type[Effect]) -> bool:
    """Return whether an effect is one of driven joints, which no belt-box has."""
    return bool(cls.reads) or example(cls.kind).moves_load


def agreement_table(kinds: list[str | None], law: str = "coulomb") -> str:
    """Return the rms differences of position from the reference [um], three seconds of Table 1 at the default step."""
    lines = [f"| effect | {' | '.join(ENGINES)} |", "|---" * (len(ENGINES) + 1) + "|"]
    base = load_scenario("kang2015_table1", law=law)
    for kind in kinds:
        effects = () if kind is None else (example(kind),)
        scenario = dataclasses.replace(base, process=None, effects=effects, duration=3.0, output_step=1.0e-3)
        reference = adapter("reference").simulate(scenario, seed=SEED).position
        errors = [adapter(name).simulate(scenario, seed=SEED).position - reference for name in ENGINES]
        cells = [f"{1.0e6 * float(np.sqrt(np.mean(error**2))):.2f}" for error in errors]
        lines.append(f"| {'none' if kind is None else f'`{kind}`'} | {' | '.join(cells)} |")
    return "\n".join(lines)


def filled(page: str, name: str, table: str) -> str:
    """Return the page with ``table`` between the marks of that name."""
    head, rest = page.split(f"<!-- {name} -->")
    return f"{head}<!-- {name} -->\n{table}\n<!-- end of {name} -->{rest.split(f'<!-- end of {name} -->')[1]}"


def main() -> None:
    """Write the tables of the page anew."""
    moving = [kind for kind in EFFECTS if effect_class(kind).group != "sensor" and not _of_joints(effect_class(kind))]
    page = PAGE.read_text(encoding="utf-8")
    page = filled(page, "effects", effects_table())
    page = filled(page, "agreement", agreement_table([None, *moving]))
    page = filled(page, "elastic", agreement_table(["dwell_ageing", "second_mode", "impacts"], law="elastic_stick"))
    PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
