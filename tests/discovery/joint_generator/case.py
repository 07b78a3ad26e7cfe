"""One case: a hidden effect in a driven joint, written as a dataset folder and a truth record."""

import json
import zlib
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from . import files, slider, thrown
from .bench import DESIGNS, Bench, Sensor, nominal_bench, true_bench
from .forms import FORMS, Effect, Form, Record
from .forms.form import NONE, UNKNOWN
from .integrator import simulate
from .motion import MOTIONS
from .plant import PRESSURE, Array, Plant, plain_plant
from .unseen import UNSEEN
from .unseen_eighteenth import UNSEEN_EIGHTEENTH
from .unseen_eighth import UNSEEN_EIGHTH
from .unseen_eleventh import UNSEEN_ELEVENTH
from .unseen_fifteenth import UNSEEN_FIFTEENTH
from .unseen_fifth import UNSEEN_FIFTH
from .unseen_fourteenth import UNSEEN_FOURTEENTH
from .unseen_fourth import UNSEEN_FOURTH
from .unseen_nineteenth import UNSEEN_NINETEENTH
from .unseen_ninth import UNSEEN_NINTH
from .unseen_second import UNSEEN_SECOND
from .unseen_seventeenth import UNSEEN_SEVENTEENTH
from .unseen_seventh import UNSEEN_SEVENTH
from .unseen_sixteenth import UNSEEN_SIXTEENTH
from .unseen_sixth import UNSEEN_SIXTH
from .unseen_tenth import UNSEEN_TENTH
from .unseen_third import UNSEEN_THIRD
from .unseen_thirteenth import UNSEEN_THIRTEENTH
from .unseen_twelfth import UNSEEN_TWELFTH
from .unseen_twentieth import UNSEEN_TWENTIETH
from .unseen_twentyfirst import UNSEEN_TWENTYFIRST

VOCABULARY = frozenset(
    (
        "random_coefficients", "correlated_coefficients", "velocity_weakening", "viscous_friction", "frictional_lag",
        "direction_asymmetry", "load_dependence", "position_dependent_friction", "position_dependent_force", "friction_drift",
        "distance_drift", "temperature_drift", "quadratic_damping", "sensor_delay", "harmonic_force", "stale_samples",
        "sensor_outliers", "effective_area", "drive_gain_change", "joint_compliance", "backlash",
    )
)  # fmt: skip
"""Kinds that docs/joints.md says are searched at joints. Any other kind is rightly answered `unknown`."""
NUMBERS = frozenset(("payload", "drive_gain", "constant_force"))
"""Numbers of the mechanism that are reported as findings; forms written before that was so count them as outside."""
LINKS = frozenset(("joint_compliance", "backlash"))
"""Links between motor and load, which forms from the fifth set on count as names; for earlier ones they are outside."""

_WITH_LINKS = UNSEEN_FIFTH | UNSEEN_SIXTH | UNSEEN_SEVENTH | UNSEEN_EIGHTH | UNSEEN_NINTH
_WITH_LINKS |= UNSEEN_TENTH | UNSEEN_ELEVENTH | UNSEEN_TWELFTH | UNSEEN_THIRTEENTH | UNSEEN_FOURTEENTH | UNSEEN_FIFTEENTH
_WITH_LINKS |= UNSEEN_SIXTEENTH | UNSEEN_SEVENTEENTH | UNSEEN_EIGHTEENTH | UNSEEN_NINETEENTH | UNSEEN_TWENTIETH
_WITH_LINKS |= UNSEEN_TWENTYFIRST
_BEFORE = 1.0  # s under control before a record begins


@dataclass(frozen=True)
class Case:
    """What is planted: one or two forms (`a+b`), a mechanism, a strength and a seed."""

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
        """The forms."""
        known = FORMS | UNSEEN | UNSEEN_SECOND | UNSEEN_THIRD | UNSEEN_FOURTH | _WITH_LINKS
        for name in self.forms.split("+"):
            if name not in known:
                raise SystemExit(f"form {name!r} is unknown; known: {', '.join(known)}")
        return tuple(known[name] for name in self.forms.split("+"))

    def rng(self, *branch: int) -> np.random.Generator:
        """A generator of this case's own."""
        identity = zlib.crc32(f"{self.forms}/{self.design}/{self.strength:g}".encode())
        return np.random.default_rng([self.seed, identity, *branch])


