"""Files and folders that appear whole or not at all, also on a full disk and with two writers."""

import errno
import subprocess
import sys

import pytest
from filelock import Timeout

from stochfric_mb import InputError
from stochfric_mb.outputs import check_target, claimed, whole_file, whole_folder


def test_whole_file_keeps_the_old_one_when_it_fails(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")
    with pytest.raises(FileNotFoundError), whole_file(path) as temporary:
        (temporary.parent / "missing" / "file.txt").write_text("new")
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_whole_folder_replaces_or_keeps(tmp_path):
    path = tmp_path / "out"
    for text in ("first", "second"):
        with whole_folder(path) as folder:
            (folder / f"{text}.txt").write_text(text)
        assert [p.name for p in path.iterdir()] == [f"{text}.txt"]
    with pytest.raises(FileNotFoundError), whole_folder(path) as folder:
        (folder / "missing" / "third.txt").write_text("third")
    assert [p.name for p in path.iterdir()] == ["second.txt"]
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_of_others_is_never_replaced(tmp_path):
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(InputError, match="was not written by this command"):
        check_target(tmp_path, force=True, marker="compare.json")
    (tmp_path / "compare.json").write_text("{}")
    assert check_target(tmp_path, force=True, marker="compare.json") == tmp_path
    with pytest.raises(InputError, match="--force"):
        check_target(tmp_path, marker="compare.json")


def test_targets_of_the_wrong_kind(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="not a file"):
        check_target(tmp_path, force=True)
    with pytest.raises(InputError, match="not a folder"):
        check_target(tmp_path / "file", force=True, marker="compare.json")
    with pytest.raises(InputError, match="not a folder that can be written"):
        check_target(tmp_path / "file" / "run.nc")


def test_what_appeared_in_the_meantime_is_kept(tmp_path):
    file, folder = tmp_path / "a.txt", tmp_path / "out"
    with pytest.raises(InputError, match=r"a\.txt has been written by another"), whole_file(file, replace=False):
        file.write_text("theirs")
    with pytest.raises(InputError, match="out has been written by another command"), whole_folder(folder, replace=False):
        folder.mkdir()
    assert file.read_text() == "theirs"
    assert sorted(tmp_path.iterdir()) == [file, folder]


def test_without_replace_a_free_name_is_taken(tmp_path):
    with whole_file(tmp_path / "a.txt", replace=False) as temporary:
        temporary.write_text("mine")
    assert [p.name for p in tmp_path.iterdir()] == ["a.txt"]
    assert (tmp_path / "a.txt").read_text() == "mine"


def test_a_claimed_target_is_refused_and_free_again_afterwards(tmp_path):
    target = tmp_path / "new" / "run.nc"
    with claimed(target), pytest.raises(InputError, match="another command is writing to"), claimed(target):
        pass
    with claimed(target):
        pass
    assert list(tmp_path.iterdir()) == []  # neither the lock nor the folder made for it


def test_a_folder_that_takes_no_new_files_is_not_another_command(tmp_path, monkeypatch):
    monkeypatch.setattr("filelock.FileLock.acquire", lambda lock: (_ for _ in ()).throw(Timeout(lock.lock_file)))
    with pytest.raises(InputError, match="not a folder that can be written"), claimed(tmp_path / "run.nc"):
        pass


def test_the_claim_of_a_killed_process_ends_with_it(tmp_path):
    target = tmp_path / "run.nc"
    code = (
        "import sys, time; from pathlib import Path; from stochfric_mb.outputs import claimed\n"
        "with claimed(Path(sys.argv[1])): print('held', flush=True); time.sleep(600)"
    )
    with subprocess.Popen([sys.executable, "-c", code, str(target)], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "held\n"
        with pytest.raises(InputError, match="another command"), claimed(target):
            pass
        process.kill()
        process.wait()
    with claimed(target):
        pass


@pytest.mark.parametrize("whole", [whole_file, whole_folder])
def test_a_full_disk_is_named(tmp_path, whole):
    with pytest.raises(OSError, match="nothing was written: free some space") as caught, whole(tmp_path / "run"):
        raise OSError(errno.ENOSPC, "No space left on device")
    assert caught.value.filename == str(tmp_path / "run")
    assert list(tmp_path.iterdir()) == []


LIMITED = """\
import resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
sys.dont_write_bytecode = True  # Python would leave the beginning of a file behind
sys.argv[1:] = ["run", "kang2015_table1", "--out", sys.argv[1]]
from stochfric_mb.__main__ import main
main()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no limit on the size of files")
@pytest.mark.parametrize("ending", [".nc", ".csv", ".parquet"])
def test_no_room_for_the_file_is_one_error_line(tmp_path, ending):
    """Files of at most 4 KiB stand for a full disk: writes fail in the middle alike, and need no disk of one's own."""
    if ending == ".parquet":
        pytest.importorskip("pyarrow", reason="Parquet needs pyarrow")
    out = tmp_path / f"run{ending}"
    done = subprocess.run([sys.executable, "-c", LIMITED, str(out)], capture_output=True, text=True, check=False)
    assert done.returncode == 2, done.stderr
    assert done.stderr.splitlines()[-1].startswith(f"Error: {out}: ")
    assert "nothing was written" in done.stderr
    assert list(tmp_path.iterdir()) == []
