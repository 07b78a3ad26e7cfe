"""Cases, and the dataset folder of each: measured runs, the model believed, and beside it what is true."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from zlib import crc32

import numpy as np
from scipy.signal import lfilter

from . import (  # each enters its forms; `eighteenth` has the others enter theirs first: rigs in turn hang on the order
    eighteenth,  # noqa: F401
    eighth,  # noqa: F401
    eleventh,  # noqa: F401
    fifteenth,  # noqa: F401
    fifth,  # noqa: F401
    fourteenth,  # noqa: F401
    fourth,  # noqa: F401
    friction_forms,  # noqa: F401
    mechanism_forms,  # noqa: F401
    nameless_forms,  # noqa: F401
    ninth,  # noqa: F401
    null_forms,  # noqa: F401
    second_forms,  # noqa: F401
    seventeenth,  # noqa: F401
    seventh,  # noqa: F401
    sixteenth,  # noqa: F401
    sixth,  # noqa: F401
    tenth,  # noqa: F401
    third,  # noqa: F401
    thirteenth,  # noqa: F401
    twelfth,  # noqa: F401
)
from .forms import FORMS, NONE, UNKNOWN, Form
from .motion import Motion, World, simulate
from .rigs import RIGS, UNCERTAINTY, Rig

POINTS_ONE = ((1.0, 1.0, "fit", 60.0), (1.0, 1.0, "test", 36.0))
"""Belt speed and load over the rig's own, role, cycles."""
POINTS_SEVERAL = (
    (1.0, 1.0, "fit", 24.0),
    (0.4, 1.0, "fit", 24.0),
    (2.0, 1.3, "fit", 24.0),
    (1.0, 0.7, "fit", 24.0),
    (1.5, 0.85, "test", 24.0),
    (0.6, 1.15, "test", 24.0),
)
REVERSED = (0, 1, 3, 4)
"""Runs of `several` that a form about direction looks at; all but the first of them are turned round."""
LOADS = (1.0, 0.5, 2.0, 0.7, 1.4, 0.8)
"""Loads of `several`, where a form is about load."""


@dataclasses.dataclass(frozen=True)
class Case:
    """One record to be made."""

    form: Form
    design: str
    strength: float

    @property
    def name(self) -> str:
        """Unique name."""
        return f"{self.form.name}-{self.design}-{self.strength:g}"

    @property
    def family(self) -> str:
        """`none`, `unknown` or `named`."""
        return next((word for word in (NONE, UNKNOWN) if word in self.form.truth), "named")


def cases() -> list[Case]:
    """Return all cases: full strength in each design, half strength in the first (later sets: in each); nulls once in each."""
    items = []
    for form in FORMS.values():
        items += [Case(form, design, 1.0) for design in form.designs]
        if NONE not in form.truth:
            items += [Case(form, design, 0.5) for design in (form.designs if form.series >= 3 else form.designs[:1])]
    return items


@dataclasses.dataclass(frozen=True)
class Run:
    """One run: how it was driven, and what it truly did and showed."""

    role: str
    settings: dict[str, float]
    world: World
    motion: Motion
    reading: np.ndarray
    """What a sensor without noise shows [m]."""


def points(case: Case) -> list[tuple[float, float, str, float]]:
    """Return belt speed and load over the rig's own, role and cycles of each run."""
    length = float(case.form.options.get("length", 1.0))
    if case.design == "one":
        return [(speed, load, role, cycles * length) for speed, load, role, cycles in POINTS_ONE]
    chosen = list(POINTS_SEVERAL)
    if case.form.options.get("reversed"):
        chosen = [(-v if i in REVERSED[1:] else v, n, role, c) for i, (v, n, role, c) in enumerate(chosen)]
    if case.form.options.get("loads"):
        chosen = [(v, load, role, c) for (v, _, role, c), load in zip(chosen, LOADS, strict=True)]
    return chosen


def make_runs(case: Case, seed: int, *, strength: float | None = None, share: float = 1.0) -> list[Run]:
    """Return the runs of a case, of which `share` of the usual length is made."""
    form, strength = case.form, case.strength if strength is None else strength
    key = [seed, crc32(f"{form.name}-{case.design}".encode())]
    nominal = rig_of(form)
    true = nominal.drawn(
        np.random.default_rng([*key, 0]),
        at_limits=float(form.options.get("at_limits", 0.0)),
        uncertainty=form.options.get("uncertainty", UNCERTAINTY),
    )
    runs = []
    for i, (speed, load, role, cycles) in enumerate(points(case)):
        here = dataclasses.replace(
            nominal, belt_velocity=abs(speed) * nominal.belt_velocity, normal_force=load * nominal.normal_force
        )
        count = int(share * cycles * here.period * nominal.rate)
        even = np.arange(count) / nominal.rate
        world = World(
            rig=true,
            nominal=nominal,
            belt_velocity=speed * nominal.belt_velocity,
            normal_force=load * true.normal_force,
            duration=float(even[-1]),
            rng=np.random.default_rng([*key, 1, i]),
        )
        form.apply(world, strength)
        rng = np.random.default_rng([*key, 2, i])
        shift = float(form.options.get("jitter", 0.0)) / nominal.rate * rng.standard_normal(count)
        motion = simulate(world, np.sort(np.clip(even + shift, 0.0, None)))
        settings = {"belt_velocity": world.belt_velocity, "normal_force": load * nominal.normal_force}
        runs.append(Run(role, settings if case.design == "several" else {}, world, motion, world.sensor(even, motion, rng)))
    return runs


