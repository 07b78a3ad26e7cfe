"""The friction element as C: the translated law, coefficients and contact behind init, force and commit."""

from __future__ import annotations

import contextlib
import dataclasses
import re
from collections.abc import Callable, Sequence
from importlib import resources

import numpy as np

from stochfric_mb import __version__, contact
from stochfric_mb.c import Translation, UntranslatableError
from stochfric_mb.c.dispatch import FLOW, NUMBERS, Dispatch
from stochfric_mb.c.model import numbered_model
from stochfric_mb.c.types import DOUBLE, DUAL, INT, Array, number
from stochfric_mb.coefficients import path
from stochfric_mb.coefficients.path import CURSOR, constant_descriptor
from stochfric_mb.coefficients.processes import EVENT
from stochfric_mb.effects import augmented_law as augmented
from stochfric_mb.effects.augmented_law import Augmented
from stochfric_mb.export.exported import Exported
from stochfric_mb.export.parameters import Group, Parameter, groups
from stochfric_mb.laws.abi import MAX_STATE
from stochfric_mb.laws.contract import GUARDS

_DERIVATIVE = """\
/* The force and its derivative along a direction in which the contact changes, made from the law's own source; the state stays
   as it is, and the time of `along` is not looked at. */
STOCHFRIC_API int stochfric_derivative(const stochfric_friction *friction, const stochfric_state *state,
                                       const stochfric_contact *at, const stochfric_contact *along, double force[2],
                                       double derivative[2]);

"""
INTEGERS = Array(INT, (None,))
CONTACT = [INTEGERS, INTEGERS, *[NUMBERS] * 6, *[DOUBLE] * 8]
"""Types of the arguments of a contact's compiled functions."""


@dataclasses.dataclass(frozen=True)
class Element:
    """The C source of a friction element."""

    header: str
    """Text of stochfric.h."""
    source: str
    """Text of stochfric.c."""
    parameters: tuple[Parameter, ...]
    """What can be set, in the order of ``values``."""
    derivative: bool
    """Whether there is ``stochfric_derivative``."""


def element(
    exported: Exported,
    *,
    mechanism: bool = False,
    more: Callable[[Translation], str] | None = None,
    effective_mass: float | None = None,
) -> Element:
    """Return the C source of what is exported.

    Args:
        exported: what is exported.
        mechanism: whether a belt-box is built on top.
        more: adds functions to the translation; returns C text that comes after them.
        effective_mass: mass that the contact feels [kg] where the caller of the C code gives none; default: the box's, or 1.

    Raises:
        UntranslatableError: a law or effect that cannot be translated; names it.
    """
    result = groups(exported, mechanism=mechanism)
    parameters = tuple(p for group in result for p in group.parameters)
    translation = Translation()
    for name in ("_start", "_compute", "_commit"):
        translation.add(getattr(contact, name), CONTACT)
    dispatch = Dispatch(translation)
    numbers = dispatch.law(type(exported.law))
    arrays = _arrays(exported, dispatch)
    flow = ""
    if exported.law.has_flow:
        flow = translation.add(exported.law.functions().flow, FLOW).name
    derivative = ""
    if not exported.effects:
        with contextlib.suppress(UntranslatableError):  # a law of one's own whose functions have no derivatives here
            derivative = _derivative(translation, exported)
    after = more(translation) if more is not None else ""
    defines = _defines(exported, arrays, mechanism=mechanism, mass=effective_mass, numbers=dataclasses.asdict(numbers))
    defines |= {"LAW_FLOW": flow} if flow else {}
    defines |= {"VALUES": _row([p.value for p in parameters])}
    rules = _rules(result)
    source = "\n".join(
        [
            '#include "stochfric.h"',
            _definitions(defines, len(rules)),
            translation.text,
            dispatch.text,
            _rule_functions(rules, parameters),
            _spread(parameters),
            template("element.c"),
            derivative,
            after,
        ]
    )
    return Element(_header(exported, parameters, arrays, derivative=bool(derivative)), source, parameters, bool(derivative))


def template(name: str) -> str:
    """Return the text of a C file that comes with the package."""
    return (resources.files("stochfric_mb.export") / "sources" / name).read_text(encoding="utf-8")


def _derivative(translation: Translation, exported: Exported) -> str:
    """Add the law's force with derivatives; return the C code that is theirs."""
    functions = exported.law.functions()
    force = translation.add(functions.force, [DOUBLE, *[DUAL] * 5, NUMBERS, *[DUAL] * 5, NUMBERS])
    evaluate = translation.add(path.evaluate, [NUMBERS, NUMBERS, INT, INT, INT, DOUBLE, DUAL, DOUBLE])
    names = {"@FORCE@": force.name, "@EVALUATE@": evaluate.name, "@PAIR@": force.returns.c, "@MU@": evaluate.returns.c}
    text = template("derivative.c")
    flow = ""
    if exported.law.has_flow:
        made = translation.add(functions.flow, [*[DUAL] * 7, NUMBERS])
        names |= {"@FLOWN@": made.returns.c, "@FLOW_NAME@": made.name}
        flow = template("flow_derivative.c")
    text = text.replace("@FLOW@", flow)
    for name, value in names.items():
        text = text.replace(name, value)
    return text


