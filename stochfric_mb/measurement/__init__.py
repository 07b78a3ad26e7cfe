"""Measured records: datasets of runs, their files and units, and the checks they pass before anything is inferred."""

from stochfric_mb.measurement.dataset import Dataset, load_dataset
from stochfric_mb.measurement.delay import Delay, Term, estimate_delay
from stochfric_mb.measurement.readers import READERS, Reader, register_reader
from stochfric_mb.measurement.run import Run
from stochfric_mb.measurement.signs import SignError, probable_sign_error
from stochfric_mb.measurement.table import Table

__all__ = [
    "READERS",
    "Dataset",
    "Delay",
    "Reader",
    "Run",
    "SignError",
    "Table",
    "Term",
    "estimate_delay",
    "load_dataset",
    "probable_sign_error",
    "register_reader",
]
