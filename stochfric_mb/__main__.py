"""The command line: ``stochfric`` or ``python -m stochfric_mb``. A command is loaded when it is used."""

from __future__ import annotations

import importlib
import warnings
from typing import Any

import click

COMMANDS: dict[str, tuple[str, str]] = {
    "run": ("stochfric_mb.commands.run:run", "Simulate one trajectory and write it to a file."),
    "compare": ("stochfric_mb.commands.compare:compare", "Compare engines with the reference and write a report."),
    "init": ("stochfric_mb.commands.init:init", "Write a scenario and a dataset for a rig of your own, to fill in."),
    "plan": ("stochfric_mb.commands.plan:plan", "Say what planned runs could show, before anything is measured."),
    "discover": ("stochfric_mb.commands.discover:discover", "Identify the effect that a model lacks, from measured data."),
    "check": ("stochfric_mb.commands.check:check", "Probe the friction of a MuJoCo model and say what to change."),
    "ensemble": ("stochfric_mb.commands.ensemble:ensemble", "Simulate many runs into one dataset; resumes."),
    "reproduce": ("stochfric_mb.commands.reproduce:reproduce", "Test every claim of a published study, with verdicts."),
    "export": ("stochfric_mb.commands.export:export", "Take friction to other codes, as an FMU or as C."),
    "translate": ("stochfric_mb.commands.translate:translate", "Convert friction to the parameters of another code, or back."),
    "list": ("stochfric_mb.commands.list:list_", "List scenarios, laws, processes, effects or engines."),
}
"""Name of a command -> where it lives and what it does; a new command is a new file and one line here."""

UNUSABLE = 2
"""Exit code for input that cannot be used, as click's own."""
INTERRUPTED = 130
"""Exit code after Ctrl-C."""


class Failure(click.ClickException):
    """Input that cannot be used: ``Error: ...`` on stderr."""

    exit_code = UNUSABLE


class Commands(click.Group):
    """The group of commands: loads each on use, and turns errors into one line and an exit code."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of the commands."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return a command, or None if there is none of that name."""
        if cmd_name not in COMMANDS:
            return None
        module, _, name = COMMANDS[cmd_name][0].partition(":")
        return getattr(importlib.import_module(module), name)

    def resolve_command(self, ctx: click.Context, args: list[str]) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the command that is named first; an unknown one is answered with the nearest and all there are."""
        if args and args[0] not in COMMANDS and not args[0].startswith("-"):
            from stochfric_mb.errors import InputError, require_name

            try:
                require_name("command", args[0], COMMANDS)
            except InputError as error:
                raise click.UsageError(str(error), ctx) from None
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the table of commands without loading any."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, text) for name, (_, text) in COMMANDS.items()])

    def invoke(self, ctx: click.Context) -> Any:
        """Return what the command returns; its errors become one line on stderr and an exit code."""
        from stochfric_mb.errors import StochfricError

        with warnings.catch_warnings():
            warnings.showwarning = _show_warning
            try:
                return super().invoke(ctx)
            except StochfricError as error:
                raise Failure(str(error)) from error
            except BrokenPipeError:  # the reader of stdout has seen enough (`stochfric list laws | head`): click ends quietly
                raise
            except OSError as error:
                raise Failure(f"{error.filename or 'file'}: {error.strerror or error}") from error
            except KeyboardInterrupt:
                click.echo("Interrupted; nothing was written", err=True)
                ctx.exit(INTERRUPTED)


@click.command(
    cls=Commands,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="\b\nExample:\n  stochfric run kang2015_table1 --engine reference --seed 1 --out run.nc",
)
@click.version_option(package_name="stochfric_mb", prog_name="stochfric")
def main() -> None:
    """Stochastic dry friction in multibody simulation: run scenarios, compare engines."""


def _show_warning(message: Warning | str, category: type[Warning], *_where: Any, **_more: Any) -> None:
    click.echo(f"Warning: {message}", err=True)


if __name__ == "__main__":
    main(prog_name="stochfric")
