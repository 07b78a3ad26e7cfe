"""Functional Mock-up Units: description, binaries for each platform and sources in one archive."""

from __future__ import annotations

import concurrent.futures
import dataclasses
import hashlib
import io
import tempfile
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path

from stochfric_mb.c import Translation
from stochfric_mb.c.compiler import TARGETS, Target, compile_library
from stochfric_mb.c.dispatch import NUMBERS
from stochfric_mb.c.types import DOUBLE, number
from stochfric_mb.errors import InputError
from stochfric_mb.export import motion
from stochfric_mb.export.description import Named, description
from stochfric_mb.export.element import element, template
from stochfric_mb.export.exported import Exported
from stochfric_mb.export.variables import STATE, Variable, variables

_PLACES = (
    "BRISTLE", "STEP", "DISPLACEMENT", "VELOCITY", "HOLDING_FORCE", "NORMAL_FORCE", "EFFECTIVE_MASS", "EXTERNAL_FORCE",
    "POSITION", "BOX_VELOCITY", "DERIVATIVES", "STATES",
)  # fmt: skip
"""Places that one kind of FMU has and another has not."""
MOST_SWITCHES = 1000
"""Most switches that a belt-box locates within one internal step; later ones fall on its end."""
STAMP = (2000, 1, 1, 0, 0, 0)
"""Time of the files in an FMU, so that equal exports are equal to the byte."""


@dataclasses.dataclass(frozen=True)
class Source:
    """An FMU before it is compiled."""

    identifier: str
    """Name of its binary."""
    description: str
    """Text of modelDescription.xml."""
    files: dict[str, str]
    """C files by name; all.c includes the others."""
    fmi: int
    """Version of FMI."""


def fmu_source(exported: Exported, *, fmi: int = 2, mechanism: bool = False, name: str = "friction") -> Source:
    """Return description and sources of an FMU.

    Args:
        exported: what is exported.
        fmi: 2 or 3.
        mechanism: whether the belt-box is exported, not the friction element alone.
        name: name of the model.

    Raises:
        InputError: an unknown version, or a belt-box that there is none of.
        UntranslatableError: a law or effect that cannot be translated; names it.
    """
    if fmi not in (2, 3):
        raise InputError(f"fmi = {fmi} is not a version that is exported; use 2 or 3")
    if mechanism and exported.mechanism is None:
        raise InputError("there is no belt-box to export; export the friction element, or give a scenario with a belt_box")
    more = _around if mechanism else None
    made = element(exported, mechanism=mechanism, more=more)
    listed = variables(exported, made.parameters, mechanism=mechanism)
    identifier = "".join(c if c.isalnum() else "_" for c in name)
    flow = mechanism and any(x.place == "BRISTLE" for x in listed)
    texts = {
        "stochfric.h": made.header,
        "stochfric.c": made.source,
        "model.c": _model(exported, listed, mechanism=mechanism)
        + template("watch.c")
        + template("model_belt_box.c" if mechanism else "model_element.c"),
        "fmu.c": template("fmu.c"),
        f"fmi{fmi}.h": template(f"fmi{fmi}.h"),
        f"fmi{fmi}.c": template(f"fmi{fmi}.c"),
    }
    token = hashlib.sha256("".join(texts.values()).encode()).hexdigest()[:32]
    derivatives = made.derivative
    texts["all.c"] = _all(fmi, token, flow=flow, derivatives=derivatives)
    kind = f"belt-box with law {exported.inner.kind}" if mechanism else f"friction element with law {exported.inner.kind}"
    line = "; ".join([exported.title or kind, *exported.notes])
    step = next((x.start for x in listed if x.name == "internal_step"), 1.0e-3)
    about = Named(name, identifier, line, token, step=max(step, 1.0e-3), stop=10.0)
    return Source(identifier, description(about, listed, fmi=fmi, derivatives=derivatives), texts, fmi)


def _around(translation: Translation) -> str:
    """Add the equations of the belt-box."""
    translation.add(motion.slip, [NUMBERS, DOUBLE, DOUBLE])
    translation.add(motion.slip_velocity, [NUMBERS, DOUBLE])
    translation.add(motion.holding_force, [NUMBERS, *[DOUBLE] * 4])
    return ""