def rig_of(form: Form) -> Rig:
    """Return the rig that a form's records come from, with the form's rate and noise."""
    rig = RIGS[form.rig]
    return dataclasses.replace(
        rig,
        rate=float(form.options.get("rate", rig.rate)),
        noise=rig.noise * float(form.options.get("loudness", 1.0)),
    )


def noise(kind: str, size: float, count: int, rng: np.random.Generator) -> np.ndarray:
    """Return a sensor's noise [m].

    White, uniform, coloured, pink (1/f above 0.1 % of the rate), white on a zero that wanders, or white and a hum that
    carries half the power of it.
    """
    white = size * rng.standard_normal(count)
    if kind == "pink":
        spectrum = np.fft.rfft(white)
        f = np.maximum(np.fft.rfftfreq(count), 1.0e-3)
        pink = np.fft.irfft(spectrum / np.sqrt(f), count)
        return size * pink / pink.std()
    if kind == "coloured":
        decay = 0.9
        return lfilter([np.sqrt(1.0 - decay**2)], [1.0, -decay], white)
    if kind == "wander":
        steps = rng.standard_normal(count)
        decay = np.exp(-1.0 / 4000.0)
        return white + 2.0 * size * lfilter([np.sqrt(1.0 - decay**2)], [1.0, -decay], steps)
    if kind == "uniform":
        return size * rng.uniform(-np.sqrt(3.0), np.sqrt(3.0), count)
    if kind == "hum":
        return white + size * np.sin(2 * np.pi * (0.0371 * np.arange(count) + rng.random()))
    return white


