"""Every reader gives back what a file was written with, and says what is wrong with one that is not of its format."""

import json
import struct

import h5py
import numpy as np
import pytest
import scipy.io

from stochfric_mb import InputError, MissingEngineError, Trajectory
from stochfric_mb.measurement.readers import READERS, read_table, register_reader
from stochfric_mb.measurement.table import Table
from stochfric_mb.storage import write_trajectory

from .files import POSITION, TIME, measured


def is_the_run(table, *, time="time", position="position", rtol=0.0):
    np.testing.assert_allclose(table.columns[time], TIME, rtol=rtol, atol=0.0)
    np.testing.assert_allclose(table.columns[position], POSITION, rtol=rtol, atol=0.0)


@pytest.mark.parametrize("dialect", [",.", ";.", ";,", "\t.", "\t,", " .", " ,"])
@pytest.mark.parametrize("ending", [".csv", ".txt"])
def test_text_in_any_dialect(tmp_path, dialect, ending):
    delimiter, decimal = dialect
    path = tmp_path / f"run{ending}"
    pairs = zip(TIME.tolist(), POSITION.tolist(), strict=True)
    rows = [delimiter.join(repr(v).replace(".", decimal) for v in pair) for pair in pairs]
    path.write_text("# logged by hand\n" + delimiter.join(["time", "position"]) + "\n" + "\n".join(rows) + "\n")
    table = read_table(path)
    is_the_run(table)
    assert table.rows[0] == 3
    assert table.row_word == "line"


def test_text_with_units_in_the_header_quotes_and_a_byte_order_mark(tmp_path):
    path = tmp_path / "run.csv"
    rows = "\n".join(f'"{t!r}","{x!r}",stick' for t, x in zip(TIME.tolist(), POSITION.tolist(), strict=True))
    path.write_text('"time (s)","position [µm]",phase\n' + rows, encoding="utf-8-sig")
    table = read_table(path)
    is_the_run(table)
    assert table.units == {"time": "s", "position": "µm"}
    assert list(table.columns) == ["time", "position"]


def test_text_in_latin_letters(tmp_path):
    path = tmp_path / "run.csv"
    path.write_bytes("time [s];Kühlung [°C]\n0,5;20,5\n0,6;20,6\n".encode("latin-1"))
    assert read_table(path).units == {"time": "s", "Kühlung": "°C"}


def test_text_header_in_a_comment_as_numpy_writes_it(tmp_path):
    np.savetxt(tmp_path / "run.txt", np.c_[TIME, POSITION], header="time [s] position [m]".replace(" [", "["), fmt="%.17g")
    is_the_run(read_table(tmp_path / "run.txt"))


def test_text_without_header_is_numbered(tmp_path):
    np.savetxt(tmp_path / "run.csv", np.c_[TIME, POSITION], delimiter="\t", fmt="%.17g")
    table = read_table(tmp_path / "run.csv", skip_rows=20)
    assert not table.has_header
    assert list(table.columns) == ["0", "1"]
    np.testing.assert_array_equal(table.columns["1"], POSITION[20:])
    assert table.rows[0] == 21


def test_text_units_in_a_line_of_their_own(tmp_path):
    (tmp_path / "run.csv").write_text("t,x,y [N]\ns,[mm],-\n0.0,1,2\n0.1,2,3\n")
    table = read_table(tmp_path / "run.csv")
    assert table.units == {"t": "s", "x": "mm", "y": "N"}
    np.testing.assert_array_equal(table.columns["x"], [1.0, 2.0])
    assert list(table.rows) == [3, 4]


@pytest.mark.parametrize("end", ["", ";"])
def test_text_rows_that_end_with_a_delimiter(tmp_path, end):
    (tmp_path / "run.csv").write_text(f"t;x{end}\n0,5;1;\n0,6;2;\n")
    assert list(read_table(tmp_path / "run.csv").columns) == ["t", "x"]


