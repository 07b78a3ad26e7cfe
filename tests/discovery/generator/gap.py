"""How much of the held-out forecast error an effect is worth: by the generator's own simulator, without discovery.

One-cycle-ahead forecasts start mid-stick from the measured position. The stated model is recalibrated on the fit runs within
its uncertainty; the floor is the true model's forecast. Scores are CRPS: the mean absolute error of a certain forecast, the
ensemble formula for a random one. Gneiting & Raftery, J. Am. Stat. Assoc. 102 (2007) 359, doi 10.1198/016214506000001437.
"""

from dataclasses import asdict, dataclass, replace

import numpy as np
from scipy.optimize import least_squares

from .case import Made
from .curve import Array
from .integrator import MODE, N_STATES, SLIPS, V, X, simulate
from .machine import BELT, SIGNAL_SPACING, Machine, plain_machine
from .rig import UNCERTAINTY

_STARTS = 12  # forecasts a run
_AROUND = 21  # samples whose median is the position at a start
_MEMBERS = 12  # of an ensemble, for random effects
_FREE = ("mu_s", "mu_k", "stiffness", "mass", "damping")
_RANDOM = frozenset({"random_coefficients", "correlated_coefficients"})


@dataclass(frozen=True)
class Gap:
    """Scores on the held-out runs [m]."""

    recalibrated: float
    floor: float

    @property
    def reducible(self) -> float:
        """Share of the recalibrated model's score that the true effect removes."""
        return 1.0 - self.floor / self.recalibrated


@dataclass(frozen=True)
class _Forecasts:
    """Where forecasts start in a run, and what was measured after."""

    run: int
    starts: Array
    """Sample numbers."""
    positions: Array
    """Measured positions there [m]."""
    states: Array
    """True states there."""
    measured: list[Array]
    """Measured positions over the cycle that follows [m]."""
    true: list[Array]
    """True positions over the same cycle [m]."""


def held_out_gap(made: Made) -> Gap:
    """The gap of a case on its held-out runs."""
    roles = [run.role for run in made.design.runs]
    fit = [_forecasts(made, i) for i, role in enumerate(roles) if role == "fit"]
    test = [_forecasts(made, i) for i, role in enumerate(roles) if role == "test"]

    def residuals(deviations: Array) -> Array:
        errors = np.concatenate([_baseline_errors(made, deviations, of) for of in fit])
        return np.append(errors / made.effects[0].noise, deviations)

    best = least_squares(residuals, np.zeros(len(_FREE)), diff_step=1e-3, x_scale=1.0, max_nfev=8)
    recalibrated = float(np.mean(np.abs(np.concatenate([_baseline_errors(made, best.x, of) for of in test]))))
    return Gap(recalibrated, float(np.mean(np.concatenate([_true_errors(made, of) for of in test]))))


def _forecasts(made: Made, run: int) -> _Forecasts:
    _, states, _ = made.states(run)
    measured = made.record(run)["position [m]"]
    breaks = np.flatnonzero(np.diff(states[:, SLIPS]) > 0)
    cycle = int(np.median(np.diff(breaks)))
    middles = (breaks[:-1] + breaks[1:]) // 2 + 50  # the slip comes first
    usable = [s for s in middles if states[s, MODE] == 0.0 and s > 20 and s + cycle < measured.size]
    starts = np.array(usable)[:: max(1, len(usable) // _STARTS)]
    half = _AROUND // 2
    positions = np.array([np.median(measured[s - half : s + half + 1]) for s in starts])
    paths = [(measured[s : s + cycle], states[s : s + cycle, X]) for s in starts]
    return _Forecasts(run, starts, positions, states[starts], [m for m, _ in paths], [t for _, t in paths])


def _baseline_errors(made: Made, deviations: Array, of: _Forecasts) -> Array:
    """Errors of the stated model with its parameters off by these standard deviations."""
    factors = {name: 1.0 + UNCERTAINTY[name] * float(d) for name, d in zip(_FREE, deviations, strict=True)}
    wrong = {name: getattr(made.nominal, name) * factor for name, factor in factors.items()}
    parameters = asdict(replace(made.nominal, **wrong)) | made.design.runs[of.run].conditions
    machine = plain_machine(**parameters, duration=made.design.runs[of.run].duration + 1.0)
    errors = []
    for start, position, measured in zip(of.starts, of.positions, of.measured, strict=True):
        state = np.zeros(N_STATES)
        state[X], state[V] = position, machine.signals[int(start), BELT]
        forecast, _ = simulate(machine, measured.size, state=state, start=float(start) * SIGNAL_SPACING)
        errors.append(forecast[:, X] - measured)
    return np.concatenate(errors)


def _true_errors(made: Made, of: _Forecasts) -> Array:
    """CRPS of the true model, started with the same error: its own path, or an ensemble of new draws where it is random."""
    rng = np.random.default_rng(of.run)
    noise = made.effects[0].noise
    start_error = noise * np.sqrt(0.5 * np.pi / _AROUND)
    random = bool(_RANDOM & {part.kind for part in made.case.parts})
    machines = [_redrawn(made, of.run, member) for member in range(_MEMBERS)] if random else [made.machine(of.run)]
    n = len(machines)
    scores: list[Array] = []
    for start, state, true in zip(of.starts, of.states, of.true, strict=True):
        off = state.copy()
        off[X] += start_error * rng.standard_normal()
        measured = true + noise * rng.standard_normal(true.size)
        runs = [simulate(machine, true.size, state=off, start=float(start) * SIGNAL_SPACING) for machine in machines]
        paths = np.array([states[:, X] for states, _ in runs])
        if random:
            paths += noise * rng.standard_normal(paths.shape)
        score = np.mean(np.abs(paths - measured), axis=0)
        if random:
            score -= 0.5 * np.mean(np.abs(paths[:, None] - paths[None, :]), axis=(0, 1)) * n / (n - 1)
        scores.append(score)
    return np.concatenate(scores)


def _redrawn(made: Made, run: int, member: int) -> Machine:
    machine = made.machine(run, with_effects=False)
    for effect in made.effects:
        machine = effect.alter(machine, np.random.default_rng([member, run]))
    return machine
