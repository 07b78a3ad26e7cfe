"""Options that several commands share."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from typing import Any

import click
from click.core import ParameterSource

from stochfric_mb.commands import completion
from stochfric_mb.engines import ENGINES
from stochfric_mb.errors import InputError, require_name


class Names(click.Choice[str]):
    """One of a few names; what is mistyped is answered with the nearest, as commands are."""

    def __init__(self, what: str, names: list[str]) -> None:
        """Keep what the names are of, for messages."""
        super().__init__(names)
        self.what = what

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Return the name once it is one of those known."""
        try:
            return require_name(self.what, str(value), map(str, self.choices))
        except InputError as error:
            raise click.UsageError(str(error), ctx) from None


def scenario_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Return ``command`` with SCENARIO, --seed, --dt, --law, --set and --force."""
    for option in (
        click.option("--force", is_flag=True, help="Replace what is at --out."),
        click.option(
            "--set", "overrides", multiple=True, metavar="TABLE.KEY=VALUE", help="Override a value of the scenario; repeatable."
        ),
        click.option(
            "--law",
            metavar="KIND",
            shell_complete=completion.laws,
            help="Replace the scenario's law; shared parameters are kept.",
        ),
        click.option(
            "--dt", type=float, metavar="DT", help="Step of the engine [s]; default 1e-4, or half the law's stability limit."
        ),
        click.option(
            "--seed", type=click.IntRange(0, 2**32 - 1), default=0, show_default=True, help="Seed of the coefficients."
        ),
        click.argument("scenario", shell_complete=completion.scenarios),
    ):
        command = option(command)
    return command


def engine_names(text: str | None) -> list[str] | None:
    """Return the engines in a comma-separated list, None if there is no list.

    Raises:
        InputError: a name is unknown, or the list is empty.
    """
    if text is None:
        return None
    names = [name.strip() for name in text.split(",") if name.strip()]
    if not names:
        raise InputError(f"--engines {text!r} names no engine; known: {', '.join(ENGINES)}")
    return [require_name("engine", name, ENGINES) for name in names]


def command_line(*, without: tuple[str, ...] = ()) -> str:
    """Return the command that is running, with the arguments and options that were given, ready for a shell.

    Args:
        without: names of parameters to leave out, such as the output folder of a result that must not depend on it.
    """
    ctx = click.get_current_context()
    words = ["stochfric", str(ctx.info_name)]
    for parameter in ctx.command.params:
        name = str(parameter.name)
        if name in ctx.params and name not in without and ctx.get_parameter_source(name) is ParameterSource.COMMANDLINE:
            words += _words(parameter, ctx.params[name])
    return shlex.join(words)


def _words(parameter: click.Parameter, value: Any) -> list[str]:
    if not isinstance(parameter, click.Option):
        return [str(value)]
    if parameter.is_flag:
        return [parameter.opts[0] if value else (parameter.secondary_opts or parameter.opts)[0]]
    values = value if parameter.multiple else (value,)
    return [word for v in values for word in (max(parameter.opts, key=len), str(v))]