def test_text_missing_values_are_nan(tmp_path):
    (tmp_path / "run.csv").write_text("t,x\n0.0,1\n0.1,\n0.2,NaN\n0.3,4\n")
    np.testing.assert_array_equal(read_table(tmp_path / "run.csv").columns["x"], [1.0, np.nan, np.nan, 4.0])


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("t,x\n0.0,1\n0.1,1.2.3\n0.2,3\n", r"run\.csv, line 3, column 2: '1\.2\.3' is not a number"),
        ("t,x\n" + "0,1\n" * 50 + "0.1\n", r"run\.csv, line 52: 1 columns instead of 2"),
        ("t,x\n0.1\n" + "0,1\n" * 50, r"run\.csv, line 2: 1 columns instead of 2"),
        ("t,x,y\n0,1\n1,2\n", r"3 names in the header, line 1, but 2 columns in most lines.*; correct .* skip_rows$"),
        ("Logger\nserial,7\nt,x\n" + "0,1\n" * 50, r"1 names in the header, line 1, but 2 columns .* skip_rows = 2$"),
        ("Rig 4\n\n2026\nt,x\ns,mm\n" + "0,1\n" * 50, r"2 columns in most lines under it; .* skip_rows = 3$"),
        ("x,x\n0,1\n1,2\n", r"column 'x' is there 2 times"),
        ("hello\nworld\n", r"no table of at least two columns"),
        ("# nothing\n", r"no rows after skip_rows = 0"),
        ("t,x\n", r"no table of at least two columns"),
        ("t,x\n\0\0", r"not a text file"),
    ],
)
def test_text_errors(tmp_path, content, message):
    (tmp_path / "run.csv").write_text(content)
    with pytest.raises(InputError, match=message):
        read_table(tmp_path / "run.csv")


