"""Datasets: what was measured, and the present model; read from TOML (`stochfric.dataset/1`)."""

from __future__ import annotations

import dataclasses
import itertools
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from stochfric_mb.errors import InputError
from stochfric_mb.measurement.assemble import RunEntry, assemble
from stochfric_mb.measurement.entries import SCHEMA, run_entries
from stochfric_mb.measurement.quantities import KNOWN
from stochfric_mb.measurement.run import Run, apply_settings
from stochfric_mb.measurement.sampling import MIN_PIECE, GapError
from stochfric_mb.measurement.signs import run_sign_error
from stochfric_mb.measurement.wrong_units import require_plausible
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.scenario import Scenario, bundled_scenarios, load_any_scenario

FILE = "dataset.toml"
"""Name of the file that describes a dataset, in its folder."""
MOST_PIECES = 20
"""Most pieces that a record with gaps is cut into [-]: with more, the recorder is at fault."""
HELD_OUT = 1.0 / 3.0
"""Part of the time that is held out where one file alone is given."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Dataset:
    """Runs of one rig, and the scenario that states its model."""

    title: str
    """A line for people."""
    scenario_path: Path | None = None
    """File of the scenario; None if it was given as an object."""
    scenario: Scenario[Any]
    """The present model."""
    runs: tuple[Run, ...]
    """All runs, in the order of the file."""

    @property
    def fit(self) -> tuple[Run, ...]:
        """Runs that models are fitted to."""
        return tuple(run for run in self.runs if run.role == "fit")

    @property
    def test(self) -> tuple[Run, ...]:
        """Runs that are held out and only scored."""
        return tuple(run for run in self.runs if run.role == "test")


def load_dataset(path: str | Path, scenario: str | Path | Scenario[Any] | None = None, *, plausible: bool = True) -> Dataset:
    """Return a dataset, read and checked.

    Args:
        path: a folder with ``dataset.toml``, that file, or one measured file alone: its last third is then held out.
        scenario: the present model, as a file, the name of a bundled scenario, or an object; it replaces the
            dataset's own, and is needed with a measured file.
        plausible: refuse values that cannot be in the units stated; False reads them for a picture.

    Raises:
        InputError: something in it cannot be used; names the file, the key or line, the rule and the remedy.
        MissingEngineError: a library that reads one of its files is not installed.
    """
    if not isinstance(path, str | Path):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f"a {type(path).__name__} is no dataset: give a file or folder, or make Run objects of arrays and a Dataset of "
            'these (docs/discovery.md, "Records in arrays")'
        )
    path = Path(path)
    if path.is_dir():
        path = path / FILE
        if not path.is_file():
            raise InputError(f"{path.parent} is a folder without {FILE}; write one, or give a measured file and --scenario")
    if not path.exists():
        raise InputError(f"{path}: no such file; give a folder with {FILE}, or a measured file and --scenario")
    return (_described if path.suffix.lower() == ".toml" else _alone)(path, scenario, plausible)


def _described(path: Path, scenario: str | Path | Scenario[Any] | None, plausible: bool) -> Dataset:
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: not a TOML file: {error}") from None
    if "mechanism" in tables:
        raise InputError(f"{path} is a scenario, not a dataset; give a measured file or a dataset.toml, with --scenario {path}")
    try:
        entries = run_entries(tables, path.parent)
        model, source = _scenario(_named(tables, path.parent) if scenario is None else scenario)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    for entry in entries:
        apply_settings(model, entry.settings, f"{path}: run {entry.name!r}")
    runs = tuple(run for entry in entries for run in _pieces(entry, model))
    if plausible:
        runs = tuple(_plausible(run, model, _stated_in(source)) for run in runs)
    dataset = Dataset(title=str(tables.get("title", "")), scenario_path=source, scenario=model, runs=runs)
    return checked(dataset, str(path))


def _alone(path: Path, scenario: str | Path | Scenario[Any] | None, plausible: bool) -> Dataset:
    """Return the dataset of one measured file: its last third is held out."""
    if scenario is None:
        raise InputError(f"{path}: a measured file alone says nothing about the rig; give --scenario SCENARIO")
    model, source = _scenario(scenario)
    pieces = _pieces(RunEntry(file=path, name=path.stem), model)
    if plausible:
        pieces = [_plausible(run, model, _stated_in(source)) for run in pieces]
    start, end = float(pieces[0].time[0]), float(pieces[-1].time[-1])
    cut = end - HELD_OUT * (end - start)
    first = [run.between(start, cut, name=f"{run.name} (first two thirds)", role="fit") for run in pieces]
    last = [run.between(cut, float("inf"), name=f"{run.name} (last third)", role="test") for run in pieces]
    runs = tuple(run for run in (*first, *last) if run.time.size >= MIN_PIECE)
    if {run.role for run in runs} != {"fit", "test"}:
        raise InputError(
            f"{path}: {last[-1].time.size} samples in its last third, which is held out; at least {MIN_PIECE} are needed "
            "there and before, without a gap: record longer"
        )
    return Dataset(title=path.name, scenario_path=source, scenario=model, runs=runs)


def rotates(scenario: Scenario[Any]) -> bool | None:
    """Return whether the mechanism's friction acts about an axis: positions are then angles; None: joints of both kinds."""
    return getattr(scenario.mechanism, "rotational", False)


