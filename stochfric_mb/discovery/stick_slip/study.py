"""What a data set of belt-box runs tells before anything is decided: slips, calibration, regression, stick phases."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.records import preconditions
from stochfric_mb.discovery.stick_slip.records.calibration import calibrate
from stochfric_mb.discovery.stick_slip.records.pool import Pool, make_pool
from stochfric_mb.discovery.stick_slip.records.record import CORRECTED, Record, corrections_of, make_record
from stochfric_mb.discovery.stick_slip.records.sensor_range import ReadingCurve, SensorRange, reading_curve, sensor_range
from stochfric_mb.discovery.stick_slip.records.slips import Slips, extract
from stochfric_mb.discovery.stick_slip.records.stick_phases import Sticking, analyse
from stochfric_mb.discovery.stick_slip.screening.regression import Baseline, baseline_of
from stochfric_mb.discovery.stick_slip.simulation.forecast import Windows, windows_of
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.prior_model import prior_model
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.dataset import Dataset, Run
from stochfric_mb.measurement.temperature import temperature_of
from stochfric_mb.measurement.units import ON_THE_SPRING

RECALIBRATIONS = 2
"""Further calibrations at most."""

Progress = Callable[[str], None]


@dataclasses.dataclass(frozen=True)
class Channels:
    """Which parts of the method are used; all of them, but for a study of what each is worth."""

    kinematic: bool = True
    """Whether the stick phases and the sensor are looked at by themselves first."""
    confirmation: bool = True
    """Whether candidates are confirmed by simulating them, and names must explain the runs."""
    unnamed: bool = True
    """Whether a term without a name is looked for where no name is known."""


EVERYTHING = Channels()
"""The whole method."""


@dataclasses.dataclass(frozen=True)
class Study:
    """Everything measured from the fit runs, before a decision."""

    dataset: Dataset
    """The data set."""
    model: Model
    """The model as stated, with mu_s and mu_k as stated."""
    uncertainty: Mapping[str, float]
    """Relative standard deviations of the stated numbers."""
    records: tuple[Record, ...]
    """Fit runs, cleaned."""
    pool: Pool
    """Their slips."""
    baseline: Baseline
    """The stated model, fitted to them."""
    sticking: Sticking | None
    """The kinematic channel."""
    range: SensorRange
    """The sensor's range, as far as its ends are reached."""
    curve: ReadingCurve | None
    """How the reading bends over; None where there is hardly any stick."""
    outliers: float
    """Share of samples that were outliers [-]."""
    belt: float = 1.0
    """Factor on the stated belt speeds with which these forces were taken [-]: the stuck box moves so much faster."""
    explained: float = 0.0
    """Evidence of what the stated model says of friction beyond two coefficients [-]: a law that depends on speed, effects."""

    @functools.cached_property
    def windows(self) -> tuple[Windows, ...]:
        """One-cycle-ahead forecasts of the fit runs."""
        return tuple(windows_of(s) for s in self.pool.slips)


def record_of(run: Run, dataset: Dataset) -> Record:
    """Return a run as a record.

    Raises:
        InputError: the run has no position.
    """
    if "position" not in run.channels:
        raise InputError(
            f"run {run.name}: no column 'position'; discovery on a belt-box needs the position of the box, "
            f"such as a column 'position [m]'{_instead(run)}"
        )
    mechanism = run.mechanism(dataset.scenario)
    return make_record(run.name, run.time, run.channels["position"], mechanism, temperature_of(run))


def _instead(run: Run) -> str:
    """Return how what a run holds is read as a position, or why it is not."""
    force = next((k for k in ("force", "friction_force") if k in run.channels), None)
    if force is not None:
        return f"; {ON_THE_SPRING}: name the column of {force} in columns = {{ position = ... }}"
    if "velocity" in run.channels:
        return (
            "; a velocity alone does not do, since it does not say where the spring is slack: integrate it from a rest with "
            "a slack spring and give that as the position, or record the position"
        )
    return ""


