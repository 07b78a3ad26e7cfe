"""What the paper leaves open, the default taken, and what a change of it does; and whether the two laws agree."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from stochfric_mb import ensemble, statistics
from stochfric_mb.coefficients import Knots
from stochfric_mb.ensemble import EnsembleResult
from stochfric_mb.reference import solve
from stochfric_mb.reproduction.claims import FAILS, HOLDS, UNDECIDABLE, Claim, Number, of_estimate
from stochfric_mb.reproduction.output_step import distance, values
from stochfric_mb.reproduction.settings import Settings
from stochfric_mb.scenario import Scenario

Tick = Callable[[int], None]

DURATION = 10.0
"""Length of the deterministic runs [s]; Table 1 settles within the first cycles."""
ALIKE = 0.01
"""Relative difference up to which two responses are alike [-]."""
VARIED: tuple[tuple[str, str, str], ...] = (
    ("havsin", "v_s", "m/s"),
    ("havsin", "v_d", "m/s"),
    ("elastic_stick", "e_lim", "m"),
    ("elastic_stick", "zeta", "-"),
    ("elastic_stick", "v_s", "m/s"),
    ("elastic_stick", "decay_velocity", "m/s"),
)
"""Law, parameter and unit of each default that is halved and doubled."""
SPACING = ("coulomb", "havsin", "elastic_stick")
"""Laws whose knot spacing is halved and doubled."""


@dataclasses.dataclass(frozen=True)
class Response:
    """What a law does in Table 1."""

    period: float
    """Interval between the last two break-aways without randomness [s]."""
    x_break_away: float
    """Position at the last break-away without randomness [m]."""
    mu_s: statistics.Estimate | None
    """Mean mu_s at break-away with randomness [-]."""
    least_v_rel: float
    """Smallest relative velocity without randomness [m/s]."""


@dataclasses.dataclass(frozen=True)
class Sensitivity:
    """One default, halved and doubled."""

    law: str
    """Law."""
    parameter: str
    """Name of the parameter."""
    unit: str
    """Its unit."""
    default: float
    """Default."""
    responses: tuple[tuple[float, Response], ...]
    """Value and response, for half the default, the default and twice the default."""

    @property
    def swing(self) -> float:
        """Largest relative change of the period [-]."""
        base = self.responses[1][1].period
        return max(abs(r.period / base - 1.0) for _, r in self.responses)

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON."""
        base = self.responses[1][1]
        rows = [
            {"value": v, "period": r.period, "period_change": r.period / base.period - 1.0, "x_break_away": r.x_break_away,
             "x_break_away_change": r.x_break_away / base.x_break_away - 1.0, "least_v_rel": r.least_v_rel,
             "break_away_mu_s": dataclasses.asdict(r.mu_s) if r.mu_s else None}
            for v, r in self.responses
        ]  # fmt: skip
        return {"law": self.law, "parameter": self.parameter, "unit": self.unit, "default": self.default, "responses": rows}


@dataclasses.dataclass(frozen=True)
class Gap:
    """Something that the paper leaves open."""

    gap: str
    """What."""
    default: str
    """What is taken."""
    effect: str
    """What it changes, measured."""


def n_responses() -> int:
    """Return how many responses `vary` computes."""
    return 3 * (len(VARIED) + len(SPACING))


def vary(scenarios: Mapping[str, Scenario], settings: Settings, seed: int, tick: Tick) -> list[Sensitivity]:
    """Return what halving and doubling each default does to Table 1.

    Args:
        scenarios: law -> scenario with knots.
        settings: sizes.
        seed: of the coefficients.
        tick: called with the number of responses done.
    """
    items: list[Sensitivity] = []
    for law, name, unit in VARIED:
        default = float(getattr(scenarios[law].law, name))
        rows: list[tuple[float, Response]] = []
        for factor in (0.5, 1.0, 2.0):
            changed = dataclasses.replace(scenarios[law].law, **{name: factor * default})
            rows.append((factor * default, response(dataclasses.replace(scenarios[law], law=changed), settings, seed)))
            tick(3 * len(items) + len(rows))
        items.append(Sensitivity(law, name, unit, default, tuple(rows)))
    for law in SPACING:
        process = scenarios[law].process
        assert isinstance(process, Knots)
        rows = []
        for factor in (0.5, 1.0, 2.0):
            changed = dataclasses.replace(process, spacing=factor * process.spacing)
            rows.append((changed.spacing, response(dataclasses.replace(scenarios[law], process=changed), settings, seed)))
            tick(3 * len(items) + len(rows))
        items.append(Sensitivity(law, "knot spacing", "s", process.spacing, tuple(rows)))
    return items


