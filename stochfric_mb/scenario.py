"""Scenarios: what is simulated, in no engine's words; read from TOML (`stochfric.scenario/1`)."""

from __future__ import annotations

import csv
import dataclasses
import math
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, cast

import numpy as np
import numpy.typing as npt

from stochfric_mb.coefficients import DISTRIBUTIONS, PROCESSES, CoefficientPath, Distribution, OutputStep, Process
from stochfric_mb.effects import Effect, effect_from_dict
from stochfric_mb.effects.combine import combined_process, with_compliance
from stochfric_mb.errors import InputError, SimulationError, StabilityError, require_name, require_number, require_text
from stochfric_mb.laws import Law, law_class, make_law
from stochfric_mb.mechanisms import MECHANISMS, BeltBox, Controller, Mechanism, Mjcf, SpringSlider, controller_from_dict
from stochfric_mb.mechanisms.mjcf import CORRECTED

if TYPE_CHECKING:
    from typing_extensions import TypeVar

    M = TypeVar("M", bound=Mechanism, default=BeltBox)
else:
    from typing import TypeVar

    M = TypeVar("M")

SCHEMA = "stochfric.scenario/1"
MOST_OUTPUTS = 1.0e8
"""Most output samples of a simulation [-]: eight columns of them take 6 GiB."""
MOST_STEPS = 1.0e11
"""Most steps of an engine [-]: they take more than a day at 1 us a step, which no engine beats."""
MOST_PERIODS = 1.0e10
"""Most natural periods [-]: with ten steps each they are as long."""
MOST_DOUBT, MOST_GUESSED = 1.0, 3.0
"""Most relative deviation of a stated number, and of one that is often a guess (a rotor behind a gear) [-]."""
GUESSED = ("inertia", "armature", "damping")
"""Numbers that are often a guess; the stiffness of a spring slider is another."""
ABSOLUTE = ("offset",)
"""Numbers whose uncertainty is given in their own unit, since they may be stated as 0."""
_TABLES = (
    "schema", "title", "mechanism", "controller", "law", "coefficients", "effects", "uncertainty", "simulation",
)  # fmt: skip


