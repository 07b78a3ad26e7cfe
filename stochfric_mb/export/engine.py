"""The belt-box FMU as an engine: exported for this machine and stepped by FMPy, as a master would do it.

It is the engine ``fmu`` of the registry, with the extra ``fmi``; the regression suite runs on it as on any other.
"""

# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false, reportUnknownVariableType=false
# (FMPy is not typed)

from __future__ import annotations

import functools
import importlib
import importlib.metadata
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from stochfric_mb.c.compiler import host
from stochfric_mb.coefficients import CoefficientPath
from stochfric_mb.effects.carry import reported
from stochfric_mb.errors import SimulationError
from stochfric_mb.export.exported import exported_scenario
from stochfric_mb.export.fmu import Source, fmu_source, write_fmu
from stochfric_mb.scenario import Scenario
from stochfric_mb.trajectory import Trajectory

CARRIES_EFFECTS = True
REPORTS = 50
"""Calls of ``progress`` in a run."""
OUTPUTS = ("position", "velocity", "friction_force", "mu_s", "mu_k")


def simulate(
    scenario: Scenario,
    *,
    seed: int = 0,
    sample: int = 0,
    dt: float | None = None,
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """Return the trajectory of a belt-box scenario from its FMU (FMI 3.0, co-simulation).

    Args:
        scenario: the scenario.
        seed: first part of the address of the coefficient path.
        sample: second part.
        dt: internal step of the FMU [s], dividing the output step, which is the communication step.
        progress: called with the simulated time [s] now and then.

    Raises:
        StabilityError: ``dt`` is beyond the law's stability limit.
        InputError: ``dt`` does not divide the output step, or an address out of range.
        MissingEngineError: FMPy or the compiler is not installed.
        SimulationError: the FMU gave an error, or a state beyond reason.
    """
    step = scenario.checked_step(dt)
    CoefficientPath(scenario.coefficient_process, scenario.law, seed=seed, sample=sample)  # refuses an address
    exported = exported_scenario(scenario)
    source = fmu_source(exported, fmi=3, mechanism=True)
    unzipped = _built(source.identifier, source.description, tuple(source.files.items()))
    before = time.perf_counter()
    rows = _run(scenario, unzipped, {"seed": seed, "sample": sample}, step, progress)
    n_steps = (scenario.n_outputs - 1) * round(scenario.output_step / step)
    attributes: dict[str, Any] = {
        "engine": "fmu",
        "version": importlib.metadata.version("fmpy"),
        "hook": "FMI 3.0 co-simulation through FMPy",
        "dt": step,
        "seed": seed,
        "sample": sample,
        "law": exported.inner.kind,
        "notes": list(exported.notes),
        "n_steps": n_steps,
        "seconds_per_step": (time.perf_counter() - before) / n_steps,
    }
    if not exported.effects:
        attributes["law"] = scenario.law.kind
    normal = np.full(len(rows), scenario.mechanism.normal_force)
    x, v, force, mu_s, mu_k, stick = rows.T.copy()
    trajectory = Trajectory(scenario.output_times(), x, v, force, normal, mu_s, mu_k, stick, attributes=attributes)
    return reported(trajectory, scenario.mechanism, scenario.effects, seed=seed, sample=sample)


_folders: list[Any] = []


@functools.lru_cache(maxsize=32)
def _built(identifier: str, description: str, files: tuple[tuple[str, str], ...]) -> str:
    """Return the folder of the unzipped FMU, compiled for this machine."""
    folder = tempfile.TemporaryDirectory(prefix="stochfric-fmu-", ignore_cleanup_errors=True)
    _folders.append(folder)
    fmu = Path(folder.name) / f"{identifier}.fmu"
    write_fmu(Source(identifier, description, dict(files), 3), fmu, platforms=[host().name])
    return str(_fmpy("fmpy").extract(str(fmu), unzipdir=str(Path(folder.name) / "unzipped")))


def _fmpy(module: str) -> Any:
    return importlib.import_module(module)


def _run(
    scenario: Scenario, unzipped: str, address: dict[str, int], step: float, progress: Callable[[float], None] | None
) -> Any:
    """Return rows of x, x', F, mu_s, mu_k, stick at the output times."""
    about = _fmpy("fmpy").read_model_description(unzipped)
    fmi3 = _fmpy("fmpy.fmi3")
    places = {v.name: v.valueReference for v in about.modelVariables}
    said: list[str] = []
    fmu = fmi3.FMU3Slave(
        guid=about.instantiationToken,
        unzipDirectory=unzipped,
        modelIdentifier=about.coSimulation.modelIdentifier,
        instanceName="belt_box",
    )
    fmu.instantiate(logMessage=lambda _environment, _status, _category, message: said.append(message.decode()))
    times = scenario.output_times()
    rows = np.empty((len(times), 6))
    reals = [places[name] for name in OUTPUTS]
    every = max(1, (len(times) - 1) // REPORTS)
    try:
        fmu.setUInt32([places[name] for name in address], list(address.values()))
        fmu.setFloat64([places["internal_step"]], [step * (1.0 + 1.0e-9)])  # so that rounding adds no step
        fmu.enterInitializationMode(startTime=0.0)
        fmu.exitInitializationMode()
        for i, t in enumerate(times):
            if i > 0:
                fmu.doStep(currentCommunicationPoint=times[i - 1], communicationStepSize=t - times[i - 1])
            rows[i, :5] = fmu.getFloat64(reals)
            rows[i, 5] = fmu.getBoolean([places["stick"]])[0]
            scenario.require_sane("fmu", t, rows[i, 0], step)
            if progress is not None and (i % every == 0 or i == len(times) - 1):
                progress(t)
    except _fmpy("fmpy.fmi1").FMICallException as error:
        raise SimulationError(f"fmu: {said[-1] if said else error}") from None
    finally:
        fmu.freeInstance()
    return rows
