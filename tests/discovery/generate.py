"""Write one case: python -m tests.discovery.generate --case FORM --design D --strength S --seed K --out DIR."""

import argparse
from pathlib import Path

from .generator.case import Case, write
from .generator.design import DESIGNS
from .generator.forms import FORMS


def main() -> None:
    """Write DIR/CASE/ (the dataset) and DIR/truth/CASE.json."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--case", required=True, help=f"a kind, a form, or two joined by +. Forms: {', '.join(FORMS)}")
    parser.add_argument("--design", default="one_free", choices=list(DESIGNS))
    parser.add_argument("--strength", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, required=True)
    chosen = parser.parse_args()
    case = Case(chosen.case, chosen.design, chosen.strength, chosen.seed)
    write(case, chosen.out / case.name, chosen.out / "truth" / f"{case.name}.json")
    print(chosen.out / case.name)


if __name__ == "__main__":
    main()