@dataclasses.dataclass(frozen=True, kw_only=True)
class Scenario(Generic[M]):
    """A mechanism, its friction law and coefficients, and how long to simulate; ``Scenario`` alone is one of a belt-box."""

    mechanism: M
    """What moves."""
    law: Law
    """The friction law."""
    process: Process | None = None
    """How the coefficients are declared to vary; see `coefficient_process`."""
    effects: tuple[Effect, ...] = ()
    """What has been added to mechanism and law."""
    controller: Controller | None = None
    """The controller that was in the loop; None: there was none."""
    duration: float
    """Time to simulate [s], > 0."""
    output_step: float
    """Distance between output samples [s], > 0, dividing the duration."""
    title: str = ""
    """A line for people."""
    uncertainty: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Relative standard deviations of the stated numbers [-]; of an offset in its own unit."""

    def __post_init__(self) -> None:
        require_number("simulation.duration", self.duration, above=0.0, unit="s")
        require_number("simulation.output_step", self.output_step, above=0.0, unit="s")
        combined_process(self.effects, self.process)
        _require_few_periods(self.duration, self.mechanism)
        _require_measured(self.effects, self.mechanism)
        n = self.duration / self.output_step
        if n > MOST_OUTPUTS:
            raise InputError(
                f"simulation.duration = {self.duration:g} s holds {n:.3g} samples of output_step = {self.output_step:g} s, "
                f"over {MOST_OUTPUTS:g}, which need {8 * 8 * n / 2**30:.3g} GiB; shorten the duration, or raise output_step"
            )
        if abs(n - round(n)) > 1.0e-6 * n or round(n) < 1:
            raise InputError(
                f"simulation.output_step = {self.output_step:g} s does not divide duration = {self.duration:g} s; "
                f"try {self.duration / max(round(n), 1):g} s"
            )

    @property
    def coefficient_process(self) -> Process | None:
        """How the coefficients vary, as declared or as an effect of randomness sets it; None: they are constant."""
        return combined_process(self.effects, self.process)

    @property
    def n_outputs(self) -> int:
        """Number of output samples, the one at t = 0 included."""
        return round(self.duration / self.output_step) + 1

    def output_times(self) -> npt.NDArray[np.float64]:
        """Return the output times [s], shape (n_outputs,), rounded to whole nanoseconds where they are."""
        times = np.arange(self.n_outputs, dtype=np.float64) * self.output_step
        return np.rint(times * 1.0e9) / 1.0e9 if self.output_step >= 1.0e-6 else times

    def path(self, seed: int, sample: int = 0, contact: int = 0) -> CoefficientPath:
        """Return the coefficient path of this scenario's contact for (seed, sample, contact)."""
        return CoefficientPath(self.coefficient_process, self.law, seed=seed, sample=sample, contact=contact)

    def step_limit(self: Scenario[BeltBox]) -> float:
        """Return the law's explicit stability limit for this mechanism [s]."""
        return with_compliance(self.law, self.effects).step_limit(self.mechanism.normal_force, self.mechanism.mass)

    def default_dt(self: Scenario[BeltBox]) -> float:
        """Return 1e-4 s or half the law's explicit stability limit, whichever is smaller, dividing the output step."""
        return fitting_step(min(1.0e-4, 0.5 * self.step_limit()), self.output_step)

    def checked_step(self: Scenario[BeltBox], dt: float | None) -> float:
        """Return the step [s] to use: ``dt`` once it can be, `default_dt` if it is None.

        Raises:
            StabilityError: it is beyond the law's stability limit.
            InputError: it is not positive or does not divide the output step.
        """
        if dt is None:
            dt = self.default_dt()
        require_number("dt", dt, above=0.0, unit="s")
        limit = self.step_limit()
        if dt > limit:
            raise StabilityError(
                f"dt = {dt:g} s is beyond the stability limit {limit:.3g} s of the law {self.law.kind!r} "
                f"({self.law.step_limit_formula}); use dt <= {fitting_step(0.5 * limit, self.output_step):.3g} s"
            )
        if self.duration / dt > MOST_STEPS:
            raise InputError(
                f"simulation.duration = {self.duration:g} s is {self.duration / dt:.3g} steps of dt = {dt:g} s, which take "
                "more than a day in any engine; shorten the duration"
            )
        return self.dividing_step(dt)

    def dividing_step(self, dt: float) -> float:
        """Return the step ``dt`` [s] once the output step is a whole multiple of it.

        Raises:
            InputError: it is not positive or does not divide the output step; names the nearest that does.
        """
        n = self.output_step / require_number("dt", dt, above=0.0, unit="s")
        if n < 0.5 or abs(n - round(n)) > 1.0e-6 * n:
            near = fitting_step(min(dt, self.output_step), self.output_step)
            raise InputError(f"dt = {dt:g} s does not divide simulation.output_step = {self.output_step:g} s; try {near:.9g} s")
        return self.output_step / round(n)

    @property
    def reach(self: Scenario[BeltBox]) -> float:
        """Position [m] beyond which a state is nonsense: 1000 static deflections, with what the motion adds."""
        m = self.mechanism
        static = self.law.mu_s * m.normal_force / m.stiffness
        swing = (abs(m.initial_velocity) + abs(m.belt_velocity)) * math.sqrt(m.mass / m.stiffness)
        return 1.0e3 * (static + abs(m.excitation_amplitude) + abs(m.initial_position) + swing)

    def require_sane(self: Scenario[BeltBox], engine: str, t: float, position: float, dt: float) -> None:
        """Return if ``position`` [m] is finite and within `reach`.

        Raises:
            SimulationError: it is not: the run has broken down.
        """
        if not abs(position) <= self.reach:
            raise SimulationError(
                f"{engine}: the box is at x = {position:g} m at t = {t:g} s, beyond {self.reach:.3g} m (1000 static "
                f"deflections): the run has broken down; lower dt = {dt:g} s or check the scenario"
            )

    def to_dict(self) -> dict[str, Any]:
        """Return the scenario as the content of its TOML file."""
        tables: dict[str, Any] = {
            "schema": SCHEMA,
            "title": self.title,
            "mechanism": self.mechanism.to_dict(),
            "law": self.law.to_dict(),
        }
        if self.controller is not None:
            tables["controller"] = self.controller.to_dict()
        if self.process is not None:
            tables["coefficients"] = self.process.to_dict()
        if self.effects:
            tables["effects"] = [effect.to_dict() for effect in self.effects]
        if self.uncertainty:
            tables["uncertainty"] = dict(self.uncertainty)
        return tables | {"simulation": {"duration": self.duration, "output_step": self.output_step}}


def fitting_step(dt: float, output_step: float) -> float:
    """Return the largest step [s] not above ``dt`` of which ``output_step`` is a whole multiple."""
    return output_step / math.ceil(output_step / dt - 1.0e-9)


