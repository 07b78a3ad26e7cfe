"""Write docs/reference.md: limit cycles of the belt-box by the reference, to 1e-9 m, with their convergence.

Run it as ``python docs/make_reference_tables.py``; it takes about a minute.
"""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import brentq

from stochfric_mb import BeltBox, Law, Trajectory, load_scenario
from stochfric_mb.reference import solve

SCENARIOS = {
    "kang2015_table1": "Table 1",
    "kang2015_table2_13_8": "Table 2, 13.8 rad/s",
    "kang2015_table2_18_7": "Table 2, 18.7 rad/s",
}
LAWS = ("coulomb", "elastic_stick", "havsin")
SLIP_EVERY = {"kang2015_table2_13_8": 4, "kang2015_table2_18_7": 5}
"""Forcing periods between two slips of the periodic orbit."""
SETTLED = 20.0
"""Time [s] after which Table 1, which has no forcing, is on its limit cycle."""
BRACKET = (0.21e-3, 0.31e-3)
"""Positions [m], stuck at t = 0, between which the shooting looks for the periodic orbit."""
HERE = Path(__file__).parent


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
    """Change of the position at break-away over the last two cycles [m]."""
    multiplier: float
    """Factor by which a small deviation grows in one cycle [-]; 0 without forcing."""


def limit_cycle(mechanism: BeltBox, law: Law, slip_every: int = 0, *, rtol: float = 1.0e-12, method: str = "auto") -> Cycle:
    """Return the limit cycle with constant coefficients: by waiting, or with forcing by shooting.

    Shooting also finds orbits that are unstable: it looks for the start at t = 0 whose positions one and two periods
    later are equal.
    """
    options: dict[str, Any] = {"rtol": rtol, "method": method}
    end, multiplier = SETTLED, 0.0
    if slip_every:
        period = slip_every * 2.0 * math.pi / mechanism.excitation_angular_frequency

        def sections(x: float) -> Any:
            times = [period, 2.0 * period]
            return solve(mechanism, law, None, times, initial_state=(x, mechanism.belt_velocity), **options).position

        x = float(brentq(lambda x: float(np.diff(sections(x))[0]), *BRACKET, xtol=1.0e-16))
        change = sections(x + 1.0e-8) - sections(x - 1.0e-8)
        options["initial_state"] = (x, mechanism.belt_velocity)
        end, multiplier = 3.0 * period, float(change[1] / change[0])
    events = solve(mechanism, law, None, [end], **options).events
    breaks = np.flatnonzero(events[:, 1] == 1.0)[-3:]
    marks = events[[*breaks, breaks[-2] + 1], 0]
    times = np.unique(np.concatenate([marks, np.arange(marks[1], marks[2], 2.0e-5)]))
    trajectory = solve(mechanism, law, None, times, **options)
    before, first, last, stick = (float(trajectory.position[np.searchsorted(times, m)]) for m in marks)
    inside = slice(int(np.searchsorted(times, marks[1])), int(np.searchsorted(times, marks[2])) + 1)
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
        multiplier=multiplier,
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
        "change of x at break-away from cycle to cycle, m": [f"{c.change:.0e}" for c in cycles.values()],
        "multiplier": [f"{c.multiplier:.3f}" if c.multiplier else "-" for c in cycles.values()],
    }
    lines = ["| | " + " | ".join(cycles) + " |", "|---|" + "---|" * len(cycles)]
    return "\n".join(lines + [f"| {name} | " + " | ".join(cells) + " |" for name, cells in rows.items()])


def difference(a: Cycle, b: Cycle) -> float:
    """Return the largest difference between two cycles in a position [m] or a time [s]."""
    names = ("x_break", "x_stick", "x_min", "x_max", "period", "slip_duration")
    return max(abs(getattr(a, n) - getattr(b, n)) for n in names)


def checkpoints(mechanism: BeltBox, law: Law) -> list[str]:
    """Return x(2 s) and x(10 s) [mm] from rest, and the number of stick and break-away events in 10 s, as text."""
    trajectory = solve(mechanism, law, None, [2.0, 10.0])
    return [*(f"{1e3 * x:.9f}" for x in trajectory.position), str(len(trajectory.events))]


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=HERE / "reference.md")
    out = parser.parse_args().out
    text = PAGE
    convergence = ["| law | scenario | tolerance halved | tolerance times 100 | closed form |", "|---|---|---|---|---|"]
    starts = ["| law | scenario | x(2 s), mm | x(10 s), mm | events in 10 s |", "|---|---|---|---|---|"]
    for kind in LAWS:
        cycles: dict[str, Cycle] = {}
        for name, label in SCENARIOS.items():
            scenario = load_scenario(name, law=kind)
            problem = (scenario.mechanism, scenario.law, SLIP_EVERY.get(name, 0))
            cycles[label] = cycle = limit_cycle(*problem)
            fine, half, loose = (limit_cycle(*problem, rtol=r, method="adaptive") for r in (1.0e-12, 0.5e-12, 1.0e-10))
            closed = f"{difference(cycle, fine):.0e}" if kind == "coulomb" else "-"
            cells = [kind, label, f"{difference(fine, half):.0e}", f"{difference(fine, loose):.0e}", closed]
            convergence.append(f"| {' | '.join(cells)} |")
            starts.append(f"| {' | '.join([kind, label, *checkpoints(*problem[:2])])} |")
        text = text.replace(f"<!-- cycles {kind} -->", table(cycles))
    text = text.replace("<!-- convergence -->", "\n".join(convergence)).replace("<!-- starts -->", "\n".join(starts))
    out.write_text(text, encoding="utf-8")


