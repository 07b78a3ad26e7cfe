"""Numbers of law and mechanism that data take beyond what is believed of them: findings themselves, a payload for instance."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.force_balance import (
    DRIVE_FACTOR,
    GAIN,
    OF_THE_DRIVE,
    PAYLOADS,
    ForceBalance,
    Nuisance,
)
from stochfric_mb.discovery.driven_joint.fit.beliefs import Belief, beliefs
from stochfric_mb.discovery.driven_joint.fit.evidence import evidence, settings_of
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit, settled
from stochfric_mb.discovery.inference.free_parameter import MECHANISM
from stochfric_mb.discovery.inference.least_squares import left_by
from stochfric_mb.effects import kind_with_signature
from stochfric_mb.effects.traits import MORE_DAMPING, OTHER_AREA

INERTIAL = ("mass", "length", "inertia", "armature")
"""Numbers of what moves."""
BEYOND = {
    **dict.fromkeys((*INERTIAL, *PAYLOADS.values()), "payload"), **dict.fromkeys(OF_THE_DRIVE, "drive_gain"),
    "offset": "constant_force", "mu_k": "friction_level",
}  # fmt: skip
"""Number of law or mechanism -> what it is called where it is off by more than its uncertainty; other ones are an effect's."""
TOGETHER = (("mass", "inertia"), ("mass", "armature"), tuple(PAYLOADS.values()))
"""Numbers that one thing moves: a payload has a weight and a lever of its own."""
OF_EFFECTS = {"damping": MORE_DAMPING, "piston_area": OTHER_AREA}
"""Number of the mechanism -> the finding of an effect that it is."""
AT_AN_END = 1.0e-3
"""Distance from the end of its range at which a number has reached it, over its stated standard deviation [-]: rounding."""
EXACT = 1.0e-3
"""How firmly a factor of the drive is believed whose uncertainty nobody stated [-]: no force is measured better."""
UNDRIVEN = 1.0e-9
"""Part of the balance that the mechanism's own terms must leave for a drive to be in it [-]: rounding leaves less."""


@dataclasses.dataclass(frozen=True)
class Released:
    """A number of law or mechanism that data take beyond what is believed of it."""

    belief: Belief
    """The number, and what was believed."""
    score: float
    """Evidence, as of a trial."""
    before: float
    """Error with the number within its belief (rms) [N or N m]."""
    after: float
    """Error with it where the data take it."""

    @property
    def name(self) -> str:
        """Name of the number."""
        return self.belief.name


@dataclasses.dataclass(frozen=True)
class Freed:
    """A fit in which a number may be anything, or two that one thing moves."""

    beliefs: tuple[Belief, ...]
    """The number, or two, and what was believed."""
    score: float
    """Evidence, as of a trial."""
    fit: JointFit
    """The fit."""
    nuisances: list[Nuisance]
    """Numbers of the mechanism, as they are believed in it."""

    @property
    def name(self) -> str:
        """Name of the first number."""
        return self.beliefs[0].name

    @property
    def count(self) -> int:
        """How many numbers may be anything."""
        return len(self.beliefs)

    def released(self, within: JointFit) -> list[Released]:
        """Return the numbers as findings, beside the fit with them within their beliefs."""
        return [Released(b, self.score, within.rms, self.fit.rms) for b in self.beliefs]


def finding(name: str) -> str:
    """Return what a number of the mechanism is called where it is off by more than its uncertainty; a kind is called itself."""
    return kind_with_signature(OF_EFFECTS[name]) if name in OF_EFFECTS else BEYOND.get(name, name)


