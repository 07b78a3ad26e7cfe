"""How large what decides becomes where nothing is missing: python -m tests.discovery.null_table [--records 210] [--part 1/1].

Simulates records in which only parameters are off, within what is stated of them, with sensors quiet, loud and coloured, on
rigs of four sizes and in all experiments, and keeps the largest value of every statistic on which a name may hang. Written to
stochfric_mb/discovery/null_scores.json, from which the package takes its chances; records that are there are not made again.
"""

import argparse
import itertools
import json
from pathlib import Path

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.decision.kinematics import outlier_share
from stochfric_mb.discovery.stick_slip.decision.random_effects import kicked
from stochfric_mb.discovery.stick_slip.decision.rounds import decide
from stochfric_mb.discovery.stick_slip.screening.screen import screen
from stochfric_mb.discovery.stick_slip.screening.switching import switching
from stochfric_mb.discovery.stick_slip.screening.variance_components import randomness
from stochfric_mb.discovery.stick_slip.simulation.prior_model import assumed
from stochfric_mb.discovery.stick_slip.study import study
from tests.discovery.generator.case import Case
from tests.discovery.generator.design import DESIGNS
from tests.discovery.net.rigs import SIZES, belt_box

TABLE = Path(__file__).parents[2] / "stochfric_mb" / "discovery" / "null_scores.json"
FORMS = ("wrong_parameters", "quiet_sensor", "loud_sensor", "coloured_noise", "slow_noise")
SEEDS = range(60, 100)
"""Tuning seeds that no other test uses."""


def cases(count):
    """Return (case, size of the rig) of each record; forms, experiments and sizes rotate at different paces."""
    every = [(form, design) for design in DESIGNS for form in FORMS]
    sizes = list(SIZES)
    for i, ((form, design), seed) in zip(range(count), ((e, s) for s, e in itertools.product(SEEDS, every)), strict=False):
        yield Case(f"none.{form}", design, 1.0, seed), sizes[(i + seed) % len(sizes)]


def statistics(case, size):
    """Return statistic -> value in one record; None where the record is refused."""
    dataset = belt_box(case, size)
    result = study(assumed(dataset))
    if result is None:
        return None
    candidates = screen(result.baseline)
    scatter = randomness(result.baseline)
    levels = switching(result.pool, result.baseline.residuals())
    jumps = result.sticking.jumps if result.sticking is not None else 0
    # what simulating refutes is not named, whatever its score was
    most = np.inf
    if candidates[0].score >= criteria.NAMED and decide(result).verdict == "none":
        most = criteria.NAMED
    return {
        "slips": min(most, max(c.score for c in candidates if c.is_effect)),
        "patterns": min(most, max(c.score for c in candidates if not c.is_effect)),
        "stick": max(result.sticking.scores.values()) if result.sticking is not None else 0.0,
        "scatter": max(scatter.static, scatter.kinetic),
        "wander": scatter.wander,
        "levels": levels.separation,
        "clipped": result.range.share,
        "outliers": outlier_share(result),
        "kicks": (float(kicked(result).sum()) + jumps) / len(result.pool.run),
        "line": max(s.line[2] for s in result.pool.slips),
    }


def main():
    """Parse the command line and run."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--records", type=int, default=210)
    parser.add_argument("--part", default="1/1", help="K/N: every N-th record, beginning with the K-th")
    parser.add_argument("--rows", type=Path, required=True, help="folder for one file a record")
    chosen = parser.parse_args()
    part, parts = map(int, chosen.part.split("/"))
    chosen.rows.mkdir(parents=True, exist_ok=True)
    for case, size in list(cases(chosen.records))[part - 1 :: parts]:
        file = chosen.rows / f"{case.name}-{size}.json"
        if not file.exists():
            file.write_text(json.dumps(statistics(case, size)))
            print(file.stem, file.read_text(), flush=True)
    rows = [r for r in (json.loads(f.read_text()) for f in sorted(chosen.rows.glob("*.json"))) if r is not None]
    table = {name: [float(f"{v:.4g}") for v in sorted((r[name] for r in rows), reverse=True)] for name in rows[0]}
    about = "largest value in each simulated record in which nothing is missing, largest record first"
    TABLE.write_text(json.dumps({"about": about, "records": len(rows), "statistics": table}) + "\n")
    for name, values in table.items():
        print(name, f"largest {values[0]:.4g}, 1 in 100 {np.quantile(values, 0.99):.4g}, median {np.median(values):.4g}")


if __name__ == "__main__":
    main()
