"""A second scoring of the claim "gap closed": `augmented.toml` alone, re-simulated on the held-out runs.

Everything but the simulator is separate from the package's own scoring: files are read with NumPy and tomllib, stick
phases are found from a smoothed velocity, forecasts start in the middle of each and reach to the middle of the next.
Only what the files hold is used: the held-out runs, `augmented.toml`, and from `result.json` the recalibrated numbers
and the floor.

    python -m tests.discovery.resimulate --dataset DIR --answer DIR
"""

import argparse
import dataclasses
import itertools
import json
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.effects import Effect
from stochfric_mb.reference.augmented import Start, augmented_system
from stochfric_mb.scenario import Scenario, load_scenario

Array = npt.NDArray[np.float64]

SMOOTHING = 0.04
"""Length of the moving mean before the position is differentiated [s]."""
FOLLOWS = 0.5
"""Difference of velocities, over the belt's, below which the box sticks [-]."""
SHORTEST = 0.15
"""Shortest stick phase that a forecast starts in [s]."""
MOST = 30
"""Forecasts a run."""
MEMBERS = 24
"""Members of an ensemble, where friction is random."""
OUTPUTS = 100
"""Compared samples of a forecast."""
SHIFTS = 48
"""Shifts in time at which a ripple's place in a run is looked for; then twice a third as wide about the best."""


@dataclasses.dataclass(frozen=True)
class Run:
    """A held-out run."""

    time: Array
    position: Array
    settings: dict[str, float]


@dataclasses.dataclass(frozen=True)
class Rescored:
    """Errors of forecasts over one cycle on the held-out runs [m]."""

    recalibrated: float
    """The model as stated, with the numbers that `result.json` holds."""
    augmented: float
    """`augmented.toml`."""
    floor: float
    """As `result.json` states it."""

    @property
    def closed(self) -> float | None:
        """Share of the gap that is closed; None where less than 5 % of the error is reducible."""
        reducible = self.recalibrated - self.floor
        return (self.recalibrated - self.augmented) / reducible if reducible > 0.05 * self.recalibrated else None


def rescored(dataset: Path, answer: Path) -> Rescored | None:
    """Score the files of a discovery; None where they make no claim on held-out runs."""
    result = json.loads((answer / "result.json").read_text())
    if not result["gap"]:
        return None
    augmented = load_scenario(answer / "augmented.toml")
    recalibrated = _recalibrated(load_scenario(dataset / "scenario.toml"), result["believed"])
    runs = [
        _read(dataset, entry)
        for entry in tomllib.loads((dataset / "dataset.toml").read_text())["runs"]
        if entry["role"] == "test"
    ]
    errors: dict[str, list[Array]] = {"recalibrated": [], "augmented": []}
    for number, run in enumerate(runs):
        starts = _starts(run, recalibrated)
        half = len(starts) // 2 if _ripples(augmented) else 0
        # a file has room for one phase of a ripple, that of the first held-out run; in others it is found from their first half
        own = augmented if number == 0 or not half else _in_step(augmented, run, starts[:half])
        errors["recalibrated"].append(_errors(recalibrated, run, starts[half:]))
        errors["augmented"].append(_errors(own, run, starts[half:]))
    means = {name: float(np.concatenate(parts).mean()) for name, parts in errors.items()}
    return Rescored(means["recalibrated"], means["augmented"], result["gap"]["floor"])


def _read(dataset: Path, entry: dict[str, Any]) -> Run:
    table = np.genfromtxt(dataset / entry["file"], delimiter=",", names=True, deletechars="")
    names = {name.split("_[")[0].split(" [")[0]: name for name in table.dtype.names or ()}
    return Run(table[names["time"]], table[names["position"]], dict(entry.get("set", {})))


def _recalibrated(scenario: Scenario, numbers: dict[str, Any]) -> Scenario:
    value = {name: entry["value"] for name, entry in numbers.items()}
    law = {name: value[name] for name in ("mu_s", "mu_k") if name in value}
    box = {name: value[name] for name in ("mass", "stiffness", "damping") if name in value}
    return dataclasses.replace(
        scenario,
        law=dataclasses.replace(scenario.law, **law),
        mechanism=dataclasses.replace(scenario.mechanism, **box),
    )


