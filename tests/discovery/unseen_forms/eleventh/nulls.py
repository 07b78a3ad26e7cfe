"""Records of rigs that are as believed, with what real records have besides: nothing is missing."""

from __future__ import annotations

from tests.discovery.unseen_forms.forms import NONE, each_stick, steady_noise
from tests.discovery.unseen_forms.motion import World

from .enter import form

LIMITS = "JCGM 100:2008 (every believed number two standard deviations off)"


@form(NONE, source="Keshner 1982 (1/f noise, a fourth louder)", rig="film", noise="pink", loudness=1.25)
def noise_pink(w: World, a: float) -> None:
    """Noise without a corner, as of cheap amplifiers."""


@form(NONE, source="Matern 1960 (zero that wanders smoothly, by 0.7 of the noise, over eight cycles)", rig="ski")
def zero_wanders(w: World, a: float) -> None:
    """Less than the noise of one reading."""

    def sensor(t, motion, rng):
        return motion.position + 0.7 * w.nominal.noise * steady_noise(rng, w.duration, 8.0 * w.nominal.period, order=2)(t)

    w.sensor = sensor


@form(NONE, source="Widrow and Kollar 2008 (steps of six and a half times the noise)", rig="needle", quantum=6.5)
def quantised(w: World, a: float) -> None:
    """Coarse, though far finer than a slip."""


@form(NONE, source="Balakrishnan 1962 (sampling instants uncertain by as much as the noise)", rig="crane", jitter=0.023)
def clock_jitters(w: World, a: float) -> None:
    """Stamps are even."""


@form(NONE, source=LIMITS, rig="damper", at_limits=True)
def limits_damper(w: World, a: float) -> None:
    """As far off as is stated, each up or down by chance."""


@form(
    NONE,
    source=f"{LIMITS}; noise of neighbours is alike (Box and Jenkins 1970), one sample of thirty is lost, and a cycle",
    rig="cantilever",
    at_limits=True,
    noise="coloured",
    missing=0.033,
    gap=1.0,
)
def limits_cantilever(w: World, a: float) -> None:
    """The same, noise of first order, and a pause of the logger."""


@form(
    NONE,
    source="Kang, Choi and Yoo 2015, section 2.2 (declared, a pair for each stick)",
    rig="film",
    declared="per_event",
    declared_sigma=0.005,
)
def scatter_declared(w: World, a: float) -> None:
    """What scatters is what the scenario says."""
    rig = w.rig

    def draw(s) -> None:
        z = w.rng.standard_normal(2)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.005 * z[0], rig.mu_k + 0.005 * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form(NONE, source="Uhlenbeck and Ornstein 1930 (declared)", rig="crane", declared="ornstein_uhlenbeck", declared_sigma=0.004)
def scatter_declared_correlated(w: World, a: float) -> None:
    """What wanders does so as the scenario says."""
    rig, (z, y) = w.rig, (steady_noise(w.rng, w.duration, w.nominal.period) for _ in range(2))
    w.mu_s, w.mu_k = lambda s: rig.mu_s + 0.004 * z(s.t), lambda s: rig.mu_k + 0.004 * y(s.t)
