"""One run of a driven joint as plain arrays: the only thing that compiled code passes on without cost."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

Array = np.ndarray

SINGLE, CHAIN, ARM = 0.0, 1.0, 2.0
"""Kinds of bodies: one body; motor and load with a spring between them; two links."""

BODY = (
    "kind", "inertia", "inertia_2", "coupling", "rotor", "rotor_2", "damping", "gravity", "gravity_2", "offset", "area",
    "link_stiffness", "link_damping", "half_gap", "link_cubic",
)  # fmt: skip
(
    KIND, INERTIA, INERTIA_2, COUPLING, ROTOR, ROTOR_2, DAMPING, GRAVITY, GRAVITY_2, OFFSET, AREA,
    LINK_STIFFNESS, LINK_DAMPING, HALF_GAP, LINK_CUBIC,
) = range(len(BODY))  # fmt: skip
"""Inertias [kg or kg m^2], gravity moments [N m], a constant force [N or N m] and the spring between motor and load."""

EXTRA = (
    "place", "drive_share", "drive_power", "hold_share", "pressure_share", "memory", "memory_distance", "memory_time",
    "rational", "other_speed", "speed_times_place", "soft_force", "soft_length", "saturation", "dead_zone", "quadratic",
    "speed_lag", "drive_from", "drive_speed", "bend", "base_speed", "limit_forward", "play", "wear", "wear_distance",
    "other_place", "relaxing_stiffness", "relaxing_time",
)  # fmt: skip
(
    PLACE, DRIVE_SHARE, DRIVE_POWER, HOLD_SHARE, PRESSURE_SHARE, MEMORY, MEMORY_DISTANCE, MEMORY_TIME,
    RATIONAL, OTHER_SPEED, SPEED_TIMES_PLACE, SOFT_FORCE, SOFT_LENGTH, SATURATION, DEAD_ZONE, QUADRATIC,
    SPEED_LAG, DRIVE_FROM, DRIVE_SPEED, BEND, BASE_SPEED, LIMIT_FORWARD, PLAY, WEAR, WEAR_DISTANCE,
    OTHER_PLACE, RELAXING_STIFFNESS, RELAXING_TIME,
) = range(len(EXTRA))  # fmt: skip
"""Hidden numbers; 0 switches one off."""

FORWARD, BACKWARD = 0, 1
"""Rows of `by_speed`: friction beyond Coulomb's [N or N m] over the speed."""
FACTOR_AT, FORCE_AT, GAIN_AT, AREA_AT, ONE_WAY_AT = range(5)
"""Rows of `by_place`: factor on friction, force against q [N or N m], factor on the drive, factor on the area, friction that
only forward motion meets [N or N m]."""
FACTOR_OF_TIME, FORCE_OF_TIME, GAIN_OF_TIME, PRESSURE, FACTOR_ON_SPEED, MASS_OF_TIME = range(6)
"""Rows of `by_time`: factor on friction, force along q [N or N m], factor on the drive, pressure [Pa], factor on `by_speed`,
factor on the mass of a single body."""

N_TABLE = 4001
TIME_SPACING = 1e-3


@dataclass(frozen=True)
class Plant:
    """A run's bodies, friction and tables. `by_stroke` is a factor on friction, read at the number of reversals so far."""

    body: dict[str, float]
    coulomb: tuple[float, float]
    """Coulomb friction of each coordinate [N or N m]."""
    top_speed: float
    reach: float
    """Largest speed and place that the tables hold; beyond, their last value stays."""
    by_speed: Array
    by_place: Array
    by_time: Array
    by_stroke: Array = field(default_factory=lambda: np.ones(1))
    extra: dict[str, float] = field(default_factory=dict)

    @property
    def speeds(self) -> Array:
        """Speeds at which `by_speed` is given, (n,) [m/s or rad/s]."""
        return np.linspace(0.0, self.top_speed, N_TABLE)

    @property
    def places(self) -> Array:
        """Places at which `by_place` is given, (n,) [m or rad]."""
        return np.linspace(-self.reach, self.reach, N_TABLE)

    @property
    def times(self) -> Array:
        """Times at which `by_time` is given, (n,) [s]; the record begins at 0."""
        return np.arange(self.by_time.shape[1]) * TIME_SPACING

    @property
    def level(self) -> float:
        """Coulomb friction where the effect sits [N or N m]."""
        return self.coulomb[int(self.extra.get("place", 0))]

    def with_extra(self, **numbers: float) -> "Plant":
        return replace(self, extra=self.extra | numbers)

    def with_body(self, **numbers: float) -> "Plant":
        return replace(self, body=self.body | numbers)

    def add_by_speed(self, forward: Callable[[Array], Array], backward: Callable[[Array], Array] | None = None) -> "Plant":
        """Further friction of this form; backward as forward if it is not given."""
        rows = np.stack([forward(self.speeds), (backward or forward)(self.speeds)])
        return replace(self, by_speed=self.by_speed + rows)

    def times_at_place(self, row: int, factor: Callable[[Array], Array]) -> "Plant":
        table = self.by_place.copy()
        table[row] *= factor(self.places)
        return replace(self, by_place=table)

    def add_force_at(self, force: Callable[[Array], Array], row: int = FORCE_AT) -> "Plant":
        table = self.by_place.copy()
        table[row] += force(self.places)
        return replace(self, by_place=table)

    def times_in_time(self, row: int, factor: Callable[[Array], Array]) -> "Plant":
        table = self.by_time.copy()
        table[row] *= factor(self.times)
        return replace(self, by_time=table)

    def add_in_time(self, row: int, value: Callable[[Array], Array]) -> "Plant":
        table = self.by_time.copy()
        table[row] += value(self.times)
        return replace(self, by_time=table)

    def packed(self) -> tuple[Array, ...]:
        """Arguments of the compiled code, in its order."""
        endless = dict.fromkeys(
            ("memory_distance", "memory_time", "wear_distance", "saturation", "base_speed", "limit_forward"), np.inf
        )
        extra = endless | {"drive_power": 1.0} | self.extra
        return (
            np.array([self.body.get(name, 0.0) for name in BODY]),
            np.array([extra.get(name, 0.0) for name in EXTRA]),
            np.array(self.coulomb),
            np.array([self.top_speed, self.reach]),
            np.ascontiguousarray(self.by_speed),
            np.ascontiguousarray(self.by_place),
            np.ascontiguousarray(self.by_time),
            np.ascontiguousarray(self.by_stroke, dtype=np.float64),
        )


def plain_plant(
    body: dict[str, float], coulomb: tuple[float, float], *, top_speed: float, reach: float, duration: float
) -> Plant:
    """A plant with nothing hidden in it."""
    n = round(duration / TIME_SPACING) + 2
    places = np.ones((5, N_TABLE))
    places[FORCE_AT], places[ONE_WAY_AT] = 0.0, 0.0
    times = np.ones((6, n))
    times[FORCE_OF_TIME], times[PRESSURE] = 0.0, 0.0
    return Plant(body, coulomb, top_speed, reach, np.zeros((2, N_TABLE)), places, times)