def scenario_folders() -> list[Path]:
    """Return the folders that hold the scenarios and scenes that come with the package."""
    here = Path(__file__).resolve().parent
    return [p for p in (here / "models", here.parent / "models") if p.is_dir()]


def bundled_scenarios() -> dict[str, Path]:
    """Return the scenarios that come with the package: name -> file."""
    files = [p for folder in reversed(scenario_folders()) for p in sorted(folder.glob("*/*.toml"))]
    return {p.parent.name if p.stem == "scenario" else p.stem: p for p in files if p.stem != "dataset"}


def load_scenario(source: str | Path, *, law: str | None = None, overrides: Sequence[str] = ()) -> Scenario:
    """Read a belt-box's scenario from a file, or by name from those that come with the package.

    >>> scenario = load_scenario("kang2015_table1", law="coulomb", overrides=["mechanism.belt_velocity=1e-3"])
    >>> scenario.law.kind, scenario.mechanism.belt_velocity, scenario.duration
    ('coulomb', 0.001, 10.0)

    Args:
        source: path of a TOML file, or a name such as ``kang2015_table1``.
        law: kind of law that replaces the scenario's; shared parameters are kept.
        overrides: ``table.key=value`` settings that replace the file's, such as ``law.mu_s=0.7``.

    Raises:
        InputError: no such file or name, a content that is not a valid scenario, or another mechanism than a belt-box;
            names the file and the key.
    """
    scenario = load_any_scenario(source, law=law, overrides=overrides)
    if not isinstance(scenario.mechanism, BeltBox):
        raise InputError(
            f"{source}: the engines simulate the belt_box by itself; mechanism {scenario.mechanism.kind!r} is for measured "
            "data: use it as the scenario of a dataset, with stochfric discover (mjcf also: stochfric ensemble --engine warp), "
            "in Python with load_any_scenario"
        )
    return cast("Scenario[BeltBox]", scenario)


def load_any_scenario(source: str | Path, *, law: str | None = None, overrides: Sequence[str] = ()) -> Scenario[Mechanism]:
    """Read a scenario of any mechanism; arguments and errors as for `load_scenario`."""
    path = _locate(source)
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: not a TOML file: {error}") from None
    if law is not None:
        stated, doubts = tables.get("law", {}), tables.get("uncertainty", {})
        tables["law"] = _replace_law(stated, law)
        tables["uncertainty"] = {k: v for k, v in doubts.items() if k in tables["law"] or k not in stated}
    for setting in overrides:
        _override(tables, setting)
    try:
        return any_scenario_from_dict(tables, folder=path.parent)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def scenario_from_dict(tables: Mapping[str, Any], *, folder: Path = Path()) -> Scenario:
    """Return the belt-box's scenario that the content of a TOML file describes.

    Raises:
        InputError: unknown or missing key, wrong type or value out of range, or another mechanism.
    """
    scenario = any_scenario_from_dict(tables, folder=folder)
    if not isinstance(scenario.mechanism, BeltBox):
        raise InputError(f"mechanism.kind = {scenario.mechanism.kind!r}; only 'belt_box' can be simulated by itself")
    return cast("Scenario[BeltBox]", scenario)


def any_scenario_from_dict(tables: Mapping[str, Any], *, folder: Path = Path()) -> Scenario[Mechanism]:
    """Return the scenario, of any mechanism, that the content of a TOML file describes.

    Raises:
        InputError: unknown or missing key, wrong type or value out of range.
    """
    for key in tables:
        require_name("key", key, _TABLES)
    if tables.get("schema") != SCHEMA:
        raise InputError(f"schema = {tables.get('schema')!r}; this version reads {SCHEMA!r}")
    simulation = _table(tables, "simulation")
    for key in simulation:
        require_name("key of simulation", key, ("duration", "output_step"))
    numbers = {k: require_number(f"simulation.{k}", _need(simulation, "simulation", k)) for k in ("duration", "output_step")}
    mechanism, law = _mechanism(_table(tables, "mechanism"), folder), law_from_dict(_table(tables, "law"))
    effects = _effects(tables.get("effects", []))
    return Scenario(
        title=require_text("title", tables.get("title", "")),
        mechanism=mechanism,
        law=law,
        process=process_from_dict(_table(tables, "coefficients"), numbers["output_step"], folder)
        if tables.get("coefficients")
        else None,
        effects=effects,
        controller=controller_from_dict(_table(tables, "controller")) if "controller" in tables else None,
        uncertainty=_uncertainty(tables, mechanism, (law, *effects)),
        **numbers,
    )


