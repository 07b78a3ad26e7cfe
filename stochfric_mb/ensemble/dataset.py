"""Ensembles in NetCDF or Zarr: one dataset with dimensions run and time."""

# pyright: reportUnknownMemberType=false, reportUnknownArgumentType=false, reportUnknownVariableType=false
# (xarray is partly typed)

from __future__ import annotations

import importlib.util
import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.ensemble.collect import QUANTITIES
from stochfric_mb.ensemble.lanes import BREAK_AWAYS, FIRST, LAST, MU_S_SUM, STICK_TIME, TALLIES
from stochfric_mb.ensemble.result import Block, EnsembleResult
from stochfric_mb.ensemble.sketch import Sketch
from stochfric_mb.errors import InputError, MissingEngineError
from stochfric_mb.outputs import check_target, whole_file, whole_folder
from stochfric_mb.scenario import Scenario, any_scenario_from_dict
from stochfric_mb.storage import versions, write_netcdf

SCHEMA = "stochfric.ensemble/1"
NETCDF, ZARR = ".nc", ".zarr"
ZARR_MARKER = "zarr.json"
"""File that shows that a folder is a Zarr store."""
CHUNK_BYTES = 2**23
"""Size of a chunk of a Zarr store, about [bytes]."""
LEVELS = (0.005, 0.025, 0.05, 0.25, 0.5, 0.75, 0.95, 0.975, 0.995)
"""Quantiles that are stored where the runs are not."""

TALLY_VARIABLES: dict[str, tuple[int, str, str]] = {
    "n_break_aways": (BREAK_AWAYS, "1", "number of break-aways"),
    "first_break_away": (FIRST, "s", "time of the first break-away"),
    "last_break_away": (LAST, "s", "time of the last break-away"),
    "break_away_mu_s_sum": (MU_S_SUM, "1", "sum of the static coefficient of friction at the break-aways"),
    "stick_time": (STICK_TIME, "s", "time that the contact sticks"),
}
"""Name of a variable of each run -> its place in the tallies, unit, meaning."""
DERIVED = {
    "period": ("s", "mean interval between break-aways"),
    "break_away_mu_s": ("1", "mean static coefficient of friction at the break-aways"),
    "stick_fraction": ("1", "share of the time that the contact sticks"),
}
"""Name of a variable that follows from those -> unit, meaning."""

Variables = dict[str, tuple[Any, ...]]


def ensemble_ending(path: str | Path) -> str:
    """Return the ending of an ensemble's file or folder.

    Raises:
        InputError: it is neither ``.nc`` nor ``.zarr``.
        MissingEngineError: Zarr is not installed.
    """
    ending = Path(path).suffix.lower()
    if ending not in (NETCDF, ZARR):
        raise InputError(
            f"{path}: ending {ending!r} is unknown; an ensemble is written as .nc (NetCDF), or .zarr if it is large"
        )
    if ending == ZARR and importlib.util.find_spec("zarr") is None:
        raise MissingEngineError(
            f"{path} needs zarr, which is not installed; in a clone of this package run: pip install '.[cluster]'"
        )
    return ending


def check_ensemble_target(path: str | Path, *, force: bool = False) -> Path:
    """Return ``path`` once an ensemble can be written there.

    Raises:
        InputError: it exists (without ``force``), or is of the wrong kind or ending.
    """
    return check_target(path, force=force, marker=ZARR_MARKER if ensemble_ending(path) == ZARR else None)


