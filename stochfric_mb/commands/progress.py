"""Progress on stderr: what runs, how far it is, how long it still takes; bars on a terminal, lines elsewhere."""

from __future__ import annotations

import contextlib
import functools
import math
import time
from collections.abc import Callable, Generator
from typing import Any

import click
from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from stochfric_mb.commands.speech import Speech, speech

REFRESH = 0.05
"""Least time between two updates of a bar [s]."""
PATIENCE = 2.0
"""Time for which a command off a terminal says nothing of its progress [s]: short ones stay silent."""
EVERY = 10.0
"""Least time between two lines on one stage off a terminal [s]."""


class Display:
    """Bars of the runs of one command, one under the other."""

    def __init__(self, progress: Progress) -> None:
        """Show runs on ``progress``."""
        self._progress = progress
        self._finish: Callable[[], None] = lambda: None

    def stage(self, name: str, duration: float) -> Callable[[float], None]:
        """Begin the run ``name`` over ``duration`` [s]; return what is called with the simulated time [s].

        Until its first call the bar only shows life: the engine is loading and compiling.
        """
        self._finish()
        progress = self._progress
        task = progress.add_task(name, total=None, detail="loading and compiling", left="")
        shown = 0.0

        def advance(t: float) -> None:
            nonlocal shown
            now = time.monotonic()
            if now - shown >= REFRESH:
                shown = now
                detail = f"{t:.3g} / {duration:g} s simulated"
                progress.update(task, total=duration, completed=t, detail=detail, left="left")

        def finish() -> None:
            progress.update(task, total=duration, completed=duration, detail=f"{duration:g} s simulated", left="left")
            progress.stop_task(task)

        self._finish = finish
        return advance

    def count(self, name: str, total: int) -> Callable[[int], None]:
        """Begin to count ``name`` up to ``total``; return what is called with how many are done.

        Until its first call the bar only shows life; what is done at the first call counts for nothing in the rate.
        """
        self._finish()
        progress = self._progress
        task = progress.add_task(name, total=None, detail="loading and compiling", left="")
        first: tuple[float, int] | None = None

        def advance(done: int) -> None:
            nonlocal first
            now = time.monotonic()
            first = (now, done) if first is None else first
            spent, new = now - first[0], done - first[1]
            rate = f", {new / spent:.3g} {name}/s, {spent / new * (total - done):.0f} s left" if new and spent > 0.0 else ""
            progress.update(task, total=total, completed=done, detail=f"{done} / {total}{rate}")

        self._finish = functools.partial(progress.stop_task, task)
        return advance

    def note(self, text: str) -> None:
        """Show that something other than a simulation is being done."""
        self._finish()
        task = self._progress.add_task(text, total=None, detail="", left="")
        self._finish = functools.partial(self._progress.remove_task, task)


class Lines(Display):
    """Progress in lines with the time since the command began, for logs and pipes."""

    def __init__(self, patience: float) -> None:
        """Begin; nothing is said in the first ``patience`` seconds."""
        self._began = time.monotonic()
        self._patience = patience

    def stage(self, name: str, duration: float) -> Callable[[float], None]:
        """Begin the run ``name`` over ``duration`` [s]; return what is called with the simulated time [s]."""
        self.note(name)
        return self._now_and_then(duration, lambda t: f"{name}: {t:.3g} / {duration:g} s simulated", begin=0.0)

    def count(self, name: str, total: int) -> Callable[[int], None]:
        """Begin to count ``name`` up to ``total``; return what is called with how many are done."""
        return self._now_and_then(total, lambda done: f"{done} / {total} {name}")

    def note(self, text: str) -> None:
        """Say that something begins."""
        spent = time.monotonic() - self._began
        if spent >= self._patience:
            click.echo(f"[{spent:.0f} s] {text}", err=True)

    def _now_and_then(self, total: float, text: Callable[[Any], str], begin: float | None = None) -> Callable[[Any], None]:
        """Return what says now and then how far it is; ``begin``: where it begins, if its first call does not say so."""
        said = began = time.monotonic()
        first: tuple[float, float] | None = None

        def advance(value: Any) -> None:
            nonlocal said, first
            now = time.monotonic()
            known = (began, begin) if first is None and begin is not None else None
            first = first or (now, value)
            if now - said >= EVERY:
                said = now
                since, before = known or first
                spent, new = now - since, value - before
                self.note(text(value) + (f", about {_in_words(spent / new * (total - value))} left" if new > 0 else ""))

        return advance


def _in_words(seconds: float) -> str:
    """Return a time in the unit in which it is a small number."""
    for unit, size in (("days", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds:.0f} s"


class Silence(Lines):
    """No progress at all."""

    def __init__(self) -> None:
        """Say nothing, ever."""
        super().__init__(math.inf)


@contextlib.contextmanager
def display() -> Generator[Display]:
    """Give the display of one command: bars on a terminal, lines elsewhere and with ``-v``, nothing with ``-q``."""
    console = Console(stderr=True)
    how = speech()
    if how is Speech.QUIET:
        yield Silence()
        return
    if how is Speech.VERBOSE or not console.is_terminal:
        yield Lines(0.0 if how is Speech.VERBOSE else PATIENCE)
        return
    columns = (
        SpinnerColumn(finished_text="[green]✓[/]"),
        TextColumn("{task.description}"),
        BarColumn(bar_width=24),
        TextColumn("{task.fields[detail]}"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        TextColumn("{task.fields[left]}"),
    )
    with Progress(*columns, console=console, transient=True) as progress:
        yield Display(progress)
