"""From a candidate of the screening to effects with numbers, where a fit or a simulation may start."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np

from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import CORRECTED, Array, corrections_of
from stochfric_mb.discovery.stick_slip.screening.regression import Baseline
from stochfric_mb.discovery.stick_slip.screening.screen import Candidate
from stochfric_mb.discovery.stick_slip.screening.waves import wave_columns
from stochfric_mb.discovery.stick_slip.simulation.model import MOST_FREED, Model
from stochfric_mb.effects import Effect, effect_class, kind_with_signature, make_effect
from stochfric_mb.effects.marks import RETURNING, Wave
from stochfric_mb.effects.traits import JUMP, WAVES

HARMONIC_BEGINS = 0.2
"""Size with which a harmonic of another kind than the ripple begins to be fitted, over that of the ripple [-]."""
HIGHEST_HARMONIC = 9
"""Order up to which a ripple at a multiple of a named one's frequency is its harmonic: beyond, a multiple is always near."""


def with_candidate(model: Model, candidate: Candidate, pool: Pool) -> Model:
    """Return the model with the candidate's effect added, at the numbers that the screening fitted.

    Args:
        model: the model so far.
        candidate: an effect of the screening.
        pool: the slips.
    """
    coefficients = candidate.strengths
    model = beside(model, candidate.solution.coefficients)
    if candidate.is_wave:
        return _periodic(model, candidate, pool, coefficients)
    if candidate.name == kind_with_signature(JUMP):
        sizes = coefficients.reshape(pool.n_runs, -1)
        times = np.array(candidate.hypothesis.setting).reshape(pool.n_runs, -1)
        for step in range(sizes.shape[1]):
            table = {s.record.name: (float(sizes[r, step]), float(times[r, step])) for r, s in enumerate(pool.slips)}
            model = with_steps(model, table)
        return model
    values = candidate.hypothesis.start(coefficients)
    corrections = dict(model.corrections)
    for name in effect_class(candidate.name).frees:
        if name not in corrections:
            continue
        corrections[name] = float(np.clip(corrections[name] + values.pop(name), -MOST_FREED, MOST_FREED))
    return dataclasses.replace(model, corrections=corrections).plus(_bounded(candidate.name, values))


def beside(model: Model, coefficients: Array) -> Model:
    """Return the model with the coefficients of friction and the mechanism that a regression estimates beside another term.

    A fit begins where the regression ended: those estimated without the term hold a part of what it explains, and that part
    would count twice.

    Args:
        model: the model so far.
        coefficients: of the regression with the term, those of the stated model first.
    """
    mu_s, mu_k = (max(float(c), 1.0e-3) for c in coefficients[:2])
    # what is left holds what the effects so far free of the mechanism no more
    held = np.array([model.corrections.get(name, 0.0) if name in model.left_open else 0.0 for name in CORRECTED])
    corrections = corrections_of(coefficients[2 : 2 + len(CORRECTED)] + held)
    return dataclasses.replace(model.with_law(mu_s, mu_k), corrections=corrections)


def with_steps(model: Model, steps: Mapping[str, tuple[float, float]], place: int | None = None) -> Model:
    """Return the model with each run's own step of the sensor: size [m] and time [s].

    Args:
        model: the model.
        steps: run -> size and time.
        place: number of the effect that is this step; a new one if not given.
    """
    if place is None:
        size, when = next(iter(steps.values()))
        model = model.plus(make_effect(kind_with_signature(JUMP), size=size, time=when))
        place = len(model.effects) - 1
    for run, (size, when) in steps.items():
        model = model.with_own(run, [place], [{"size": size, "time": when}])
    return model


def _bounded(kind: str, values: Mapping[str, float | str]) -> Effect:
    """Return the effect with its values moved into the bounds of fits."""
    cls = effect_class(kind)
    about = {f.name: f.metadata for f in dataclasses.fields(cls)}
    kept: dict[str, float | str] = {}
    for name, value in values.items():
        if isinstance(value, str):
            kept[name] = value
            continue
        low, high = about[name]["fit_low"], about[name]["fit_high"]
        inside = 1.0e-3 * min(abs(value), high - low) if about[name]["strict"] else 0.0
        kept[name] = float(np.clip(value, low + inside, high - inside))
    return make_effect(kind, **kept)


def _periodic(model: Model, candidate: Candidate, pool: Pool, coefficients: Array) -> Model:
    if candidate.hypothesis.variant == RETURNING:
        effect = _bounded(candidate.name, candidate.hypothesis.start(coefficients))
        begins = candidate.hypothesis.setting[1 : 1 + pool.n_runs]
        return _with_own(model, pool, [effect], [({"phase": 2.0 * np.pi * begin},) for begin in begins])
    harmonics = int(candidate.hypothesis.setting[-1])
    main = candidate.hypothesis.setting[0]
    pairs = coefficients.reshape(pool.n_runs, harmonics, 2)
    # slips of a run that keep to the wave are all alike, and tell its size hardly at all
    variance = (candidate.solution.deviations[-coefficients.size :] ** 2).reshape(pairs.shape).sum(axis=2)
    amplitudes = np.average(np.hypot(pairs[..., 0], pairs[..., 1]), axis=0, weights=1.0 / variance)
    # a cos + b sin = A cos(theta + phase)
    phases = np.arctan2(-pairs[..., 1], pairs[..., 0])
    if candidate.along_belt:
        # a mirrored run sees the belt coordinate with the opposite sign
        phases = phases * np.array([s.record.direction for s in pool.slips])[:, None]
        effects, added = _along_belt(candidate.name, main, amplitudes, phases)
    else:
        effects, added = _in_time(candidate.name, main, amplitudes, phases)
    return _with_own(model, pool, effects, added)


