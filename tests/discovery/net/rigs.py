"""Belt-box data sets of the net: the generator's cases, cut short, on rigs of four sizes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

from stochfric_mb.measurement.dataset import Dataset, load_dataset
from tests.discovery.generator.case import Case, write


@dataclass(frozen=True)
class Size:
    """Units of force, length and time of a rig, over those of the generator's."""

    force: float
    length: float
    time: float


SIZES = {
    "bench": Size(1.0, 1.0, 1.0),
    "gauge": Size(0.02, 0.1, 0.3),  # a quarter of a newton, slips of a tenth of a millimetre
    "axis": Size(40.0, 0.25, 0.1),  # half a kilonewton, a stiff drive that rings at 40 Hz
    "press": Size(3000.0, 8.0, 5.0),  # tens of kilonewtons, slow
}
SHORT = {True: 20.0, False: 30.0}
"""Seconds that are kept of a run [s], where there are several operating points and where there is one."""


def grown(dataset: Dataset, size: Size) -> Dataset:
    """Return the same rig in other units, under the old names of the units."""
    force, length, time = size.force, size.length, size.time
    of = {
        "mass": force / length * time**2, "damping": force / length * time, "stiffness": force / length, "normal_force": force,
        "belt_velocity": length / time, "excitation_amplitude": length, "excitation_angular_frequency": 1.0 / time,
    }  # fmt: skip
    scenario = dataset.scenario
    mechanism = replace(scenario.mechanism, **{k: getattr(scenario.mechanism, k) * factor for k, factor in of.items()})
    process = scenario.process
    if process is not None:
        process = replace(process, spacing=process.spacing * time)
    scenario = replace(
        scenario,
        process=process,
        mechanism=mechanism,
        duration=scenario.duration * time,
        output_step=scenario.output_step * time,
    )
    units = {"position": length, "velocity": length / time, "friction_force": force}
    runs = tuple(
        replace(
            run,
            time=run.time * time,
            channels={name: values * units[name] for name, values in run.channels.items()},
            settings={name: value * of[name] for name, value in run.settings.items()},
            sample_interval=run.sample_interval * time,
        )
        for run in dataset.runs
    )
    return replace(dataset, scenario=scenario, runs=runs)


def belt_box(case: Case, size: str = "bench") -> Dataset:
    """Return a case of the generator as its files hold it, cut short, on a rig of another size."""
    with TemporaryDirectory() as folder:
        write(case, Path(folder) / "rig", Path(folder) / "truth.json")
        dataset = load_dataset(Path(folder) / "rig")
    end = SHORT[case.experiment.several_points]
    runs = tuple(run.between(-1.0, end, name=run.name, role=run.role) for run in dataset.runs)
    dataset = replace(dataset, runs=runs)
    return dataset if size == "bench" else grown(dataset, SIZES[size])
