"""Parts fall on a conveyor belt, slide until they move with it, and leave at its end; each has a random friction path."""

from __future__ import annotations

import argparse
import math

import pymunk

from stochfric_mb.coefficients import Spatial
from stochfric_mb.friction import Friction
from stochfric_mb.laws import make_law
from stochfric_mb.pymunk import add_friction

GRAVITY, BELT_VELOCITY, BELT_LENGTH, DROP = 9.81, 1.0, 2.0, 0.3
MU_S, MU_K = 0.4, 0.3


def drop_part(space: pymunk.Space) -> pymunk.Shape:
    body = pymunk.Body(0.5, math.inf)
    body.position = (0.1, 0.025 + DROP)
    shape = pymunk.Poly.create_box(body, (0.1, 0.05))
    space.add(body, shape)
    return shape


def run(*, duration: float = 6.0, interval: float = 0.4, dt: float = 5e-4, seed: int = 1) -> list[dict[str, float]]:
    """Return, for each part that left the belt: its number, how long it slid [s] and how far [m], and its mean mu_k [-]."""
    space = pymunk.Space()
    space.gravity, space.collision_slop = (0.0, -GRAVITY), 1e-5
    belt = pymunk.Segment(space.static_body, (0.0, 0.0), (BELT_LENGTH, 0.0), 0.0)
    belt.surface_velocity = (BELT_VELOCITY, 0.0)
    space.add(belt)
    process = Spatial(sigma_s=0.03, sigma_k=0.03, spacing=0.02)  # the surface varies along the way that a part has slid
    handle = add_friction(space, "*", belt, Friction(make_law("elastic_stick", mu_s=MU_S, mu_k=MU_K), process), seed=seed)
    parts: dict[pymunk.Shape, dict[str, float]] = {}
    gone: list[dict[str, float]] = []
    for i in range(round(duration / dt)):
        if i % round(interval / dt) == 0:
            parts[drop_part(space)] = {"part": len(parts) + len(gone), "slid": 0.0, "far": 0.0, "mu_k": 0.0}
        space.step(dt)
        for reading in handle.readings():
            part = parts[reading.a]
            if not reading.stick:
                part["slid"] += dt
                part["far"] += reading.velocity * dt
                part["mu_k"] += reading.mu_k * dt
        for shape in [s for s in parts if s.body.position.y < -0.1]:
            gone.append(parts.pop(shape))
            space.remove(shape, shape.body)
    return [p | {"mu_k": p["mu_k"] / p["slid"]} for p in gone]


def plot(parts: list[dict[str, float]], path: str) -> None:
    from matplotlib.figure import Figure

    figure = Figure()
    axes = figure.subplots()
    axes.plot([p["mu_k"] for p in parts], [p["slid"] for p in parts], "o")
    axes.set_xlabel("mean sliding coefficient [-]")
    axes.set_ylabel("time until the part moves with the belt [s]")
    figure.savefig(path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plot", metavar="PNG", help="save a figure")
    arguments = parser.parse_args()
    parts = run()
    fall = math.sqrt(2.0 * GRAVITY * DROP)
    print(f"a part lands with {fall:.2f} m/s, slides, and takes on the belt's {BELT_VELOCITY:g} m/s")
    for p in parts:
        print(f"part {p['part']:2.0f}: slid {1e3 * p['slid']:5.1f} ms over {1e3 * p['far']:5.1f} mm, mean mu_k {p['mu_k']:.3f}")
    if arguments.plot:
        plot(parts, arguments.plot)


if __name__ == "__main__":
    main()