def _arrays(exported: Exported, dispatch: Dispatch) -> dict[str, list[float]]:
    """Return the numbers that the C code reads: law, process, model of the effects, mechanism."""
    law, process = exported.inner, exported.process
    descriptor = constant_descriptor(law) if process is None else process.descriptor(law)
    model = numbered_model(exported.law, exported.effects, dispatch) if isinstance(exported.law, Augmented) else np.zeros(1)
    if isinstance(exported.law, Augmented):
        model[augmented.INNER_P] = 0.0
    mechanism = [0.0] if exported.mechanism is None else list(dataclasses.astuple(exported.mechanism))
    return {
        "law": law.parameters().tolist(),
        "process": descriptor.tolist(),
        "model": model.tolist(),
        "mechanism": mechanism,
    }


def _row(values: Sequence[float]) -> str:
    return "{" + ", ".join(number(float(v)) for v in values) + "}"


def _defines(
    exported: Exported, arrays: dict[str, list[float]], *, mechanism: bool, mass: float | None, numbers: dict[str, int]
) -> dict[str, str]:
    box = exported.mechanism
    default_mass = mass if mass is not None else 1.0 if box is None else box.mass
    law = exported.law
    table = {name.upper(): _row(values) for name, values in arrays.items()}
    table |= {f"LAW_{name.upper()}": str(value) for name, value in numbers.items()}
    table |= {
        "N_LAW": str(len(arrays["law"])),
        "MAX_STATE": str(MAX_STATE),
        "GUARDS": str(GUARDS),
        "N_STATE": str(max(len(law.state_names), 1)),
        "IS_MODED": "1.0" if law.state_names[:1] == ("mode",) else "0.0",
        "DEFAULT_STICK_SPEED": number(law.stick_speed),
        "DEFAULT_MASS": number(float(default_mass)),
        "ALIVE": str(contact.ALIVE),
        "MASS": str(contact.MASS),
        "HALF_STEP": str(contact.HALF_STEP),
        "STICK_SPEED": str(contact.STICK_SPEED),
        "MODED": str(contact.MODED),
        "STUCK": str(contact.STUCK),
        "EVENTS_SO_FAR": str(contact.EVENTS),
        "CLOCK_EVENT": number(EVENT),
        "BOOK_MU_S": str(contact.MU_S),
        "BOOK_MU_K": str(contact.MU_K),
        "INNER_P": str(augmented.INNER_P),
        "MODEL_SEED": str(augmented.SEED),
        "MODEL_SAMPLE": str(augmented.SAMPLE),
        "MODEL_NORMAL_FORCE": str(augmented.N),
    }
    table |= {"WITH_EFFECTS": "1"} if exported.effects else {}
    table |= {"WITH_MECHANISM": "1"} if mechanism else {}
    return table


def _definitions(defines: dict[str, str], n_rules: int) -> str:
    names = {"RULE_MASS": n_rules + 1, "RULE_STEP": n_rules + 2, "RULE_ADDRESS": n_rules + 3, "RULE_FEASIBLE": n_rules + 4}
    lines = [f"#define {name} {value}" for name, value in (defines | {k: str(v) for k, v in names.items()}).items()]
    return "\n".join(lines)


# --- rules of the parameters ------------------------------------------------------------------------------------------------


def _rules(groups: Sequence[Group]) -> list[tuple[str, str, str]]:
    """Return (prefix, condition, message) of each rule."""
    return [(group.prefix, rule.broken, rule.message) for group in groups for rule in group.rules]


def _rule_functions(rules: Sequence[tuple[str, str, str]], parameters: Sequence[Parameter]) -> str:
    """Return the C functions that check the parameters and say which rule is broken."""
    lines = ["static int broken_rule(const double *values) {"]
    for i, (prefix, broken, _) in enumerate(rules, start=1):
        condition = broken
        for place, p in enumerate(parameters):
            own, _, field = p.name.rpartition(".")
            if own == prefix:
                condition = re.sub(rf"\b{field}\b", f"values[{place}]", condition)
        lines.append(f"    if ({condition}) return {i};")
    lines += [
        "    (void)values;",
        "    return 0;",
        "}",
        "",
        "static const char *rule_message(int rule) {",
        "    switch (rule) {",
    ]
    for i, (prefix, _, message) in enumerate(rules, start=1):
        text = f"{prefix}: {message}".replace("\\", "\\\\").replace('"', '\\"').replace("%", "percent")
        lines.append(f'        case {i}: return "{text}";')
    return "\n".join([*lines, '        default: return "unknown status";', "    }", "}", ""])


def _spread(parameters: Sequence[Parameter]) -> str:
    lines = [f"    friction->{array}[{index}] = values[{i}];" for i, p in enumerate(parameters) for array, index in p.places]
    head = "static void spread(stochfric_friction *friction, const double *values) {"
    return "\n".join(["/* Put each parameter where the equations read it. */", head, *lines, "}", ""])


def _header(exported: Exported, parameters: Sequence[Parameter], arrays: dict[str, list[float]], *, derivative: bool) -> str:
    law = exported.inner
    enumerators = "\n".join(f"    STOCHFRIC_{p.identifier.upper()},  /* {_clean(p.description)} */" for p in parameters)
    return template("element.h.in").format(
        title=_clean(exported.title or f"friction law {law.kind}"),
        equation=_clean(f"Law {law.kind}: {law.equation}. Source: {law.source}."),
        version=__version__,
        enumerators=enumerators,
        mass_note="" if exported.law.needs_effective_mass else "; this law does not use it",
        hold_note="" if exported.law.needs_holding_force else ". This law does not use it",
        derivative=_DERIVATIVE if derivative else "",
        n_book=contact.BOOK,
        n_state=MAX_STATE,
        n_cursor=CURSOR,
        n_guards=GUARDS,
        **{f"n_{name}": len(values) for name, values in arrays.items()},
    )


def _clean(text: str) -> str:
    return " ".join(text.split()).replace("*/", "* /")
