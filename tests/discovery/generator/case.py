"""One case: a hidden effect in an experiment, written as a dataset folder and a truth record."""

import json
import zlib
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from . import expectation
from .curve import Array
from .design import DESIGNS, Design, Run
from .forms import FORMS, Effect, Form, Record
from .integrator import V, X, simulate
from .machine import Machine, plain_machine
from .rig import UNCERTAINTY, Rig, true_rig

_BURN_IN = (20.0, 24.0)  # s: many cycles, and a length that leaves the record's start anywhere in the cycle


@dataclass(frozen=True)
class Case:
    """What is planted: one or two forms (`a+b`), an experiment, a strength and a seed."""

    forms: str
    design: str
    strength: float
    seed: int

    @property
    def name(self) -> str:
        """Unique, and usable as a folder name."""
        return f"{self.forms}-{self.design}-{self.strength:g}-{self.seed}"

    @property
    def parts(self) -> tuple[Form, ...]:
        """The forms; a bare kind stands for one of its forms, chosen by the seed."""
        return tuple(_resolve(name, self.seed) for name in self.forms.split("+"))

    @property
    def experiment(self) -> Design:
        """The design, with the forms' changes of the rig."""
        if self.design not in DESIGNS:
            raise SystemExit(f"design {self.design!r} is unknown; known: {', '.join(DESIGNS)}")
        design = DESIGNS[self.design]
        for part in self.parts:
            design = replace(design, rig=replace(design.rig, **part.rig))
        return design


@dataclass(frozen=True)
class Made:
    """A case with its truth, ready to simulate run after run."""

    case: Case
    design: Design
    nominal: Rig
    true: Rig
    load_factor: float
    effects: tuple[Effect, ...]

    def machine(self, i: int, *, with_effects: bool = True) -> Machine:
        """The true machine of run i."""
        run = self.design.runs[i]
        rng = self._rng(1, i)
        parameters = asdict(self.true) | run.conditions
        parameters["normal_force"] *= self.load_factor
        machine = plain_machine(**parameters, burn_in=rng.uniform(*_BURN_IN), duration=run.duration)
        if with_effects:
            for j, effect in enumerate(self.effects):
                machine = effect.alter(machine, self._rng(2, i, j))
        return machine

    def states(self, i: int) -> tuple[Machine, Array, Array]:
        """Machine, states and friction force over the record of run i, record times 0 to its end."""
        machine = self.machine(i)
        before = round(-machine.start / 1e-3)
        n = round(self.design.runs[i].duration / 1e-3) + 1
        states, friction = simulate(machine, before + n)
        return machine, states[before:], friction[before:]

    def record(self, i: int) -> Record:
        """What the sensors of run i deliver."""
        _, states, friction = self.states(i)
        rng = self._rng(3, i)
        noise = self.effects[0].noise
        record: Record = {
            "time [s]": 1e-3 * np.arange(states.shape[0]),
            "position [m]": states[:, X] + noise * rng.standard_normal(states.shape[0]),
        }
        channels = {channel for effect in self.effects for channel in effect.channels}
        if "velocity" in channels:
            record["velocity [m/s]"] = states[:, V] + 2e-4 * rng.standard_normal(states.shape[0])
        if "friction_force" in channels:
            record["friction_force [N]"] = friction + 0.02 * rng.standard_normal(states.shape[0])
        for j, effect in enumerate(self.effects):
            record = effect.measure(record, self._rng(4, i, j))
        return record

    def _rng(self, *branch: int) -> np.random.Generator:
        return _generator(self.case, *branch)


def make(case: Case) -> Made:
    """Draw a case's truth."""
    design = case.experiment
    true, load_factor = true_rig(design.rig, _generator(case, 0))
    effects = tuple(part.draw(_generator(case, 5, j), case.strength, design.rig) for j, part in enumerate(case.parts))
    return Made(case, design, design.rig, true, load_factor, effects)


def truth(made: Made) -> dict[str, object]:
    """The record that is kept away from the dataset."""
    kinds = [part.kind for part in made.case.parts]
    return {
        "case": asdict(made.case),
        "forms": [part.name for part in made.case.parts],
        "kinds": kinds,
        "acceptable": [sorted(expectation.acceptable(part, made.design)) for part in made.case.parts],
        "visible": [expectation.visible(kind, made.design) for kind in kinds],
        "several_points": made.design.several_points,
        "effect_parameters": [effect.parameters for effect in made.effects],
        "true_rig": asdict(made.true),
        "normal_force_factor": made.load_factor,
    }


def write(case: Case, folder: Path, truth_file: Path) -> dict[str, object]:
    """Write the dataset into the folder and the truth beside it, never inside; returns the truth."""
    made = make(case)
    folder.mkdir(parents=True, exist_ok=True)
    for i in range(len(made.design.runs)):
        _write_csv(folder / f"run_{i + 1}.csv", made.record(i))
    (folder / "scenario.toml").write_text(_scenario(made))
    (folder / "dataset.toml").write_text(_dataset(made.design.runs))
    record = truth(made)
    truth_file.parent.mkdir(parents=True, exist_ok=True)
    truth_file.write_text(json.dumps(record, indent=1))
    return record


def _resolve(name: str, seed: int) -> Form:
    if name in FORMS:
        return FORMS[name]
    family = [form for form in FORMS.values() if form.kind == name]
    if not family:
        raise SystemExit(f"case {name!r} is unknown; known: {', '.join(FORMS)}")
    return family[seed % len(family)]


def _generator(case: Case, *branch: int) -> np.random.Generator:
    identity = zlib.crc32(f"{case.forms}/{case.design}/{case.strength:g}".encode())
    return np.random.default_rng([case.seed, identity, *branch])


def _write_csv(file: Path, record: Record) -> None:
    formats = ["%.4f" if name.startswith("time") else "%.8g" for name in record]
    np.savetxt(file, np.column_stack(list(record.values())), fmt=formats, delimiter=",", header=",".join(record), comments="")


def _scenario(made: Made) -> str:
    rig = made.nominal
    mechanism = {key: value for key, value in asdict(rig).items() if not key.startswith("mu_")}
    mechanism |= {"initial_position": 0.0, "initial_velocity": 0.0}
    coefficients = {key: value for effect in made.effects for key, value in effect.nominal.items()}
    text = 'schema = "stochfric.scenario/1"\ntitle = "Belt rig"\n'
    text += _table("mechanism", {"kind": "belt_box"} | mechanism)
    text += _table("law", {"kind": "coulomb", "mu_s": rig.mu_s, "mu_k": rig.mu_k})
    if coefficients:
        text += _table("coefficients", coefficients)
    text += _table("uncertainty", UNCERTAINTY)
    return text + _table("simulation", {"duration": 10.0, "output_step": 1e-3})


def _dataset(runs: tuple[Run, ...]) -> str:
    text = 'schema = "stochfric.dataset/1"\ntitle = "Belt rig"\nscenario = "scenario.toml"\n'
    for i, run in enumerate(runs):
        text += f'\n[[runs]]\nfile = "run_{i + 1}.csv"\nrole = "{run.role}"\n'
        if run.conditions:
            text += "set = { " + ", ".join(f"{key} = {value!r}" for key, value in run.conditions.items()) + " }\n"
    return text


def _table(name: str, entries: Mapping[str, object]) -> str:
    lines = [f'{key} = "{value}"' if isinstance(value, str) else f"{key} = {value!r}" for key, value in entries.items()]
    return f"\n[{name}]\n" + "\n".join(lines) + "\n"
