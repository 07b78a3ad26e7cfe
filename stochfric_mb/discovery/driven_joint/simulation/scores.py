"""How far a joint's model is from data: inverse dynamics, the closed loop simulated again, and the noise floors of both."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.fit.wave_scan import with_phases
from stochfric_mb.discovery.driven_joint.simulation.closed_loop import closed_loop, controller_output
from stochfric_mb.discovery.inference.noise import white_noise
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import Cascade, PrismaticJoint
from stochfric_mb.numerics.robust import deviation
from stochfric_mb.scenario import Scenario

Array = npt.NDArray[np.float64]

SETTLED = 10.0
"""Time constants of the position loop after which the state at the start, which is not known, plays no part."""
AHEAD = 0.5
"""Time after which a simulation without a controller starts again from the measured state [s]."""
FLOOR = 1.5
"""What a model may leave, over the noise floor, for nothing to be missing [-]. Nulls of tests/discovery/joint_generator stay
below 1.32, which drives with noise that lasts as long as the window come to."""
APART = 4
"""Centres between windows that share no samples that matter."""


@dataclasses.dataclass(frozen=True)
class Score:
    """Errors of one model on some runs."""

    sliding: float
    """Inverse dynamics, rms over the windows in which the joint slides one way [N or N m]."""
    whole: float
    """Inverse dynamics, rms over all windows, reversals and rest included [N or N m]."""
    loop: float | None
    """Voltage, or another drive, of the simulated closed loop against the measured one, relative rms [-]; None without."""
    forward: float | None = None
    """Positions of the model run forward in its engine against the measured ones, rms; None where it was not."""
    forward_unit: str = ""
    """Unit of these positions: m, rad, or both where joints are of both kinds."""


def score(
    model: JointModel, balances: Sequence[ForceBalance], nuisances: Sequence[Nuisance], runs: Sequence[Run], scenario: Scenario
) -> Score:
    """Return the errors of ``model`` on ``balances``, which belong to ``runs``."""
    model = with_phases(model, balances, nuisances)
    rest = [model.remainder(s, nuisances) for s in balances]
    sliding = np.concatenate([r[s.sliding] for r, s in zip(rest, balances, strict=True)])
    return Score(rms(sliding), rms(np.concatenate(rest)), loop_error(model, runs, scenario, [s.before for s in balances]))


def loop_error(model: JointModel, runs: Sequence[Run], scenario: Scenario, before: Sequence[float]) -> float | None:
    """Return the relative error of the simulated controller's voltage [-]; None where there is no controller.

    Args:
        model: friction and corrections.
        runs: what is simulated again.
        scenario: holds mechanism and controller.
        before: distance slid in earlier pieces of each run's record [m].
    """
    controller = scenario.controller
    if not isinstance(controller, Cascade) or any(e.moves_load for e in model.effects):
        return None
    wrong = right = 0.0
    for run, slid in zip(runs, before, strict=True):
        joint: PrismaticJoint = run.mechanism(scenario)
        voltage, _ = closed_loop(run, joint, model, controller, slid)
        late = round(SETTLED / controller.position_gain / run.sample_interval)
        measured = controller_output(run, joint)[late:]
        wrong += float(np.sum((voltage[late:] - measured) ** 2))
        right += float(np.sum(measured**2))
    return float(np.sqrt(wrong / right))


def drive_floor(given: Sequence[Array]) -> float:
    """Return the noise of what controllers gave over its size [-], from third differences."""
    noise = sum(white_noise(u) ** 2 * len(u) for u in given)
    return float(np.sqrt(noise / sum(float(np.sum(u**2)) for u in given)))


def noise_floor(model: JointModel, balances: Sequence[ForceBalance], nuisances: Sequence[Nuisance]) -> float:
    """Return the noise of the balance [N or N m]: second differences between windows that do not overlap.

    What friction leaves changes slowly from one window to the next, noise does not (von Neumann 1941). Their median size
    counts: blows, gaps and skipped teeth come in bursts and are no noise. Where no window has such neighbours it is what white
    noise of the channels leaves; nan: no such noise shows either.
    """
    parts: list[Array] = []
    model = with_phases(model, balances, nuisances)
    for s in balances:
        r = model.remainder(s, nuisances)
        seconds = (r[: -2 * APART] - 2.0 * r[APART:-APART] + r[2 * APART :]) / np.sqrt(6.0)
        parts.append(seconds[_has_neighbours(s)])
    differences = np.concatenate(parts)
    return deviation(differences, about=0.0) if len(differences) else white_floor(balances) or float("nan")


def floor_from(balances: Sequence[ForceBalance]) -> str:
    """Return where the noise of the balance is from, in words."""
    if any(_has_neighbours(s).any() for s in balances):
        return "differences between neighbouring windows that do not overlap"
    return "white noise of the channels: no window has neighbours on both sides that do not overlap it"


def _has_neighbours(balance: ForceBalance) -> npt.NDArray[np.bool_]:
    """Return which windows slide together with their next ones to either side that do not overlap them."""
    s = balance.sliding
    return s[: -2 * APART] & s[APART:-APART] & s[2 * APART :]


def white_floor(balances: Sequence[ForceBalance]) -> float:
    """Return what white noise of the channels leaves in the balance [N or N m]; 0: no such noise shows in them."""
    left = [sum((s.window.gain(order) * size) ** 2 for order, size in s.white.items()) for s in balances]
    return float(np.sqrt(np.mean(left)))


def closed_share(before: float, after: float, floor: float) -> float:
    """Return the part of a squared error, noise apart, that is gone [-].

    Args:
        before: error without what closes it.
        after: the same with it, in the same unit.
        floor: what noise alone leaves; nan, where no windows show it, counts as none, and the share is a lower bound.
    """
    floor = floor if np.isfinite(floor) else 0.0
    return (before**2 - after**2) / max(before**2 - floor**2, 1.0e-12 * before**2, 1.0e-300)


def rms(values: Array) -> float:
    """Return the root mean square of values; nan of none."""
    return float(np.sqrt(np.mean(values**2))) if len(values) else float("nan")
