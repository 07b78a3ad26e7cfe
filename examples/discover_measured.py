"""What the workflow says of published friction measurements.

Run it as ``python examples/discover_measured.py emps``; the names are the folders under ``models`` that have a
``dataset.toml``. The data are not part of the package: set STOCHFRIC_DATA to the folder that holds them.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from stochfric_mb.discovery import discover
from stochfric_mb.discovery.export import files

MODELS = Path(__file__).parents[1] / "models"


def names() -> list[str]:
    """Return the names of the datasets."""
    return sorted(file.parent.name for file in MODELS.glob("*/dataset.toml"))


def main(arguments: list[str] | None = None) -> None:
    """Run discovery, print the result, and write the augmented model if wanted."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("name", choices=names())
    parser.add_argument("--out", type=Path, help="folder for parameters.csv, augmented.toml and, for joints, augmented.xml")
    options = parser.parse_args(arguments)
    outcome = discover(MODELS / options.name, progress=print)
    result = outcome.result
    print(f"{options.name}: {result.verdict}")
    for effect in result.effects:
        print(f"  {effect.kind}: {effect.where.text}")
    if result.gap is not None:
        gap = result.gap
        print(
            f"  held out, {gap.metric} [{gap.unit}]: {gap.baseline:.4g} as stated, {gap.recalibrated:.4g} recalibrated, "
            f"{gap.augmented:.4g} with the effects, {gap.floor:.4g} noise"
        )
    for note in result.notes:
        print(f"  {note}")
    if options.out is not None:
        options.out.mkdir(parents=True, exist_ok=True)
        for name, text in files(outcome).items():
            (options.out / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
