"""Which cases a suite consists of: every form, with experiments and strengths that rotate with the seed."""

from collections.abc import Iterable, Iterator

from .generator import expectation
from .generator.case import Case
from .generator.design import DESIGNS, Design
from .generator.forms import FORMS, Form

TUNING = range(100)
"""Seeds for developing discovery."""
REPORTING = range(1000, 10000)
"""Seeds for the numbers that are reported: nobody looks at their cases while developing, or the numbers mean nothing."""

STRENGTHS = (0.5, 1.0, 0.5, 1.0, 0.3)
"""The tables of what must be reached count 0.5 and above; 0.3 is shown beside them."""

PAIRS = (
    "velocity_weakening.exponential+sensor_outliers.spikes",
    "position_dependent_friction.sinusoidal+viscous_friction.proportional",
    "normal_load_ripple.sinusoidal+sensor_drift.linear",
    "friction_drift.warming+belt_speed_ripple.belt_sinusoidal",
    "position_dependent_friction.square+random_coefficients.per_slip",
    "frictional_lag.slip_distance+friction_drift.linear",
    "harmonic_force.sine+velocity_weakening.rational",
    "nonlinear_stiffness.cubic+sensor_step.one_step",
)
"""Two effects at once: fields of the machine that do not collide."""

_ONE = [DESIGNS[name] for name in ("one_free", "one_forced", "one_free", "one_forced_fast")]
_SEVERAL = [design for design in DESIGNS.values() if design.several_points]


def cases(seeds: Iterable[int]) -> Iterator[Case]:
    """For each seed, every form and pair once at one operating point and once at several."""
    everything = [*FORMS, *PAIRS]
    for seed in seeds:
        for i, forms in enumerate(everything):
            parts = [FORMS[name] for name in forms.split("+")]
            for designs in (_ONE, _SEVERAL):
                suited = [design for design in designs if _shows(parts, design)] or designs
                design = suited[(seed + i) % len(suited)]
                yield Case(forms, design.name, STRENGTHS[(seed + seed // len(suited) + i) % len(STRENGTHS)], seed)


def sampled(everything: list[Case], n: int) -> list[Case]:
    """About n cases spread evenly over the list."""
    if n >= len(everything):
        return everything
    return [everything[(i * len(everything)) // n] for i in range(n)]


def selected(everything: Iterable[Case], kinds: set[str], designs: set[str], strengths: set[float]) -> list[Case]:
    """Cases with one of the kinds (or forms), designs and strengths; an empty set selects all."""

    def wanted(case: Case) -> bool:
        names = {part.kind for part in case.parts} | {part.name for part in case.parts}
        return (
            (not kinds or bool(names & kinds))
            and (not designs or case.design in designs)
            and (not strengths or case.strength in strengths)
        )

    return [case for case in everything if wanted(case)]


def _shows(parts: list[Form], design: Design) -> bool:
    return all(expectation.visible(part.kind, design) for part in parts)
