"""Every key of a scenario and of a dataset, taken from the dataclasses that hold them: type, unit, default, meaning."""

from __future__ import annotations

import ast
import dataclasses
import inspect
import re
import textwrap
from typing import Any


@dataclasses.dataclass(frozen=True)
class Key:
    """One key of a table of a TOML file."""

    name: str
    """The key."""
    type: str
    """Type of its value, in words of TOML."""
    unit: str
    """SI unit; empty: it has none, or its text says it."""
    default: str
    """Value where the key is left out; empty: the key is required."""
    text: str
    """What it means."""

    @property
    def required(self) -> bool:
        """Whether the key must be there."""
        return not self.default


def keys_of(cls: type, *, without: tuple[str, ...] = ()) -> list[Key]:
    """Return the keys that a dataclass reads: its fields, with the docstrings below them.

    Args:
        cls: the dataclass.
        without: fields that are no keys.
    """
    texts = _texts(cls)
    return [
        Key(f.name, _type(str(f.type)), _unit(f, texts.get(f.name, "")), _default(f), _plain(texts.get(f.name, "")))
        for f in dataclasses.fields(cls)
        if f.name not in without
    ]


def _texts(cls: type) -> dict[str, str]:
    """Return the docstrings below the fields of a class and of those that it is made from."""
    texts: dict[str, str] = {}
    for one in reversed(cls.__mro__):
        if not dataclasses.is_dataclass(one):
            continue
        body = ast.parse(textwrap.dedent(inspect.getsource(one))).body[0]
        assert isinstance(body, ast.ClassDef)
        for field, text in zip(body.body, body.body[1:], strict=False):
            if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name) and isinstance(text, ast.Expr):
                texts[field.target.id] = " ".join(str(ast.literal_eval(text.value)).split())
    return texts


_TYPES = (
    (r"Mapping\[str, float\]", "table of numbers"),
    (r"Mapping\[str, int\]", "table of whole numbers"),
    (r"Mapping\[str, str\]", "table of texts"),
    (r"Mapping", "table"),
    (r"tuple\[float, float\]", "two numbers"),
    (r"tuple\[float, \.\.\.\]", "list of numbers"),
    (r"tuple", "list of texts"),
    (r"Distribution", "name or table"),
    (r"bool", "true or false"),
    (r"\bint\b", "whole number"),
    (r"float", "number"),
)


def _type(annotation: str) -> str:
    """Return a Python type in words of TOML."""
    return next((words for pattern, words in _TYPES if re.search(pattern, annotation)), "text")


def _unit(field: dataclasses.Field[Any], text: str) -> str:
    if "unit" in field.metadata:
        return str(field.metadata["unit"])
    if "choices" in field.metadata:
        return ""
    match = re.search(r"(?<!`)\[([^\]]+)\]", text)
    return match.group(1) if match else ""


def _plain(text: str) -> str:
    return text.rstrip(".").replace("``", "`")


def _default(field: dataclasses.Field[Any]) -> str:
    """Return the default as TOML, "none" where leaving a key out means that there is none."""
    value: Any = field.default
    if field.default_factory is not dataclasses.MISSING:
        value = field.default_factory()
    if value is dataclasses.MISSING:
        return ""
    if value is None or value in ("", (), {}, []):
        return "none"
    if isinstance(value, int | float) and not isinstance(value, bool):
        return f"{value:g}"
    return str(getattr(value, "kind", value))


def scenario_tables() -> dict[str, list[Key]]:
    """Return the tables of a scenario, by name as in the file, each with its keys."""
    from stochfric_mb.coefficients import DISTRIBUTIONS, PROCESSES
    from stochfric_mb.laws import LAWS, law_class
    from stochfric_mb.mechanisms import MECHANISMS
    from stochfric_mb.mechanisms.controller import KINDS, JointLoop
    from stochfric_mb.scenario import Scenario

    whole = {key.name: key for key in keys_of(Scenario)}
    tables = {"simulation": [whole["duration"], whole["output_step"]]}
    tables |= {f'mechanism, kind = "{kind}"': keys_of(cls) for kind, cls in MECHANISMS.items()}
    tables |= {f'law, kind = "{kind}"': keys_of(law_class(kind)) for kind in LAWS}
    tables |= {f'coefficients, process = "{kind}"': keys_of(cls) for kind, cls in PROCESSES.items()}
    tables |= {f'distribution, kind = "{kind}"': keys_of(cls) for kind, cls in DISTRIBUTIONS.items()}
    tables |= {f'controller, kind = "{cls.kind}"': keys_of(cls) for cls in KINDS}
    return tables | {"controller.joints.NAME": keys_of(JointLoop)}


def dataset_tables() -> dict[str, list[Key]]:
    """Return the tables of a dataset, by name as in the file, each with its keys."""
    from stochfric_mb.measurement.assemble import RunEntry
    from stochfric_mb.measurement.entries import RUN_KEYS

    names = {"settings": "set"}
    keys = [dataclasses.replace(key, name=names.get(key.name, key.name)) for key in keys_of(RunEntry)]
    needed = {"file": "", "role": ""}
    keys = [
        dataclasses.replace(key, default=needed.get(key.name, "name of the file" if key.name == "name" else key.default))
        for key in keys
    ]
    assert {key.name for key in keys} == set(RUN_KEYS)
    return {"runs": keys}
