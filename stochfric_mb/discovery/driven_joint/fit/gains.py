"""What an effect could be worth, and what could imitate it, to first order about a fit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit, prior_rows, prior_weight
from stochfric_mb.discovery.driven_joint.fit.free_parameters import adjusted, free_parameters
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.inference.free_parameter import LAW, FreeParameter
from stochfric_mb.effects import Effect

Array = npt.NDArray[np.float64]


def effect_columns(model: JointModel, effect: Effect, balances: Sequence[ForceBalance]) -> Array:
    """Return how an effect and its parameters would change the friction of a model, shape (n, 1 + n_parameters)."""
    trial = model.plus(effect)
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


def predicted_rms(model: JointModel, effect: Effect, balances: Sequence[ForceBalance], current: JointFit) -> float:
    """Return the rms that ``effect`` would leave if the balance were linear in all numbers [N or N m].

    Cheap: one evaluation a parameter. It ranks starting points; the fit itself is not linear.
    """
    design = np.column_stack([current.jacobian, effect_columns(model, effect, balances)])
    left = left_by(design, np.concatenate(current.remainders))
    return float(np.sqrt(np.mean(left**2)))


def hidden_share(effect: Effect, balances: Sequence[ForceBalance], current: JointFit) -> float:
    """Return what part of an effect's change of friction the numbers fitted already would imitate, beliefs counted [-]."""
    columns = effect_columns(current.model, effect, balances)
    change = columns[:, int(np.argmax(np.abs(columns).max(axis=0) > 0.0))]
    size = float(change @ change)
    prior, _ = prior_rows(current, prior_weight(current))
    left = left_by(np.vstack([current.jacobian, prior]), np.r_[change, np.zeros(len(prior))])
    return 1.0 - float(left @ left) / size if size > 0.0 else 1.0


def left_by(design: Array, values: Array) -> Array:
    """Return what the columns of ``design`` leave of ``values``."""
    scaled = design / np.maximum(np.linalg.norm(design, axis=0), 1.0e-300)
    return values - scaled @ np.linalg.lstsq(scaled, values, rcond=1.0e-10)[0]
