"""Signed integers that a log holds as unsigned ones."""

import numpy as np
import pytest

from stochfric_mb.errors import InputError
from stochfric_mb.measurement.assemble import RunEntry, assemble


def write(path, values):
    # a clock that jitters: what is read is interpolated, after the words have been turned
    times = 0.01 * np.arange(len(values)) + 0.002 * (np.arange(len(values)) % 2)
    rows = [f"{t:.4f},{v}" for t, v in zip(times, values, strict=True)]
    path.write_text("time [s],load\n" + "\n".join(rows) + "\n")


def test_words_are_turned_before_interpolation(tmp_path):
    signed = np.round(50.0 * np.sin(np.arange(200) / 10.0)).astype(int)
    write(tmp_path / "log.csv", signed % 2**16)
    (tmp_path / "log.csv").write_text((tmp_path / "log.csv").read_text().replace("time [s],load", "time [s],load,position [m]"))
    lines = (tmp_path / "log.csv").read_text().splitlines()
    (tmp_path / "log.csv").write_text("\n".join([lines[0], *(line + ",0.5" for line in lines[1:])]) + "\n")
    run = assemble(RunEntry(file=tmp_path / "log.csv", name="log", signed_bits={"load": 16}), rotational=False)
    assert np.abs(run.covariates["load"]).max() <= 50.0


def test_an_unknown_column_is_named(tmp_path):
    (tmp_path / "log.csv").write_text("time [s],position [m]\n" + "".join(f"{0.01 * i:.2f},0.{i}\n" for i in range(60)))
    with pytest.raises(InputError, match="signed_bits"):
        assemble(RunEntry(file=tmp_path / "log.csv", name="log", signed_bits={"load": 16}), rotational=False)
