"""Freeze what discovery says of the net's data sets, or list what a change moved.

python -m tests.discovery.net --list
python -m tests.discovery.net --freeze [NAME ...]     # writes tests/discovery/net/frozen/NAME.json, says what moved
python -m tests.discovery.net [NAME ...] [--part 1/4] # compares: answers, numbers beyond 1e-9, times beyond a factor of 1.5

A NAME selects all data sets whose names contain it.
"""

import argparse
import json
import time
from pathlib import Path
from typing import Any

from stochfric_mb.discovery import discover
from tests.discovery.net.cases import known
from tests.discovery.net.moved import frozen, moved

FROZEN = Path(__file__).parent / "frozen"


def said(name: str) -> dict[str, Any]:
    """What discovery says of a data set, as it is frozen."""
    dataset = known()[name]()
    begin = time.process_time()
    try:
        answer = frozen(discover(dataset).result.to_dict())
    except Exception as failure:  # a failure is an answer, too
        answer = {"answer": {"failed": f"{type(failure).__name__}: {failure}"}, "numbers": {}}
    return answer | {"seconds": round(time.process_time() - begin, 2)}


def main() -> None:
    """Parse the command line and run."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", nargs="*", help="only data sets whose names contain one of these")
    parser.add_argument("--freeze", action="store_true")
    parser.add_argument("--missing", action="store_true", help="freeze only what is not frozen yet")
    parser.add_argument("--part", default="1/1", help="K/N: every N-th data set, beginning with the K-th")
    parser.add_argument("--list", action="store_true")
    chosen = parser.parse_args()
    part, parts = map(int, chosen.part.split("/"))
    names = [n for n in known() if not chosen.name or any(word in n for word in chosen.name)][part - 1 :: parts]
    if chosen.list:
        print("\n".join(names))
        return
    count = 0
    for name in names:
        file = FROZEN / f"{name}.json"
        if chosen.freeze:
            if not (chosen.missing and file.exists()):
                now = said(name)
                if file.exists():
                    print("\n  ".join([name, *moved(json.loads(file.read_text()), now)]), flush=True)
                file.write_text(json.dumps(now, indent=0) + "\n")
                print(f"{name}: {now['answer'].get('effects') or now['answer']} in {now['seconds']} s", flush=True)
            continue
        if not file.exists():
            print(f"{name}: not frozen", flush=True)
            continue
        lines = moved(json.loads(file.read_text()), said(name))
        count += bool(lines)
        print("\n  ".join([name, *lines]) if lines else f"{name}: as before", flush=True)
    if not chosen.freeze:
        print(f"{count} of {len(names)} data sets moved")


if __name__ == "__main__":
    main()
