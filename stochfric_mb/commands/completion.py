"""What a shell completes: scenarios, engines, laws. Nothing heavy is imported for it."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import click
from click.shell_completion import CompletionItem

Complete = Callable[[click.Context, click.Parameter, str], list[CompletionItem]]


def scenarios(_context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Return the bundled scenarios that begin so, and leave files to the shell."""
    from stochfric_mb.scenario import bundled_scenarios

    return [*_beginning(bundled_scenarios(), incomplete), CompletionItem(incomplete, type="file")]


def engines(_context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Return the engines that continue a comma-separated list."""
    from stochfric_mb.engines import ENGINES

    done, comma, last = incomplete.rpartition(",")
    taken = done.split(",")
    return [CompletionItem(f"{done}{comma}{name}") for name in ENGINES if name.startswith(last) and name not in taken]


def laws(_context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Return the laws that begin so."""
    from stochfric_mb.laws import LAWS

    return _beginning(LAWS, incomplete)


def _beginning(names: Iterable[str], incomplete: str) -> list[CompletionItem]:
    return [CompletionItem(name) for name in names if name.startswith(incomplete)]
