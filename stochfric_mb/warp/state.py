# type: ignore
# (kernels are typed by Warp)
"""What friction keeps on the device: numbers of each world, and a slot for each contact of each world, twice.

A step reads the slots that the step before wrote and writes the other set (`Slots`, first index), so that a step which is
evaluated again finds the same past. All arrays keep their addresses, as captured graphs need.
"""

import warp as wp

STICK = wp.constant(0)
SLIP = wp.constant(1)

vec5 = wp.types.vector(length=5, dtype=wp.float32)


@wp.struct
class Worlds:
    """Numbers of each world, shape (nworld,) or (nworld, n)."""

    last_time: wp.array[float]
    count: wp.array[int]
    """Accepted steps since the world began; -1 before the first."""
    fresh: wp.array[int]
    """1 if this evaluation begins a step, 0 if it repeats one."""
    episode: wp.array[int]
    """Times that the world began, less one."""
    first_sample: wp.array[wp.int64]
    """Second part of the address of the world's coefficient path in its first episode."""
    sample: wp.array[wp.int64]
    """The same in this episode."""
    descriptor: wp.array2d[wp.float64]
    cursor: wp.array2d[wp.float64]
    parameters: wp.array2d[float]
    """The law's parameters, as `Law.parameters`."""
    stick_speed: wp.array[float]
    """Speed below which a new contact sticks [m/s]."""
    peak_speed: wp.array[float]
    """Speed at which a law that creeps at rest has its largest coefficient [m/s]; 0 for other laws."""
    mu_s: wp.array[float]
    mu_k: wp.array[float]
    overflow: wp.array[int]
    """Contacts that found no slot since the world began."""
    means: wp.array[wp.float64]
    """Descriptor of the law's mean coefficients, drawn for each episode; empty: they are given."""
    spreads: wp.array2d[wp.float64]
    """A row for each further parameter that is drawn for each episode: see `stochfric_mb.warp.domain`."""
    v_s: int
    """Place of the stick speed among the parameters, -1 if the law has none."""
    peak_ratio: float
    """Peak speed over stick speed [-]."""
    origin: wp.float64
    """Displacement at which coefficient paths along a contact's own path begin [m]."""
    stride: wp.int64
    """What is added to a world's sample with each episode."""


@wp.struct
class Slots:
    """Contacts, shape (2, n_slots, nworld); the set ``count % 2`` is the present one.

    Worlds lie side by side, so that slots which no world uses cost nothing.
    """

    used: wp.array2d[int]
    """Number of slots in use, shape (2, nworld)."""
    geoms: wp.array3d[wp.vec2i]
    rows: wp.array3d[wp.vec2i]
    """First constraint row of the contact, and its number of rows."""
    axis_1: wp.array3d[wp.vec3]
    axis_2: wp.array3d[wp.vec3]
    """Tangents of the contact, in world coordinates."""
    side: wp.array3d[int]
    """1 if the friction's first geom is the contact's first, -1 if it is the second."""
    place: wp.array3d[wp.vec3]
    """Position of the contact relative to its second geom [m]."""
    friction: wp.array3d[vec5]
    """What the solver was given."""
    scale: wp.array3d[float]
    """What the tangential rows of the solver's Jacobian were multiplied by [-], and so their forces divided by."""
    mu_s: wp.array3d[float]
    mu_k: wp.array3d[float]
    normal: wp.array3d[float]
    """The solver's normal force [N]."""
    pull: wp.array3d[wp.vec3]
    """The solver's friction force, on the contact's second geom [N], in world coordinates."""
    saturated: wp.array3d[int]
    """1 where the friction force reached its cap."""
    loose: wp.array3d[int]
    """1 where it did so at every contact of the same two bodies."""
    drift: wp.array3d[wp.vec3]
    """Displacement since the contact stuck [m], in world coordinates."""
    velocity: wp.array3d[wp.vec3]
    """Relative velocity at the step's start [m/s], likewise."""
    creep: wp.array3d[float]
    """Speed at which a law that creeps at rest has the force at hand [m/s]."""
    springs: wp.array3d[int]
    """Whether, stuck, it is the spring of an elastic law."""
    path: wp.array3d[wp.float64]
    """Displacement along the contact's direction since it began [m]."""
    events: wp.array3d[int]
    """Number of stick phases that have begun."""
    cursor: wp.array4d[wp.float64]
    """Cursors of the contacts' own coefficient paths; empty where coefficients run along time."""
    mode: wp.array3d[int]
    """STICK or SLIP."""


@wp.struct
class Rows:
    """A joint or tendon, shape (2, nworld); the set ``count % 2`` is the present one."""

    row: wp.array2d[int]
    """Its constraint row, -1 if it has none."""
    cap: wp.array2d[float]
    """Friction force or torque that the solver was allowed [N or N m]."""
    force: wp.array2d[float]
    """The solver's friction force or torque [N or N m]."""
    drift: wp.array2d[float]
    """Displacement since it stuck [m or rad]."""
    creep: wp.array2d[float]
    """Speed at which a law that creeps at rest has the force at hand [m/s or rad/s]."""
    springs: wp.array2d[int]
    """Whether, stuck, it is the spring of an elastic law."""
    path: wp.array2d[wp.float64]
    """Displacement since the world began [m or rad]."""
    mu_s: wp.array2d[float]
    mu_k: wp.array2d[float]
    events: wp.array2d[int]
    """Number of stick phases that have begun."""
    mode: wp.array2d[int]
    """STICK or SLIP."""
