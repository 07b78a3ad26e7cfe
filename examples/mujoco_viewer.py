"""The belt-box in the MuJoCo viewer, with its friction force and stick state; or as a film where there is no display.

    python examples/mujoco_viewer.py                            the viewer, at half speed
    python examples/mujoco_viewer.py --film film.gif            a film, drawn offscreen
    python examples/mujoco_viewer.py --film frames --seconds 2  a folder of PNG files

The box moves by millimetres: displacements of box and belt are drawn 40 times as large. The box is green while it
sticks and red while it slips; the arrow is the friction force on it; the coil is the spring.
"""

import argparse
import itertools
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

if (
    sys.platform == "linux"
    and "MUJOCO_GL" not in os.environ
    and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
):
    os.environ["MUJOCO_GL"] = "egl"  # offscreen drawing without a display; read when mujoco is imported

import mujoco
import numpy as np

from stochfric_mb.errors import InputError
from stochfric_mb.mujoco import belt_box, readings
from stochfric_mb.scenario import load_scenario

MAGNIFICATION = 40.0
WIDTH, HEIGHT, RATE = 640, 240, 25
STICK, SLIP = (0.25, 0.6, 0.3, 1.0), (0.85, 0.25, 0.15, 1.0)
STEEL, STRIPE = (0.7, 0.7, 0.75, 1.0), (0.6, 0.6, 0.65, 1.0)
HALF = 0.05
FORCE_LENGTH = 0.015
WALL, COILS, RADIUS = -0.32, 9, 0.02
STRIPES, SPACING = 11, 0.1
EYE = np.eye(3).ravel()


