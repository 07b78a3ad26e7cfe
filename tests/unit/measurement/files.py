"""Small measured files, written by other means than the readers, and where real ones are."""

import os
from pathlib import Path

import numpy as np
import pytest

TIME = np.arange(120) * 1e-3 + 0.25
POSITION = 0.02 * np.sin(40.0 * TIME)

BESIDE = Path(__file__).resolve().parents[4] / "shared" / "data"


def measured(name: str) -> Path:
    """Return a real measured file, or skip the test."""
    folder = Path(os.environ.get("STOCHFRIC_DATA", BESIDE))
    if not (folder / name).exists():
        pytest.skip(f"measured data {name} is not in {folder}; set STOCHFRIC_DATA")
    return folder / name


def dataset(folder: Path, *runs: str, scenario: str = "kang2015_table1", more: str = "") -> Path:
    """Write dataset.toml with the runs' own lines of TOML; return its folder."""
    text = f'schema = "stochfric.dataset/1"\ntitle = "rig"\nscenario = "{scenario}"\n{more}\n'
    (folder / "dataset.toml").write_text(text + "".join(f"[[runs]]\n{run}\n" for run in runs), encoding="utf-8")
    return folder


def csv(path: Path, **columns) -> Path:
    """Write columns as CSV; a key ``position__mm`` is the header ``position [mm]``."""
    heads = [k.replace("__", " [") + ("]" if "__" in k else "") for k in columns]
    rows = zip(*(np.asarray(c, dtype=object) for c in columns.values()), strict=True)
    lines = [",".join(heads), *(",".join(v if isinstance(v, str) else repr(float(v)) for v in row) for row in rows)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path
