"""modelDescription.xml of FMI 2.0 and 3.0."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Sequence
from xml.etree import ElementTree as Xml

from stochfric_mb import __version__
from stochfric_mb.export import variables as v
from stochfric_mb.export.variables import Variable

_BASE = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")


@dataclasses.dataclass(frozen=True)
class Named:
    """What a description is made of."""

    name: str
    """Name of the model."""
    identifier: str
    """Name of the binary."""
    description: str
    """A line for people."""
    token: str
    """What binds description and binary together."""
    step: float
    """Default step of a master [s]."""
    stop: float
    """Default end of a simulation [s]."""


def description(about: Named, variables: Sequence[Variable], *, fmi: int, derivatives: bool) -> str:
    """Return the text of modelDescription.xml.

    Args:
        about: the model.
        variables: its variables, each at the place of its value reference.
        fmi: 2 or 3.
        derivatives: whether outputs have derivatives with respect to inputs.
    """
    made = _fmi2(about, variables) if fmi == 2 else _fmi3(about, variables)
    for kind in ("ModelExchange", "CoSimulation"):
        place = made.find(kind)
        if derivatives and place is not None:
            place.set("providesDirectionalDerivative" if fmi == 2 else "providesDirectionalDerivatives", "true")
    return _text(made)


def _text(root: Xml.Element) -> str:
    Xml.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + Xml.tostring(root, encoding="unicode") + "\n"


def _head(about: Named, fmi: int) -> dict[str, str]:
    token = {"guid": about.token} if fmi == 2 else {"instantiationToken": about.token}
    return {
        "fmiVersion": f"{fmi}.0",
        "modelName": about.name,
        **token,
        "description": about.description,
        "version": __version__,
        "generationTool": f"stochfric_mb {__version__}",
        "license": "MIT",
        "variableNamingConvention": "structured",
    }


def _fmi2(about: Named, variables: Sequence[Variable]) -> Xml.Element:
    root = Xml.Element("fmiModelDescription", _head(about, 2) | {"numberOfEventIndicators": str(v.INDICATORS)})
    abilities = {"modelIdentifier": about.identifier, "canGetAndSetFMUstate": "true", "canSerializeFMUstate": "true"}
    steps = {"canHandleVariableCommunicationStepSize": "true"}
    for kind, more in (("ModelExchange", {}), ("CoSimulation", steps)):
        files = Xml.SubElement(Xml.SubElement(root, kind, abilities | more), "SourceFiles")
        Xml.SubElement(files, "File", {"name": "all.c"})
    _units(root, variables)
    _categories(root)
    Xml.SubElement(root, "DefaultExperiment", {"startTime": "0", "stopTime": repr(about.stop), "stepSize": repr(about.step)})
    listed = Xml.SubElement(root, "ModelVariables")
    for i, variable in enumerate(variables):
        _variable2(listed, i, variable)
    structure = Xml.SubElement(root, "ModelStructure")
    for name, chosen in (("Outputs", _outputs(variables)), ("Derivatives", _of(variables, v.DERIVATIVE))):
        if chosen:
            parent = Xml.SubElement(structure, name)
            for i in chosen:
                Xml.SubElement(parent, "Unknown", {"index": str(i + 1)})
    first = [i for i, x in enumerate(variables) if x.kind in (v.OUTPUT, v.STATE, v.DERIVATIVE)]
    parent = Xml.SubElement(structure, "InitialUnknowns")
    for i in first:
        Xml.SubElement(parent, "Unknown", {"index": str(i + 1)})
    return root


def _outputs(variables: Sequence[Variable]) -> list[int]:
    """Return the places of outputs: a box's position and velocity are outputs as well as states."""
    return [i for i, x in enumerate(variables) if x.kind in (v.OUTPUT, v.STATE)]


def _of(variables: Sequence[Variable], kind: str) -> list[int]:
    return [i for i, x in enumerate(variables) if x.kind == kind]


_ATTRIBUTES = {
    v.TIME: {"causality": "independent", "variability": "continuous"},
    v.PARAMETER: {"causality": "parameter", "variability": "fixed", "initial": "exact"},
    v.INPUT: {"causality": "input", "variability": "continuous"},
    v.OUTPUT: {"causality": "output", "variability": "continuous", "initial": "calculated"},
    v.STATE: {"causality": "output", "variability": "continuous", "initial": "calculated"},
    v.INDICATOR: {"causality": "local", "variability": "continuous", "initial": "calculated"},
    v.DERIVATIVE: {"causality": "local", "variability": "continuous", "initial": "calculated"},
}