class Scene:
    """The belt-box while it runs, and how to draw it into a MuJoCo scene."""

    def __init__(self, *, seed: int = 1, speed: float = 0.5) -> None:
        scenario = load_scenario("kang2015_table1")
        self.speed = speed
        self.belt_velocity = scenario.mechanism.belt_velocity
        self.model = belt_box.build(scenario, seed=seed)
        self.model.geom("box").rgba[3] = 0.0  # drawn magnified instead
        self.data = belt_box.start(self.model, scenario.mechanism)
        self.camera = mujoco.MjvCamera()
        self.camera.lookat[:] = -0.02, 0.0, 0.07
        self.camera.distance, self.camera.azimuth, self.camera.elevation = 0.55, 90.0, -15.0
        mujoco.mj_forward(self.model, self.data)

    def advance(self) -> None:
        """Simulate what a frame shows."""
        mujoco.mj_step(self.model, self.data, nstep=max(1, round(self.speed / RATE / self.model.opt.timestep)))
        mujoco.mj_forward(self.model, self.data)

    def state(self) -> tuple[float, float, bool]:
        """Return position [m], friction force [N] and whether the box sticks."""
        contacts = [reading for pair in readings(self.model, self.data).values() for reading in pair]
        force = sum(reading.force[0] for reading in contacts)
        return float(self.data.joint("x").qpos[0]), force, all(reading.stick for reading in contacts)

    def draw(self, scene: mujoco.MjvScene) -> None:
        """Add box, spring, belt stripes, force arrow and text to a scene."""
        x, force, stick = self.state()
        place = np.array([MAGNIFICATION * x, 0.0, HALF])
        _add(scene, mujoco.mjtGeom.mjGEOM_BOX, place, (HALF, HALF, HALF), STICK if stick else SLIP)
        text = _add(scene, mujoco.mjtGeom.mjGEOM_SPHERE, (-0.25, 0.0, 0.15), (1e-3, 1e-3, 1e-3), STEEL)
        text.label = f"{'stick' if stick else 'slip'}   x = {1e3 * x:.2f} mm   F = {force:.1f} N   t = {self.data.time:.2f} s"
        self._belt(scene)
        _spring(scene, place[0] - HALF)
        foot = place + np.array([0.0, -HALF - 0.01, 0.03 - HALF])
        _connect(
            scene,
            mujoco.mjtGeom.mjGEOM_ARROW,
            0.012,
            foot,
            foot + np.array([FORCE_LENGTH * force, 0.0, 0.0]),
            (1, 0.85, 0.1, 1),
        )

    def _belt(self, scene: mujoco.MjvScene) -> None:
        shift = (MAGNIFICATION * self.belt_velocity * self.data.time) % SPACING
        for i in range(STRIPES):
            at = np.array([(i - STRIPES // 2) * SPACING + shift, 0.0, 0.0])
            _add(scene, mujoco.mjtGeom.mjGEOM_BOX, at, (0.006, 0.15, 0.001), STRIPE)


def _add(scene, kind, position, size, colour):
    if scene.ngeom >= scene.maxgeom:
        raise InputError(f"the scene holds only {scene.maxgeom} geoms; give its renderer a larger max_geom")
    geom = scene.geoms[scene.ngeom]
    mujoco.mjv_initGeom(geom, kind, np.array(size, float), np.array(position, float), EYE, np.array(colour, np.float32))
    scene.ngeom += 1
    return geom


def _connect(scene, kind, width, start, end, colour):
    geom = _add(scene, kind, start, (width, width, width), colour)
    mujoco.mjv_connector(geom, kind, width, start, end)


def _spring(scene, end):
    """Draw a zigzag from the wall to the box."""
    _add(scene, mujoco.mjtGeom.mjGEOM_BOX, (WALL - 0.01, 0.0, HALF), (0.01, 0.08, 0.08), STEEL)
    along = np.linspace(WALL, end, 2 * COILS + 1)
    across = RADIUS * np.sin(0.5 * np.pi * np.arange(2 * COILS + 1))
    points = [np.array([a, 0.0, HALF + b]) for a, b in zip(along, across, strict=True)]
    for first, second in itertools.pairwise(points):
        _connect(scene, mujoco.mjtGeom.mjGEOM_CAPSULE, 0.003, first, second, STEEL)


def view(scene: Scene) -> None:
    """Run the belt-box in MuJoCo's viewer until its window is closed."""
    import mujoco.viewer

    with mujoco.viewer.launch_passive(scene.model, scene.data) as window:
        for name in ("lookat", "distance", "azimuth", "elevation"):
            setattr(window.cam, name, getattr(scene.camera, name))
        while window.is_running():
            began = time.perf_counter()
            with window.lock():
                scene.advance()
                window.user_scn.ngeom = 0
                scene.draw(window.user_scn)
            window.sync()
            time.sleep(max(0.0, 1.0 / RATE - (time.perf_counter() - began)))


def film(scene: Scene, target: Path, frames: int) -> None:
    """Draw frames offscreen and write them as a GIF, a video (where ffmpeg is) or a folder of PNG files."""
    if target.suffix not in ("", ".gif", ".mp4"):
        raise InputError(f"{target}: a film is a .gif, an .mp4 or a folder of PNG files (no ending)")
    if target.exists():
        raise InputError(f"{target} exists; give another name")
    if target.suffix == ".mp4" and shutil.which("ffmpeg") is None:
        raise InputError(f"{target}: video needs ffmpeg, which is not installed; write a .gif instead")
    with mujoco.Renderer(scene.model, HEIGHT, WIDTH) as renderer:
        images = []
        for i in range(frames):
            if i:
                scene.advance()
            renderer.update_scene(scene.data, scene.camera)
            scene.draw(renderer.scene)
            images.append(renderer.render().copy())
    target.absolute().parent.mkdir(parents=True, exist_ok=True)
    {"": _write_folder, ".gif": _write_gif, ".mp4": _write_video}[target.suffix](images, target)


def _write_folder(images, folder):
    from PIL import Image

    folder.mkdir()
    for i, image in enumerate(images):
        Image.fromarray(image).save(folder / f"{i:04d}.png")


def _write_gif(images, path):
    from PIL import Image

    first, *others = [Image.fromarray(image).quantize(64) for image in images]
    first.save(path, save_all=True, append_images=others, duration=1000 // RATE, loop=0)


def _write_video(images, path):
    command = f"ffmpeg -loglevel error -f rawvideo -pix_fmt rgb24 -s {WIDTH}x{HEIGHT} -r {RATE} -i - -pix_fmt yuv420p".split()
    subprocess.run([*command, str(path)], input=b"".join(image.tobytes() for image in images), check=True)


def has_display() -> bool:
    """Return whether a window can be opened."""
    if sys.platform == "linux":
        return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    return True


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--film", type=Path, metavar="FILE", help="write a film (.gif, .mp4 or a folder) instead of opening the viewer"
    )
    parser.add_argument("--seconds", type=float, default=4.0, help="length of the film [s] (default 4)")
    parser.add_argument("--speed", type=float, default=0.5, help="simulated over shown time (default 0.5)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the friction coefficients (default 1)")
    options = parser.parse_args(arguments)
    try:
        scene = Scene(seed=options.seed, speed=options.speed)
        if options.film is None and not has_display():
            options.film = Path("mujoco_viewer.gif")
            print(
                f"No display (neither DISPLAY nor WAYLAND_DISPLAY is set): writing {options.film} instead of opening the viewer"
            )
        if options.film is None:
            view(scene)
            return 0
        film(scene, options.film, max(1, round(options.seconds * RATE)))
    except InputError as error:
        print(f"Error: {error}", file=sys.stderr)
        return 2
    print(options.film)
    return 0


if __name__ == "__main__":
    sys.exit(main())
