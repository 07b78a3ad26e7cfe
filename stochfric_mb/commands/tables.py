"""Tables on stdout."""

from __future__ import annotations

from collections.abc import Sequence

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from stochfric_mb.commands.speech import speaks

WIDTH = 100
"""Width of a table where stdout is no terminal."""
WIDEST = 10_000
"""Width of a table that is not to be broken, at most."""


def _console() -> Console:
    """Return a console as wide as the terminal, or as `WIDTH`: one that is no terminal would cut tables at 80 columns."""
    console = Console()
    return console if console.is_terminal else Console(width=WIDTH)


def print_table(head: Sequence[str], rows: Sequence[Sequence[str]], *, title: str | None = None, whole: bool = False) -> None:
    """Print a table; its first column is never broken, the others fold.

    A ``whole`` table, of names and numbers, is as wide as they are where stdout is no terminal: none of them is broken there.
    """
    if not speaks():
        return
    console = _console()
    if title is not None:
        console.print(title, style="bold", highlight=False)
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for number, name in enumerate(head):
        table.add_column(Text(name), no_wrap=number == 0, overflow="fold")
    for row in rows:
        table.add_row(*map(Text, row))
    if whole and not console.is_terminal:
        console.width = max(WIDTH, console.measure(table, options=console.options.update(max_width=WIDEST)).maximum)
    console.print(table)


def print_cards(cards: Sequence[tuple[str, Sequence[tuple[str, str]]]], *, title: str) -> None:
    """Print one card each: a name, and lines of what and text; made for texts too long for a table's cells."""
    if not speaks():
        return
    console = _console()
    console.print(title, style="bold", highlight=False)
    table = Table("name", "", "", box=box.SIMPLE_HEAD, pad_edge=False, show_header=False)
    table.columns[0].no_wrap = table.columns[1].no_wrap = True
    table.columns[2].overflow = "fold"  # a formula has no spaces to break at, and is cut otherwise
    for name, lines in cards:
        for number, (what, text) in enumerate(lines):
            table.add_row(Text(name if number == 0 else "", style="bold"), Text(what, style="dim"), Text(text))
        table.add_section()
    console.print(table)