def _locate(source: str | Path) -> Path:
    path = Path(source)
    if path.is_file():
        return path
    names = bundled_scenarios()
    if path.suffix == "" and path.name in names and str(source) == path.name:
        return names[path.name]
    if path.is_dir():
        raise InputError(f"{path} is a folder; give the scenario file in it")
    raise InputError(
        f"no scenario file {str(source)!r}, and no bundled scenario of that name; bundled: {', '.join(sorted(names))}"
    )


def _replace_law(table: Mapping[str, Any], kind: str) -> dict[str, Any]:
    known = {f.name for f in dataclasses.fields(law_class(kind))}
    return {"kind": kind} | {k: v for k, v in table.items() if k in known}


def _override(tables: dict[str, Any], setting: str) -> None:
    name, equals, text = setting.partition("=")
    keys = name.strip().split(".")
    of_effect = keys[0] == "effects"
    if not equals or len(keys) != (3 if of_effect else 2):
        raise InputError(f"--set {setting!r} is not of the form table.key=value, such as law.mu_s=0.7 (or effects.0.rate=0.02)")
    value: Any
    try:
        value = float(text)
    except ValueError:
        value = text.strip().strip("\"'")
    if not of_effect:
        tables.setdefault(keys[0], {})[keys[1]] = value
        return
    effects: list[dict[str, Any]] = tables.get("effects", [])
    if not (keys[1].isdecimal() and int(keys[1]) < len(effects)):
        raise InputError(f"--set {setting!r}: the scenario has {len(effects)} effects, numbered from 0; give one of them")
    effects[int(keys[1])][keys[2]] = value