def _starts(run: Run, scenario: Scenario) -> list[tuple[int, int, float]]:
    """Sample in the middle of a stick phase, sample in the middle of the next, and time in stick until then [s]."""
    rate = 1.0 / (run.time[1] - run.time[0])
    belt = run.settings.get("belt_velocity", scenario.mechanism.belt_velocity)
    width = round(SMOOTHING * rate)
    smooth = np.convolve(run.position, np.ones(width) / width, mode="same")
    sticks = np.abs(np.gradient(smooth, 1.0 / rate) - belt) < FOLLOWS * abs(belt)
    sticks[:width] = sticks[-width:] = False
    edges = np.flatnonzero(np.diff(np.r_[0, sticks.astype(int), 0]))
    phases = [(a, b) for a, b in zip(edges[::2], edges[1::2], strict=True) if b - a > SHORTEST * rate]
    middles = [((a + b) // 2, (b - a) / 2.0 / rate) for a, b in phases]
    starts = [(m, n, dwell) for (m, dwell), (n, _) in itertools.pairwise(middles)]
    return starts[:: max(1, len(starts) // MOST)]


def _errors(scenario: Scenario, run: Run, starts: list[tuple[int, int, float]]) -> Array:
    """Error of each forecast [m]: the mean absolute one, or the CRPS of an ensemble where friction is random."""
    random = scenario.process is not None or any(
        e.coefficient_process() is not None or e.kind == "impacts" for e in scenario.effects
    )
    scores = []
    for window, start in enumerate(starts):
        first, last, _ = start
        # forecasts that shared their draws from event to event would share their luck
        samples = range(MEMBERS * window, MEMBERS * (window + 1) if random else MEMBERS * window + 1)
        chosen = np.unique(np.linspace(first + 1, last, OUTPUTS).round().astype(int))
        paths = np.stack([_path(scenario, run, start, sample)[chosen - first - 1] for sample in samples])
        score = np.abs(paths - run.position[chosen]).mean(axis=0)
        if random:
            apart = np.abs(paths[:, None] - paths[None, :]).sum(axis=(0, 1))
            score -= 0.5 * apart / (MEMBERS * (MEMBERS - 1))
        scores.append(score.mean())
    return np.array(scores)


def _path(scenario: Scenario, run: Run, start: tuple[int, int, float], sample: int) -> Array:
    """What the sensor will show from a start on, sample by sample [m]."""
    first, last, dwell = start
    step = float(run.time[1] - run.time[0])
    box = dataclasses.replace(scenario.mechanism, **run.settings)
    around = round(0.05 / step)
    shown = float(np.mean(run.position[first - around : first + around + 1]))
    time = float(run.time[first])
    generator = np.random.default_rng(sample)
    sensor = [e for e in scenario.effects if e.group == "sensor" and e.kind != "sensor_outliers"]
    late = sum(float(getattr(e, "delay", 0.0)) for e in sensor)
    true = shown - sum(_offset(e, time, shown) for e in sensor if e.kind in ("sensor_drift", "sensor_step"))
    system = augmented_system(box, scenario.law, scenario.effects, scenario.process, seed=1, sample=sample)
    motion = system.march(Start(time - late, true, box.belt_velocity, stick=True, dwell=dwell), step, last - first)
    path = motion.position
    for effect in sensor:
        if effect.kind != "sensor_delay":  # taken into account by the earlier start
            path = effect.measure(run.time[first + 1 : last + 1], path, generator)
    return path


def _offset(effect: Effect, time: float, shown: float) -> float:
    return float(effect.measure(np.array([time]), np.array([shown]), np.random.default_rng(0))[0]) - shown


def _ripples(scenario: Scenario) -> list[Effect]:
    return [e for e in scenario.effects if hasattr(e, "phase")]


def _in_step(scenario: Scenario, run: Run, starts: list[tuple[int, int, float]]) -> Scenario:
    """The scenario with its ripples shifted together, in time or along the belt, to where they lie in a run."""
    few = starts[:: max(1, len(starts) // 8)]
    belt = float(run.settings.get("belt_velocity", scenario.mechanism.belt_velocity))
    slowest = min(_frequency(e, belt) for e in _ripples(scenario))
    shifts, width = np.arange(SHIFTS) / SHIFTS / slowest, 1.0 / SHIFTS / slowest
    best = scenario
    for _ in range(3):
        trials = [_shifted(scenario, float(shift), belt) for shift in shifts]
        costs = [float(_errors(trial, run, few).mean()) for trial in trials]
        place = int(np.argmin(costs))
        best, shifts = trials[place], shifts[place] + width * np.linspace(-1.0, 1.0, 7)
        width /= 3.0
    return best


def _frequency(effect: Effect, belt: float) -> float:
    return float(getattr(effect, "frequency", 0.0) or abs(belt) / getattr(effect, "wavelength", np.inf))


def _shifted(scenario: Scenario, shift: float, belt: float) -> Scenario:
    effects = []
    for effect in scenario.effects:
        if hasattr(effect, "phase"):
            turn = 2.0 * np.pi * _frequency(effect, belt) * shift
            phases = {
                n: getattr(effect, n) + int(n[6:] or 1) * turn for n in ("phase", "phase_2", "phase_3") if hasattr(effect, n)
            }
            effect = dataclasses.replace(effect, **phases)  # type: ignore[arg-type]  # noqa: PLW2901
        effects.append(effect)
    return dataclasses.replace(scenario, effects=tuple(effects))


def main() -> None:
    """Print the two scorings side by side."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--dataset", type=Path, required=True)
    parser.add_argument("--answer", type=Path, required=True)
    chosen = parser.parse_args()
    result = rescored(chosen.dataset, chosen.answer)
    gap = json.loads((chosen.answer / "result.json").read_text())["gap"]
    print("stated:", gap and {name: gap[name] for name in ("recalibrated", "augmented", "floor", "closed")})
    print("re-simulated:", result, "closed", result and result.closed)


if __name__ == "__main__":
    main()
