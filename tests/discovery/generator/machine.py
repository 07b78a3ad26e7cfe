"""Everything the simulator must know about one run: constants, curves and signals over time."""

from typing import NamedTuple

import numpy as np

from .curve import Array, Curve, constant, line

SIGNAL_SPACING = 1e-3
STATIC, KINETIC, LOAD, BELT, FORCE, STIFFNESS = range(6)
"""Columns of `Machine.signals`: mu_s [-], mu_k [-], normal force [N], belt velocity [m/s], applied force [N],
spring factor [-]."""


class Machine(NamedTuple):
    """One run of the rig. A machine without effects keeps the defaults of `plain_machine`."""

    mass: float
    spring: Curve
    """Force over position [N over m]."""
    damper: Curve
    """Force over velocity [N over m/s]."""
    start: float
    """Record time at which the signals begin [s]: negative, the burn-in."""
    signals: Array
    """Shape (n, 6), every millisecond."""

    sliding: Curve
    """Factor of mu_k over the relative speed (or its delayed value) [- over m/s]."""
    speed_delay: float
    """Relaxation time of the relative speed that `sliding` sees [s]; 0: none."""
    memory_of_distance: Curve
    """Share of mu_s - mu_k that survives, over distance slipped since break-away [- over m]."""
    memory_of_time: Curve
    """The same over time since break-away [- over s]."""
    ageing: Curve
    """Factor of mu_s over the logarithm of dwell [- over ln(s)]."""
    belt_surface: Curve
    """Factor of both coefficients over the place on the belt [- over m]."""
    stroke: Curve
    """Factor of both coefficients over position [- over m]."""
    forward_factor: float
    """Factor of both coefficients when v_rel > 0."""
    backward_factor: float
    """The same when v_rel < 0."""

    static_by_slip: Array
    """Factor of mu_s in the stick before slip i, repeated."""
    kinetic_by_slip: Array
    """Factor of mu_k in slip i, repeated."""
    force_by_slip: Array
    """Force applied during slip i [N], repeated."""

    creep: Curve
    """Creep velocity in stick over the share of the static limit in use [m/s over -]."""
    contact_length: float
    """Deflection of the contact at break-away [m]; 0: rigid stick."""
    contact_shape: Curve
    """Share of the static limit over deflection / contact_length; odd, reaches 1 at 1."""
    contact_damping: float
    """Damping of the stuck contact [N s/m]."""

    second_mass: float
    """Mass of a second body [kg]; 0: none."""
    link_stiffness: float
    """Between box and second body [N/m]."""
    link_damping: float
    ground_stiffness: float
    """Between second body and wall [N/m]."""
    ground_damping: float

    @property
    def time(self) -> Array:
        """Record times of the signals, shape (n,) [s]."""
        return self.start + SIGNAL_SPACING * np.arange(self.signals.shape[0])

    def scaled(self, column: int, factor: Array | float) -> "Machine":
        """A signal multiplied by a factor over time."""
        signals = self.signals.copy()
        signals[:, column] *= factor
        return self._replace(signals=signals)

    def pushed(self, force: Array) -> "Machine":
        """A further applied force over time [N]."""
        signals = self.signals.copy()
        signals[:, FORCE] += force
        return self._replace(signals=signals)


def plain_machine(
    *,
    mass: float,
    damping: float,
    stiffness: float,
    normal_force: float,
    belt_velocity: float,
    mu_s: float,
    mu_k: float,
    excitation_amplitude: float = 0.0,
    excitation_angular_frequency: float = 0.0,
    burn_in: float = 0.0,
    duration: float = 60.0,
) -> Machine:
    """The rig without effects, SI units; its record runs from -burn_in to duration."""
    start = -round(burn_in / SIGNAL_SPACING) * SIGNAL_SPACING
    n = round((duration - start) / SIGNAL_SPACING) + 2
    time = start + SIGNAL_SPACING * np.arange(n)
    signals = np.empty((n, 6))
    signals[:, STATIC] = mu_s
    signals[:, KINETIC] = mu_k
    signals[:, LOAD] = normal_force
    signals[:, BELT] = belt_velocity
    signals[:, FORCE] = stiffness * excitation_amplitude * np.cos(excitation_angular_frequency * time)
    signals[:, STIFFNESS] = 1.0
    return Machine(
        mass=mass,
        spring=line(stiffness),
        damper=line(damping),
        start=start,
        signals=signals,
        sliding=constant(1.0),
        speed_delay=0.0,
        memory_of_distance=constant(0.0),
        memory_of_time=constant(0.0),
        ageing=constant(1.0),
        belt_surface=constant(1.0),
        stroke=constant(1.0),
        forward_factor=1.0,
        backward_factor=1.0,
        static_by_slip=np.ones(1),
        kinetic_by_slip=np.ones(1),
        force_by_slip=np.zeros(1),
        creep=constant(0.0),
        contact_length=0.0,
        contact_shape=line(1.0),
        contact_damping=0.0,
        second_mass=0.0,
        link_stiffness=0.0,
        link_damping=0.0,
        ground_stiffness=0.0,
        ground_damping=0.0,
    )