def response(scenario: Scenario, settings: Settings, seed: int) -> Response:
    """Return the response of a scenario: its late period and break-away without randomness, its mean mu_s with it."""
    problem = (scenario.mechanism, scenario.law, None)
    run = solve(*problem, np.arange(0.0, DURATION + 5.0e-4, 1.0e-3))
    breaks = run.events[run.events[:, 1] == 1.0, 0]
    x = float(solve(*problem, [breaks[-1]]).position[0])
    random = ensemble.run(scenario, settings.n_sensitivity, seed=seed, output_times=[scenario.duration], threads=2)
    v = float(np.min(scenario.mechanism.belt_velocity - run.velocity[1:]))
    return Response(float(breaks[-1] - breaks[-2]), x, statistics.event_statistics(random).break_away_mu_s, v)


def gaps(
    scenarios: Mapping[str, Scenario], forced: Scenario, varied: list[Sensitivity], settings: Settings, seed: int
) -> list[Gap]:
    """Return every gap with the default taken and its measured effect."""
    swing = {
        (s.law, s.parameter): f"period changes by at most {100 * s.swing:.2g} % when it is halved or doubled" for s in varied
    }
    elastic = scenarios["elastic_stick"]
    assert elastic.process is not None
    law: Any = elastic.law
    part = elastic.process.sigma_s / law.mu_s
    shifts = [
        _period(dataclasses.replace(elastic, law=dataclasses.replace(law, e_lim=law.e_lim * f)))
        for f in (1 - part, 1, 1 + part)
    ]
    stiff = max(abs(p / shifts[1] - 1.0) for p in (shifts[0], shifts[2]))
    backward = {k: next(s for s in varied if s.law == k).responses[1][1].least_v_rel for k in ("havsin", "elastic_stick")}
    m = forced.mechanism
    omitted = m.damping * m.excitation_angular_frequency / m.stiffness
    decay = f"{1.0 / law.decay_velocity:g} s/m"
    slow = _period(dataclasses.replace(elastic, law=dataclasses.replace(law, decay_velocity=10.0 * law.decay_velocity)))
    tenth = f"by {100 * abs(slow / shifts[1] - 1.0):.2g} % at a tenth of the rate"
    negative = 0.5 * math.erfc(law.mu_k / elastic.process.sigma_k / math.sqrt(2.0))
    speeds = " and ".join(f"{1e3 * _of(scenarios['havsin'], name):g}" for name in ("v_s", "v_d"))
    at = f"{m.excitation_angular_frequency:g} rad/s"
    return [
        Gap("eq. 6 lost its superscript; a depends on the unit of v_r", f"mu = a^-(v_r + b) + mu_k, decay rate {decay}",
            f"{swing['elastic_stick', 'decay_velocity']}, {tenth}"),
        Gap("eq. 5 lost its root", "c_stick = 2 zeta sqrt(k_stick m)", swing["elastic_stick", "zeta"] + " (zeta)"),
        Gap("v_r < 0", "odd extension",
            "least v_r in Table 1 from rest: " + ", ".join(f"{k} {1e3 * v:.3g} mm/s" for k, v in backward.items())),
        Gap("v_s, v_d of the modified Coulomb law", f"{speeds} mm/s",
            f"v_s: {swing['havsin', 'v_s']}; v_d: {swing['havsin', 'v_d']}"),
        Gap("v_s of the elastic stick law", f"{1e3 * law.v_s:g} mm/s", swing["elastic_stick", "v_s"]),
        Gap("e_lim", f"{1e6 * law.e_lim:g} um", swing["elastic_stick", "e_lim"]),
        Gap("zeta", f"{law.zeta:g}", swing["elastic_stick", "zeta"]),
        Gap("slip and re-stick rule (figure 3b is a picture)", "break-away at the limit of the deflection, stick again at v_s",
            "not varied: no other rule that the figure would allow is at hand"),
        Gap("k_stick from the mean of mu_s or from mu_s(t)", "the mean",
            f"period changes by at most {100 * stiff:.2g} % when k_stick changes by one sigma_s ({100 * part:.2g} %)"),
        Gap('sigma_k "about 5 % of the mean"', "the tables", "see the claims sigma_k"),
        Gap("eq. 7 omits c u'", "eq. 7 as it is", f"the omitted force is {100 * omitted:.2g} % of k u_0 at {at}"),
        Gap("mu_k < 0 draws", "redrawn too", f"probability {negative:.0e} a pair in Table 1"),
        Gap("knot spacing (the paper's output step)", f"{_spacing(elastic):g} s, fixed",
            "; ".join(_mu_swing(s) for s in varied if s.parameter == "knot spacing")),
    ]  # fmt: skip


