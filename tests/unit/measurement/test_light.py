"""Libraries of file formats and units are loaded where they are used, and readers of other packages are found."""

import subprocess
import sys
import textwrap

import pytest

HEAVY = ("pint", "nptdms", "pyuff", "pyarrow", "h5py", "xarray", "scipy.io", "scipy.signal", "numba", "pandas")


def run(code):
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.mark.parametrize("module", ["stochfric_mb", "stochfric_mb.measurement.readers", "stochfric_mb.measurement.delay"])
def test_loads_no_library_of_a_format(module):
    heavy = tuple(name for name in HEAVY if module == "stochfric_mb" or name != "numba")  # scenarios bring the laws' compiler
    assert run(f"import {module}, sys; print([m for m in {heavy} if m in sys.modules])") == "[]"


def test_reader_of_another_package_is_found_by_its_entry_point(tmp_path):
    (tmp_path / "lab").mkdir()
    (tmp_path / "lab" / "__init__.py").write_text("")
    (tmp_path / "lab" / "wave.py").write_text(
        "import numpy as np\nfrom stochfric_mb.measurement.table import Table\n"
        "def read(path, *, skip_rows=0):\n    return Table(columns={'time': np.arange(3.0)[skip_rows:]})\n"
    )
    info = tmp_path / "lab-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: lab\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[stochfric_mb.readers]\nwave = lab.wave\ncsv = lab.wave\n")
    (tmp_path / "run.wave").write_text("")
    result = run(f"""
        import sys; sys.path.insert(0, {str(tmp_path)!r})
        from pathlib import Path
        from stochfric_mb.measurement.readers import READERS, read_table
        assert "lab.wave" not in sys.modules
        print(read_table(Path({str(tmp_path / "run.wave")!r}), skip_rows=1).columns["time"], READERS[".csv"])
    """)
    assert result == "[1. 2.] stochfric_mb.measurement.readers.text"
