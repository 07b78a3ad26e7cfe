"""``stochfric list``: what there is, with equation and source."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import click

from stochfric_mb.commands.options import Names
from stochfric_mb.commands.speech import answer, say, spoken

EXAMPLE = """\b
Example:
  stochfric list laws
"""


Cards = list[tuple[str, list[tuple[str, str]]]]


@click.command("list", epilog=EXAMPLE)
@spoken
@click.argument("what", type=Names("list", ["scenarios", "laws", "processes", "effects", "engines"]))
def list_(what: str) -> None:
    """List what there is: bundled scenarios, laws, processes, effects or engines, with equation and source."""
    _LISTS[what]()


def _print(cards: Cards, title: str) -> None:
    from stochfric_mb.commands.tables import print_cards

    answer({title: {name: dict(lines) for name, lines in cards}})
    print_cards(cards, title=title)


def _laws() -> None:
    from stochfric_mb.laws import AXIOMS, LAWS, law_class

    cards: list[tuple[str, list[tuple[str, str]]]] = []
    for kind in LAWS:
        cls = law_class(kind)
        lines = [("equation", cls.equation), ("parameters", _parameters(cls)), ("source", cls.source)]
        cards.append((kind, lines + _broken(cls.exceptions)))
    _print(cards, title="Friction laws")
    say("Every law is tested on these axioms, unless it says that one does not hold:")
    for name, text in AXIOMS.items():
        say(f"  {name}: {text}")


def _broken(exceptions: Mapping[str, str]) -> list[tuple[str, str]]:
    if not exceptions:
        return [("axioms", "all hold")]
    return [(f"not {name}", reason) for name, reason in exceptions.items()]


def _processes() -> None:
    from stochfric_mb.coefficients import PROCESSES

    cards = [
        (kind, [("equation", cls.equation), ("parameters", _parameters(cls)), ("source", cls.source)])
        for kind, cls in PROCESSES.items()
    ]
    _print(cards, title="Coefficient processes")


def _effects() -> None:
    import dataclasses

    from stochfric_mb.effects import GROUPS, effect_class, effect_kinds

    classes = sorted(map(effect_class, effect_kinds()), key=lambda cls: GROUPS.index(cls.group))
    cards = [
        (
            cls.kind,
            [
                ("group", cls.group),
                ("equation", cls.equation),
                ("parameters", ", ".join(_effect_parameter(f) for f in dataclasses.fields(cls))),
                ("source", cls.source),
            ],
        )
        for cls in classes
    ]
    _print(cards, title="Effects: what may be added to a model")


def _effect_parameter(field: Any) -> str:
    """Return the name of an effect's parameter with its unit, choices and default."""
    import dataclasses

    choices = field.metadata.get("choices")
    text = f"{field.name} ({' or '.join(choices)})" if choices else f"{field.name} [{field.metadata['unit']}]"
    if field.default is dataclasses.MISSING or choices:
        return text
    return f"{text} = {field.default:g}"


def _engines() -> None:
    from stochfric_mb.commands.tables import print_table
    from stochfric_mb.engines import ENGINES

    rows = [(e.name, e.version or "not installed", e.hook, e.source) for e in ENGINES.values()]
    head = ("engine", "version", "how friction enters", "source")
    answer({"engines": [dict(zip(head, row, strict=True)) for row in rows]})
    print_table(head, rows, title="Engines")
    for engine in ENGINES.values():
        if not engine.installed:
            say(f"{engine.name} is not installed; {engine.remedy}")


def _scenarios() -> None:
    from stochfric_mb.commands.tables import print_table
    from stochfric_mb.scenario import bundled_scenarios, load_any_scenario

    head = ("scenario", "mechanism", "law", "title", "data")
    rows: list[tuple[str, ...]] = []
    for name, file in bundled_scenarios().items():
        scenario = load_any_scenario(file)
        data = "measured" if (file.parent / "dataset.toml").is_file() else ""
        rows.append((name, scenario.mechanism.kind, scenario.law.kind, scenario.title, data))
    answer({"scenarios": [dict(zip(head, row, strict=True)) for row in rows]})
    print_table(head, rows, title="Bundled scenarios")


def _parameters(cls: type) -> str:
    """Return the fields of a dataclass with their defaults."""
    import dataclasses

    return ", ".join(
        _parameter(f.name, None if f.default is dataclasses.MISSING else (f.default,)) for f in dataclasses.fields(cls)
    )


def _parameter(name: str, default: tuple[object] | None) -> str:
    if default is None:
        return name
    value = default[0]
    if value is None:
        return f"{name} (optional)"
    return f"{name} = {value:g}" if isinstance(value, float) else f"{name} = {getattr(value, 'kind', value)}"


_LISTS: dict[str, Callable[[], None]] = {
    "scenarios": _scenarios,
    "laws": _laws,
    "processes": _processes,
    "effects": _effects,
    "engines": _engines,
}
