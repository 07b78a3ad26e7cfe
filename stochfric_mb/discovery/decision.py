"""The decision: which effects are named, which cannot be told apart, and when the answer is "none" or "unknown"."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery.confirmation import Case, Confirmed, cases_of, confirm
from stochfric_mb.discovery.innovations import left_over
from stochfric_mb.discovery.model import Model
from stochfric_mb.discovery.naming import PERIODIC, with_candidate
from stochfric_mb.discovery.randomness import Randomness, randomness
from stochfric_mb.discovery.refit import refit
from stochfric_mb.discovery.regression import Regression, Solution, Terms, believed
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.screening import Candidate, screen
from stochfric_mb.discovery.study import Progress, Study
from stochfric_mb.effects import make_effect

SELECT, NAME = 14.0, 20.0
"""Scores at which a candidate is followed up, and at which it is named [-]."""
MARGIN, MARGIN_SHARE = 15.0, 0.03
"""A competitor that names no physics wins if it beats the best effect by this much, or by this share [-]."""
CLASS, CLASS_SHARE = 12.0, 0.03
"""Effects whose score is within this, or this share, of the best are of one class with it [-]."""
CONFIRMED_CLASS = 10.0
"""Effects whose simulated criterion is within this of the best are of one class with it [-]."""
LACK, LACK_SHARE_ONE, LACK_SHARE_SEVERAL = 25.0, 0.15, 0.35
"""A simulated candidate is refused if chi^2 stays this far above its freedom and above this share of the believed model's."""
SECOND = 0.1
"""A further effect needs at least this share of the first one's score [-]."""
YIELDS = 0.5
"""Share of the evidence for creep that a yielding or ringing contact must reach to be named in its place [-]."""
REMAINING_SCATTER = 0.1
"""Share of the believed model's scatter that must remain with the effects in for it to be called random [-]."""
MOST_EFFECTS = 3
"""Effects that are looked for."""

IN_SLIP = (
    "velocity_weakening", "viscous_friction", "frictional_lag", "nonlinear_stiffness", "quadratic_damping", "backlash",
    "second_mode",
)  # fmt: skip
"""Effects that shape every slip alike: told apart by simulating them."""
IN_TIME = ("friction_drift", "sensor_drift", "sensor_step")
"""Effects that change in the course of a run; like periodic ones they are fitted to forecasts."""
BETWEEN_POINTS = ("dwell_ageing", "direction_asymmetry", "load_dependence")
"""Effects that differ between operating points: simulated too where there are several."""


@dataclasses.dataclass(frozen=True)
class Named:
    """One effect that was decided on."""

    kind: str
    """Its name."""
    class_: tuple[str, ...]
    """Effects that the data cannot tell from it, without itself."""
    score: float
    """Evidence [-]."""
    where: Where
    """Where it shows."""


@dataclasses.dataclass(frozen=True)
class Decision:
    """What the fit runs say."""

    verdict: str
    """"effect", "none" or "unknown"."""
    named: tuple[Named, ...]
    """The effects, in the order in which they were found."""
    where: Where | None
    """Where an unknown disagreement lives."""
    model: Model
    """The model with the effects, at starting values for the refit."""
    ranking: tuple[tuple[str, float], ...]
    """Every candidate of the first round with its score."""
    random: Randomness | None
    """What the scatter says."""
    details: dict[str, object]
    """Numbers behind it."""


