"""A wedge under a load: it locks itself up to an angle of 2 atan(mu), and is squeezed out beyond."""

from __future__ import annotations

import argparse
import math

import pymunk

from stochfric_mb.laws import make_law
from stochfric_mb.pymunk import add_friction

MU = 0.3
CRITICAL = 2.0 * math.atan(MU)
"""Angle [rad] at which the wedge's two faces, each within its friction cone, just hold it."""
LOAD = 200.0
"""Force on the load, at full [N]."""


def build(angle: float) -> tuple[pymunk.Space, pymunk.Body, pymunk.Body]:
    """Return a space with a floor, a wedge that rises to the right, and a load on it that moves up and down only."""
    space = pymunk.Space()
    space.iterations, space.collision_slop = 100, 1e-6
    floor = pymunk.Segment(space.static_body, (-5.0, 0.0), (5.0, 0.0), 0.0)
    wedge, load = pymunk.Body(1.0, math.inf), pymunk.Body(1.0, math.inf)
    rise = math.tan(angle)
    faces = [
        pymunk.Poly(wedge, [(0.0, 0.0), (1.0, 0.0), (1.0, rise)]),
        pymunk.Poly(load, [(0.4, 0.4 * rise), (0.6, 0.6 * rise), (0.6, 1.5), (0.4, 1.5)]),
    ]
    guide = pymunk.GrooveJoint(space.static_body, load, (0.5, -5.0), (0.5, 5.0), (0.5, 1.0))
    space.add(floor, wedge, load, *faces, guide)
    add_friction(space, "*", "*", make_law("coulomb", mu_s=MU, mu_k=MU))
    return space, wedge, load


def run(angle: float, *, duration: float = 1.5, ramp: float = 0.5, dt: float = 5e-4) -> list[tuple[float, float]]:
    """Return times [s] and positions [m] of the wedge while the load grows and then stays."""
    space, wedge, load = build(angle)
    path = [(0.0, 0.0)]
    for i in range(1, round(duration / dt) + 1):
        force = LOAD * min(i * dt / ramp, 1.0)
        load.force, wedge.force = (0.0, -force), (0.0, -0.01 * force)
        space.step(dt)
        path.append((i * dt, wedge.position.x))
        if path[-1][1] > 0.3:
            break
    return path


def plot(paths: dict[float, list[tuple[float, float]]], path: str) -> None:
    from matplotlib.figure import Figure

    figure = Figure()
    axes = figure.subplots()
    for angle, points in paths.items():
        axes.plot(*zip(*points, strict=True), label=f"{math.degrees(angle):.1f} degrees")
    axes.set_xlabel("time [s]")
    axes.set_ylabel("position of the wedge [m]")
    axes.legend()
    figure.savefig(path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plot", metavar="PNG", help="save a figure")
    arguments = parser.parse_args()
    print(f"critical angle 2 atan(mu) = {math.degrees(CRITICAL):.2f} degrees")
    paths = {CRITICAL * share: run(CRITICAL * share) for share in (0.5, 0.97, 1.03, 1.2)}
    for angle, points in paths.items():
        moved = points[-1][1]
        verdict = "locked" if moved < 1e-4 else "squeezed out"
        print(f"{math.degrees(angle):5.2f} degrees: {verdict}, moved {1e3 * moved:.4f} mm in {points[-1][0]:.2f} s")
    if arguments.plot:
        plot(paths, arguments.plot)


if __name__ == "__main__":
    main()