def _with_own(model: Model, pool: Pool, effects: Sequence[Effect], added: Sequence[tuple[dict[str, float], ...]]) -> Model:
    """Return the model with further effects, and what of them is each run's own."""
    own = {
        s.record.name: (*model.own.get(s.record.name, ({},) * len(model.effects)), *mine)
        for s, mine in zip(pool.slips, added, strict=True)
    }
    return dataclasses.replace(model, effects=(*model.effects, *effects), own=own)


def beside_waves(model: Model, candidate: Candidate, baseline: Baseline) -> Model:
    """Return the model with a candidate that is a wave in time beside others: all of them as one regression shows them.

    The waves that the model holds were fitted without the candidate, and have taken a part of it.

    Args:
        model: the model so far.
        candidate: an effect of the screening.
        baseline: what the model leaves.
    """
    pool = baseline.pool
    waves = _waves_beside(model, candidate, pool)
    if not waves:
        return with_candidate(model, candidate, pool)
    held = [c for _, e in waves for c in wave_columns(pool, _wave(e, pool), _frequency(e, 1.0), 1)]
    mine = candidate.hypothesis.columns
    solution = baseline.solved([*held, *mine])
    joint = with_candidate(model, dataclasses.replace(candidate, solution=solution), pool)
    changes = solution.coefficients[-len(held) - len(mine) : -len(mine)].reshape(len(waves), pool.n_runs, 2)
    effects, values = list(joint.effects), {run: list(numbers) for run, numbers in joint.own.items()}
    for (place, effect), change in zip(waves, changes, strict=True):
        before = np.array([values[s.record.name][place]["phase"] for s in pool.slips])
        after = effect.amplitude * np.exp(1j * before) + change[:, 0] - 1j * change[:, 1]  # pyright: ignore[reportAttributeAccessIssue]
        numbers = {"amplitude": float(np.abs(after).mean()), "frequency": _frequency(effect, 1.0)}
        effects[place] = _bounded(effect.kind, numbers)
        for s, phase in zip(pool.slips, np.angle(after), strict=True):
            values[s.record.name][place] = {"phase": float(phase)}
    return dataclasses.replace(joint, effects=tuple(effects), own={run: tuple(numbers) for run, numbers in values.items()})


def _waves_beside(model: Model, candidate: Candidate, pool: Pool) -> list[tuple[int, Effect]]:
    """Return place and effect of the model's waves in time that one regression can tell from a candidate, if that is a wave."""
    if not candidate.is_wave or candidate.along_belt:
        return []
    own = candidate.frequency(1.0) * np.arange(1, int(candidate.hypothesis.setting[-1]) + 1)
    held = [(i, e) for i, e in enumerate(model.effects) if WAVES in e.traits and e.own_to_run]
    waves = [(i, e) for i, e in held if hasattr(e, "frequency") and not getattr(e, "any_shape", False)]
    return [(i, e) for i, e in waves if np.abs(own - _frequency(e, 1.0)).min() > 1.0 / pool.duration]


def _wave(effect: Effect, pool: Pool) -> Wave:
    wave = type(effect).wave(pool)
    assert wave is not None
    return wave


Waves = tuple[list[Effect], list[tuple[dict[str, float], ...]]]
"""Effects, and for each run the values of each that are its own."""


def _along_belt(kind: str, wavelength: float, amplitudes: Array, phases: Array) -> Waves:
    """Return one effect with its harmonics along the belt."""
    values = {"amplitude": amplitudes[0], "wavelength": wavelength}
    values |= {f"amplitude_{h + 1}": amplitudes[h] for h in range(1, len(amplitudes))}
    own = [({("phase" if h == 0 else f"phase_{h + 1}"): float(p) for h, p in enumerate(row)},) for row in phases]
    return [_bounded(kind, values)], own


def _in_time(kind: str, frequency: float, amplitudes: Array, phases: Array) -> Waves:
    """Return one effect for every harmonic that is large."""
    large = [h for h in range(len(amplitudes)) if h == 0 or amplitudes[h] > 0.1 * amplitudes[0]]
    effects = [_bounded(kind, {"amplitude": amplitudes[h], "frequency": frequency * (h + 1)}) for h in large]
    return effects, [tuple({"phase": float(row[h])} for h in large) for row in phases]


def as_harmonic(model: Model, candidate: Candidate, pool: Pool) -> Model | None:
    """Return the model with the candidate as a harmonic of a ripple that it holds; None where it is none.

    A ripple that is not a sine, such as a square one, leaves multiples of its frequency behind.
    """
    if not candidate.is_wave:
        return None
    held = next((e for e in model.effects if WAVES in e.traits and e.own_to_run), None)
    if held is None:
        return None
    belt = float(pool.belt_velocity.min())
    main, other = _frequency(held, belt), candidate.frequency(belt)
    order = round(other / main)
    if not 1 <= order <= HIGHEST_HARMONIC or abs(other - order * main) > 2.0 / pool.duration:
        return None
    if held.kind == candidate.name:
        return with_candidate(model, candidate, pool)
    # set by the kind that is held; amplitude and phases are fitted next
    setting = {"frequency": order * main} if hasattr(held, "frequency") else {"wavelength": belt / (order * main)}
    size = held.amplitude or held.course  # pyright: ignore[reportAttributeAccessIssue]
    return model.plus(_bounded(held.kind, {"amplitude": HARMONIC_BEGINS * size} | setting))


def _frequency(effect: Effect, belt: float) -> float:
    return float(effect.frequency if hasattr(effect, "frequency") else belt / effect.wavelength)  # pyright: ignore[reportAttributeAccessIssue]