WHERE: dict[str, tuple[str, str]] = {
    "velocity_weakening": ("relative velocity", "friction in slip depends on the sliding velocity and falls as it rises"),
    "viscous_friction": ("relative velocity", "friction in slip rises with the sliding velocity"),
    "frictional_lag": ("slip distance", "friction falls with the distance slid after a break-away, not at once"),
    "dwell_ageing": ("dwell", "the force at break-away depends on how long the contact has stuck"),
    "direction_asymmetry": ("direction", "friction differs between the two directions of sliding"),
    "load_dependence": ("normal load", "friction is not proportional to the normal load"),
    "presliding_compliance": ("stick", "the contact yields and rings in stick"),
    "position_dependent_friction": ("belt position", "friction varies along the belt"),
    "friction_drift": ("time", "friction drifts in the course of a run"),
    "normal_load_ripple": ("time", "friction in stick and slip is modulated periodically in time by the same share"),
    "belt_speed_ripple": ("time, in stick", "in stick the box shows that the belt's speed varies periodically"),
    "nonlinear_stiffness": ("position of the box", "the restoring force is not linear in position"),
    "quadratic_damping": ("velocity", "the damping grows with the square of the box's velocity"),
    "backlash": ("position of the box", "the restoring force has a dead zone"),
    "second_mode": ("frequency", "the box rings with a second mode in slip"),
    "harmonic_force": ("time", "a periodic force is added, the same in stick and slip"),
    "impacts": ("time", "single kicks let the box break away early or jump"),
    "sensor_drift": ("time, sensor", "the position drifts, in stick and slip alike"),
    "sensor_step": ("time, sensor", "the position jumps once and stays off"),
    "sensor_clipping": ("position, sensor", "the record stays at one ceiling where the box goes on"),
    "sensor_outliers": ("sensor", "single samples are far off"),
    "sensor_delay": ("time, sensor", "the record lags behind the known excitation"),
    "random_coefficients": ("scatter", "friction scatters from slip to slip with no memory"),
    "correlated_coefficients": ("scatter, time", "friction wanders slowly and at random"),
}  # fmt: skip
"""Effect -> the axis on which it shows, and a sentence."""


def where_of(kind: str) -> Where:
    """Return where an effect shows."""
    axis, text = WHERE.get(kind, (kind, f"{kind} explains the disagreement"))
    return Where(axis, text)


def decide(study: Study, *, progress: Progress = lambda _: None) -> Decision:
    """Return what the fit runs say."""
    details: dict[str, object] = {}
    named: list[Named] = []
    model = _levels(study.model, study)
    blamed = _kinematics(study, details)
    if isinstance(blamed, Where):
        return Decision("unknown", (), blamed, model, (), None, details)
    for kind, score, values in blamed:
        named.append(Named(kind, (), score, where_of(kind)))
        model = _with_kinematic(study, model, kind, values)
    progress("screening")
    return _dynamics(study, model, named, details, progress)


def _with_kinematic(study: Study, model: Model, kind: str, values: dict[str, float]) -> Model:
    """Return the model with an effect that the stick phases showed; a ripple's phases and amplitude are fitted at once."""
    if kind == "belt_speed_ripple":
        names = [s.record.name for s in study.pool.slips]
        best: tuple[float, Model] | None = None
        for amplitude in (0.01, 0.05):
            own = {
                name: (*({} for _ in model.effects), {"phase": phase})
                for name, phase in _ripple_phases(study, values["frequency"])
            }
            assert set(own) == set(names)
            trial = model.plus(make_effect(kind, **(values | {"amplitude": amplitude})))
            fit = refit(dataclasses.replace(trial, own=own), study.windows, study.uncertainty, most=12, evaluations=20)
            if best is None or fit.cost < best[0]:
                best = (fit.cost, fit.model)
        assert best is not None
        return best[1]
    model = model.plus(make_effect(kind, **values))
    if kind == "presliding_compliance":
        return _compliant(study, model)
    return model


def _compliant(study: Study, model: Model) -> Model:
    """Return the model with the elastic limit and damping that forecast best; looked for on a grid first."""
    place = len(model.effects) - 1
    first = model.effects[place]
    best: tuple[float, Model] | None = None
    for limit in (5.0e-6, 1.5e-5, 5.0e-5, 1.5e-4):
        for ratio in (0.05, 0.3):
            effects = (*model.effects[:place], dataclasses.replace(first, elastic_limit=limit, damping_ratio=ratio))
            trial = dataclasses.replace(model, effects=effects)
            fit = refit(trial, study.windows, study.uncertainty, most=5, evaluations=4)
            if best is None or fit.cost < best[0]:
                best = (fit.cost, fit.model)
    assert best is not None
    return refit(best[1], study.windows, study.uncertainty, most=12, evaluations=20).model