def study(dataset: Dataset, *, progress: Progress = lambda _: None) -> Study | None:
    """Return what the fit runs of a data set tell; None where no run has slips enough to tell anything.

    Raises:
        InputError: a run without a position, or one in which friction does not drive the box along with the belt.
    """
    model = prior_model(dataset.scenario)
    progress("slips")
    records = tuple(record_of(run, dataset) for run in dataset.fit)
    usable = _usable(records, dataset)
    if not usable:
        return None
    progress("calibration")
    baseline = _calibrated(usable, dataset.scenario.uncertainty)
    pool = baseline.pool
    return Study(
        dataset=dataset,
        model=model,
        uncertainty=dataset.scenario.uncertainty,
        records=records,
        pool=pool,
        baseline=baseline,
        sticking=analyse(pool.slips),
        range=sensor_range(pool.slips),
        curve=reading_curve(pool.slips),
        outliers=float(np.mean(np.concatenate([r.outlier for r in records]))),
    )


def retaken(study: Study, corrections: Mapping[str, float]) -> Study:
    """Return the study with forces taken with a mechanism that differs from the stated one by ``corrections``."""
    baseline, _ = _taken([extract(s.record.corrected(corrections)) for s in study.pool.slips], study.uncertainty)
    return dataclasses.replace(study, pool=baseline.pool, baseline=baseline)


def _usable(records: Sequence[Record], dataset: Dataset) -> list[Slips]:
    """Return the slips of the records that have enough of them; none where all have too few.

    Raises:
        InputError: a record in which friction does not drive the box along with the belt.
    """
    usable = [s for s in map(extract, records) if len(s) >= criteria.FEWEST_OF_RUN]
    if sum(map(len, usable)) < criteria.FEWEST_SLIPS:
        return []
    preconditions.require_driven(usable, dataset.scenario.law.mu_s)
    return usable


def require_usable(dataset: Dataset) -> None:
    """Return if discovery would not refuse the runs of a belt-box.

    Raises:
        InputError: a belt at rest, too few samples, a run without a position, or one in which friction does not drive the box
            along with the belt.
    """
    preconditions.require_usable(dataset)
    _usable([record_of(run, dataset) for run in dataset.fit], dataset)


def _calibrated(slips: Sequence[Slips], uncertainty: Mapping[str, float]) -> Baseline:
    """Return the slips with forces taken with the mechanism that they show, the bias of these taken out, and their fit.

    With the stated mechanism edges and forces err by more than noise where it is off by a few percent: what corrections of
    first order leave shapes every slip alike, as an effect does. A mechanism far beyond what is stated is none: an effect looks
    like one, and its forces are those of the stated mechanism.
    """
    baseline, shown = _taken(slips, uncertainty)
    for _ in range(RECALIBRATIONS):
        at = baseline.pool.slips[0].record.corrections
        off = baseline.solution.deviations[2:]
        if all(abs(shown[name] - at[name]) <= doubt for name, doubt in zip(CORRECTED, off, strict=True)):
            break
        slips = [extract(s.record.corrected(shown)) for s in slips]
        baseline, shown = _taken(slips, uncertainty)
    return baseline


def _taken(slips: Sequence[Slips], uncertainty: Mapping[str, float]) -> tuple[Baseline, dict[str, float]]:
    """Return the stated model, fitted to slips as they were extracted, and the corrections of the mechanism that they show."""
    baseline = baseline_of(make_pool(slips, [calibrate(s, seed=11 + i) for i, s in enumerate(slips)]), uncertainty)
    shown = corrections_of(baseline.solution.coefficients[2:])
    away = np.array(list(shown.values())) / baseline.terms.priors[2:]
    if away @ away > criteria.FAR_FROM_STATED:
        shown = dict.fromkeys(shown, 0.0)
    return baseline, shown


def slips_of_run(run: Run, dataset: Dataset, study: Study) -> Slips:
    """Return the slips of a run, forces taken with the mechanism that the fit runs of ``study`` show."""
    return extract(record_of(run, dataset).corrected(study.pool.slips[0].record.corrections))