@dataclass(frozen=True)
class Made:
    """A case with its truth, ready to simulate run after run."""

    case: Case
    nominal: Bench
    true: Bench
    effects: tuple[Effect, ...]

    @property
    def roles(self) -> list[str]:
        return ["fit"] * self.nominal.n_fit + ["test"] * self.nominal.n_test

    @property
    def gains(self) -> tuple[float, float, float]:
        """Position gain, velocity gain and limit of the first joint, in units of its output."""
        b = self.nominal
        inertia = b.numbers["inertia"] + b.numbers.get("rotor", 0.0)
        w = b.bandwidth * min(2.5 * np.pi * b.speed / b.reach + 12.0, b.rate / 12.0)
        most = 4.0 * (sum(b.coulomb) + b.numbers.get("gravity", 0.0) + inertia * 4.0 * b.speed**2 / b.reach)
        return inertia * w**2 / b.gain, 2.0 * 0.8 * inertia * w / b.gain, most / b.gain

    def plant(self, i: int, *, with_effects: bool = True) -> Plant:
        """The true plant of run i."""
        b = self.true
        top = 4.0 * b.speed
        plant = plain_plant(b.body(), b.coulomb, top_speed=top, reach=4.0 * b.reach, duration=b.duration)
        plant = plant.with_extra(place=float(b.place))
        if b.pressures:
            plant = plant.add_in_time(PRESSURE, lambda t: b.pressures[i % len(b.pressures)] + 0.0 * t)
        if with_effects:
            for j, effect in enumerate(self.effects):
                plant = effect.alter(plant, self.case.rng(2, i, j))
        return plant

    def wanted(self, i: int) -> Array:
        """What the controller of run i is asked for, at each control instant from `_BEFORE` before the record, (n, 6)."""
        b = self.nominal
        rng = self.case.rng(3, i)
        times = np.arange(-round(_BEFORE * b.rate), round(b.duration * b.rate) + 1) / b.rate
        wanted = np.zeros((times.size, 6))
        for d in range(2 if b.design == "arm" else 1):
            wanted[:, d], wanted[:, 2 + d] = MOTIONS[b.motion](rng, times, b.reach, b.speed)
            if not b.declared:
                wanted[:, 4 + d] = self._held(wanted)[d] + b.coulomb[d] * np.tanh(wanted[:, 2 + d] / (0.05 * b.speed)) / b.gain
        return wanted

    def _held(self, wanted: Array) -> tuple[Array, Array]:
        """Output that holds the weight of both links."""
        n = self.nominal.numbers
        g1, g2 = n.get("gravity", 0.0), n.get("gravity_2", 0.0)
        outer = g2 * np.sin(wanted[:, 0] + wanted[:, 1])
        return (g1 * np.sin(wanted[:, 0]) + outer) / self.nominal.gain, outer

    def states(self, i: int, *, with_effects: bool = True) -> tuple[Array, Array]:
        """States over the record of run i, and what was wanted."""
        b = self.nominal
        position, velocity, limit = self.gains
        shares = (*files.arm_shares(b), 1.0)[:2]
        forward = 0.0 if b.declared else 1.0
        gains = np.array([[s * position, s * velocity, forward, s * limit, b.gain] for s in shares])
        wanted = self.wanted(i)
        before = round(_BEFORE * b.rate)
        start = np.array([wanted[0, 0], wanted[0, 1] if b.design == "arm" else wanted[0, 0]])
        plant = self.plant(i, with_effects=with_effects)
        return simulate(plant, gains, wanted, start, before, 1.0 / b.rate), wanted[before:]

    def record(self, i: int) -> Record:
        """What the sensors of run i deliver."""
        b = self.nominal
        states, wanted = self.states(i)
        rng = self.case.rng(4, i)

        def sensed(x: Array, sensor: Sensor) -> Array:
            noisy = x + sensor.position * rng.standard_normal(x.size)
            return np.round(noisy / sensor.resolution) * sensor.resolution if sensor.resolution else noisy

        length, force = ("rad", "N m") if b.rotational else ("m", "N")
        record: Record = {"time [s]": np.arange(len(states)) / b.rate}
        if b.design == "arm":
            for d, joint in enumerate(files.ARM_JOINTS):
                record[f"{joint}_angle [rad]"] = sensed(states[:, d], b.sensor)
                record[f"{joint}_torque [N m]"] = states[:, 4 + d] + b.sensor.drive * rng.standard_normal(len(states))
                record[f"{joint}_target [rad]"] = wanted[:, d]
        else:
            drive = f"{'torque' if b.rotational else 'force'} [{force}]" if b.gain == 1.0 else "voltage [V]"
            record[f"position [{length}]"] = sensed(states[:, 0], b.sensor)
            record[drive] = states[:, 4] + b.sensor.drive / b.gain * rng.standard_normal(len(states))
            if b.declared:
                record[f"target [{length}]"] = wanted[:, 0]
        if b.pressures:
            record["pressure [Pa]"] = b.pressures[i % len(b.pressures)] * (1.0 + 1e-3 * rng.standard_normal(len(states)))
        for j, effect in enumerate(self.effects):
            record = effect.measure(record, self.case.rng(5, i, j))
        return record


