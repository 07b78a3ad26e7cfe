"""Compilation beside the main work: another process fills the cache for the engine whose turn comes last.

Only where nothing of it is compiled yet. MuJoCo takes as long as the reference and all other engines together, so a first
comparison on two cores takes half of the time.
"""

from __future__ import annotations

import contextlib
import dataclasses
import os
import subprocess
import sys
from collections.abc import Callable, Generator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stochfric_mb.scenario import Scenario

SAMPLES = 20
"""Output samples that the other process simulates: enough to call, and so compile, what an engine needs."""


@contextlib.contextmanager
def compiling_beside(engines: Sequence[str], scenario: Scenario) -> Generator[Callable[[str], None]]:
    """Compile the first engine in another process until the block ends; a comparison runs it last.

    Gives a function that waits until the engine of a name is compiled, if it is compiled beside.
    """
    cold = [name for name in engines[:1] if not is_compiled(name)]
    if not cold or (os.cpu_count() or 1) < 2:
        yield _wait_for_nothing
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

            def wait_for(name: str) -> None:
                if name in cold:
                    process.wait()

            yield wait_for
        finally:
            process.kill()


def _wait_for_nothing(_name: str) -> None:
    pass


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
