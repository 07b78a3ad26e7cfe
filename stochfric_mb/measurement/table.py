"""What a reader returns: the named columns of one file, as they are in it."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True, kw_only=True)
class Table:
    """The numeric columns of a file, in its own units and under its own names, before any check."""

    columns: Mapping[str, Array]
    """Name -> float64[n], in the order of the file; not all need be of one length. Missing values are NaN."""
    units: Mapping[str, str] = dataclasses.field(default_factory=dict[str, str])
    """Name -> unit, where the file says it."""
    constants: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Single numbers beside the columns, such as a gain."""
    has_header: bool = True
    """Whether the names come from the file; without a header they are the column numbers."""
    rows: npt.NDArray[np.int64] | None = None
    """Number by which a person finds each sample in the file, int64[n]; None: 1, 2, 3 ..."""
    row_word: str = "sample"
    """What that number counts: ``line`` of a text file, or ``sample``."""