def _ripple_phases(study: Study, frequency: float) -> list[tuple[str, float]]:
    """Return run and phase of a ripple of the belt's speed, from what its integral leaves in the stick phases."""
    found: list[tuple[str, float]] = []
    for slips in study.pool.slips:
        samples = slips.stick
        angle = 2.0 * np.pi * frequency * samples.time
        count = np.maximum(np.bincount(samples.segment), 1)
        centred = [
            c - (np.bincount(samples.segment, c) / count)[samples.segment]
            for c in (np.cos(angle), np.sin(angle), samples.time, samples.residual)
        ]
        a, b, _ = np.linalg.lstsq(np.stack(centred[:3], axis=1), centred[3], rcond=None)[0]
        # the position is the integral, v_b A/w sin(w t + phase) = v_b A/w (cos w t sin phase + sin w t cos phase)
        phase = float(np.arctan2(a, b))
        found.append((slips.record.name, phase))
    return found


def _levels(model: Model, study: Study) -> Model:
    """Return the model at the mean coefficients that the regression found."""
    mu_s, mu_k = study.solution.coefficients[:2]
    return model.with_law(float(max(mu_s, 1.0e-3)), float(np.clip(mu_k, 1.0e-5, 0.999 * mu_s)))


def _kinematics(study: Study, details: dict[str, object]) -> list[tuple[str, float, dict[str, float]]] | Where:
    """Return the effects that the stick phases and the sensor show, or where they disagree with no known effect."""
    found: list[tuple[str, float, dict[str, float]]] = []
    outliers = study.outliers
    n = sum(len(r.time) for r in study.records)
    details["outlier_share"] = outliers
    if outliers > 5.0e-5 and outliers * n >= 5:
        size = np.concatenate([np.abs(r.raw - r.position)[r.outlier] for r in study.records])
        found.append(
            ("sensor_outliers", float(outliers * n * 10.0), {"fraction": outliers, "size": float(np.sqrt(np.mean(size**2)))})
        )
    details["ceiling"] = study.ceiling[0]
    if study.ceiling[0] > 30.0:
        found.append(("sensor_clipping", float(study.ceiling[0]), {"high": float(study.ceiling[1])}))
        return found
    sticking = study.sticking
    if sticking is None:
        return found
    details["sticking"] = dict(sticking.scores) | {"excess": sticking.excess, "excess_ratio": sticking.excess_ratio}
    best = max(sticking.scores, key=lambda k: sticking.scores[k])
    score = sticking.scores[best]
    if score <= NAME:
        return found
    if best in ("creep_before", "creep_after", "yielding"):
        gradual = max(sticking.scores["yielding"], sticking.scores["presliding_compliance"])
        if gradual > YIELDS * score:
            best, score = "presliding_compliance", max(score, 0.0) + max(sticking.scores["presliding_compliance"], 0.0)
    if best == "creep_before":
        return Where("stick, before the break-away", "the box leaves the belt's motion before it breaks away")
    if best == "creep_after":
        return Where("stick, after the re-stick", "the box does not follow the belt at once when it sticks again")
    if score < 0.75 * sticking.excess - 60.0:
        return Where("stick", "in stick the box does not follow the belt, in a way that no known effect explains")
    settings = sticking.settings[best]
    if best == "belt_speed_ripple":
        found.append((best, score, {"amplitude": 0.01, "frequency": settings["frequency"]}))
    elif best == "presliding_compliance":
        box = study.records[0].mechanism
        stiffness = max(settings["angular_frequency"] ** 2 * box.mass - box.stiffness, 0.1 * box.stiffness)
        limit = float(study.solution.coefficients[0]) * box.normal_force / stiffness
        found.append((best, score, {"elastic_limit": limit, "damping_ratio": settings["damping_ratio"]}))
    elif best == "sensor_step":
        found.append((best, score, {"size": 1.0e-5, "time": settings["time_0"]}))
    return found


