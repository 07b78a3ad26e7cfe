"""Large and odd files: tables of millions of rows are read in seconds, what is no table is refused at once."""

import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from stochfric_mb import InputError
from stochfric_mb.measurement.readers import read_table
from stochfric_mb.measurement.readers.text import _plain

REFUSED = """\
import sys
from pathlib import Path
from stochfric_mb import InputError
from stochfric_mb.measurement.readers import read_table
try:
    read_table(Path(sys.argv[1]))
except InputError as error:
    print(error)
status = Path("/proc/self/status")  # ru_maxrss would count what the parent had when it forked
words = status.read_text().split() if status.exists() else ["VmHWM:", "0"]
print(words[words.index("VmHWM:") + 1])
"""


@pytest.mark.parametrize(
    ("ending", "content", "message"),
    [
        ("csv", b"1.0,", "its first line is longer"),
        ("csv", b"\x00\x01\xff\x7f", "not a text file"),
        ("json", b"1.0,", "not JSON"),
        ("json", b"\x00\x01\xff\x7f", "not JSON"),
        ("mat", b"\x30\x91\xff\x7f", "not a MATLAB file"),
        ("uff", b"\x00\x01\xff\x7f", "not a universal file"),
    ],
)
def test_200_megabytes_that_are_no_table_are_refused_in_little_time_and_memory(tmp_path, ending, content, message):
    if ending == "uff":
        pytest.importorskip("pyuff", reason="pyuff reads universal files")
    file = tmp_path / f"log.{ending}"
    with file.open("wb") as target:
        for _ in range(200):
            target.write(content * 2**18)
    began = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run([sys.executable, "-c", REFUSED, str(file)], capture_output=True, text=True, check=True)
    assert resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - began < 5.0  # processor time: the machine may be busy
    said, memory = done.stdout.splitlines()
    assert message in said
    assert int(memory) < 200 * 1024


def _rows(path, n):
    t = np.arange(n) * 1e-3
    np.savetxt(path, np.column_stack([t, np.sin(t)]), "%.6g", ",", header="time [s],position [m]", comments="")
    return path


def test_a_tidy_file_is_read_as_any_other(tmp_path):
    tidy = _rows(tmp_path / "tidy.csv", 500)
    assert _plain(tidy) is not None
    lines = tidy.read_text().splitlines()
    other = tmp_path / "other.csv"
    other.write_text("\n".join([*lines[:300], "", *lines[300:]]))
    assert _plain(other) is None
    one, two = read_table(tidy), read_table(other)
    for name in one.columns:
        np.testing.assert_array_equal(one.columns[name], two.columns[name])
    assert one.units == two.units == {"time": "s", "position": "m"}
    assert (one.rows[0], one.rows[-1]) == (2, 501)
    assert two.rows[-1] == 502


def test_a_word_among_the_numbers_is_named_with_its_line(tmp_path):
    file = _rows(tmp_path / "run.csv", 500)
    lines = file.read_text().splitlines()
    lines[400] = "0.4,oops"
    file.write_text("\n".join(lines))
    with pytest.raises(InputError, match=r"line 401, column 2: 'oops' is not a number"):
        read_table(Path(file))


@pytest.mark.slow
def test_half_an_hour_at_1_khz_is_read_in_seconds(tmp_path):
    file = _rows(tmp_path / "run.csv", 1_800_000)
    began = time.process_time()
    assert len(read_table(file).columns["time"]) == 1_800_000
    assert time.process_time() - began < 10.0  # 2 s on an idle machine; line after line it was 25 s