def beyond_beliefs(
    current: JointFit,
    balances: Sequence[ForceBalance],
    nuisances: Sequence[Nuisance],
    noise: float,
    *,
    beside: bool,
    without: frozenset[str],
) -> list[Freed]:
    """Return the numbers that data take beyond their priors, best first, each with the fit in which it may be anything.

    Two that one thing moves stand there together as well, where each of them is off.

    Args:
        current: the fit with all beliefs.
        balances: fit runs.
        nuisances: numbers of the mechanism with their priors.
        noise: weight of beliefs, as of `fit`.
        beside: whether the model has effects that were not stated.
        without: names of numbers that stay as they are believed.
    """
    freed: list[Freed] = []
    believed, driven, settings = beliefs(current.model, nuisances), _driven(balances, nuisances), settings_of(balances)
    asked = [b for b in believed if b.name not in without and (b.owner != MECHANISM or driven)]
    # beside an effect that imitates inertia less mass would only be less noise: it must press against its bound
    pressing = [b for b in asked if not beside or abs(b.off(current.model)) >= criteria.AT_BOUND * criteria.MOST_OFF]
    heavier = [b for b in asked if b.name in INERTIAL and b not in pressing]
    factor = _factor_of_the_drive(balances, nuisances)
    exact = [] if factor is None or factor.name in without else [factor]
    for several in [*((b,) for b in [*pressing, *heavier]), *_together(asked, pressing), *((b,) for b in exact)]:
        model, wide = current.model, list(nuisances)
        for belief in several:
            model, wide = belief.given_up(*(belief.added_to(model, wide) if belief in exact else (model, wide)))
        fitted, _ = settled(model, balances, wide, noise=noise)
        if any(abs(b.off(fitted.model)) < criteria.MOST_OFF or _at_an_end(b, fitted) for b in several):
            continue
        if any(b in heavier and b.off(fitted.model) < 0.0 for b in several):
            continue
        cost = len(several) * np.log(fitted.n) + 2.0 * np.log(len(believed) + len(exact))
        score = evidence(current, fitted, fitted, settings) - float(cost)
        freed.append(Freed(several, score, fitted, wide))
    return sorted(freed, key=lambda f: -f.score)


def _together(asked: Sequence[Belief], pressing: Sequence[Belief]) -> list[tuple[Belief, ...]]:
    """Return the beliefs that one thing moves together, of which at least one presses."""
    by_name = {b.name: b for b in asked}
    groups = [tuple(by_name[name] for name in names if name in by_name) for names in TOGETHER]
    return [g for g in groups if len(g) > 1 and any(b in pressing for b in g)]


def _factor_of_the_drive(balances: Sequence[ForceBalance], nuisances: Sequence[Nuisance]) -> Belief | None:
    """Return the factor of the drive that is stated without an uncertainty; None: it has one, or no drive is measured.

    A drive that is larger by a factor is a mechanism and friction that are smaller by it: motion alone cannot tell it from a
    mass, and friction tells it as firmly as its coefficient is believed.
    """
    name = next((n for n in (GAIN, DRIVE_FACTOR) if all(n in b.columns for b in balances)), None)
    if name is None or any(n.name in OF_THE_DRIVE for n in nuisances) or any(b.drive is None for b in balances):
        return None
    stated = balances[0].drive_factor
    return Belief(MECHANISM, name, stated, EXACT * stated, stated=False)


def _at_an_end(belief: Belief, fitted: JointFit) -> bool:
    """Return whether a number is as far as it can be at all, a mass of 0 for instance: there it stands for something else."""
    at = fitted.at(belief.owner, belief.name)[0]
    one, value = fitted.free[at], fitted.values[at]
    return min(value - one.low, one.high - value) < AT_AN_END * belief.deviation


def _driven(balances: Sequence[ForceBalance], nuisances: Sequence[Nuisance]) -> bool:
    """Return whether a drive is measured: without one all forces could be less in the same proportion, errors included."""
    if not nuisances:
        return True
    names = [n.name for n in nuisances if n.name not in OF_THE_DRIVE]  # the drive itself would leave nothing
    if not names:
        return True
    columns = np.concatenate([np.column_stack([s.columns[n] for n in names if n in s.columns]) for s in balances])
    driven = np.concatenate([s.driven for s in balances])
    rest = left_by(columns, driven, None)
    return float(np.linalg.norm(rest)) > UNDRIVEN * float(np.linalg.norm(driven))