def _mu_swing(s: Sensitivity) -> str:
    shown = ", ".join("-" if r.mu_s is None else f"{r.mu_s.value:.4f}" for _, r in s.responses)
    return f"mean mu_s at break-away {shown} when halved, as it is, doubled ({s.law})"


def _of(scenario: Scenario, name: str) -> float:
    return float(getattr(scenario.law, name))


def _spacing(scenario: Scenario) -> float:
    assert scenario.process is not None
    return scenario.process.knot_spacing


def _period(scenario: Scenario) -> float:
    events = solve(scenario.mechanism, scenario.law, None, [DURATION]).events
    breaks = events[events[:, 1] == 1.0, 0]
    return float(breaks[-1] - breaks[-2])


def laws_claim(varied: list[Sensitivity], ensembles: Mapping[str, Mapping[float, EnsembleResult]], settings: Settings) -> Claim:
    """Return the claim that the modified Coulomb law and the elastic stick law give the same response.

    Args:
        varied: sensitivities, whose middle responses are the defaults'.
        ensembles: law -> output step -> runs at the times of the settings.
        settings: sizes.
    """
    base = {law: next(s for s in varied if s.law == law).responses[1][1] for law in ("havsin", "elastic_stick")}
    a, b = base["havsin"].period, base["elastic_stick"].period
    gap = abs(a / b - 1.0)
    open_swing = max(s.swing for s in varied if s.parameter != "knot spacing")
    verdict = HOLDS if max(gap, open_swing) <= ALIKE else FAILS if gap - open_swing > ALIKE else UNDECIDABLE
    numbers = [
        *(
            Number(name=f"period_{law}", label=f"deterministic period, {law}", value=r.period, unit="s")
            for law, r in base.items()
        ),
        Number(name="relative_difference", label="relative difference of the periods", value=gap),
        Number(name="default_swing", label="largest relative change of a period when a default is halved or doubled",
               value=open_swing),
        *(
            of_estimate(f"break_away_mu_s_{law}", f"mean mu_s at break-away, {law}", r.mu_s, n=settings.n_sensitivity)
            for law, r in base.items()
        ),
    ]  # fmt: skip
    step = settings.steps[0]
    for i, t in enumerate(settings.times):
        x, y = (values(ensembles[law][step], "position", i) for law in ("havsin", "elastic_stick"))
        numbers.append(distance(f"ks_{t:g}s", f"havsin and elastic_stick, x({t:g} s), step {step:g} s", x, y, settings))
    return Claim(
        id="laws_alike",
        claim="The modified Coulomb law and the elastic stick law give the same response",
        where="section 2.1",
        test="late deterministic period of Table 1 under both laws with our defaults, against what halving or doubling a "
        "default that the paper does not give does to it; distributions of displacement for comparison",
        rule=f"holds if difference and swing are both within {ALIKE:.0%}; fails if the difference exceeds the swing by more "
        f"than {ALIKE:.0%}; undecidable otherwise: then the values that the paper does not give decide",
        verdict=verdict,
        reason=f"The periods differ by {100 * gap:.2g} %; a default that is left open changes one by {100 * open_swing:.2g} %",
        numbers=tuple(numbers),
        remark="The wording is ours. The paper gives neither v_s, v_d, e_lim, zeta nor the decay of eq. 6.",
    )
