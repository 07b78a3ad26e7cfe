"""Write one case: python -m tests.discovery.generate --case FORM --design D --strength S --seed K --out DIR."""

import argparse
from pathlib import Path

from .generator.case import Case, make, write
from .generator.design import DESIGNS
from .generator.forms import FORMS
from .generator.gap import held_out_gap


def main() -> None:
    """Write DIR/CASE/ (the dataset) and DIR/truth/CASE.json."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--case", required=True, help=f"a kind, a form, or two joined by +. Forms: {', '.join(FORMS)}")
    parser.add_argument("--design", default="one_free", choices=list(DESIGNS))
    parser.add_argument("--strength", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--gap", action="store_true", help="print the reducible held-out gap, too (some seconds)")
    chosen = parser.parse_args()
    case = Case(chosen.case, chosen.design, chosen.strength, chosen.seed)
    write(case, chosen.out / case.name, chosen.out / "truth" / f"{case.name}.json")
    print(chosen.out / case.name)
    if chosen.gap:
        gap = held_out_gap(make(case))
        print(f"recalibrated {gap.recalibrated:.3g} m, floor {gap.floor:.3g} m, reducible {100.0 * gap.reducible:.1f} %")


if __name__ == "__main__":
    main()
