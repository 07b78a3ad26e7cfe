"""Laws and effects by number: what compiled Python calls by its address, C calls by a number in a switch."""

from __future__ import annotations

import dataclasses
from types import FunctionType
from typing import Any

from stochfric_mb.c.translation import Function, Translation
from stochfric_mb.c.types import DOUBLE, Array, Tuple
from stochfric_mb.effects import Effect
from stochfric_mb.laws import Law

NUMBERS = Array(DOUBLE, (None,))
"""A pointer to doubles."""
_MOTION, _REST = [DOUBLE] * 6, [DOUBLE] * 5
LAW_FUNCTIONS = {
    "init": [*_MOTION, *_REST, NUMBERS],
    "force": [*_MOTION, NUMBERS, *_REST, NUMBERS],
    "commit": [*_MOTION, NUMBERS, *_REST, NUMBERS],
    "guards": [*_MOTION, NUMBERS, *_REST, NUMBERS],
}
"""A law's functions -> types of their arguments."""
FLOW = [*[DOUBLE] * 7, NUMBERS]
"""Types of the arguments of a law's ``flow``."""
EFFECT_FUNCTIONS = ("surroundings", "friction")
"""An effect's functions, of four pointers each."""

_SWITCHES = """
static void call_law(int64_t address, double t, double ux, double uy, double vx, double vy, double normal_force,
                     double mu_s, double mu_k, double effective_mass, double hx, double hy, int64_t state,
                     int64_t p, int64_t out) {{
    switch (address) {{
{law_cases}
        default: break;
    }}
    (void)state;
}}

static void call_effect(int64_t address, int64_t world, int64_t memory, int64_t rates, int64_t p) {{
    switch (address) {{
{effect_cases}
        default: break;
    }}
    (void)world; (void)memory; (void)rates; (void)p;
}}
"""
_CALL = "t, ux, uy, vx, vy, normal_force, {state}mu_s, mu_k, effective_mass, hx, hy, doubles_at(p)"


@dataclasses.dataclass(frozen=True)
class LawNumbers:
    """The numbers of a law's functions."""

    init: int
    force: int
    commit: int
    guards: int


class Dispatch:
    """The laws and effects of one translation, and the two C functions that call them."""

    def __init__(self, translation: Translation) -> None:
        self._translation = translation
        self._laws: dict[type[Law], LawNumbers] = {}
        self._effects: dict[tuple[type[Effect], str], int] = {}
        self._law_cases: list[str] = []
        self._effect_cases: list[str] = []

    def law(self, cls: type[Law]) -> LawNumbers:
        """Return the numbers of a law's functions; translates them at the first call."""
        if cls not in self._laws:
            module: Any = cls.functions()
            numbers = [self._law_case(name, getattr(module, name)) for name in LAW_FUNCTIONS]
            self._laws[cls] = LawNumbers(*numbers)
        return self._laws[cls]

    def effect(self, cls: type[Effect], name: str) -> int:
        """Return the number of one of an effect's functions, 0 where it has none of that name."""
        function = getattr(cls.functions(), name, None)
        if not isinstance(function, FunctionType):
            return 0
        if (cls, name) not in self._effects:
            made = self._translation.add(function, [NUMBERS] * 4)
            number = len(self._effect_cases) + 1
            arguments = ", ".join(f"doubles_at({a})" for a in ("world", "memory", "rates", "p"))
            self._effect_cases.append(f"        case {number}: {made.name}({arguments}); break;")
            self._effects[cls, name] = number
        return self._effects[cls, name]

    @property
    def text(self) -> str:
        """The C source of the two functions."""
        return _SWITCHES.format(law_cases="\n".join(self._law_cases), effect_cases="\n".join(self._effect_cases))

    def _law_case(self, name: str, function: Any) -> int:
        made = self._translation.add(function, LAW_FUNCTIONS[name])
        number = len(self._law_cases) + 1
        arguments = _CALL.format(state="" if name == "init" else "doubles_at(state), ")
        lines = [f"        case {number}: {{", f"            const {made.returns.c} r = {made.name}({arguments});"]
        lines += [f"            doubles_at(out)[{i}] = r.a{i};" for i in range(_length(made))]
        self._law_cases.append("\n".join([*lines, "            break;", "        }"]))
        return number


def _length(made: Function) -> int:
    assert isinstance(made.returns, Tuple)
    return len(made.returns.items)
