"""What an effect could be worth, and what could imitate it, to first order about a fit."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from scipy.linalg import block_diag

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit, prior_rows, prior_weight
from stochfric_mb.discovery.driven_joint.fit.free_parameters import adjusted, free_parameters
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.fit.wave_scan import Start
from stochfric_mb.discovery.inference.free_parameter import LAW, FreeParameter
from stochfric_mb.discovery.inference.least_squares import left_by
from stochfric_mb.effects import Effect

Array = npt.NDArray[np.float64]


def effect_columns(model: JointModel, start: Start, balances: Sequence[ForceBalance]) -> Array:
    """Return how an effect and its parameters, each run's own too, would change the friction of a model, shape (n, 1 + p)."""
    effect, trial = start.effect, start.added_to(model)
    owner = len(trial.effects) - 1
    free = [k for k in free_parameters(trial, ()) if k.owner == owner]
    if "mu_s" in effect.frees:
        free += [k for k in free_parameters(trial, ()) if k.name == "mu_s"]
    level = FreeParameter(LAW, "mu_k", model.law.mu_k, 1.0, 0.0, np.inf)

    def force(some: JointModel) -> Array:
        return -np.concatenate([some.remainder(s, ())[s.sliding] for s in balances])

    here = force(trial)
    columns = [here - force(model)]
    for one in free:
        step = 1.0e-3 * one.scale
        moved = adjusted(trial, [level, one], np.array([model.law.mu_k, one.value + step]))
        columns.append((force(moved) - here) / step)
    return np.column_stack(columns)


def predicted_left(model: JointModel, start: Start, balances: Sequence[ForceBalance], current: JointFit) -> Array:
    """Return what an effect would leave from a start if the balance were linear in all numbers [N or N m], window by window.

    Cheap: one evaluation a parameter. It ranks starting points; the fit itself is not linear. The force of a load that moves by
    itself is far from linear in most numbers: it is taken as it is where the fit begins, and beliefs count as windows do.
    """
    rest = np.concatenate(current.remainders)
    if start.effect.moves_load:
        left = _left_by_load(start.effect, balances, current)
        return left * np.sqrt(len(left) / len(rest))
    return left_by(np.column_stack([current.jacobian, effect_columns(model, start, balances)]), rest)


def hidden_share(effect: Effect, balances: Sequence[ForceBalance], current: JointFit) -> float:
    """Return what part of an effect's change of friction the numbers fitted already would imitate, beliefs counted [-]."""
    columns = effect_columns(current.model, Start(effect), balances)
    change = columns[:, int(np.argmax(np.abs(columns).max(axis=0) > 0.0))]
    size = float(change @ change)
    prior, _ = prior_rows(current, prior_weight(current))
    left = left_by(np.vstack([current.jacobian, prior]), np.r_[change, np.zeros(len(prior))])
    return 1.0 - float(left @ left) / size if size > 0.0 else 1.0


def _left_by_load(effect: Effect, balances: Sequence[ForceBalance], current: JointFit) -> Array:
    """Return what a load that moves by itself leaves, how it moves when each record begins fitted beside all other numbers.

    Beliefs are counted, as what is left of them.
    """
    names = effect.own_to_run
    still = dataclasses.replace(effect, **dict.fromkeys(names, 0.0))
    moving = [still, *(dataclasses.replace(still, **{n: getattr(effect, n)}) for n in names)]
    forces = [[s.load_force(e)[s.sliding] for s in balances] for e in moving]  # pyright: ignore[reportOptionalSubscript]
    prior, off = prior_rows(current, prior_weight(current))
    columns = [np.vstack([current.jacobian, prior])]
    for begun in forces[1:]:
        own = np.asarray(block_diag(*((x - y)[:, None] for x, y in zip(begun, forces[0], strict=True))), dtype=np.float64)  # pyright: ignore[reportArgumentType, reportCallIssue]
        columns.append(np.vstack([own, np.zeros((len(off), len(balances)))]))
    return left_by(np.hstack(columns), np.r_[np.concatenate(current.remainders) - np.concatenate(forces[0]), off])
