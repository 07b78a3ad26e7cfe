"""Measured datasets for tests, discovered once in a session."""

import dataclasses
import functools
from pathlib import Path

import pytest

from stochfric_mb.discovery.driven_joint import JointOutcome, joint_outcome
from stochfric_mb.measurement import Dataset, load_dataset
from stochfric_mb.measurement.entries import data_folder

MODELS = Path(__file__).parents[3] / "models"


def dataset(name: str) -> Dataset:
    if data_folder() is None:
        pytest.skip("the measured data are not here: set STOCHFRIC_DATA to their folder")
    return load_dataset(MODELS / name)


@functools.cache
def outcome(name: str) -> JointOutcome:
    return joint_outcome(dataset(name))


def repeated(data: Dataset, result: JointOutcome) -> Dataset:
    """The held-out repeats as fit runs, and the augmented model as the stated one."""
    swapped = tuple(dataclasses.replace(r, role="test" if r.role == "fit" else "fit") for r in data.runs)
    return dataclasses.replace(data, scenario=result.scenario, runs=swapped)


def kinds(result: JointOutcome) -> list[str]:
    return [e.kind for e in result.result.effects]