def _common(i: int, variable: Variable) -> dict[str, str]:
    about = {"name": variable.name, "valueReference": str(i), "description": variable.description}
    attributes = dict(_ATTRIBUTES[variable.kind])
    if variable.type != v.REAL and attributes["variability"] == "continuous":
        attributes["variability"] = "discrete"
    return about | attributes


def _value(variable: Variable) -> dict[str, str]:
    """Return unit, start and nominal."""
    texts: dict[str, str] = {}
    if variable.unit:
        texts["unit"] = variable.unit
    if variable.kind in (v.PARAMETER, v.INPUT):
        texts["start"] = repr(float(variable.start)) if variable.type == v.REAL else str(int(variable.start))
    if variable.nominal > 0.0:
        texts["nominal"] = repr(variable.nominal)
    return texts


def _variable2(parent: Xml.Element, i: int, variable: Variable) -> None:
    scalar = Xml.SubElement(parent, "ScalarVariable", _common(i, variable))
    value = _value(variable)
    if variable.of >= 0:
        value["derivative"] = str(variable.of + 1)
    if variable.type == v.NUMBER:
        value["min"] = "0"
    name = {v.REAL: "Real", v.NUMBER: "Integer", v.FLAG: "Boolean"}[variable.type]
    Xml.SubElement(scalar, name, value)


def _fmi3(about: Named, variables: Sequence[Variable]) -> Xml.Element:
    root = Xml.Element("fmiModelDescription", _head(about, 3))
    abilities = {"modelIdentifier": about.identifier, "canGetAndSetFMUState": "true", "canSerializeFMUState": "true"}
    Xml.SubElement(root, "ModelExchange", abilities | {"needsCompletedIntegratorStep": "true"})
    Xml.SubElement(root, "CoSimulation", abilities | {"canHandleVariableCommunicationStepSize": "true"})
    _units(root, variables)
    _categories(root)
    Xml.SubElement(root, "DefaultExperiment", {"startTime": "0", "stopTime": repr(about.stop), "stepSize": repr(about.step)})
    listed = Xml.SubElement(root, "ModelVariables")
    for i, variable in enumerate(variables):
        value = _value(variable)
        if variable.of >= 0:
            value["derivative"] = str(variable.of)
        name = {v.REAL: "Float64", v.NUMBER: "UInt32", v.FLAG: "Boolean"}[variable.type]
        Xml.SubElement(listed, name, _common(i, variable) | value)
    structure = Xml.SubElement(root, "ModelStructure")
    initial = _outputs(variables)
    for i in initial:
        Xml.SubElement(structure, "Output", {"valueReference": str(i)})
    for i in _of(variables, v.DERIVATIVE):
        Xml.SubElement(structure, "ContinuousStateDerivative", {"valueReference": str(i)})
    for i in [*initial, *_of(variables, v.DERIVATIVE)]:
        Xml.SubElement(structure, "InitialUnknown", {"valueReference": str(i)})
    for i in _of(variables, v.INDICATOR):
        Xml.SubElement(structure, "EventIndicator", {"valueReference": str(i)})
    return root


def _categories(root: Xml.Element) -> None:
    listed = Xml.SubElement(root, "LogCategories")
    Xml.SubElement(
        listed, "Category", {"name": "error", "description": "Input that cannot be used, and motion that broke down"}
    )


def _units(root: Xml.Element, variables: Sequence[Variable]) -> None:
    ordered = sorted({x.unit for x in variables if x.unit})
    if ordered:
        listed = Xml.SubElement(root, "UnitDefinitions")
        for unit in ordered:
            element = Xml.SubElement(listed, "Unit", {"name": unit})
            base = _base_unit(unit)
            if base is not None:
                Xml.SubElement(element, "BaseUnit", {k: str(n) for k, n in base.items() if n})


def _base_unit(unit: str) -> dict[str, int] | None:
    """Return the exponents of a unit such as "N s/m", None for one that is not made of base units."""
    total: dict[str, int] = {}
    above, _, below = unit.partition("/")
    for part, sign in ((above, 1), (below, -1)):
        for word in part.replace("(", " ").replace(")", " ").split():
            if word == "1":
                continue
            matched = re.fullmatch(r"([A-Za-z]+)\^?(\d*)", word)
            if matched is None:
                return None
            power = sign * int(matched[2] or "1")
            own = {"N": {"kg": 1, "m": 1, "s": -2}, "Hz": {"s": -1}}.get(matched[1])
            if own is None and matched[1] not in _BASE:
                return None
            for name, n in (own or {matched[1]: 1}).items():
                total[name] = total.get(name, 0) + power * n
    return {name: total[name] for name in _BASE if name in total}
