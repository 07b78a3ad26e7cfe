"""An example of every effect, of a size that shows."""

from __future__ import annotations

from stochfric_mb.effects import Effect, make_effect

EXAMPLES: dict[str, dict[str, float | str]] = {
    "random_coefficients": {"sigma_s": 0.015, "sigma_k": 0.02},
    "correlated_coefficients": {"sigma_s": 0.015, "sigma_k": 0.02, "correlation_time": 3.0},
    "velocity_weakening": {"amplitude": 0.05, "decay_velocity": 5.0e-3},
    "viscous_friction": {"coefficient": 5.0},
    "dwell_ageing": {"rate": 0.02},
    "frictional_lag": {"distance": 1.0e-4},
    "direction_asymmetry": {"asymmetry": 0.1},
    "load_dependence": {"exponent": -0.3, "reference_load": 10.0},
    "presliding_compliance": {"elastic_limit": 1.0e-5},
    "position_dependent_friction": {"amplitude": 0.03, "wavelength": 0.01, "phase": 1.0},
    "position_dependent_force": {"stiffness": 100.0, "zero": 1.0e-3, "amplitude": 0.3, "wavelength": 0.01, "phase": 1.0},
    "friction_drift": {"rate": 0.01},
    "distance_drift": {"rate": 4.0},
    "temperature_drift": {"rate": 0.01},
    "normal_load_ripple": {"amplitude": 0.03, "frequency": 5.0, "phase": 1.0},
    "belt_speed_ripple": {"amplitude": 0.03, "frequency": 5.0, "phase": 1.0},
    "nonlinear_stiffness": {"cubic": 1.0e8},
    "quadratic_damping": {"coefficient": 50.0},
    "backlash": {"gap": 1.0e-4, "position": 1.0e-3},
    "second_mode": {"mass_ratio": 0.05, "frequency": 20.0},
    "joint_compliance": {"load_share": 0.5, "frequency": 5.0},
    "effective_area": {"gradient": 1.0e-4, "zero": 1.0e-3},
    "drive_gain_change": {"rate": -0.02},
    "harmonic_force": {"amplitude": 0.3, "frequency": 5.0, "phase": 1.0},
    "impacts": {"rate": 2.0, "impulse": 0.02},
    "sensor_drift": {"rate": 1.0e-6},
    "sensor_step": {"size": 5.0e-5, "time": 1.0},
    "sensor_clipping": {"high": 2.0e-3},
    "sensor_outliers": {"fraction": 0.01, "size": 2.0e-4},
    "sensor_delay": {"delay": 5.0e-3},
    "stale_samples": {"rate": 3.0, "duration": 0.01},
    "unnamed": {"low": 0.0, "high": 0.06, "change_1": 0.02, "change_3": -0.03, "change_6": 0.05},
}
NOTHING: dict[str, dict[str, float]] = {
    "velocity_weakening": {"amplitude": 0.0},
    "viscous_friction": {"coefficient": 0.0},
    "dwell_ageing": {"rate": 0.0},
    "frictional_lag": {"distance": 1.0e-12},
    "direction_asymmetry": {"asymmetry": 0.0},
    "load_dependence": {"exponent": 0.0},
    "presliding_compliance": {"elastic_limit": 0.0},
    "position_dependent_friction": {"amplitude": 0.0},
    "position_dependent_force": {"amplitude": 0.0, "stiffness": 0.0},
    "friction_drift": {"rate": 0.0},
    "distance_drift": {"rate": 0.0},
    "temperature_drift": {"rate": 0.0},
    "normal_load_ripple": {"amplitude": 0.0},
    "belt_speed_ripple": {"amplitude": 0.0},
    "nonlinear_stiffness": {"cubic": 0.0},
    "quadratic_damping": {"coefficient": 0.0},
    "backlash": {"gap": 0.0},
    "second_mode": {"mass_ratio": 0.0},
    "joint_compliance": {"load_share": 1.0e-6},
    "effective_area": {"gradient": 0.0},
    "drive_gain_change": {"rate": 0.0},
    "harmonic_force": {"amplitude": 0.0},
    "impacts": {"impulse": 0.0},
    "sensor_drift": {"rate": 0.0},
    "sensor_step": {"size": 0.0},
    "sensor_clipping": {"high": float("inf")},
    "sensor_outliers": {"size": 0.0},
    "sensor_delay": {"delay": 0.0},
    "stale_samples": {"duration": 0.0},
    "unnamed": dict.fromkeys([f"change_{i}" for i in range(1, 7)], 0.0),
}
"""Parameters with which an effect does nothing."""


def example(kind: str, **changes: float | str) -> Effect:
    """Return the example of an effect, changed where asked."""
    return make_effect(kind, **(EXAMPLES[kind] | changes))
