"""Run all code blocks of a page in their order, in the folder it is called in: python -m tests.examples.run_page PAGE."""

import shlex
import subprocess
import sys
from pathlib import Path

from .doc_blocks import ROOT, blocks
from .page_settings import SETTINGS, Setting

SHELL = ("sh", "bash")
INSTALLS = ("pip", ".venv/bin/pip")
"""What installs is run where CI sets up its environments."""
PROGRAMS = {
    "stochfric": [sys.executable, "-m", "stochfric_mb"], "python": [sys.executable], "pytest": [sys.executable, "-m", "pytest"]
}  # fmt: skip


def shortened(text: str, setting: Setting) -> str:
    """Return a block with the parts replaced that its setting names; commands with an empty replacement are left out."""
    for part, instead in setting.shorter.items():
        lines = [line.replace(part, instead) for line in text.splitlines() if instead or part not in line]
        text = "\n".join(lines)
    return text


def run_shell(text: str) -> None:
    """Run the lines of a block of the shell; ``stochfric`` and ``python`` are those of this environment."""
    for line in text.replace("\\\n", " ").splitlines():
        for command in line.partition("  #")[0].split("&&"):
            words = shlex.split(command, comments=True)
            if not words or words[0] in INSTALLS or words[:3] == ["python3", "-m", "venv"]:
                continue
            name = Path(words[0]).name
            if name in PROGRAMS:
                words = PROGRAMS[name] + words[1:]
            print("$", *words, flush=True)
            subprocess.run(words, check=True)


def run_page(page: str) -> None:
    """Run the blocks of a page, each after the code that its setting has for it."""
    setting = SETTINGS.get(page, Setting())
    names: dict[str, object] = {"__name__": "page"}
    names["names"] = names
    for number, block in enumerate(blocks(page)):
        names["text"] = block.text
        place = f"{page}:{block.line}"
        if number in setting.code:
            exec(compile(setting.code[number], f"{place} (setting)", "exec"), names)
        if block.language == "python":
            print("python", place, flush=True)
            file = Path(f"block_{number}.py").resolve()  # compiled functions are cached by the file that they stand in
            file.write_text(shortened(block.text, setting), encoding="utf-8")
            exec(compile(file.read_text(encoding="utf-8"), file, "exec"), names)
        elif block.language in SHELL:
            run_shell(shortened(block.text, setting))
        elif number not in setting.code:
            raise SystemExit(f"{place}: nothing runs this block of {block.language}; say in page_settings.py how it is used")


if __name__ == "__main__":
    for folder in ("examples", "tests", "models", "docs"):  # what a reader has in the clone
        if not Path(folder).exists():
            Path(folder).symlink_to(ROOT / folder)
    run_page(sys.argv[1])
