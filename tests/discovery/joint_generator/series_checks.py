"""What every series of forms for a report must keep, for the test files of the series; nothing here asks the method judged."""

import re
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from tests.discovery import joint_plan

from . import slider, thrown
from .bench import UNCERTAINTY, nominal_bench
from .case import LINKS, NUMBERS, VOCABULARY, Case, Made, expected, make
from .forms import FORMS, Record
from .forms.form import NONE, Form

UNDRIVEN = ("slider", "thrown")
"""Mechanisms that nothing drives in a loop."""
SLIDER_NOISE = 2e-4
_SOURCE = re.compile(r"[A-Z][\w'-]+.*?\b(1[789]|20)\d\d\b")
_SEED = 7


@dataclass(frozen=True)
class Series:
    """A series by its number in the plan."""

    number: int

    @property
    def forms(self) -> dict[str, Form]:
        return joint_plan.SERIES[self.number][0]

    @property
    def pairs(self) -> tuple[str, ...]:
        return joint_plan.SERIES[self.number][1]

    @cached_property
    def kinds(self) -> dict[str, str]:
        """True kind of each form."""
        return {name: expected(form) for name, form in self.forms.items()}

    @property
    def nulls(self) -> list[str]:
        """At joints."""
        return [name for name in self._driven(self.forms) if self.kinds[name] == NONE]

    @property
    def joints(self) -> list[str]:
        """Forms and pairs with an effect at joints."""
        return [name for name in self._driven([*self.forms, *self.pairs]) if self.kinds.get(name) != NONE]

    @property
    def undriven(self) -> list[str]:
        """Forms at sliders and thrown blocks."""
        return [name for name, form in self.forms.items() if form.designs[0] in UNDRIVEN]

    def _driven(self, names: dict[str, Form] | list[str]) -> list[str]:
        return [name for name in names if self.forms[name.split("+")[0]].designs[0] not in UNDRIVEN]

    def counts(self) -> tuple[int, int, int, int]:
        """Known effects, effects outside the vocabulary, nulls and pairs."""
        kinds = list(self.kinds.values())
        outside, nulls = kinds.count("unknown"), kinds.count(NONE)
        return len(kinds) - outside - nulls, outside, nulls, len(self.pairs)

    def kinds_not_shown(self) -> set[str]:
        """Names of the vocabulary that no form has."""
        return {name for name in VOCABULARY | NUMBERS | LINKS if name not in self.kinds.values()}

    def misplaced(self) -> set[str]:
        """Forms whose own kind is no name of the vocabulary, nor `unknown`, nor `none`, and names in `also` that are none."""
        names = VOCABULARY | NUMBERS | LINKS | {"second_mode", "unknown"}
        return {f.name for f in self.forms.values() if f.kind not in names | {NONE} or not f.also <= names}

    def unsourced(self) -> list[str]:
        """Forms whose docstring names no author with a year."""
        return [form.name for form in self.forms.values() if not _SOURCE.search(form.draw.__doc__ or "")]

    def repeated_names(self) -> set[str]:
        """Names, without their kind, that an earlier series has too."""
        earlier = [*FORMS, *(name for i in range(1, self.number) for name in joint_plan.SERIES[i][0])]
        return {name.split(".")[1] for name in earlier} & {name.split(".")[1] for name in self.forms}

    def short(self, name: str, *, strength: float = 1.0, design: str | None = None, seed: int = _SEED) -> Made:
        """A case whose runs are four seconds long."""
        parts = [self.forms[part] for part in name.split("+")]
        chosen = design or next(d for d in parts[0].designs if all(d in part.designs for part in parts))
        made = make(Case(name, chosen, strength, seed))
        return replace(made, nominal=replace(made.nominal, duration=4.0), true=replace(made.true, duration=4.0))

    def shown(self, name: str, *, strength: float = 1.0) -> Record:
        """A run of a slider, or of a thrown block; the same draws at any strength."""
        case = Case(name, self.forms[name].designs[0], 1.0, _SEED)
        form = case.parts[0]
        law = form.draw(case.rng(1, 0), strength, nominal_bench("slide", case.rng(0))).law
        assert law is not None
        drawn = law(case.rng(2, 0))
        if isinstance(drawn, thrown.Throw):
            return thrown.record(drawn, case.rng(4, 0))
        assert isinstance(drawn, slider.RateAndState)
        return slider.record(drawn, 3000.0, np.array([1e-6, 1e-5, 1e-6, 3e-5]), SLIDER_NOISE, case.rng(4, 0))


def columns_moved(made: Made) -> float:
    """How far columns are from those without the effects, at most and as a root of the mean square, in their noise."""
    record, far = made.record(0), 0.0
    plain = _plain(made, record)
    for name in set(record) & set(plain):
        noise = made.nominal.sensor.position if "position" in name or "angle" in name else drive_noise(made)
        if "target" not in name and "time" not in name and noise and record[name].size == plain[name].size:
            far = max(far, float(np.sqrt(np.mean((record[name] - plain[name]) ** 2))) / noise)
    return far


def _plain(made: Made, record: Record) -> Record:
    """The first run without the effects; its rows of the same stamps where some are missing in the record."""
    plain, t = replace(made, effects=()).record(0), record["time [s]"]
    if t.size == plain["time [s]"].size:
        return plain
    rows = np.minimum(np.searchsorted(plain["time [s]"], t - 1e-9), plain["time [s]"].size - 1)
    return {name: x[rows] for name, x in plain.items()}


def drive_noise(made: Made) -> float:
    """Standard deviation of the drive's noise, in the drive's unit."""
    return made.nominal.sensor.drive / made.nominal.gain


def undriven_moved(series: Series, name: str, *, strength: float) -> float:
    """The same for a slider or a thrown block."""
    column, noise = ("friction_coefficient", SLIDER_NOISE) if "slider" in series.forms[name].designs else ("position [m]", None)
    changed, plain = (series.shown(name, strength=s)[column] for s in (strength, 0.0))
    n = min(changed.size, plain.size)
    return float(np.sqrt(np.mean((changed[:n] - plain[:n]) ** 2))) / (noise or thrown.NOISE)


def assert_finite(record: Record) -> None:
    assert all(np.all(np.isfinite(x)) for x in record.values())
    assert np.all(np.diff(record["time [s]"]) > 0.0)


def assert_same(one: Record, other: Record) -> None:
    assert one.keys() == other.keys()
    for name, x in one.items():
        np.testing.assert_array_equal(x, other[name])


def assert_nothing_is_missing(made: Made) -> None:
    """The plant is the plain one, numbers are off by at most two deviations, and records by noise without a trend."""
    np.testing.assert_array_equal(made.states(0)[0], made.states(0, with_effects=False)[0])
    nominal, true = made.nominal, made.true
    assert abs(true.numbers["inertia"] / nominal.numbers["inertia"] - 1.0) <= 2.0 * UNCERTAINTY["mass"] + 1e-12
    assert abs(true.level / nominal.level - 1.0) <= 2.0 * UNCERTAINTY["mu"] + 1e-12
    assert abs(true.numbers["offset"] - nominal.numbers["offset"]) <= 2.0 * nominal.offset_sd * (1.0 + 1e-12)
    record = made.record(0)
    plain = _plain(made, record)
    assert columns_moved(made) < 10.0
    name = next(name for name in record if name.startswith(("position", "force", "torque", "voltage")))
    off = (record[name] - plain[name]) / (nominal.sensor.position or nominal.reach * 1e-4)
    assert abs(off.mean()) < 0.5
