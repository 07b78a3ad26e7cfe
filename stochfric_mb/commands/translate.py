"""``stochfric translate``: friction in the words of other codes, and back."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import click

from stochfric_mb.commands import completion
from stochfric_mb.commands.speech import answer, say, spoken

if TYPE_CHECKING:
    from stochfric_mb.dialects.translation import Translated

EXAMPLE = """\b
Example:
  stochfric translate kang2015_table1 --to adams
"""
SCHEMA = "stochfric.dialect/1"
"""Schema of a file with the friction parameters of another code."""


@click.command(epilog=EXAMPLE)
@spoken
@click.argument("source")
@click.option("--to", "dialect", metavar="DIALECT", help="adams, recurdyn, simscape, modelica, exudyn, mujoco, physx or bam.")
@click.option(
    "--law",
    metavar="KIND",
    shell_complete=completion.laws,
    help="Our law: in the place of the scenario's, or to which a dialect is translated.",
)
@click.option(
    "--normal-force", type=float, metavar="N", help="Normal force [N, at a hinge N m]; default: the scenario's, or 1."
)
@click.option("--speeds", default="1e-5,0.1", show_default=True, metavar="LOW,HIGH", help="Speeds to be met [m/s].")
@click.option("-o", "--out", metavar="FILE", help="TOML file to write: the dialect's parameters, or a friction file.")
@click.option("--force", is_flag=True, help="Replace what is at --out.")
def translate(
    source: str, dialect: str | None, law: str | None, normal_force: float | None, speeds: str, out: str | None, force: bool
) -> None:
    """Translate SOURCE: a friction file or a scenario to a DIALECT, or a dialect's file (stochfric.dialect/1) to our law."""
    import tomli_w

    from stochfric_mb.errors import InputError
    from stochfric_mb.outputs import check_target, whole_file

    if out is not None:
        check_target(out, force=force)
    tables = _dialect_file(source)
    if tables is None:
        result, content = _to(source, dialect, law, normal_force, _speeds(speeds))
    elif dialect is not None:
        raise InputError(
            f"--to {dialect}: {source} holds the friction of another code, which is translated to our laws; leave --to out, "
            f"and translate the result (--out) to {dialect}"
        )
    else:
        result, content = _from(tables, law, normal_force, _speeds(speeds))
    answer(lambda: _numbers(result, back=tables is not None) | {"out": out})
    say(_text(result, back=tables is not None, load=content.get("normal_force")))
    if out is not None:
        with whole_file(Path(out), replace=force) as temporary:
            temporary.write_text(tomli_w.dumps(content), encoding="utf-8")
        say(f"Written: {out}")


def _dialect_file(source: str) -> dict[str, Any] | None:
    """Return the content of a dialect's file; None where the source is another file or a name."""
    import tomllib

    from stochfric_mb.errors import InputError

    path = Path(source)
    if not path.is_file():
        return None
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: not a TOML file: {error}") from None
    return tables if tables.get("schema") == SCHEMA else None


def _speeds(text: str) -> Any:
    from stochfric_mb.dialects.curve import speeds
    from stochfric_mb.errors import InputError

    try:
        low, high = map(float, text.split(","))
    except ValueError:
        raise InputError(f"--speeds {text!r} is not LOW,HIGH; give two numbers in m/s, such as 1e-5,0.1") from None
    return speeds(low, high)


def _to(source: str, dialect: str | None, law: str | None, normal_force: float | None, speed: Any) -> Any:
    from stochfric_mb.dialects import DIALECTS
    from stochfric_mb.dialects.translation import to_dialect
    from stochfric_mb.errors import InputError, require_name, require_number
    from stochfric_mb.export import load_exported

    if dialect is None:
        raise InputError(f"--to is missing; name a dialect: {', '.join(DIALECTS)}")
    cls = DIALECTS[require_name("dialect", dialect, DIALECTS)]
    exported = load_exported(source, law=law)
    box = exported.mechanism
    stated = 1.0 if exported.load is None else exported.load
    n = stated if normal_force is None else normal_force
    require_number("--normal-force", n, above=0.0, unit="N")
    mass = 1.0 if box is None else box.mass
    translation = to_dialect(exported.inner, cls, speed, normal_force=n, mass=mass, process=exported.process)
    return translation, {"schema": SCHEMA, "dialect": dialect, "normal_force": n, "parameters": translation.dialect.to_dict()}


def _from(tables: dict[str, Any], law: str | None, normal_force: float | None, speed: Any) -> Any:
    from stochfric_mb.dialects import DIALECTS
    from stochfric_mb.dialects.translation import from_dialect
    from stochfric_mb.errors import InputError, require_name, require_number
    from stochfric_mb.export.exported import SCHEMA as FRICTION
    from stochfric_mb.laws import LAWS

    for key in tables:
        require_name("key of a dialect's file", key, ("schema", "dialect", "normal_force", "parameters"))
    cls = DIALECTS[require_name("dialect", str(tables.get("dialect")), DIALECTS)]
    parameters = tables.get("parameters", {})
    if not isinstance(parameters, dict):
        raise InputError(f"parameters = {parameters!r} is not a table; write [parameters] and one parameter a line")
    given = cls.from_dict(cast(dict[str, Any], parameters))
    n = require_number(
        "normal_force", tables.get("normal_force", 1.0) if normal_force is None else normal_force, above=0.0, unit="N"
    )
    kind = cls.nearest if law is None else require_name("law", law, LAWS)
    translation = from_dialect(given, kind, speed, normal_force=n)
    return translation, {"schema": FRICTION, "title": f"from {cls.kind}", "law": translation.law.to_dict()}


def _numbers(translation: Translated, *, back: bool) -> dict[str, Any]:
    """Return the result in numbers."""
    return {
        "to": translation.law.kind if back else translation.dialect.kind,
        "law": translation.law.to_dict(),
        "dialect": {"kind": translation.dialect.kind} | translation.dialect.to_dict(),
        "max_error": translation.max_error,
        "rms_error": translation.rms_error,
        "break_away_error": translation.break_away_error,
        "lost": list(translation.lost),
    }


def _text(translation: Translated, *, back: bool, load: float | None) -> str:
    """Return the result in words; ``load``: the normal force at which a law was translated."""
    ours = {k: v for k, v in translation.law.to_dict().items() if k != "kind"}
    theirs = translation.dialect.to_dict()
    name = f"law {translation.law.kind}"
    source, result = (translation.dialect.title, name) if back else (name, translation.dialect.title)
    shown = ours if back else theirs
    equation = translation.law.equation if back else translation.dialect.equation
    at = "" if load is None else f", at normal_force = {load:g}"
    lines = [f"From {source} to {result}{at}", f"  {equation}", *(f"  {k} = {_number(v)}" for k, v in shown.items())]
    snippet = getattr(translation.dialect, "snippet", None)
    if snippet is not None and not back:
        lines.append(f"  {snippet()}")
    lines.append(
        f"Error of the coefficient: {translation.max_error:.2g} at most, {translation.rms_error:.2g} rms; "
        f"at break-away {translation.break_away_error:+.2g}"
    )
    return "\n".join([*lines, *(f"Lost: {what}" for what in translation.lost)])


def _number(value: Any) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(map(_number, cast(list[Any], value))) + "]"
    return value if isinstance(value, str) else f"{value:.6g}"
