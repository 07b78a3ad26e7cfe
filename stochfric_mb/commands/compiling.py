"""Compilation beside the main work: another process fills the cache for engines whose turn comes later.

Only where nothing of an engine is compiled yet: a first comparison on two cores then takes two thirds of the time.
"""

from __future__ import annotations

import contextlib
import dataclasses
import os
import subprocess
import sys
from collections.abc import Generator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stochfric_mb.scenario import Scenario

SAMPLES = 20
"""Output samples that the other process simulates: enough to call, and so compile, what an engine needs."""


@contextlib.contextmanager
def compiling_beside(engines: Sequence[str], scenario: Scenario) -> Generator[list[str]]:
    """Compile engines in another process until the block ends, the last first; gives the names of those it compiles.

    The first engine is left to this process, which begins with it.
    """
    cold = [name for name in reversed(engines[1:]) if not is_compiled(name)]
    if not cold or (os.cpu_count() or 1) < 2:
        yield []
        return
    import tomli_w

    command = [sys.executable, "-P", "-m", __name__, *cold]  # -P: in a clone the package itself, not its sources
    quiet = subprocess.DEVNULL
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=quiet, stderr=quiet) as process:
        try:
            assert process.stdin is not None
            with contextlib.suppress(BrokenPipeError):
                process.stdin.write(tomli_w.dumps(short(scenario).to_dict()).encode())
                process.stdin.close()
            yield cold
        finally:
            process.kill()


def is_compiled(engine: str) -> bool:
    """Return whether the cache beside the sources holds anything of an engine."""
    folder = Path(__file__).parents[1] / engine
    return not folder.is_dir() or any(folder.rglob("*.nbi"))


def short(scenario: Scenario) -> Scenario:
    """Return a scenario of a few output samples."""
    return dataclasses.replace(scenario, duration=min(SAMPLES, scenario.n_outputs - 1) * scenario.output_step)


def main() -> None:
    """Simulate the scenario on stdin with the engines that are named: what compiles on the way lands in the cache."""
    import tomllib

    from stochfric_mb.engines import adapter
    from stochfric_mb.scenario import scenario_from_dict

    scenario = scenario_from_dict(tomllib.loads(sys.stdin.read()))
    for name in sys.argv[1:]:
        adapter(name, effects=scenario.effects).simulate(scenario, seed=0)


if __name__ == "__main__":
    main()