def _all(fmi: int, token: str, *, flow: bool, derivatives: bool) -> str:
    official = f'#ifdef STOCHFRIC_OFFICIAL_FMI\n#include <fmi{fmi}Functions.h>\n#else\n#include "fmi{fmi}.h"\n#endif\n'
    head = f'/* The whole FMU: compile this file alone. */\n#define TOKEN "{token}"\n#define MARK UINT64_C(0x{token[:16]})\n'
    files = "".join(f'#include "{name}"\n' for name in ("stochfric.c", "model.c", "fmu.c", f"fmi{fmi}.c"))
    head += "#define WITH_DERIVATIVES 1\n" if derivatives else ""
    return head + ("#define WITH_FLOW 1\n" if flow else "") + "#define STOCHFRIC_API static\n" + official + files


def _model(exported: Exported, listed: Sequence[Variable], *, mechanism: bool) -> str:
    """Return the definitions that bind the variables to their places."""
    n = len(listed)
    lines = [f"#define N_VARIABLES {n}", "#define FIRST_PARAMETER 1"]
    table = {x.place: i for i, x in enumerate(listed) if x.place}
    states = [i for i, x in enumerate(listed) if x.kind == STATE]
    places = dict.fromkeys(_PLACES, n) | {"STATES": states[0] if states else n} | table
    lines += [f"#define VR_{place} {i}" for place, i in places.items()]
    nominals = [number(listed[i].nominal) for i in states] or ["1.0"]
    starts = ", ".join(number(float(x.start)) for x in listed)
    lines += [
        f"#define N_STATES {len(states)}",
        f"#define NOMINALS {{{', '.join(nominals)}}}",
        f'#define VARIABLE_KINDS "{"".join(x.kind for x in listed)}"',
        f'#define VARIABLE_TYPES "{"".join(x.type for x in listed)}"',
        f"#define VARIABLE_STARTS {{{starts}}}",
    ]
    if mechanism:
        lines += [f"#define BOX_{name} {getattr(motion, name)}" for name in (
            "MASS", "DAMPING", "STIFFNESS", "NORMAL_FORCE", "BELT_VELOCITY", "INITIAL_POSITION", "INITIAL_VELOCITY",
        )]  # fmt: skip
        names = exported.law.state_names
        lines += [
            f"#define IS_HOLDING {int(exported.law.needs_holding_force)}",
            f"#define BRISTLE {names.index('zx') if 'zx' in names else 0}",
            f"#define MOST_SWITCHES {MOST_SWITCHES}",
        ]
    return "\n".join([*lines, ""])


def write_fmu(
    source: Source,
    out: Path,
    *,
    platforms: Sequence[str] = tuple(TARGETS),
    compiled: Callable[[int], None] | None = None,
) -> None:
    """Compile an FMU and write it.

    Args:
        source: the FMU.
        out: file to write.
        platforms: what to compile it for.
        compiled: called with the number of platforms that are done, first with 0.

    Raises:
        InputError: no platform, or one that FMI 2 has no name for alone.
        MissingEngineError: the compiler is not installed.
        SimulationError: the compiler reports an error in the sources.
    """
    targets = [TARGETS[name] for name in platforms]
    if not targets:
        raise InputError(f"no platform is given; known: {', '.join(TARGETS)}")
    tell = compiled or (lambda _n: None)
    tell(0)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        for name, text in source.files.items():
            (folder / name).write_text(text, encoding="utf-8")
        with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
            binaries: list[bytes] = []
            for binary in pool.map(lambda target: _binary(source, folder, target), targets):
                binaries.append(binary)
                tell(len(binaries))
    out.write_bytes(_archive(source, dict(zip(targets, binaries, strict=True))))


def _binary(source: Source, folder: Path, target: Target) -> bytes:
    into = folder / target.name
    into.mkdir()
    library = into / f"{source.identifier}{target.ending}"
    compile_library([folder / "all.c"], library, target, include=[folder])
    return library.read_bytes()


def _archive(source: Source, binaries: dict[Target, bytes]) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:

        def put(name: str, data: bytes) -> None:
            info = zipfile.ZipInfo(name, STAMP)
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            archive.writestr(info, data)

        put("modelDescription.xml", source.description.encode())
        for target, data in binaries.items():
            folder = target.fmi2 if source.fmi == 2 else target.name
            put(f"binaries/{folder}/{source.identifier}{target.ending}", data)
        for name, text in source.files.items():
            put(f"sources/{name}", text.encode())
        if source.fmi == 3:
            put("sources/buildDescription.xml", _build_description(source).encode())
    return content.getvalue()


def _build_description(source: Source) -> str:
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<fmiBuildDescription fmiVersion="3.0">\n'
        f'  <BuildConfiguration modelIdentifier="{source.identifier}">\n'
        '    <SourceFileSet language="C99">\n      <SourceFile name="all.c"/>\n    </SourceFileSet>\n'
        "  </BuildConfiguration>\n</fmiBuildDescription>\n"
    )
