"""A model in the making: the stated one, its parameters corrected within their uncertainty, and the effects selected so far."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from stochfric_mb.coefficients import Process
from stochfric_mb.discovery.inference.free_parameter import LAW, MECHANISM, FreeParameter
from stochfric_mb.discovery.stick_slip.records.record import CORRECTED, LEAST_CORRECTION, Array, Record
from stochfric_mb.discovery.stick_slip.simulation.natural_units import NaturalUnits, exponents
from stochfric_mb.effects import Effect
from stochfric_mb.effects.contract import PHASES
from stochfric_mb.effects.traits import SHAPES_SLIPS
from stochfric_mb.errors import InputError, SimulationError
from stochfric_mb.laws import Law, make_law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.reference.augmented import AugmentedSystem, augmented_system

NOT_FITTED = (
    "reference_load", "spacing", "fraction", "size", "time", "duration", "high", "low", "static_share", "share_below",
    "shape_exponent", "tail", "adhesion", "reference_temperature",
)  # fmt: skip
"""Parameters of effects that forecasts cannot fit, or that are fixed by what they mean."""
STRENGTHS = (
    "amplitude", "coefficient", "distance", "cubic", "gap", "mass_ratio", "rate", "exponent", "asymmetry", "time_constant",
    "quadratic", "change",
)  # fmt: skip
"""Parameters that measure how strong an effect is."""
REACH = 0.25
"""How far a fit may move the coefficients, over mu_s [-]: further off, a forecast that never slips would look good."""
MOST_FREED = 0.4
"""How far what an effect leaves open (`Effect.frees`) may be off [-]: whether an oscillator was weighed with the body, and at
which deflection a spring was measured, nobody said."""
SHORTEST_LIMIT = 3.04e-4
"""Smallest elastic limit that a fit may reach, over the deflection of the spring under the normal force [-]: a stiffer contact
looks rigid and costs time."""
FROM_ZERO = 0.01
"""Natural step of a number with a dimension that begins at 0, in the rig's own units [-]."""
TUNED, TUNING = ("frequency", "wavelength"), 0.02
"""Parameters of effects that small changes of tell upon, and a natural step over their size [-]."""
TUNED_STRIDE = 0.5
"""Natural steps of these in one iteration of a fit: an oscillator of damping ratio 0.01, the least that is looked for, rings on
within 1 % of its frequency, and 6 % off, the phases of its ring agree again at some break-aways."""
FORECAST_TOLERANCE = 1.0e-7
"""Local error of a step over the static deflection [-]: in the one cycle of a forecast it comes to a millionth of a slip, a
hundredth of what a natural step of a number changes in a fit; a run of many cycles, whose errors grow at each break-away, needs
less."""
MOST_TUNED, FARTHEST = 2.0, 30.0
"""Factors by which a fit may change these, and other scales of length, time and speed: beyond, simulations take forever."""