def test_parquet(tmp_path):
    arrow = pytest.importorskip("pyarrow", reason="Parquet needs pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    fields = [arrow.field("time [s]", arrow.float64()), arrow.field("position", arrow.float64(), metadata={"unit": "mm"})]
    words = arrow.field("phase", arrow.string())
    table = arrow.table([TIME, POSITION, ["stick"] * TIME.size], schema=arrow.schema([*fields, words]))
    parquet.write_table(table, tmp_path / "run.parquet")
    table = read_table(tmp_path / "run.parquet")
    is_the_run(table)
    assert table.units == {"time": "s", "position": "mm"}
    assert list(table.columns) == ["time", "position"]


@pytest.mark.parametrize("compressed", [False, True])
def test_mat_of_version_5(tmp_path, compressed):
    log = {"time": TIME[:, None], "position": POSITION[None, :]}
    scipy.io.savemat(
        tmp_path / "run.mat", {"log": log, "kp": 160.0, "two": np.c_[TIME, POSITION], "name": "rig"}, do_compression=compressed
    )
    table = read_table(tmp_path / "run.mat")
    is_the_run(table, time="log.time", position="log.position")
    is_the_run(table, time="two[0]", position="two[1]")
    assert table.constants == {"kp": 160.0}


def test_mat_of_version_7_3(tmp_path):
    with h5py.File(tmp_path / "run.mat", "w", userblock_size=512) as file:
        file["log/time"] = TIME[None, :]
        file["position"] = POSITION[:, None]
        file["#refs#/a"] = np.zeros(3)
        file["kp"] = np.array([[160.0]])
    with (tmp_path / "run.mat").open("r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64")
    table = read_table(tmp_path / "run.mat")
    is_the_run(table, time="log.time")
    assert list(table.columns) == ["log.time", "position"]
    assert table.constants == {"kp": 160.0}


@pytest.mark.parametrize("ending", [".h5", ".hdf5"])
def test_hdf5(tmp_path, ending):
    with h5py.File(tmp_path / f"run{ending}", "w") as file:
        file["rig/time [s]"] = TIME
        file["rig/position"] = POSITION
        file["rig/position"].attrs["units"] = "mm"
        file["rig/comment"] = "words"
    table = read_table(tmp_path / f"run{ending}", skip_rows=0)
    is_the_run(table)
    assert table.units == {"time": "s", "position": "mm"}


@pytest.mark.parametrize("engine", ["h5netcdf", "scipy"])
def test_netcdf_of_both_kinds(tmp_path, engine):
    xarray = pytest.importorskip("xarray")
    position = xarray.Variable("time", POSITION, {"units": "mm"})
    time = xarray.Variable("time", TIME, {"units": "seconds since 2026-01-01 00:00:00"})
    xarray.Dataset({"position": position}, coords={"time": time}).to_netcdf(tmp_path / "run.nc", engine=engine)
    table = read_table(tmp_path / "run.nc")
    is_the_run(table)
    assert table.units == {"time": "seconds", "position": "mm"}


@pytest.mark.parametrize("named", [True, False], ids=["time is a channel", "time is the waveform's"])
def test_tdms(tmp_path, named):
    nptdms = pytest.importorskip("nptdms", reason="TDMS needs npTDMS")
    waveform = {"wf_increment": 1e-3, "wf_start_offset": 0.25, "unit_string": "mm"}
    channels = [nptdms.ChannelObject("rig", "position", POSITION, properties=waveform)]
    if named:
        channels.append(nptdms.ChannelObject("rig", "time", TIME, properties={"unit_string": "s"}))
    with nptdms.TdmsWriter(tmp_path / "run.tdms") as file:
        file.write_segment(channels)
    table = read_table(tmp_path / "run.tdms")
    is_the_run(table, rtol=1e-15)  # npTDMS counts the waveform's time up
    assert table.units == {"time": "s", "position": "mm"}


def uff58(label: str, unit: str, values, *, kind: int, binary: bool) -> bytes:
    """Return a data set 58 with even time stamps in double precision, by the published description of its 13 records."""
    count = f"{len(values):10d}"
    first = f"{58:6d}" + (f"b{1:6d}{2:6d}{11:12d}{8 * len(values):12d}{0:6d}{0:6d}{0:12d}{0:12d}" if binary else "")
    lines = [
        "    -1",
        first,
        "rig",
        "NONE",
        "NONE",
        "NONE",
        "NONE",
        f"{1:5d}{0:10d}{0:5d}{0:10d} {'NONE':10s}{7:10d}{-1:4d} {'NONE':10s}{0:10d}{0:4d}",
        f"{4:10d}{count}{1:10d}{TIME[0]:13.5e}{1e-3:13.5e}{0.0:13.5e}",
        f"{17:10d}{0:5d}{0:5d}{0:5d} {'Time':20s} {'s':20s}",
        f"{kind:10d}{0:5d}{0:5d}{0:5d} {label:20s} {unit:20s}",
        f"{0:10d}{0:5d}{0:5d}{0:5d} {'NONE':20s} {'NONE':20s}",
        f"{0:10d}{0:5d}{0:5d}{0:5d} {'NONE':20s} {'NONE':20s}",
    ]
    text = ("\n".join(lines) + "\n").encode()
    if binary:
        return text + struct.pack(f"<{len(values)}d", *values) + b"\n    -1\n"
    body = "\n".join("".join(f"{v:20.11e}" for v in values[i : i + 4]) for i in range(0, len(values), 4))
    return text + body.encode() + b"\n    -1\n"


@pytest.mark.parametrize("binary", [False, True], ids=["text", "binary"])
def test_uff58(tmp_path, binary):
    pytest.importorskip("pyuff", reason="UFF needs pyuff")
    sets = [
        uff58("NONE", "mm", POSITION, kind=8, binary=binary),
        uff58("belt", "NONE", 2.0 * POSITION, kind=8, binary=binary),
        uff58("NONE", "N", POSITION, kind=13, binary=binary),
        uff58("NONE", "N", POSITION[::-1], kind=13, binary=binary),
    ]
    (tmp_path / "run.uff").write_bytes(b"".join(sets[:3]))
    table = read_table(tmp_path / "run.uff")
    is_the_run(table, rtol=1e-10)  # 11 decimals in the text
    np.testing.assert_allclose(table.columns["belt"], 2.0 * POSITION, rtol=1e-10)
    assert table.units == {"time": "s", "position": "mm", "force": "N"}
    (tmp_path / "twice.uff").write_bytes(b"".join(sets))
    with pytest.raises(InputError, match=r"force_7_-x"):
        read_table(tmp_path / "twice.uff")


@pytest.mark.parametrize("shape", ["records", "columns", "entries", "inner", "lines"])
def test_json(tmp_path, shape):
    columns = {"time [s]": TIME.tolist(), "position": POSITION.tolist(), "on": [True] * TIME.size, "word": ["a"] * TIME.size}
    records = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    content = {
        "records": records,
        "columns": columns,
        "entries": {"mass": 0.5, "name": "rig", "entries": records},
        "inner": {"mass": 0.5, "log": columns},
        "lines": None,
    }[shape]
    path = tmp_path / ("run.jsonl" if shape == "lines" else "run.json")
    path.write_text("\n".join(map(json.dumps, records)) if shape == "lines" else json.dumps(content))
    table = read_table(path)
    is_the_run(table)
    assert list(table.columns) == ["time", "position", "on"]
    np.testing.assert_array_equal(table.columns["on"], 1.0)
    assert table.units == {"time": "s"}
    assert table.constants == ({"mass": 0.5} if shape in ("entries", "inner") else {})


@pytest.mark.parametrize("content", ["3", "null", "{}", "[]", "[1, 2]", '{"a": "b"}', '{"a": []}'])
def test_json_without_a_table(tmp_path, content):
    (tmp_path / "run.json").write_text(content)
    with pytest.raises(InputError, match=r"run\.json: (no columns of numbers|a single value)"):
        read_table(tmp_path / "run.json")


def test_json_key_that_a_record_lacks_is_missing(tmp_path):
    (tmp_path / "run.json").write_text('[{"t": 0, "x": 1}, {"t": 1}, {"t": 2, "x": null}]')
    np.testing.assert_array_equal(read_table(tmp_path / "run.json").columns["x"], [1.0, np.nan, np.nan])


@pytest.mark.parametrize("ending", [".nc", ".csv", ".parquet"])
def test_simulated_trajectories_are_measured_files_too(tmp_path, ending):
    if ending == ".parquet":
        pytest.importorskip("pyarrow", reason="Parquet needs pyarrow")
    rest = [np.zeros(TIME.size)] * 6
    path = write_trajectory(Trajectory(TIME, POSITION, *rest, attributes={}), tmp_path / f"run{ending}")
    table = read_table(path)
    is_the_run(table)
    assert table.units["velocity"] in ("m/s", "m s-1")


@pytest.mark.parametrize("ending", [e for e in READERS if e not in (".csv", ".tsv", ".txt", ".dat")])
def test_file_that_is_not_of_its_format(tmp_path, ending):
    path = tmp_path / f"run{ending}"
    path.write_bytes(b"these are words and no measured data at all" * 20)
    with pytest.raises(InputError, match=rf"run\{ending}: "):
        read_table(path)


def test_binary_file_without_columns(tmp_path):
    scipy.io.savemat(tmp_path / "run.mat", {"kp": 160.0})
    with pytest.raises(InputError, match="no columns of numbers"):
        read_table(tmp_path / "run.mat")


def test_skip_rows_beyond_the_end(tmp_path):
    scipy.io.savemat(tmp_path / "run.mat", {"t": TIME})
    with pytest.raises(InputError, match="no samples after skip_rows = 120"):
        read_table(tmp_path / "run.mat", skip_rows=120)


def test_no_such_file_and_no_such_reader(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        read_table(tmp_path / "run.csv")
    (tmp_path / "run.xyz").write_text("")
    with pytest.raises(InputError, match=r"no reader for '\.xyz'; known: .*\.tdms"):
        read_table(tmp_path / "run.xyz")


@pytest.mark.parametrize(("ending", "library"), [(".parquet", "pyarrow"), (".tdms", "nptdms"), (".uff", "pyuff")])
def test_missing_library_says_what_to_install(tmp_path, monkeypatch, ending, library):
    monkeypatch.setitem(__import__("sys").modules, library, None)
    (tmp_path / f"run{ending}").write_bytes(b"x")
    with pytest.raises(MissingEngineError, match=r"pip install '\.\[(measured|parquet)\]'"):
        read_table(tmp_path / f"run{ending}")


def test_a_reader_of_ones_own(tmp_path, monkeypatch):
    monkeypatch.setattr("stochfric_mb.measurement.readers.READERS", dict(READERS))

    def read(path, *, skip_rows=0):
        return Table(columns={"time": TIME[skip_rows:]})

    register_reader(".LOG", read)
    (tmp_path / "run.log").write_text("")
    assert read_table(tmp_path / "run.log", skip_rows=1).columns["time"].size == TIME.size - 1


def test_real_mat_file():
    table = read_table(measured("emps/DATA_EMPS.mat"))
    assert {name: values.size for name, values in table.columns.items()} == dict.fromkeys(("qg", "qm", "t", "vir"), 24841)
    assert table.constants["gtau"] == pytest.approx(35.1507, abs=1e-4)


def test_real_json_logs():
    table = read_table(measured("bam_xl330/2026-01-15_10h28m10.json"))
    assert {v.size for v in table.columns.values()} == {1124}
    assert table.constants == {"mass": 0.49, "length": 0.1, "kp": 100.0, "vin": 7.4}
    assert {"position", "speed", "load", "temp", "torque_enable"} <= set(table.columns)


def test_real_text_files():
    assert len(read_table(measured("pneuseal/O-ring_1bar.csv")).columns) == 7
    table = read_table(measured("rock_velocity_steps/velstep4_BRAVA_expb819_basalt.txt"))
    assert table.units == {"Time": "s", "Displ": "microns", "Normal_stress": "MPa"}
    assert table.columns["Friction"].size == 5849
