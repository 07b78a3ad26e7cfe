"""Where each effect shows, in words for a reader."""

from __future__ import annotations

from stochfric_mb.discovery.result import Where
from stochfric_mb.effects import effect_class

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
    if kind in WHERE:
        return Where(*WHERE[kind])
    cls = effect_class(kind)
    return Where(cls.shows_on or kind, cls.shows or f"{kind} explains the disagreement")