@dataclasses.dataclass(frozen=True)
class Model:
    """The model of the rig: law, mechanism, effects."""

    law: Law
    """The friction law with its mean coefficients."""
    corrections: Mapping[str, float]
    """Relative corrections of the mechanism's parameters [-], by name."""
    effects: tuple[Effect, ...] = ()
    """Effects added to it."""
    process: Process | None = None
    """Process of the coefficients, where the scenario declares one."""
    own: Mapping[str, tuple[Mapping[str, float], ...]] = dataclasses.field(default_factory=dict[str, Any])
    """Run -> values of the parameters that are its own (`Effect.own_to_run`), one mapping an effect."""
    measured: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Parameter of an effect that neither forces nor forecasts show, and that no fit may move -> its standard deviation."""
    freed: frozenset[str] = frozenset()
    """Numbers of the mechanism that are not believed although no effect leaves them open."""
    stated: frozenset[Effect] = frozenset()
    """Effects that the scenario states: their numbers are exact, as all are for which no uncertainty can be stated, but for
    the phases of each run."""

    def mechanism(self, stated: BeltBox) -> BeltBox:
        """Return a run's mechanism with the corrections applied."""
        return dataclasses.replace(
            stated, **{name: getattr(stated, name) * (1.0 + value) for name, value in self.corrections.items()}
        )

    def effects_in(self, run: str) -> tuple[Effect, ...]:
        """Return the effects with the run's own parameters."""
        if run not in self.own:
            return self.effects
        return tuple(dataclasses.replace(e, **dict(v)) for e, v in zip(self.effects, self.own[run], strict=True))

    def system(self, record: Record, *, seed: int = 0, sample: int = 0) -> AugmentedSystem:
        """Return the simulator of a run; it moves as stated, not mirrored.

        Raises:
            SimulationError: a fit has brought mu_s and mu_k too close for what scatters about them.
        """
        mechanism, effects = self.mechanism(record.stated), self.effects_in(record.name)
        try:
            return augmented_system(
                mechanism, self.law, effects, self.process, seed=seed, sample=sample, temperature=record.temperatures,
                tolerance=FORECAST_TOLERANCE,
            )  # fmt: skip
        except InputError as error:
            raise SimulationError(str(error).split(";")[0]) from error

    def with_law(self, mu_s: float, mu_k: float) -> Model:
        """Return the model with other mean coefficients."""
        return dataclasses.replace(self, law=dataclasses.replace(self.law, mu_s=mu_s, mu_k=min(mu_k, mu_s)))

    def bare(self, record: Record) -> Model:
        """Return plain friction alone, on the mechanism that a record's forces are taken with."""
        return Model(self.plain_law, record.corrections)

    @property
    def plain_law(self) -> Law:
        """The law without what makes friction depend on speed: Coulomb's of a contact that is rigid in stick, else its own."""
        if self.law.rest != "rigid":
            return self.law
        return make_law("coulomb", mu_s=self.law.mu_s, mu_k=self.law.mu_k)

    @property
    def shapes_slips(self) -> bool:
        """Whether it changes how a slip begins and ends: noise then makes other errors in the forces than in plain slips."""
        return self.plain_law != self.law or any(SHAPES_SLIPS in e.traits for e in self.effects)

    @property
    def says_more(self) -> bool:
        """Whether it says more of friction than two coefficients: a law that depends on speed, or effects."""
        return bool(self.effects) or self.plain_law != self.law

    def plus(self, *effects: Effect) -> Model:
        """Return the model with further effects."""
        own = {run: (*values, *({} for _ in effects)) for run, values in self.own.items()}
        return dataclasses.replace(self, effects=(*self.effects, *effects), own=own)

    def without_last(self, kind: str) -> Model:
        """Return the model without its last effect of a kind."""
        last = max(i for i, e in enumerate(self.effects) if e.kind == kind)
        return self.keeping([i for i in range(len(self.effects)) if i != last])

    def without_waves(self, kinds: Collection[str]) -> Model:
        """Return the model without its waves of some kinds."""
        waves = self.waves(kinds)
        return self.keeping([i for i in range(len(self.effects)) if i not in waves]) if waves else self

    def waves(self, kinds: Collection[str] | None = None) -> list[int]:
        """Return the places of its waves, which have a phase of their own in each run, of some kinds or of all."""
        waves = [i for i, e in enumerate(self.effects) if e.own_to_run and e.group != "sensor"]
        return waves if kinds is None else [i for i in waves if self.effects[i].kind in kinds]

    def keeping(self, places: Sequence[int]) -> Model:
        """Return the model with the effects at some places alone."""
        own = {run: tuple(values[i] for i in places) for run, values in self.own.items()}
        return dataclasses.replace(self, effects=tuple(self.effects[i] for i in places), own=own)

    def with_own(self, run: str, places: Sequence[int], values: Sequence[Mapping[str, float]]) -> Model:
        """Return the model with the effects at some places having values of their own in a run."""
        own = list(self.own.get(run, ({},) * len(self.effects)))
        for place, mine in zip(places, values, strict=True):
            own[place] = dict(mine)
        return dataclasses.replace(self, own={**self.own, run: tuple(own)})

    @property
    def lasting(self) -> list[int]:
        """Places of the effects that are not random: those of its mean."""
        return [i for i, e in enumerate(self.effects) if not e.random]

    @property
    def mean(self) -> Model:
        """The model without what is random in it."""
        return dataclasses.replace(self.keeping(self.lasting), process=None)

    def with_mean(self, mean: Model) -> Model:
        """Return the model with the numbers of its `mean`, fitted: what is random stays as it is."""
        effects = list(self.effects)
        for place, effect in zip(self.lasting, mean.effects, strict=False):
            effects[place] = effect
        model = dataclasses.replace(self, law=mean.law, corrections=mean.corrections, effects=tuple(effects), own={})
        for run, values in mean.own.items():
            model = model.with_own(run, self.lasting, values)
        return model

    @property
    def left_open(self) -> frozenset[str]:
        """Names of the numbers whose priors are widened: those that effects leave open, and `freed` ones."""
        return self.freed.union(*(e.frees for e in self.effects))

    @property
    def late(self) -> float:
        """By how much its sensor is late [s]."""
        return sum(e.late for e in self.effects)

    @property
    def drawn(self) -> bool:
        """Whether its coefficients of friction are drawn; kicks leave them as they are."""
        return self.process is not None or any(e.coefficient_process() is not None for e in self.effects)

    @property
    def random(self) -> bool:
        """Whether its friction is random."""
        return self.process is not None or any(e.random and e.group != "sensor" for e in self.effects)


