"""Write docs/reference.md: limit cycles of the belt-box by the reference, to 1e-9 m, with their convergence.

Run it as ``python docs/make_reference_tables.py``; it takes about a minute.
"""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import math
from pathlib import Path

import numpy as np

from stochfric_mb import BeltBox, Law, Trajectory, load_scenario
from stochfric_mb.reference import solve

SCENARIOS = {
    "kang2015_table1": "Table 1",
    "kang2015_table2_13_8": "Table 2, 13.8 rad/s",
    "kang2015_table2_18_7": "Table 2, 18.7 rad/s",
}
LAWS = ("coulomb", "elastic_stick", "havsin")
SETTLED = {"kang2015_table1": 20.0, "kang2015_table2_13_8": 150.0, "kang2015_table2_18_7": 300.0}
"""Time [s] after which the motion is taken as its limit cycle."""
TEMPLATE = Path(__file__).with_name("reference.template.md")


@dataclasses.dataclass(frozen=True)
class Cycle:
    """A limit cycle: one stick phase and one slip."""

    x_break: float
    """Position at break-away [m]."""
    x_stick: float
    """Position at stick [m]."""
    period: float
    """Interval between break-aways [s]."""
    slip_duration: float
    """Time from break-away to stick [s]."""
    stick_fraction: float
    """Share of the period with abs(v_rel) <= stick_speed [-]."""
    x_min: float
    """Lowest position [m]."""
    x_max: float
    """Highest position [m]."""
    change: float
    """Change of the position at break-away since the cycle before [m]."""


def limit_cycle(mechanism: BeltBox, law: Law, settled: float, *, rtol: float = 1.0e-12, method: str = "auto") -> Cycle:
    """Return the cycle between the last two break-aways before ``settled`` [s], from rest and with constant coefficients."""
    options = {"rtol": rtol, "method": method}
    events = solve(mechanism, law, None, [settled], **options).events
    breaks = np.flatnonzero(events[:, 1] == 1.0)[-3:]
    sticks = breaks[-2] + 1
    marks = events[[*breaks, sticks], 0]
    grid = np.arange(marks[1], marks[2], 2.0e-5)
    times = np.unique(np.concatenate([marks, grid]))
    trajectory = solve(mechanism, law, None, times, **options)
    before, first, last, stick = (float(trajectory.position[np.searchsorted(times, m)]) for m in marks)
    inside = slice(int(np.searchsorted(times, marks[1])), None)
    x_min, x_max = extremes(times[inside], trajectory.position[inside], trajectory.velocity[inside])
    return Cycle(
        x_break=last,
        x_stick=stick,
        period=float(marks[2] - marks[1]),
        slip_duration=float(marks[3] - marks[1]),
        stick_fraction=share_below(mechanism, law, trajectory, inside),
        x_min=x_min,
        x_max=x_max,
        change=max(abs(last - first), abs(first - before)),
    )


def extremes(t: np.ndarray, x: np.ndarray, v: np.ndarray) -> tuple[float, float]:
    """Return the lowest and highest position [m], turning points on the cubic between samples."""
    candidates = [float(x.min()), float(x.max())]
    for i in np.flatnonzero(v[:-1] * v[1:] < 0.0):
        h = t[i + 1] - t[i]
        d = (x[i + 1] - x[i]) / h
        a, b, c = 3.0 * (v[i] + v[i + 1] - 2.0 * d), 2.0 * (3.0 * d - 2.0 * v[i] - v[i + 1]), v[i]
        root = 2.0 * c / (-b + math.copysign(math.sqrt(b * b - 4.0 * a * c), -b))
        candidates.append(float(x[i] + h * root * (c + root * (b / 2.0 + root * a / 3.0))))
    return min(candidates), max(candidates)


def share_below(mechanism: BeltBox, law: Law, trajectory: Trajectory, inside: slice) -> float:
    """Return the share of time with abs(v_rel) <= stick_speed, linear between samples 2e-5 s apart."""
    slack = law.stick_speed - np.abs(mechanism.belt_velocity - trajectory.velocity[inside])
    t = trajectory.time[inside]
    total = 0.0
    for (g, s), (h, e) in itertools.pairwise(zip(slack, t, strict=True)):
        if g >= 0.0 and h >= 0.0:
            total += e - s
        elif (g >= 0.0) != (h >= 0.0):
            total += (e - s) * max(g, h) / abs(g - h)
    return float(total / (t[-1] - t[0]))


def table(cycles: dict[str, Cycle]) -> str:
    """Return a table of cycles as Markdown, one column each."""
    rows = {
        "x at break-away, mm": [f"{1e3 * c.x_break:.9f}" for c in cycles.values()],
        "x at stick, mm": [f"{1e3 * c.x_stick:.9f}" for c in cycles.values()],
        "lowest x, mm": [f"{1e3 * c.x_min:.9f}" for c in cycles.values()],
        "highest x, mm": [f"{1e3 * c.x_max:.9f}" for c in cycles.values()],
        "period, s": [f"{c.period:.9f}" for c in cycles.values()],
        "slip duration, s": [f"{c.slip_duration:.9f}" for c in cycles.values()],
        "stick fraction": [f"{c.stick_fraction:.6f}" for c in cycles.values()],
        "last change of x at break-away, m": [f"{c.change:.1e}" for c in cycles.values()],
    }
    lines = ["| | " + " | ".join(cycles) + " |", "|---|" + "---|" * len(cycles)]
    return "\n".join(lines + [f"| {name} | " + " | ".join(cells) + " |" for name, cells in rows.items()])


def difference(a: Cycle, b: Cycle) -> float:
    """Return the largest difference between two cycles in a position [m] or a time [s]."""
    names = ("x_break", "x_stick", "x_min", "x_max", "period", "slip_duration")
    return max(abs(getattr(a, n) - getattr(b, n)) for n in names)


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path(__file__).with_name("reference.md"))
    out = parser.parse_args().out
    text = TEMPLATE.read_text(encoding="utf-8")
    convergence = ["| law | scenario | tolerance halved | tolerance times 100 | closed form |", "|---|---|---|---|---|"]
    for kind in LAWS:
        cycles: dict[str, Cycle] = {}
        for name, label in SCENARIOS.items():
            scenario = load_scenario(name, law=kind)
            problem = (scenario.mechanism, scenario.law, SETTLED[name])
            cycles[label] = cycle = limit_cycle(*problem)
            fine, half, loose = (limit_cycle(*problem, rtol=r, method="adaptive") for r in (1.0e-12, 0.5e-12, 1.0e-10))
            closed = f"{difference(cycle, fine):.1e}" if kind == "coulomb" else "-"
            convergence.append(
                f"| {kind} | {label} | {difference(fine, half):.1e} | {difference(fine, loose):.1e} | {closed} |"
            )
        text = text.replace(f"<!-- table {kind} -->", table(cycles))
    out.write_text(text.replace("<!-- convergence -->", "\n".join(convergence)), encoding="utf-8")


if __name__ == "__main__":
    main()
