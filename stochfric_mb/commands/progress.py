"""Progress on stderr: what runs, how far it is, how long it still takes; bars on a terminal, lines elsewhere."""

from __future__ import annotations

import contextlib
import functools
import io
import math
import sys
import time
from collections.abc import Callable, Generator
from typing import Any

import click
from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from stochfric_mb.commands.speech import Speech, speech
from stochfric_mb.errors import InputError

REFRESH = 0.05
"""Least time between two updates of a bar [s]."""
PATIENCE = 2.0
"""Time for which a command off a terminal says nothing of its progress [s]: short ones stay silent."""
EVERY = 10.0
"""Least time between two lines on one stage off a terminal [s]."""
SURE, DAY = 30.0, 86400.0
"""Time of simulating from which on its end can be told, and the longest a run may take unless it is told to [s]."""


class _Left:
    """How long a count still takes, by its pace since the first value."""

    def __init__(self) -> None:
        self.since: tuple[float, float] | None = None

    def __call__(self, value: float, total: float) -> float | None:
        """Return the time left [s]; None where nothing tells it yet."""
        now = time.monotonic()
        self.since = self.since or (now, value)
        spent, new = now - self.since[0], value - self.since[1]
        return spent / new * (total - value) if new > 0.0 and spent > 0.0 else None

    @property
    def spent(self) -> float:
        """Return the time since the first value [s]."""
        return 0.0 if self.since is None else time.monotonic() - self.since[0]


class Display:
    """Bars of the runs of one command, one under the other."""

    def __init__(self, progress: Progress) -> None:
        """Show runs on ``progress``."""
        self._progress = progress
        self._finish: Callable[[], None] = lambda: None

    def run(self, name: str, duration: float, *, however_long: bool = False) -> Callable[[float], None]:
        """Begin a run as `stage`; one that would take over a day stops with an error unless ``however_long``."""
        advance = self.stage(name, duration)
        if however_long:
            return advance
        left = _Left()

        def within_a_day(t: float) -> None:
            seconds = left(t, duration)
            if seconds is not None and seconds > DAY and left.spent > SURE:
                raise InputError(
                    f"{name}: {t:.3g} of {duration:g} s are simulated, and the rest takes about {_in_words(seconds)}: shorten "
                    "simulation.duration, take a longer step (--dt), or give --however-long"
                )
            advance(t)

        return within_a_day

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
        time_left = _Left()

        def advance(done: int) -> None:
            left = time_left(done, total)
            rate = f", {(total - done) / left:.3g} {name}/s, {left:.0f} s left" if left else ""
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
        return self._now_and_then(duration, lambda t: f"{name}: {t:.3g} / {duration:g} s simulated")

    def count(self, name: str, total: int) -> Callable[[int], None]:
        """Begin to count ``name`` up to ``total``; return what is called with how many are done."""
        return self._now_and_then(total, lambda done: f"{done} / {total} {name}")

    def note(self, text: str) -> None:
        """Say that something begins."""
        spent = time.monotonic() - self._began
        if spent >= self._patience:
            click.echo(f"[{spent:.0f} s] {text}", err=True)

    def _now_and_then(self, total: float, text: Callable[[Any], str]) -> Callable[[Any], None]:
        """Return what says now and then how far it is."""
        said = time.monotonic()
        time_left = _Left()

        def advance(value: Any) -> None:
            nonlocal said
            now = time.monotonic()
            first = time_left.since is None
            left = time_left(value, total)
            if now - said >= EVERY:
                said = now - (EVERY - PATIENCE if first else 0.0)  # what comes before the first value tells nothing of the pace
                self.note(text(value) + ("" if left is None else f", about {_in_words(left)} left"))

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
    """Give the display of one command: bars on a terminal, lines elsewhere and with ``-v``, nothing with ``-q``.

    What engines print meanwhile goes to stderr, too, and nowhere with ``-q``: stdout is the command's.
    """
    console = Console(stderr=True)
    how = speech()
    with contextlib.redirect_stdout(io.StringIO() if how is Speech.QUIET else sys.stderr):
        yield from _shown(console, how)


def _shown(console: Console, how: Speech) -> Generator[Display]:
    """Give the display for a way of speaking."""
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
