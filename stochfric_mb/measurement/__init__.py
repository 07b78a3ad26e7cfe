"""Measured records: datasets of runs, their files and units, and the checks they pass before anything is inferred."""

from stochfric_mb.measurement.dataset import Dataset, load_dataset
from stochfric_mb.measurement.run import Run

__all__ = ["Dataset", "Run", "load_dataset"]