def _table(tables: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    table = tables.get(name)
    if not isinstance(table, Mapping):
        needed = "" if name in tables else " (a scenario needs the tables [mechanism], [law] and [simulation])"
        raise InputError(f"{name} = {table!r} is not a table; write [{name}]{needed}")
    return cast(Mapping[str, Any], table)


def _need(table: Mapping[str, Any], name: str, key: str) -> Any:
    if key not in table:
        raise InputError(f"key {name}.{key} is missing; add it to [{name}]")
    return table[key]


def _require_measured(effects: Sequence[Effect], mechanism: Any) -> None:
    """Return if no effect reads what is measured at a rig and has no place in the simulation of a mechanism."""
    if isinstance(mechanism, BeltBox):
        for effect in effects:
            if effect.reads:
                raise InputError(
                    f"effect {effect.kind!r} reads a measured {effect.reads[0]}, which a simulated {mechanism.kind} does not "
                    "have; leave it out, or let friction change with time: friction_drift"
                )
            if effect.moves_load:
                raise InputError(
                    f"effect {effect.kind!r} moves the load behind the motor of a driven joint, which a simulated "
                    f"{mechanism.kind} does not have; leave it out, or use second_mode"
                )


def _require_few_periods(duration: float, mechanism: Any) -> None:
    """Return if simulating a belt-box for ``duration`` [s] takes less than a day, whatever the engine."""
    if not isinstance(mechanism, BeltBox):
        return
    periods = duration * math.sqrt(mechanism.stiffness / mechanism.mass) / math.tau
    if periods > MOST_PERIODS:
        raise InputError(
            f"simulation.duration = {duration:g} s holds {periods:.3g} natural periods of the box, which take more than a day "
            "in any engine; shorten the duration, or correct mass and stiffness"
        )


def _effects(tables: Any) -> tuple[Effect, ...]:
    if not isinstance(tables, list) or not all(isinstance(t, Mapping) for t in cast(list[Any], tables)):
        raise InputError(f"effects = {tables!r} is not a list of tables; write [[effects]]")
    return tuple(effect_from_dict(table) for table in cast(list[Mapping[str, Any]], tables))


def _mechanism(table: Mapping[str, Any], folder: Path) -> Mechanism:
    kind = require_name("mechanism", _need(table, "mechanism", "kind"), MECHANISMS)
    cls = MECHANISMS[kind]
    if cls is Mjcf:
        return Mjcf.from_table(table, folder)
    fields = {f.name: f for f in dataclasses.fields(cls)}
    values = {k: v for k, v in table.items() if k != "kind"}
    for key in values:
        require_name("key of mechanism", key, fields)
    for key, field in fields.items():
        if field.default is dataclasses.MISSING:
            _need(values, "mechanism", key)
    cls(**values)  # its own checks say the units
    numbers: dict[str, Any] = {k: require_number(k, v) for k, v in values.items()}
    return cls(**numbers)


def law_from_dict(table: Mapping[str, Any]) -> Law:
    """Return the law of a ``[law]`` table.

    Raises:
        InputError: unknown kind or key, wrong type or value out of range.
    """
    cls = law_class(str(_need(table, "law", "kind")))
    fields = {f.name: f for f in dataclasses.fields(cls)}
    values = {k: v for k, v in table.items() if k != "kind"}
    for key in values:
        require_name(f"parameter of law {cls.kind}", key, fields)
    return make_law(
        cls.kind, **{k: v if "choices" in fields[k].metadata else require_number(f"law.{k}", v) for k, v in values.items()}
    )


def process_from_dict(table: Mapping[str, Any], output_step: float, folder: Path) -> Process:
    """Return the process of a ``[coefficients]`` table.

    Args:
        table: the table.
        output_step: spacing of the process ``output_step`` [s].
        folder: where data files are looked for.

    Raises:
        InputError: unknown kind or key, wrong type or value out of range.
    """
    cls = PROCESSES[require_name("process", str(_need(table, "coefficients", "process")), PROCESSES)]
    fields = {f.name: f for f in dataclasses.fields(cls)}
    values: dict[str, Any] = {}
    for key, value in table.items():
        if key == "process":
            continue
        require_name(f"key of process {cls.kind} in [coefficients]:", key, ["process", *fields, "distribution"])
        if key.startswith("distribution"):
            values[key] = _distribution(value, folder)
        else:
            values[key] = require_number(f"coefficients.{key}", value)
    if (common := values.pop("distribution", None)) is not None:
        values = {"distribution_s": common, "distribution_k": common} | values
    if cls is OutputStep:
        values.setdefault("spacing", output_step)
    for key, field in fields.items():
        if field.default is dataclasses.MISSING:
            _need(values, "coefficients", key)
    return cls(**values)


def _distribution(value: Any, folder: Path) -> Distribution:
    table: dict[str, Any] = {"kind": value} if isinstance(value, str) else dict(value)
    cls = DISTRIBUTIONS[require_name("distribution", str(table.pop("kind", "")), DISTRIBUTIONS)]
    if "file" in table:
        table["values"] = _read_column(folder / str(table.pop("file")), table.pop("column", None))
    fields = [f.name for f in dataclasses.fields(cls)]
    for key in table:
        require_name(f"key of distribution {cls.kind}", key, [*fields, "file", "column"])
    if "values" in fields and "values" not in table:
        raise InputError("distribution empirical needs file and column, or values; give a CSV file and the name of its column")
    if isinstance(table.get("values"), list):
        table["values"] = tuple(table["values"])
    return cls(**table)


def _read_column(path: Path, column: Any) -> tuple[float, ...]:
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}; distribution.file must name a CSV file with a header") from None
    names = list(rows[0]) if rows else []
    name = require_name(f"column of {path}", str(column if column is not None else (names[0] if names else "")), names)
    values: list[float] = []
    for number, row in enumerate(rows, start=2):
        try:
            values.append(float(row[name]))
        except (TypeError, ValueError):
            raise InputError(
                f"{path}, row {number}: {row[name]!r} in column {name!r} is not a number; remove or correct the row"
            ) from None
    return tuple(values)


def _uncertainty(tables: Mapping[str, Any], mechanism: Mechanism, others: Sequence[Law | Effect]) -> dict[str, float]:
    """Return the uncertainties of numbers of the mechanism, the law and the effects."""
    table: Mapping[str, Any] = _table(tables, "uncertainty") if "uncertainty" in tables else {}
    known = set(CORRECTED) if isinstance(mechanism, Mjcf) else {f.name for f in dataclasses.fields(mechanism)}
    known |= {f.name for other in others for f in dataclasses.fields(other)}
    return {require_name("key of uncertainty", k, known): _doubt(k, v, mechanism) for k, v in table.items()}


def _doubt(name: str, value: object, mechanism: Mechanism) -> float:
    """Return the uncertainty of a number."""
    doubt = require_number(f"uncertainty.{name}", value, low=0.0)
    guessed = name in GUESSED or isinstance(mechanism, SpringSlider)
    most = MOST_GUESSED if guessed else MOST_DOUBT
    if name not in ABSOLUTE and doubt > most:
        raise InputError(
            f"uncertainty.{name} = {doubt:g} is {100.0 * doubt:g} % of {name}, over {100.0 * most:g} %: uncertainties are "
            f"relative standard deviations; write {doubt / 100.0:g} for {doubt:g} %"
        )
    return doubt
