"""What a perfect analyst could answer: which effects an experiment can see, and which names its data cannot tell apart."""

from .design import Design
from .forms import Form

UNKNOWN = "unknown"
NONE = "none"


_SPEEDS, _LOADS, _DIRECTION = "belt_velocity", "normal_force", "direction"


def visible(kind: str, design: Design) -> bool:
    """Whether the experiment can show the effect at all."""
    varied = design.varied
    if kind == "load_dependence":
        return _LOADS in varied
    if kind == "direction_asymmetry":
        return _DIRECTION in varied
    if kind == "dwell_ageing":  # dwell is constant otherwise: forced motion locks to the forcing within the burn-in
        return _SPEEDS in varied or _LOADS in varied
    return True


def acceptable(form: Form, design: Design) -> frozenset[str]:
    """Names that are right for the form in this experiment: the table of what cannot be distinguished."""
    kind = form.kind
    if kind in (UNKNOWN, NONE):
        return frozenset({kind}) | form.also
    if not visible(kind, design):
        return frozenset({NONE, kind})
    names = {kind} | form.also
    varied = design.varied
    for group, separable in (
        ({"position_dependent_friction", "normal_load_ripple"}, _SPEEDS in varied),
        ({"viscous_friction", "quadratic_damping", "velocity_weakening"}, _SPEEDS in varied and _LOADS in varied),
        ({"backlash", "second_mode"}, False),
        ({"sensor_drift", "harmonic_force"}, False),
    ):
        if kind in group and not separable:
            names |= group
    return frozenset(names)
