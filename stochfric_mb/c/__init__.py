"""C99 made from the package's own compiled functions: the same equations where no Python runs."""

from __future__ import annotations

from stochfric_mb.c.translation import Translation, UntranslatableError

__all__ = ["Translation", "UntranslatableError"]
