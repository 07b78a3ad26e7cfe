"""Write docs/keys.md: every key of a scenario and of a dataset, from the dataclasses that hold them.

Run it as ``python docs/make_keys_page.py``.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from stochfric_mb.commands.init import EXAMPLES
from stochfric_mb.commands.keys import Key, dataset_tables, scenario_tables
from stochfric_mb.scenario import bundled_scenarios

PAGE = Path(__file__).parent / "keys.md"
HEAD = """\
# Keys of a scenario and of a dataset

Both are TOML files; `stochfric init` writes them with comments. SI units everywhere. A key without a default is required.
An unknown key, a wrong type or a value out of range is an error that names file and key. This page is generated from the
code that reads the files (`python docs/make_keys_page.py`).

A scenario has `schema = "stochfric.scenario/1"`, `title` (a text), the tables `[mechanism]`, `[law]` and `[simulation]`, and,
where wanted, `[coefficients]` (how mu_s and mu_k vary), `[[effects]]` (what is added to the model, see [Effects](effects.md)),
`[controller]` and `[uncertainty]`: a relative standard deviation for each number of the mechanism and the law that is not known
exactly, such as `mass = 0.01` for 1 %. The uncertainty of an `offset` is in its own unit. For `mjcf` the numbers are
`mass`, `armature`, `gain`, `damping` and `offset`. One above 1 is an error (above 3 for an inertia, an armature, a damping and
in a spring slider).

A dataset has `schema = "stochfric.dataset/1"`, `title`, `scenario` (a file beside it, or the name of a bundled one) and
`[[runs]]`; see [Measured data](datasets.md).
"""
FALLBACK = {
    "name": "slow belt", "set": "{ belt_velocity = 1e-3 }", "sign": "{ force = -1 }", "scale": "{ force = 25.0 }",
    "signed_bits": "{ load = 16 }", "max_gap": "0.1", "correlation_time": "0.5", "spacing": "0.01",
    "values": "[0.41, 0.43, ...]", "upper": "0.9", "tendons": '["cable"]', "pairs": '{ foot = { geoms = ["foot", "floor"] } }',
    "offset": "{ elbow = 0.1 }", "factors": "{ mass = 1.1 }", "payload": "{ end = 0.5 }",
    "effects_in": '["elbow"]', "sigma_s": "0.015", "sigma_k": "0.023",
    "distribution_s": '"lognormal"', "distribution_k": '"lognormal"', "excitation_amplitude": "5e-4",
    "excitation_angular_frequency": "13.8", "velocity_gain": "4.0", "piston_area": "1e-3", "mu_s": "0.8", "mu_k": "0.46",
}  # fmt: skip
"""Key -> example, where no bundled file has it."""


def page() -> str:
    """Return the page."""
    files = [tomllib.loads(file.read_text(encoding="utf-8")) for file in bundled_scenarios().values()]
    files += [
        tomllib.loads(file.read_text(encoding="utf-8"))
        for file in sorted((Path(__file__).parents[1] / "models").glob("*/dataset.toml"))
    ]
    parts = [HEAD]
    for title, tables in (("Scenario", scenario_tables()), ("Dataset", dataset_tables())):
        parts.append(f"## {title}\n")
        parts += [_table(name, keys, files) for name, keys in tables.items() if keys]
    return "\n".join(parts)


def _table(name: str, keys: list[Key], files: list[dict[str, Any]]) -> str:
    title, _, kind = name.partition(", ")
    lines = [f"### `[{title}]`" + (f", `{kind}`" if kind else ""), ""]
    lines += ["| key | type | unit | default | example | meaning |", "|---|---|---|---|---|---|"]
    for key in keys:
        default = f"`{key.default}`" if key.default not in ("", "none") else key.default or "required"
        cells = (f"`{key.name}`", key.type, key.unit, default, f"`{_example(name, key, files)}`", key.text.replace("|", "\\|"))
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def _example(name: str, key: Key, files: list[dict[str, Any]]) -> str:
    """Return the value of a key in `stochfric init`, in a bundled file, in `FALLBACK`, or by default."""
    table, _, kind = name.partition(", ")
    value = EXAMPLES.get(kind.partition("= ")[2].strip('"'), {}).get(key.name)
    for content in files:
        value = _of(content, table, kind, key.name) if value is None else value
    if value is None:
        other = FALLBACK.get(key.name, key.default)
        return key.default if other.startswith("{") and key.type == "number" else other
    return _toml(value)


def _of(content: Mapping[str, Any], table: str, kind: str, key: str) -> Any:
    inner: Any = content.get(table.split(".", maxsplit=1)[0])
    for part in table.split(".")[1:]:
        inner = inner and (next(iter(inner.values())) if part == "NAME" else inner.get(part))
    entries = inner if isinstance(inner, list) else [inner or {}]
    word, _, value = kind.partition(" = ")
    return next((e[key] for e in entries if key in e and (not kind or e.get(word) == value.strip('"'))), None)


def _toml(value: Any) -> str:
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{k} = {_toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return f'"{value}"' if isinstance(value, str) else f"{value:g}" if isinstance(value, float) else str(value)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
