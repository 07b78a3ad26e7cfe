"""Effects of friction that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import each_stick, warm
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World
from tests.discovery.unseen_forms.third.friction import by_load

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Patir and Cheng 1978; Hu and others 1999 (normal heights that a film lifts: a power 6.8)")
def weakening_of_normal_heights(w: World, a: float) -> None:
    """The film grows as the speed to 0.6, to 1.6 roughnesses; asperities carry a power 6.8 of what it lacks to four."""
    top = w.nominal.peak_speed
    weaken(w, lambda v: max(1.0 - 0.4 * (v / top) ** 0.6, 0.0) ** 6.804, 0.5 * a * w.nominal.gap)


@form("viscous_friction", source="Gecim and Winer 1980 (an oil that yields like a plastic: a hyperbolic tangent)", rig="wedge")
def viscous_of_a_plastic_film(w: World, a: float) -> None:
    """A line at low speed, and nearly the limit of what the film bears at the highest."""
    viscous(w, lambda u: np.tanh(2.0 * u) / np.tanh(2.0), 0.4 * a * w.nominal.gap * w.nominal.normal_force)


@form(
    "dwell_ageing",
    source="Lee and Radok 1960 (a cap of rubber that sinks in while it rests: its compliance to the power 2/3)",
    designs=SEVERAL,
)
def dwell_of_a_sinking_cap(w: World, a: float) -> None:
    """A solid of one relaxation time, 0.8 cycles; it yields two and a half times as much in the end as at once."""
    base, tau, size = w.rig.mu_s, 0.8 * w.nominal.period, 0.6 * a * w.nominal.gap

    def area(dwell):
        return (1.0 - 1.5 * np.expm1(-dwell / tau)) ** (2 / 3)

    usual = area(w.nominal.period)
    w.mu_s = lambda s: base + size * (area(s.dwell) - usual)


@form("frictional_lag", source="Rabinowicz 1951 (round junctions that are drawn off one another: where two circles overlap)")
def lag_of_round_junctions(w: World, a: float) -> None:
    """Nine tenths of the gap fall steadily at first and softly at the end, which is a fifth of a slip."""
    across = 0.2 * w.nominal.slip_length

    def overlap(s: float) -> float:
        u = min(s / across, 1.0)
        return float(np.arccos(u) - u * np.sqrt(1.0 - u * u)) * 2.0 / np.pi

    lag(w, lambda s, t: 0.9 * a * overlap(s))


@form(
    "direction_asymmetry",
    source="Goddard and Wilman 1962 (a tip that ploughs with its blunt side one way: as the root of the load)",
    designs=SEVERAL,
    reversed=True,
    rig="points",
)
def asymmetry_of_a_blunt_side(w: World, a: float) -> None:
    """As stated one way; the other way a groove is ploughed, which counts in full in sliding and by half at rest."""
    rig, more = w.rig, 0.11 * a * np.sqrt(w.normal_force / w.nominal.normal_force)
    other = w.belt_velocity < 0.0
    w.mu_s = lambda s: rig.mu_s * (1.0 + (0.5 * more if other else 0.0))
    w.mu_k = lambda s: rig.mu_k * (1.0 + (more if s.direction < 0.0 else 0.0))


@form(
    "load_dependence",
    source="Byerlee 1978 (rock: in proportion up to a load, and a flatter line beyond it)",
    designs=SEVERAL,
    loads=True,
)
def load_of_two_lines(w: World, a: float) -> None:
    """Up to 0.8 of the usual load the coefficient is level; beyond it the friction force rises 0.55 times as steeply."""

    def level(u: float) -> float:
        return min(1.0, 0.55 + 0.45 * 0.8 / u)

    by_load(w, 1.0 + a * (level(w.normal_force / w.nominal.normal_force) / level(1.0) - 1.0))


@form(
    "presliding_compliance", source="Puzrin and Burland 1996 (soil and rock: a line less a power of a logarithm)", rig="points"
)
def presliding_logarithmic(w: World, a: float) -> None:
    """Six times as stiff at first as on the whole, and level where it lets go."""
    if a <= 0.0:
        return
    way = 6.0
    power = (1.0 + way) * np.log1p(way) / (way * (way - 1.0))
    z = np.linspace(0.0, way, 4001)
    force = 1.01 * z * (1.0 - (way - 1.0) / way * (np.log1p(z) / np.log1p(way)) ** power)
    contact(
        w,
        lambda u: float(np.interp(u * way, z, force)),
        lambda share: float(np.interp(share, force, z)) / way,
        0.13 * a * w.nominal.slip_length,
    )


@form(
    "position_dependent_friction",
    source="Rosenthal 1946 (a belt welded at two places: what the heat has left falls off to either side)",
)
def position_of_two_welds(w: World, a: float) -> None:
    """Two dips a turn, unequally deep and unevenly apart, each a cusp between two exponentials."""
    turn, welds = 11.7 * w.nominal.slip_length, ((0.18, 0.16), (0.61, 0.10))

    def softer(s: State):
        u = (s.travel - s.x) / turn
        return sum(depth * np.exp(-np.abs(np.mod(u - at + 0.5, 1.0) - 0.5) / 0.06) for at, depth in welds)

    scaled(w, lambda s: 1.0 - a * softer(s))


@form(
    "friction_drift",
    source="Crank 1956 (a lining that takes up moisture through its thickness: a root of time, then an exponential)",
    also_one=("distance_drift",),
)
def drift_of_a_damp_lining(w: World, a: float) -> None:
    """Half of a seventh within ten cycles, and nearly all within fifty."""
    time, odd = 50.0 * w.nominal.period, np.arange(1.0, 200.0, 2.0)
    root = np.linspace(0.0, 2.0, 1001)
    taken = 8.0 / np.pi**2 * (-np.expm1(-np.outer(root**2, 0.25 * np.pi**2 * odd**2)) / odd**2).sum(1)
    scaled(w, lambda s: 1.0 + 0.14 * a * np.interp(np.sqrt(s.t / time), root, taken))


@form(
    "distance_drift",
    source="Godet 1984 (third bodies: debris is stored until the contact is full, and flows out from there on)",
    also_one=("friction_drift",),
)
def distance_of_stored_debris(w: World, a: float) -> None:
    """Straight up for eleven slips by an eighth, and exponentially back to less than half of that."""
    full = 11.0 * w.nominal.slip_length

    def debris(u):
        return np.minimum(u, 1.0) + 0.6 * np.expm1(-np.maximum(u - 1.0, 0.0) / 0.8)

    scaled(w, lambda s: 1.0 + 0.125 * a * debris(s.slid / full))


@form(
    "temperature_drift", source="Brunauer, Emmett and Teller 1938 (moist air: the film of water thickens towards the dew point)"
)
def temperature_of_moist_air(w: World, a: float) -> None:
    """The dew point is 13 degC; the colder, the nearer to it, and friction falls with the film, in proportion."""
    warm(w)
    celsius = vars(w)["temperature"]

    def film(c):
        moist = np.exp(17.6 * (13.0 / (243.0 + 13.0) - c / (243.0 + c)))  # Magnus
        return 10.0 * moist / ((1.0 - moist) * (1.0 + 9.0 * moist))

    scaled(w, lambda s: 1.0 - 0.07 * a * (film(celsius(s.t)) - film(20.0)))


@form("random_coefficients", source="Mises 1918; Mardia 1972 (grains that lie askew: the cosine of a normal angle)")
def scatter_of_askew_grains(w: World, a: float) -> None:
    """Most lie nearly straight, and a few across: from a ceiling down, each coefficient by itself; means are as stated."""
    rig, gap, spread = w.rig, w.nominal.gap, 0.8

    def draw(s: State | None) -> None:
        askew = spread * np.clip(w.rng.standard_normal(2), -2.5, 2.5)
        z = (np.cos(askew) - np.exp(-0.5 * spread**2)) * np.sqrt(2.0) / -np.expm1(-(spread**2))
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.11 * a * gap * z[0], rig.mu_k + 0.06 * a * gap * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form("correlated_coefficients", source="Cox 1962; Trent 1977 (a built-up edge: it grows with each slip until it breaks off)")
def correlated_by_a_built_up_edge(w: World, a: float) -> None:
    """One slip of eight breaks it off; it is full after twenty-two."""
    keep, full = 7 / 8, 22
    chance = keep ** np.arange(1, full + 1)
    mean = chance.sum()
    sd = np.sqrt(((2.0 * np.arange(1, full + 1) - 1.0) * chance).sum() - mean**2)

    def turn(s: State | None) -> None:
        age = w.rng.geometric(1.0 - keep) - 1.0 if s is None else w.memory["age"] + 1.0
        w.memory["age"] = 0.0 if s is not None and w.rng.random() > keep else age

    each_stick(w, turn)
    scaled(w, lambda s: 1.0 + 0.05 * a * (min(w.memory["age"], full) - mean) / sd)