PAGE = """\
# The reference

`stochfric_mb.reference` solves the belt-box with every law, and every other engine is compared with it.

```python
from stochfric_mb import load_scenario
from stochfric_mb.reference import simulate, solve

scenario = load_scenario("kang2015_table1")
trajectory = simulate(scenario, seed=1)
print(trajectory.events)  # time [s] and 1 (break-away) or 0 (stick)
```

This page is written by `python docs/make_reference_tables.py`; a test runs part of it again.

## Method

m x'' + c x' + k x = F + k u_0 cos(W t), with the friction force F of the law.

- **Coulomb** is solved in closed form between events and coefficient knots: a damped oscillation, a straight line and
  the steady response while it slides; x = x_0 + v_b t while it sticks. The zeros of v_rel and of mu_s N - abs(hold)
  are bracketed in pieces of 0.2 rad, extrema included, and bisected down to rounding.
- **Every other law**, and Coulomb as a check, is integrated by DOP853 (Hairer, Norsett and Wanner 1993), with a local
  error of 1e-12 of the scales of the motion. The formula never steps across an output time, a coefficient knot, or a
  switch of the law. A law announces its switches by `guards`. They are looked at in the quarters of each step and
  where v_rel vanishes or turns, so that no speed limit, however narrow, is stepped over. A guard that turns negative
  is bisected on the step size down to rounding, and the law commits there. The integration then starts again.
- Laws with true stick (coulomb, stribeck, karnopp) move with the belt exactly while they stick. Laws whose memory is a
  differential equation (dahl, lugre) are integrated with it.
- Between knots the coefficients are linear in time (or in u = v_b t - x for a field along the belt).

Two things to know:

- Elastic stick with a random mu_s: the limit mu_s(t) N can fall onto the deflection while v_rel points back. The
  deflection is then clipped at the end of each of the short steps that follow the switch, until the contact relaxes
  faster than the limit falls.
- A `per_event` path draws a new pair at each re-stick; the law commits again with the new pair at the same instant.

## Limit cycles with constant coefficients

Defaults of the laws (v_s = 0.1 mm/s, v_d = 1 mm/s, e_lim = 10 um, zeta = 0.3, decay velocity 1 mm/s). Break-away and
stick are changes of mode for coulomb and elastic_stick, and abs(v_rel) passing v_s for havsin. The stick fraction is
the share of time with abs(v_rel) <= v_s (0.1 mm/s for coulomb; by its mode alone it is 1 - slip duration/period).

Table 1 is run for 20 s. Table 2 is solved by shooting over four (13.8 rad/s) and five (18.7 rad/s) forcing periods.
The multiplier is the factor by which a small deviation grows from one slip to the next.

### coulomb

<!-- cycles coulomb -->

### elastic_stick

<!-- cycles elastic_stick -->

### havsin

<!-- cycles havsin -->

**At 18.7 rad/s the periodic orbits of elastic_stick and havsin are unstable**: their multipliers are below -1, while
that of coulomb is inside (-1, 1). A run from rest passes near the orbit, leaves it with alternating sign, and does not
settle on it (checked up to 6000 s for elastic_stick and 3000 s for havsin). The columns above are the unstable orbits.
Compare single trajectories at that frequency over a few seconds, not after many slips.

## From rest

x(2 s), x(10 s) and the number of events in 10 s, from x = x' = 0.

<!-- starts -->

## Convergence

Largest change of a position [m] or time [s] in the tables above when the tolerance of the adaptive integration is
halved (1e-12 to 0.5e-12) or taken a hundred times larger, and its difference from the closed form.

<!-- convergence -->

Against SciPy (`tests/physics/test_reference_independent.py`): automata of every law written in plain Python and
integrated by DOP853 or LSODA, with random knots, with a field along the belt, with a pair per stick, with excitation,
and with v_rel of both signs, agree to 1e-9 m.
"""


if __name__ == "__main__":
    main()