def make(case: Case) -> Made:
    """Draw a case's truth."""
    if case.design not in DESIGNS:
        raise SystemExit(f"design {case.design!r} is unknown; known: {', '.join(DESIGNS)}")
    nominal = nominal_bench("slide" if case.design in ("slider", "thrown") else case.design, case.rng(0))
    effects = tuple(part.draw(case.rng(1, j), case.strength, nominal) for j, part in enumerate(case.parts))
    for effect in effects:
        nominal = effect.rig(nominal)
    deviations = [effect.deviation for effect in effects if effect.deviation is not None]
    true = true_bench(nominal, case.rng(6), deviations[0] if deviations else None)
    return Made(case, nominal, true, effects)


def acceptable(form: Form) -> frozenset[str]:
    """Names that are right for a form; `unknown` is right for a kind that is not in the vocabulary."""
    return frozenset({form.kind, expected(form)}) | form.also


def expected(form: Form) -> str:
    """The true kind: the form's own if it is in the vocabulary, otherwise `unknown`."""
    numbers = frozenset() if form.name in FORMS else NUMBERS
    links = LINKS if form.name in _WITH_LINKS else frozenset()
    return form.kind if form.kind in VOCABULARY | numbers | links | {NONE} else UNKNOWN


def truth(made: Made) -> dict[str, object]:
    """The record that is kept away from the dataset."""
    parts = made.case.parts
    return {
        "case": asdict(made.case),
        "forms": [part.name for part in parts],
        "kinds": [expected(part) for part in parts],
        "acceptable": [sorted(acceptable(part)) for part in parts],
        "visible": [True for _ in parts],
        "several_points": False,
        "effect_parameters": [effect.parameters for effect in made.effects],
        "place": made.nominal.place,
        "believed": asdict(made.nominal),
        "true": asdict(made.true),
    }


def write(case: Case, folder: Path, truth_file: Path) -> dict[str, object]:
    """Write the dataset into the folder and the truth beside it, never inside; returns the truth."""
    made = make(case)
    folder.mkdir(parents=True, exist_ok=True)
    if case.design == "slider":
        _write_slider(made, folder)
    elif case.design == "thrown":
        _write_thrown(made, folder)
    else:
        for i in range(len(made.roles)):
            files.write_csv(folder / f"run_{i + 1}.csv", made.record(i))
        (folder / "scenario.toml").write_text(files.scenario_text(made.nominal, made.gains))
        (folder / "dataset.toml").write_text(files.dataset_text(made.roles))
        if case.design in ("mjcf_slide", "mjcf_hinge", "arm"):
            (folder / "model.xml").write_text(files.model_text(made.nominal))
    record = truth(made)
    truth_file.parent.mkdir(parents=True, exist_ok=True)
    truth_file.write_text(json.dumps(record, indent=1))
    return record


def _write_slider(made: Made, folder: Path) -> None:
    """Velocity steps up and down; the held-out run has other ones."""
    rng = made.case.rng(7)
    stiffness = rng.uniform(1500.0, 6000.0)
    nominal = stiffness * (1.0 + 0.4 * float(np.clip(rng.standard_normal(), -1.5, 1.5)))
    noise = rng.uniform(1e-4, 4e-4)
    tests = ((1e-6, 1e-5, 1e-6, 3e-6, 3e-5, 3e-6), (3e-6, 3e-5, 1e-5, 1e-6, 1e-5))
    for i, velocities in enumerate(tests):
        law = made.effects[0].law
        assert law is not None
        drawn = law(made.case.rng(2, i)) or slider.RateAndState(0.6, 0.0)
        assert isinstance(drawn, slider.RateAndState)
        record = slider.record(drawn, stiffness, np.array(velocities), noise, made.case.rng(4, i))
        files.write_csv(folder / f"run_{i + 1}.csv", record)
    (folder / "scenario.toml").write_text(files.slider_scenario(nominal, 0.62))
    (folder / "dataset.toml").write_text(files.dataset_text(["fit", "test"]))


def _write_thrown(made: Made, folder: Path) -> None:
    """Many short slides; every fourth is held out."""
    mass, mu = made.case.rng(7).uniform(0.1, 0.6), 0.3
    for i in range(thrown.N_RUNS):
        law = made.effects[0].law
        assert law is not None
        drawn = law(made.case.rng(2, i))
        assert isinstance(drawn, thrown.Throw)
        files.write_csv(folder / f"run_{i + 1}.csv", thrown.record(drawn, made.case.rng(4, i)))
    (folder / "scenario.toml").write_text(files.thrown_scenario(mass, mu))
    (folder / "dataset.toml").write_text(files.dataset_text(["test" if i % 4 == 3 else "fit" for i in range(thrown.N_RUNS)]))