def free_parameters(
    model: Model, uncertainty: Mapping[str, float], units: NaturalUnits, runs: Sequence[str] = ()
) -> list[FreeParameter]:
    """Return what may be adjusted in a model.

    Args:
        model: the model; its present values are the start.
        uncertainty: relative standard deviations of the mechanism's stated numbers.
        units: the rig's own.
        runs: runs that have own parameters.
    """
    law = model.law
    most_kinetic = max(law.mu_k, min(law.mu_k + REACH * law.mu_s, 0.98 * law.mu_s))
    return [
        FreeParameter(LAW, "mu_s", law.mu_s, 0.02 * law.mu_s, law.mu_s * (1.0 - REACH), law.mu_s * (1.0 + REACH)),
        FreeParameter(LAW, "mu_k", law.mu_k, 0.02 * law.mu_s, 1.0e-5, most_kinetic),
        *(c for name in CORRECTED if (c := _correction(model, name, uncertainty.get(name, 0.0))) is not None),
        *(p for i in range(len(model.effects)) for p in _of_effect(model, i, units, runs)),
    ]


def _correction(model: Model, name: str, deviation: float) -> FreeParameter | None:
    """Return the relative correction of a number of the mechanism; None where it is certain."""
    most, prior = 3.0 * deviation, deviation
    if name in model.left_open:
        most, prior = most + MOST_FREED, math.hypot(prior, MOST_FREED / 2.0)
    if prior <= 0.0:
        return None
    present = model.corrections.get(name, 0.0)
    return FreeParameter(MECHANISM, name, present, deviation or 0.01, max(LEAST_CORRECTION, -most), most, prior=prior)


def _of_effect(model: Model, i: int, units: NaturalUnits, runs: Sequence[str]) -> Iterator[FreeParameter]:
    """Yield what may be adjusted in the i-th effect."""
    effect = model.effects[i]
    for field in dataclasses.fields(effect):
        name, meta, value = field.name, field.metadata, getattr(effect, field.name)
        if name in model.measured or "choices" in meta or not np.isfinite(value) or _stays(effect, name, value):
            continue
        if effect in model.stated and name not in effect.own_to_run:
            continue
        if name in effect.own_to_run:
            for run in runs:
                own = model.own.get(run, ({},) * len(model.effects))[i].get(name, value)
                yield FreeParameter(i, name, own, 0.3, -np.inf, np.inf, run=run)
        else:
            # a frequency that is off by its share of a wave in the whole record changes everything
            scale = TUNING * value if name in TUNED else _step(value, effect.unit_of(name), meta, units)
            low, high = _bounds(name, value, scale, meta, units)
            if name in TUNED and effect.own_to_run:
                low, high = _in_peak(name, value, units, low, high)
            stride = TUNED_STRIDE if name in TUNED else np.inf
            yield FreeParameter(i, name, value, scale, low, high, nominal=value, prior=meta["fit_prior"], stride=stride)