def _dynamics(study: Study, model: Model, named: list[Named], details: dict[str, object], progress: Progress) -> Decision:
    """Return the decision after looking for effects in the forces of the slips, one after the other."""
    pool, regression = study.pool, study.regression
    terms, solution = study.terms, study.solution
    if any(n.kind in ("belt_speed_ripple", "presliding_compliance") for n in named):
        pool = left_over(study.pool, model)
        regression = Regression(pool)
        terms = believed(pool, dict(study.uncertainty))
        solution = regression.fit(terms, solution.scatter)
    ranking: tuple[tuple[str, float], ...] = ()
    cases = cases_of(pool, model)
    confirmed = confirm(cases, model, study.uncertainty) if cases else None
    first = 0.0
    held: list[str] = [n.kind for n in named]
    for round_ in range(MOST_EFFECTS):
        candidates = screen(pool, regression, terms, solution, without=held)
        if round_ == 0:
            ranking = tuple((c.name, c.score) for c in candidates)
            first = candidates[0].score
        details[f"round_{round_ + 1}"] = {c.name: c.score for c in candidates[:8]}
        if candidates[0].score < max(NAME if round_ == 0 else SELECT, SECOND * first if round_ else 0.0):
            break
        progress("confirmation")
        outcome = _choose(study, model, terms, candidates, cases, confirmed, details, round_)
        if isinstance(outcome, Where):
            if named:
                # what was found stands; the rest is noted, not named
                details["left_over"] = dataclasses.asdict(outcome)
                break
            return Decision("unknown", (), outcome, model, ranking, None, details)
        if outcome is None:
            break
        chosen, class_, score, model, confirmed = outcome
        named.append(Named(chosen.name, class_, score, where_of(chosen.name)))
        held.append(chosen.name)
        progress("what is left")
        if chosen.name in PERIODIC or chosen.name in IN_TIME:
            model = refit(model, study.windows, study.uncertainty, most=12, evaluations=20).model
        pool = left_over(study.pool, model)
        regression = Regression(pool)
        terms = believed(pool, dict(study.uncertainty))
        solution = regression.fit(terms, solution.scatter)
    scatter = randomness(regression, terms, solution)
    details["randomness"] = dataclasses.asdict(scatter)
    random = _random(study, scatter, solution, named)
    if isinstance(random, Where):
        if not named:
            return Decision("unknown", (), random, model, ranking, scatter, details)
        details["left_over"] = dataclasses.asdict(random)
    elif random is not None:
        kind, score, values, class_ = random
        model = model.plus(make_effect(kind, **values))
        named.append(Named(kind, class_, score, where_of(kind)))
    return Decision("effect" if named else "none", tuple(named), None, model, ranking, scatter, details)


