"""What a command says on stdout: text for people, nothing (``-q``), or one JSON document (``--json``)."""

from __future__ import annotations

import enum
import json
from collections.abc import Callable, Mapping
from typing import Any

import click

KEY = "stochfric_mb.speech"
"""Where a click context keeps how a command speaks."""


class Speech(enum.Enum):
    """How a command speaks."""

    NORMAL = "normal"
    QUIET = "quiet"
    VERBOSE = "verbose"
    JSON = "json"


def speech() -> Speech:
    """Return how the running command speaks; outside of a command: normally."""
    context = click.get_current_context(silent=True)
    return Speech.NORMAL if context is None else context.meta.get(KEY, Speech.NORMAL)


def spoken(command: Callable[..., Any]) -> Callable[..., Any]:
    """Return ``command`` with -q, -v and --json."""
    for names, how, text in (
        (("--json",), Speech.JSON, "Print the result as one JSON document on stdout, and nothing else there."),
        (("-v", "--verbose"), Speech.VERBOSE, "Show progress in lines with times, also where stderr is no terminal."),
        (("-q", "--quiet"), Speech.QUIET, "Print nothing but errors."),
    ):
        command = click.option(
            *names, f"{how.value}_speech", is_flag=True, expose_value=False, callback=_chosen(how), help=text
        )(command)
    return command


def _chosen(how: Speech) -> Callable[[click.Context, click.Parameter, bool], None]:
    def note(context: click.Context, _parameter: click.Parameter, given: bool) -> None:
        if not given:
            return
        if KEY in context.meta:
            raise click.UsageError(f"--{context.meta[KEY].value} and --{how.value} do not go together; give one of them")
        context.meta[KEY] = how

    return note


def speaks() -> bool:
    """Return whether text for people goes to stdout."""
    return speech() in (Speech.NORMAL, Speech.VERBOSE)


def say(text: str = "") -> None:
    """Print a line for people, unless the command is quiet or prints JSON."""
    if speaks():
        click.echo(text)


def answer(content: Callable[[], Mapping[str, Any]] | Mapping[str, Any]) -> None:
    """Print the result as JSON if that is what the user asked for."""
    if speech() is Speech.JSON:
        click.echo(json.dumps(content() if callable(content) else content, allow_nan=False))