def _step(value: float, unit: str, about: Mapping[str, Any], units: NaturalUnits) -> float:
    """Return the natural step of a number of an effect: its size, but for one about 0."""
    if any(exponents(unit)):
        return abs(value) or FROM_ZERO * units.of(unit)
    return max(abs(value), 0.05 * about["scale"])


def _stays(effect: Effect, name: str, value: float) -> bool:
    """Return whether forecasts cannot fit a number, or it says what is fixed, or belongs to a form that is not this one."""
    if effect.lacks(name) or effect.__dataclass_fields__[name].metadata["fit_prior"] == 0.0:
        return True
    if name in NOT_FITTED:
        return not _shared(name, value)
    if name in PHASES and name != "phase":
        return not getattr(effect, name.replace("phase", "amplitude"))
    return False


def _bounds(name: str, value: float, scale: float, about: Mapping[str, Any], units: NaturalUnits) -> tuple[float, float]:
    """Return the smallest and the largest value that a fit may give a parameter of an effect."""
    inside = 1.0e-6 * scale if about["strict"] else 0.0
    low, high = about["low"] + inside, about["high"] - inside
    if name == "elastic_limit":
        return SHORTEST_LIMIT * units.length, np.inf
    if name == "delay" and value > 0.0:  # later by a whole period of a known force it forecasts alike
        return low, value * MOST_TUNED
    if (about["fit_low"], about["fit_high"]) != (about["low"], about["high"]):
        return min(value, max(about["fit_low"], low)), max(value, min(about["fit_high"], high))
    if about["strict"] and value > 0.0:
        most = MOST_TUNED if name in TUNED else FARTHEST
        return max(low, value / most), min(high, value * most)
    return low, high


def _in_peak(name: str, value: float, units: NaturalUnits, low: float, high: float) -> tuple[float, float]:
    """Return the bounds of a wave's frequency or length within its peak, a quarter of a wave in the record to either side.

    Beyond it there are other peaks, of noise or of an alias, in which a fit to a few forecasts ends as well.
    """
    if units.duration <= 0.0:
        return low, high
    reach = 0.25 / units.duration
    if name == "frequency":
        return max(low, value - reach), min(high, value + reach)
    number = units.belt_velocity / value
    longest = units.belt_velocity / (number - reach) if number > reach else high
    return max(low, units.belt_velocity / (number + reach)), min(high, longest)


def _shared(name: str, value: float) -> bool:
    """Return whether a number that singles out a form is to be fitted: where it is neither none nor all nor the plain one."""
    return name in ("static_share", "share_below", "shape_exponent", "adhesion") and value not in (0.0, 1.0)


def adjusted(model: Model, free: Sequence[FreeParameter], values: Array) -> Model:
    """Return the model with its free parameters at ``values``, each kept within its bounds."""
    corrections = dict(model.corrections)
    law = {"mu_s": model.law.mu_s, "mu_k": model.law.mu_k}
    changes: list[dict[str, float]] = [{} for _ in model.effects]
    own = {run: tuple(dict(v) for v in values_) for run, values_ in model.own.items()}
    for one, raw in zip(free, values, strict=True):
        value = one.inside(raw)
        if one.owner < 0:
            (law if one.name in law else corrections)[one.name] = value
        elif one.run:
            own.setdefault(one.run, tuple({} for _ in model.effects))[one.owner][one.name] = value
        else:
            changes[one.owner][one.name] = value
    effects = tuple(dataclasses.replace(e, **c) for e, c in zip(model.effects, changes, strict=True))
    law["mu_k"] = min(law["mu_k"], law["mu_s"])
    return dataclasses.replace(
        model, law=dataclasses.replace(model.law, **law), corrections=corrections, effects=effects, own=own
    )