def write_record(case: Case, folder: Path, seed: int, *, share: float = 1.0) -> dict:
    """Write the dataset of a case to `folder`/data, and what is true of it to `folder`/truth.json, which is returned."""
    form, nominal = case.form, rig_of(case.form)
    runs = make_runs(case, seed, share=share)
    twins = runs if case.family == NONE else make_runs(case, seed, strength=0.0, share=share)  # nulls know no strength
    data = folder / "data"
    data.mkdir(parents=True, exist_ok=True)
    lines = ['schema = "stochfric.dataset/1"', f'title = "{nominal.name} belt rig"', 'scenario = "scenario.toml"']
    key = [seed, crc32(f"{form.name}-{case.design}".encode())]
    for i, run in enumerate(runs):
        _write_run(data / f"run_{i + 1}.csv", run, form, nominal, np.random.default_rng([*key, 3, i]))
        lines += ["[[runs]]", f'file = "run_{i + 1}.csv"', f'role = "{run.role}"']
        if run.settings:
            lines.append("set = { " + ", ".join(f"{name} = {value!r}" for name, value in run.settings.items()) + " }")
    (data / "dataset.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (data / "scenario.toml").write_text(_scenario(nominal, form, runs[0].world.duration), encoding="utf-8")
    sizes = effect_sizes(runs, twins, nominal)
    stated = max(sizes, key=lambda name: sizes[name])
    truth = {
        "form": form.name,
        "truth": sorted(form.right(case.design)),
        "classes": sorted(form.classes(case.design)),
        "family": case.family,
        "design": case.design,
        "strength": case.strength,
        "rig": nominal.name,
        "source": form.source,
        "seed": seed,
        "slips": [len(run.motion.sticks) for run in runs],
        "feature": stated,
        "size": round(sizes[stated], 3),
        "sizes": {name: round(value, 3) for name, value in sizes.items()},
    }
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n", encoding="utf-8")
    return truth


def _write_run(path: Path, run: Run, form: Form, nominal: Rig, rng: np.random.Generator) -> None:
    rate = nominal.rate
    time = run.motion.time if form.options.get("stamped") else np.arange(run.motion.time.size) / rate
    shown = run.reading + noise(str(form.options.get("noise", "white")), nominal.noise, time.size, rng)
    quantum = float(form.options.get("quantum", 0.0)) * nominal.noise
    if quantum:
        shown = quantum * np.round(shown / quantum)
    factor = {"m": 1.0, "mm": 1.0e3, "um": 1.0e6}[nominal.unit]
    table = [
        time + float(form.options.get("begins", 0.0)),
        factor * shown,
        *(column(time, run.motion) for column in run.world.columns.values()),
    ]
    header = ["time [s]", f"position [{nominal.unit}]", *run.world.columns]
    rows = np.column_stack(table)
    missing = float(form.options.get("missing", 0.0))
    if missing:
        keep = rng.random(time.size) > missing
        gap = int(rng.uniform(0.4, 0.6) * time.size)
        keep[gap : gap + int(float(form.options.get("gap", 0.15)) * nominal.period * rate)] = False
        rows = rows[keep]
    stamp = float(form.options.get("stamp", 0.0))
    if stamp:
        rows[:, 0] = stamp * np.round(rows[:, 0] / stamp)
    rows = rows[_first(run, form) : len(rows) - int(float(form.options.get("end", 0.0)) * nominal.period * rate)]
    np.savetxt(path, rows, "%.9g", ",", header=",".join(header), comments="")


def _first(run: Run, form: Form) -> int:
    """Return the sample that the record begins with: option `amid` counts half natural periods from the third break-away."""
    amid = float(form.options.get("amid", 0.0))
    nominal = run.world.nominal
    return int(np.searchsorted(run.motion.time, run.motion.breaks[2, 0] + amid * np.pi / nominal.pulsation)) if amid else 0


def _scenario(nominal: Rig, form: Form, duration: float) -> str:
    mechanism = ("mass", "damping", "stiffness", "normal_force", "belt_velocity")
    lines = [
        'schema = "stochfric.scenario/1"',
        f'title = "{nominal.name} belt rig, as believed"',
        "",
        "[mechanism]",
        'kind = "belt_box"',
    ]
    lines += [f"{name} = {getattr(nominal, name)!r}" for name in mechanism]
    if nominal.excitation_amplitude:
        lines += [f"{name} = {getattr(nominal, name)!r}" for name in ("excitation_amplitude", "excitation_angular_frequency")]
    lines += ["", "[law]", 'kind = "coulomb"', f"mu_s = {nominal.mu_s!r}", f"mu_k = {nominal.mu_k!r}"]
    declared = form.options.get("declared")
    if declared:
        sigma = float(form.options.get("declared_sigma", 0.015))
        lines += ["", "[coefficients]", f'process = "{declared}"', f"sigma_s = {sigma!r}", f"sigma_k = {sigma!r}"]
        lines += ["spacing = 0.01"] if declared == "knots" else []
        lines += [f"correlation_time = {nominal.period!r}"] if declared == "ornstein_uhlenbeck" else []
    if not form.options.get("unstated"):
        stated = form.options.get("uncertainty", UNCERTAINTY)
        lines += ["", "[uncertainty]", *(f"{name} = {value!r}" for name, value in stated.items())]
    step = 1.0 / nominal.rate
    lines += ["", "[simulation]", f"duration = {step * round(duration / step)!r}", f"output_step = {step!r}"]
    return "\n".join(lines) + "\n"


def features(run: Run) -> dict[str, np.ndarray]:
    """Return what the sensor shows of slips: positions at break-away and at stick, slip length, period, mean shapes."""
    breaks, sticks, time = run.motion.breaks, run.motion.sticks, run.motion.time
    rig = run.world.nominal
    first = breaks[2:, 0]
    out = {
        "break_away": np.interp(first, time, run.reading),
        "stick": np.interp(sticks[3:, 0], time, run.reading),
        "period": np.diff(first),
    }
    n = min(len(out["break_away"]), len(out["stick"]))
    out["slip_length"] = np.abs(out["break_away"][:n] - out["stick"][:n])
    for name, starts, span in (("slip_shape", first, np.pi / rig.pulsation), ("stick_shape", sticks[3:, 0], 0.2 * rig.period)):
        inside = starts[starts + span < time[-1]]
        grid = np.linspace(0.0, span, 40)
        curves = np.interp(inside[:, None] + grid, time, run.reading)
        out[name] = (curves - curves[:, :1]).mean(0) if len(inside) else np.zeros(40)
    return out


def effect_sizes(runs: list[Run], twins: list[Run], nominal: Rig) -> dict[str, float]:
    """Return changes against the same runs without the form, in multiples of the floor of one reading.

    Mean and spread of positions at break-away and at stick, of the slip length and of the period; mean shapes of slips and
    of the beginnings of stick phases (rms); the reading itself (rms difference from the position). The floor is the standard
    deviation of the sensor's noise, and of the period that over the belt speed, or half a sample.
    """
    sizes: dict[str, float] = {}
    for run, twin in zip(runs, twins, strict=True):
        new, old = features(run), features(twin)
        floor = nominal.noise
        floors = {"period": max(floor / abs(run.world.belt_velocity), 0.5 / nominal.rate)}
        table = {}
        for name, value in new.items():
            if name.endswith("shape"):
                table[name] = np.sqrt(np.mean((value - old[name]) ** 2)) / floor
            elif min(value.size, old[name].size) > 2:
                table[f"{name}_mean"] = abs(value.mean() - old[name].mean()) / floors.get(name, floor)
                table[f"{name}_spread"] = abs(value.std() - old[name].std()) / floors.get(name, floor)
        difference = (run.reading - run.motion.position) - (twin.reading - twin.motion.position)
        table["reading"] = np.sqrt(np.mean(difference**2)) / floor
        sizes = {name: float(max(sizes.get(name, 0.0), value)) for name, value in table.items()}
    return sizes