def _choose(
    study: Study,
    model: Model,
    terms: Terms,
    candidates: Sequence[Candidate],
    cases: Sequence[Case],
    before: Confirmed | None,
    details: dict[str, object],
    round_: int,
) -> tuple[Candidate, tuple[str, ...], float, Model, Confirmed | None] | Where | None:
    """Return the effect of this round with its class, score and model; or where the unknown lives; or None for nothing."""
    n_terms = terms.columns.shape[2]
    several = len(cases) > 1 and not cases[0].record.mechanism.excitation_amplitude
    simulated = IN_SLIP + (BETWEEN_POINTS if several else ())
    effects = [c for c in candidates if c.is_effect]
    others = [c for c in candidates if not c.is_effect]
    shape = max((c.score for c in candidates if c.name in simulated or c.name in ("slip_shape", "position")), default=-np.inf)
    rest = max(
        (c.score for c in candidates if c.name not in simulated and c.name not in ("slip_shape", "position")), default=-np.inf
    )
    if before is not None and shape >= NAME and shape >= rest:
        trials = [c for c in effects if c.name in simulated and c.score > 0.2 * shape]
        tried: list[tuple[Candidate, Confirmed]] = [
            (c, confirm(cases, with_candidate(model, c, study.pool, n_terms), study.uncertainty)) for c in trials
        ]
        details[f"confirmation_{round_ + 1}"] = {c.name: [f.chi2, f.criterion] for c, f in tried} | {
            "believed": [before.chi2, before.criterion]
        }
        if tried:
            tried.sort(key=lambda t: t[1].criterion)
            best, fitted = tried[0]
            gain = before.criterion - fitted.criterion
            lack = LACK_SHARE_SEVERAL if several else LACK_SHARE_ONE
            if gain >= SELECT:
                if fitted.chi2 > fitted.freedom + LACK and fitted.chi2 > lack * before.chi2:
                    return Where(
                        "shape of the friction force within a slip",
                        f"no known effect explains the force within the slips; {best.name} comes closest",
                    )
                class_ = tuple(c.name for c, f in tried[1:] if f.criterion < fitted.criterion + CONFIRMED_CLASS)
                return best, class_, best.score, fitted.model, fitted
        # simulation does not bear the shape out: what remains are effects that change from slip to slip
        effects = [c for c in effects if c.name not in simulated]
        others = [c for c in others if c.name not in ("slip_shape", "position")]
        if not effects:
            return None
    best = effects[0]
    other = others[0] if others else None
    if max(best.score, other.score if other else -np.inf) < NAME:
        return None
    if other is not None and other.score > best.score + max(MARGIN, MARGIN_SHARE * abs(other.score)):
        return Where(other.axis, f"the disagreement lives on the axis: {other.axis}; no known effect explains it")
    if best.score < NAME:
        return None
    near = best.score - max(CLASS, CLASS_SHARE * best.score)
    class_ = tuple(c.name for c in effects[1:] if c.score > near)
    return best, class_, best.score, with_candidate(model, best, study.pool, n_terms), before


def _random(
    study: Study, scatter: Randomness, solution: Solution, named: Sequence[Named]
) -> tuple[str, float, dict[str, float | str], tuple[str, ...]] | Where | None:
    """Return (kind, score, parameters, class) of random friction, or where its scatter is of no known kind."""
    strongest = max(scatter.static, scatter.kinetic)
    if strongest <= 30.0 and scatter.wander <= NAME:
        return None
    remaining = np.exp(2.0 * solution.scatter[:2]).sum() / np.exp(2.0 * study.solution.scatter[:2]).sum()
    if named and remaining < REMAINING_SCATTER:
        return None
    load = float(np.median(study.pool.normal_force))
    sigma_s, sigma_k, _ = np.exp(solution.scatter) / load
    if scatter.two_levels > NAME:
        return Where("scatter", "friction switches at random between two levels")
    believed = study.model.process is not None
    if scatter.wander > NAME and scatter.correlation > 3.0:
        share = max(scatter.wander_share, 1.0e-3)
        mu_s, mu_k = study.solution.coefficients[:2]
        values: dict[str, float | str] = {
            "sigma_s": float(share * mu_s), "sigma_k": float(share * mu_k), "correlation_time": float(scatter.wander_time)
        }  # fmt: skip
        return "correlated_coefficients", scatter.wander, values, ()
    if believed:
        return None
    knots = scatter.within > 0.05 * strongest and scatter.within > 30.0
    values = {"process": "knots" if knots else "per_event", "sigma_s": float(sigma_s), "sigma_k": float(sigma_k)}
    return "random_coefficients", strongest, values, ()
