"""What a perfect analyst could answer: which effects an experiment can see, and which names its data cannot tell apart."""

from .design import Design

UNKNOWN = "unknown"
NONE = "none"


def visible(kind: str, design: Design) -> bool:
    """Whether the experiment can show the effect at all."""
    varied = design.varied
    if kind == "load_dependence":
        return "normal_force" in varied
    if kind == "direction_asymmetry":
        return "direction" in varied
    if kind == "dwell_ageing":  # dwell is constant otherwise
        return design.forced or "belt_velocity" in varied or "normal_force" in varied
    return True


def acceptable(kind: str, design: Design) -> frozenset[str]:
    """Names that are right for the effect in this experiment: the table of what cannot be told apart."""
    if kind in (UNKNOWN, NONE):
        return frozenset({kind})
    if not visible(kind, design):
        return frozenset({NONE, kind})
    names = {kind}
    varied = design.varied
    several_speeds = "belt_velocity" in varied
    for group, told_apart in (
        ({"position_dependent_friction", "normal_load_ripple"}, several_speeds),
        ({"viscous_friction", "quadratic_damping", "velocity_weakening"}, several_speeds and "normal_force" in varied),
        ({"backlash", "second_mode"}, False),
        ({"sensor_drift", "friction_drift"}, False),
    ):
        if kind in group and not told_apart:
            names |= group
    return frozenset(names)