def write_ensemble(result: EnsembleResult, path: str | Path, *, scenario: Scenario, force: bool = False) -> Path:
    """Return the path of the file (``.nc``) or folder (``.zarr``) that now holds an ensemble, whole or not at all.

    Args:
        result: the runs, or statistics of them.
        path: target.
        scenario: what was simulated; kept as its TOML text.
        force: whether what is there is replaced.

    Raises:
        InputError: unknown ending, or the target exists.
        MissingEngineError: Zarr is not installed.
    """
    target = check_ensemble_target(path, force=force)
    dataset = to_dataset(result, scenario)
    if ensemble_ending(path) == ZARR:
        with whole_folder(target, replace=force) as temporary:
            dataset.to_zarr(temporary, mode="w", consolidated=False, zarr_format=3)
    else:
        with whole_file(target, replace=force) as temporary:
            write_netcdf(dataset, temporary, encoding=_compression(dataset))
    return target


def write_blocks(
    blocks: Iterable[Block], n_runs: int, times: npt.NDArray[np.float64], path: str | Path, *, scenario: Scenario,
    attributes: Mapping[str, Any], force: bool = False,
) -> Path:  # fmt: skip
    """Return the path of the Zarr folder that now holds an ensemble; memory is needed for one chunk of runs only.

    Args:
        blocks: the runs, in order.
        n_runs: number of runs.
        times: output times [s].
        path: target, ending in ``.zarr``.
        scenario: what was simulated.
        attributes: as `EnsembleResult.attributes`.
        force: whether what is there is replaced.

    Raises:
        InputError, MissingEngineError: as `write_ensemble`.
    """
    target = check_ensemble_target(path, force=force)
    chunk = min(max(CHUNK_BYTES // (8 * len(times)), 1), n_runs)
    with whole_folder(target, replace=force) as temporary:
        done = 0
        for runs in _regrouped(blocks, chunk):
            result = EnsembleResult(
                time=times, position=runs.position, velocity=runs.velocity, stick=runs.stick, tallies=runs.tallies,
                attributes=dict(attributes) | {"n_runs": n_runs},
            )  # fmt: skip
            part = to_dataset(result, scenario, first_run=done)
            if done == 0:
                _lay_out(part, n_runs, chunk, temporary)
            part = part.drop_vars([n for n in part.variables if "run" not in part[n].dims])
            part.to_zarr(temporary, region={"run": slice(done, done + len(runs.tallies))}, consolidated=False)
            done += len(runs.tallies)
    return target


def read_ensemble(path: str | Path) -> tuple[EnsembleResult, Scenario]:
    """Return the ensemble in a file or folder that this package wrote, and its scenario.

    Raises:
        InputError: no such file, or it holds no ensemble.
        MissingEngineError: Zarr is not installed.
    """
    import tomllib

    path = Path(path)
    if not path.exists():
        raise InputError(f"{path}: no such file")
    with open_dataset(path) as dataset:
        about = {str(k): v.item() if isinstance(v, np.generic) else v for k, v in dataset.attrs.items()}
        if about.get("schema") != SCHEMA:
            raise InputError(f"{path}: schema = {about.get('schema')!r}; this version reads {SCHEMA!r}")
        scenario: Any = any_scenario_from_dict(tomllib.loads(about["scenario"]))
        about["notes"] = str(about.get("notes", "")).splitlines()
        tallies = np.empty((dataset.sizes["run"], TALLIES))
        for name, (place, _, _) in TALLY_VARIABLES.items():
            tallies[:, place] = dataset[name].values
        common = {"time": dataset["time"].values, "tallies": tallies, "attributes": about}
        if "position" in dataset:
            runs = {name: dataset[name].values for name in QUANTITIES}
            return EnsembleResult(**common, **runs, stick=dataset["stick"].values.astype(np.bool_)), scenario
        sketches = {name: _sketch(dataset, name) for name in QUANTITIES}
        return EnsembleResult(**common, sketches=sketches, stuck=dataset["stuck_runs"].values.astype(np.int64)), scenario


def open_dataset(path: str | Path) -> Any:
    """Return the dataset of an ensemble as xarray sees it, its values still on the disk.

    Raises:
        InputError: neither NetCDF 4 nor Zarr.
    """
    import xarray

    library: Any = xarray
    try:
        if ensemble_ending(path) == ZARR:
            return library.open_dataset(path, engine="zarr", consolidated=False, decode_times=False, chunks=None)
        return library.open_dataset(path, engine="h5netcdf", decode_times=False)
    except (OSError, ValueError, KeyError) as error:
        raise InputError(f"{path}: no ensemble: {error}") from None


def to_dataset(result: EnsembleResult, scenario: Scenario, *, first_run: int = 0) -> Any:
    """Return an ensemble as an `xarray.Dataset`: values, CF units and names, and what made it."""
    import xarray

    run: Any = np.arange(first_run, first_run + result.n_runs) + int(result.attributes.get("first_sample", 0))
    coordinates: Variables = {
        "run": ("run", run.astype(np.int64), _about("1", "sample: second part of the address of the run's coefficient path")),
        "time": ("time", result.time, _about("s", "time since the start of a run") | {"axis": "T"}),
    }
    variables = _of_runs(result)
    if result.position is None:
        variables |= _of_statistics(result)
        coordinates["level"] = ("level", np.array(LEVELS), _about("1", "level of a quantile"))
    else:
        for name in QUANTITIES:
            about = _about(_unit(result, name), f"{name} of the body")
            variables[name] = (("run", "time"), getattr(result, name), about)
        assert result.stick is not None
        flags = {"flag_values": np.array([0, 1], np.int8), "flag_meanings": "slip stick"}
        about = {"long_name": "whether the contact sticks"} | flags
        variables["stick"] = (("run", "time"), result.stick.view(np.int8), about)
    return xarray.Dataset(variables, coords=coordinates, attrs=_attributes(result, scenario))


def _of_runs(result: EnsembleResult) -> Variables:
    variables: Variables = {}
    for name, (place, unit, text) in TALLY_VARIABLES.items():
        variables[name] = ("run", result.tallies[:, place], _about(unit, text))
    for name, (unit, text) in DERIVED.items():
        variables[name] = ("run", getattr(result, name), _about(unit, text))
    return variables


def _of_statistics(result: EnsembleResult) -> Variables:
    """Return statistics for people, and the sketches that they come from."""
    assert result.stuck is not None
    variables: Variables = {"stuck_runs": ("time", result.stuck, _about("1", "number of runs that stick"))}
    variables["stick_probability"] = ("time", result.stick_probability, _about("1", "share of the runs that stick"))
    for name, sketch in result.sketches.items():
        unit = _unit(result, name)
        over = {"mean": ("run: mean", sketch.mean), "standard_deviation": ("run: standard_deviation", sketch.std)}
        over |= {"minimum": ("run: minimum", sketch.moments[3]), "maximum": ("run: maximum", sketch.moments[4])}
        for what, (cell, values) in over.items():
            about = _about(unit, f"{what.replace('_', ' ')} of the {name} of the body") | {"cell_methods": cell}
            variables[f"{name}_{what}"] = ("time", values, about)
        about = _about(unit, f"quantiles of the {name} of the body over the runs")
        variables[f"{name}_quantile"] = (("level", "time"), sketch.quantiles(LEVELS), about)
        about = _about(unit, f"no quantile of the {name} is off by more")
        variables[f"{name}_quantile_error"] = ("time", sketch.quantile_error, about)
        bin_text = f"edge i of the histogram of the {name}: (low + i) 2^exponent {unit}"
        variables[f"{name}_histogram"] = (("time", f"{name}_bin"), sketch.counts, _about("1", f"runs in each bin; {bin_text}"))
        variables[f"{name}_histogram_low"] = ("time", sketch.low, _about("1", "first bin edge, in bin widths"))
        variables[f"{name}_histogram_exponent"] = ("time", sketch.exponent, _about("1", "bin width = 2^exponent"))
        text = "shift, sum and sum of squares of (value - shift), smallest and largest value"
        variables[f"{name}_moments"] = (("moment", "time"), sketch.moments, {"long_name": text})
    return variables


def _sketch(dataset: Any, name: str) -> Sketch:
    return Sketch(
        counts=dataset[f"{name}_histogram"].values.astype(np.uint32),
        low=dataset[f"{name}_histogram_low"].values.astype(np.int64),
        exponent=dataset[f"{name}_histogram_exponent"].values.astype(np.int64),
        moments=dataset[f"{name}_moments"].values,
        n=int(dataset.sizes["run"]),
    )


def _unit(result: EnsembleResult, name: str) -> str:
    unit = str(result.attributes.get("position_unit", "m"))
    return unit if name == "position" else f"{unit} s-1"


def _about(unit: str, text: str) -> dict[str, Any]:
    return {"units": unit, "long_name": text}


def _attributes(result: EnsembleResult, scenario: Scenario) -> dict[str, Any]:
    """Return what a dataset says about itself; nothing in it depends on who computed it, or how fast."""
    import tomli_w

    given = {k: v for k, v in result.attributes.items() if k != "seconds"}
    notes = "\n".join(given.pop("notes", ()))
    about: dict[str, Any] = {"Conventions": "CF-1.11", "schema": SCHEMA, "title": scenario.title} | given
    about |= {"notes": notes, "scenario": tomli_w.dumps(scenario.to_dict())}
    about.setdefault("versions", json.dumps(versions()))
    return {k: v if isinstance(v, str | int | float) else json.dumps(v) for k, v in about.items()}


def _compression(dataset: Any) -> dict[str, dict[str, Any]]:
    """Return the encoding that packs what is mostly zeros or repeats."""
    packed = [n for n in dataset.data_vars if n == "stick" or str(n).endswith("_histogram")]
    return {name: {"zlib": True, "complevel": 2, "shuffle": True} for name in packed}


def _lay_out(part: Any, n_runs: int, chunk: int, folder: Path) -> None:
    """Write the frame of a store: everything that does not depend on the run, and room for what does."""
    import xarray
    import zarr

    wide: Any = part.isel(run=slice(0, 1))
    frame = xarray.Dataset(
        {n: v for n, v in part.variables.items() if "run" not in v.dims and n not in part.coords},
        coords={n: v for n, v in part.coords.items() if "run" not in v.dims}, attrs=part.attrs,
    )  # fmt: skip
    frame.to_zarr(folder, mode="w", consolidated=False, zarr_format=3)
    group = zarr.open_group(folder, mode="r+")
    runs = np.arange(n_runs) + int(part["run"][0])
    for name, variable in wide.variables.items():
        if "run" not in variable.dims:
            continue
        shape = (n_runs, *variable.shape[1:])
        array = group.create_array(
            str(name), shape=shape, chunks=(chunk if len(shape) > 1 else n_runs, *shape[1:]), dtype=variable.dtype,
            dimension_names=list(variable.dims), fill_value=math.nan if variable.dtype.kind == "f" else 0,
        )  # fmt: skip
        array.attrs.update({k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in variable.attrs.items()})
        if name == "run":
            array[:] = runs  # xarray leaves an index out when it writes a region


def _regrouped(blocks: Iterable[Block], n: int) -> Iterable[Block]:
    """Give the runs in groups of ``n`` (the last one of what is left)."""
    waiting: list[Block] = []
    count = 0
    for block in blocks:
        waiting.append(block)
        count += len(block.tallies)
        while count >= n:
            whole = _joined(waiting)
            yield _cut(whole, slice(None, n))
            waiting, count = [_cut(whole, slice(n, None))], count - n
    if count:
        yield _joined(waiting)


def _joined(blocks: Iterable[Block]) -> Block:
    arrays: Any = (np.concatenate(a) for a in zip(*blocks, strict=True))
    return Block(*arrays)


def _cut(block: Block, runs: slice) -> Block:
    return Block(block.position[runs], block.velocity[runs], block.stick[runs], block.tallies[runs])
