"""The code blocks of the pages: what stands between fences, with its language and, where it is a file, the file's name."""

import dataclasses
import re
import shlex
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = {
    str(p.relative_to(ROOT)): p for p in [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
}
FENCE = re.compile(r"^```(\w+)(?: title=\"([^\"]+)\")?\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@dataclasses.dataclass(frozen=True)
class Block:
    """One fenced block."""

    language: str
    title: str
    text: str
    line: int


def blocks(page: str) -> list[Block]:
    """Return the blocks of a page that have a language."""
    text = PAGES[page].read_text(encoding="utf-8")
    return [Block(m[1], m[2] or "", m[3], text.count("\n", 0, m.start()) + 1) for m in FENCE.finditer(text)]


def commands(block: Block) -> list[list[str]]:
    """Return the words of each ``stochfric`` command in a block of the shell."""
    joined = block.text.replace("\\\n", " ")
    parts = [part.strip() for line in joined.splitlines() for part in re.split(r"&&|\|\|", line.partition("  #")[0])]
    words = [shlex.split(part, comments=True) for part in parts]
    return [w for w in words if w and Path(w[0]).name == "stochfric"]