def _pieces(entry: RunEntry, model: Scenario[Any]) -> list[Run]:
    """Return the run of an entry, or, where samples are missing, a run for each piece between the gaps.

    What happened in a gap is unknown: it is left out, and never taken for motion. On a belt something always moves.
    """
    if entry.max_gap is not None and isinstance(model.mechanism, BeltBox):
        note = "max_gap is not used: the belt runs on in a gap, so that a straight line across it would be no motion of the box"
        return [_with_note(run, note) for run in _pieces(dataclasses.replace(entry, max_gap=None), model)]
    rotational = rotates(model)
    try:
        return [assemble(entry, rotational=rotational)]
    except GapError as error:
        if not 0 < len(error.pieces) <= MOST_PIECES:
            raise
        note = f"samples are missing: {len(error.pieces)} pieces between the gaps are runs of their own"
        first, *others = [
            assemble(dataclasses.replace(entry, name=f"{entry.name}, piece {i}", time_range=span), rotational=rotational)
            for i, span in enumerate(error.pieces, start=1)
        ]
        return [_with_note(first, note), *others]


def _with_note(run: Run, note: str) -> Run:
    return dataclasses.replace(run, notes=(note, *run.notes))


def checked(dataset: Dataset, where: str = "dataset", *, scenario: str | Path | Scenario[Any] | None = None) -> Dataset:
    """Return a dataset whose runs of arrays are as plausible as those of files, with a note on samples in both roles.

    Args:
        dataset: runs, each sound by itself, and the model.
        where: what it is, for messages.
        scenario: the present model, in the place of the dataset's own.

    Raises:
        InputError: no run to fit or none held out, runs of one name, a setting that is none of the mechanism's, or values that
            cannot be right.
    """
    if scenario is not None:
        model, source = _scenario(scenario)
        dataset = dataclasses.replace(dataset, scenario=model, scenario_path=source)
    model, stated_in = dataset.scenario, _stated_in(dataset.scenario_path)
    names = [run.name for run in dataset.runs]
    for run in dataset.runs:
        run.mechanism(model)
        if names.count(run.name) > 1:
            raise InputError(f"{where}: {names.count(run.name)} runs have the name {run.name!r}; give each run its own")
    runs = [run if run.source else _plausible(run, model, stated_in) for run in dataset.runs]
    fit = tuple(run for run in runs if run.role == "fit")
    runs = tuple(_seen_in_fit(run, fit) if run.role == "test" else run for run in runs)
    dataset = dataclasses.replace(dataset, runs=runs)
    _require_roles(where, dataset)
    return dataset


def _stated_in(source: Path | None) -> str:
    return "the scenario" if source is None else str(source)


def _plausible(run: Run, scenario: Scenario[Any], stated_in: str) -> Run:
    """Return the run once it is plausible, with notes if it hardly fits the model, or its friction has the wrong sign."""
    units = {k: q.units_of(rotates(scenario))[0] for k, q in KNOWN.items()}
    shown = dataclasses.replace(run, source=f"run {run.name!r}", units=units | dict(run.units), file_units=units)
    shown = run if run.source else shown
    try:
        doubts = (require_plausible(shown, scenario, stated_in), run_sign_error(run, scenario))
    except InputError as error:
        remedy = "" if run.source else " (runs of arrays have no such keys: bring the arrays to SI units and signs beforehand)"
        raise InputError(f"{error}{remedy}") from None
    return dataclasses.replace(run, notes=(*run.notes, *(str(doubt) for doubt in doubts if doubt)))


def _scenario(source: str | Path | Scenario[Any]) -> tuple[Scenario[Any], Path | None]:
    if isinstance(source, Scenario):
        return source, None
    model = load_any_scenario(source)
    return model, Path(source) if Path(source).is_file() else bundled_scenarios()[str(source)]


def _named(tables: Mapping[str, Any], folder: Path) -> Path | str:
    """Return the scenario that a dataset names: a file beside it, or a bundled scenario."""
    name = tables.get("scenario")
    if not isinstance(name, str):
        raise InputError(
            f'scenario = {name!r}: a dataset names the file of the present model; write scenario = "scenario.toml"'
        )
    return folder / name if (folder / name).exists() or Path(name).suffix else name


def _require_roles(where: str, dataset: Dataset) -> None:
    roles = ", ".join(f"{run.name}: {run.role}" for run in dataset.runs)
    if not dataset.fit:
        raise InputError(f'{where}: no run to fit ({roles}); give at least one run role = "fit"')
    if not dataset.test:
        raise InputError(
            f'{where}: no run is held out ({roles}), so that nothing could be scored; give a run role = "test", or cut one '
            "file into two runs with time_range"
        )


def _seen_in_fit(test: Run, fit: tuple[Run, ...]) -> Run:
    """Return a run that is held out, with a note if samples of it are fitted."""
    shared = {run.name: n for run in fit if (n := _shared(run, test)) > 1}  # ranges may meet in a sample
    notes = tuple(
        f"{n} of its samples are in run {name!r}, which is fitted: scores on them are not of held-out data; give another file, "
        "or time_range = [first, last] that do not overlap"
        for name, n in shared.items()
    )
    return dataclasses.replace(test, notes=tuple(dict.fromkeys((*test.notes, *notes)))) if notes else test


def _shared(one: Run, other: Run) -> int:
    """Return how many samples two runs have in common: those of one file at one time, in the same columns."""
    start, end = max(one.time[0], other.time[0]), min(one.time[-1], other.time[-1])
    if one.source != other.source or start > end:
        return 0
    first, second = (run.between(start, np.nextafter(end, np.inf), name=run.name, role=run.role) for run in (one, other))
    pairs = [(values, second.channels[name]) for name, values in first.channels.items() if name in second.channels]
    return first.time.size if pairs and all(itertools.starmap(np.array_equal, pairs)) else 0


__all__ = ["FILE", "SCHEMA", "Dataset", "Run", "checked", "load_dataset", "rotates"]
