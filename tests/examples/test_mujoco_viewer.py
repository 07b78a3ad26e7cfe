"""The viewer example draws a film where there is no display."""

import contextlib
import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")
image = pytest.importorskip("PIL.Image")

EXAMPLE = Path(__file__).parents[2] / "examples" / "mujoco_viewer.py"
PROBE = "import mujoco; mujoco.Renderer(mujoco.MjModel.from_xml_string('<mujoco/>'), 8, 8).close()"
NO_DISPLAY = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}


def run(*words, folder):
    command = [sys.executable, str(EXAMPLE), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, env=NO_DISPLAY, timeout=300, check=False)


def pixels(path):
    with image.open(path) as picture:
        return np.asarray(picture.convert("RGB"), dtype=float)


@pytest.fixture(scope="module")
def drawing():
    """Skip where MuJoCo cannot draw offscreen."""
    backend = {"MUJOCO_GL": os.environ.get("MUJOCO_GL", "egl")} if sys.platform == "linux" else {}
    probe = subprocess.run([sys.executable, "-c", PROBE], capture_output=True, text=True, env=NO_DISPLAY | backend, check=False)
    if probe.returncode != 0:
        pytest.skip(f"MuJoCo cannot draw offscreen here: {probe.stderr.strip().splitlines()[-1]}")


@pytest.mark.usefixtures("drawing")
def test_five_frames(tmp_path):
    done = run("--film", "frames", "--seconds", 0.2, "--speed", 15, folder=tmp_path)
    assert done.returncode == 0, done.stderr
    files = sorted((tmp_path / "frames").iterdir())
    assert [f.name for f in files] == [f"000{i}.png" for i in range(5)]
    frames = [pixels(f) for f in files]
    assert {f.shape for f in frames} == {(240, 640, 3)}
    assert len({f.tobytes() for f in frames}) == 5  # box and belt move
    greens = [int(np.sum((f[..., 1] > 1.3 * f[..., 0]) & (f[..., 1] > 1.3 * f[..., 2]))) for f in frames]
    assert max(greens) > 1000  # the box sticks in one of them at least: it does so for nine tenths of the time
    again = run("--film", "frames", folder=tmp_path)
    assert again.returncode == 2
    assert "frames exists" in again.stderr


@pytest.mark.usefixtures("drawing")
@pytest.mark.skipif(sys.platform != "linux", reason="only on Linux a missing display is known beforehand")
def test_a_film_where_there_is_no_display(tmp_path):
    done = run("--seconds", 0.2, folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert re.search("No display .* writing mujoco_viewer.gif instead", done.stdout)
    with image.open(tmp_path / "mujoco_viewer.gif") as film:
        assert film.n_frames == 5


def test_the_loop_of_the_viewer(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", os.environ.get("MUJOCO_GL", "egl"))  # so that the example leaves it alone
    viewer = importlib.import_module("mujoco.viewer")
    spec = importlib.util.spec_from_file_location("mujoco_viewer", EXAMPLE)
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    scene = example.Scene(speed=1.0)
    counts = []

    class Window:
        """What the example uses of MuJoCo's handle of a viewer."""

        cam, user_scn = mujoco.MjvCamera(), mujoco.MjvScene(scene.model, 100)

        def is_running(self):
            return len(counts) < 3

        def sync(self):
            counts.append(self.user_scn.ngeom)

        lock = contextlib.nullcontext

    for name in ("cam", "user_scn", "is_running", "sync", "lock"):
        assert hasattr(viewer.Handle, name)
    monkeypatch.setattr(viewer, "launch_passive", lambda model, data: contextlib.nullcontext(Window()))
    example.view(scene)
    assert len(set(counts)) == 1  # each frame draws anew
    assert counts[0] > 20  # box, text, arrow, wall, spring and stripes
    assert scene.data.time == pytest.approx(3 / example.RATE)


def test_an_unknown_ending_is_refused(tmp_path):
    done = run("--film", "film.avi", folder=tmp_path)
    assert done.returncode == 2
    assert "a .gif, an .mp4 or a folder" in done.stderr
    assert not list(tmp_path.iterdir())
