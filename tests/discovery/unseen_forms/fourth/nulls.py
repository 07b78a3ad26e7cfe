"""Records of rigs that are as believed, with what real records have besides: nothing is missing."""

from __future__ import annotations

from tests.discovery.unseen_forms.forms import NONE, each_stick, steady_noise, warm
from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World
from tests.discovery.unseen_forms.rigs import DEFAULT_UNCERTAINTY

from .enter import form

LIMITS = "JCGM 100:2008 (every believed number two standard deviations off)"
LOOSE = {"mass": 0.02, "stiffness": 0.04, "damping": 0.4, "normal_force": 0.03, "mu_s": 0.08, "mu_k": 0.08}
"""Relative standard deviations of a rig that nobody has measured well [-]."""


@form(NONE, source="a pin on a strip", rig="tribometer")
def plain_tribometer(w: World, a: float) -> None:
    pass


@form(NONE, source="a feed axis", rig="axis")
def plain_axis(w: World, a: float) -> None:
    pass


@form(NONE, source="Leonardo's sled", rig="sled")
def plain_sled(w: World, a: float) -> None:
    pass


@form(NONE, source="a tactile probe", rig="probe")
def plain_probe(w: World, a: float) -> None:
    pass


@form(NONE, source="a block on a turntable", rig="turntable")
def plain_turntable(w: World, a: float) -> None:
    pass


@form(NONE, source="Keshner 1982 (1/f noise)", rig="axis", noise="pink")
def noise_pink(w: World, a: float) -> None:
    pass


@form(NONE, source="Uhlenbeck and Ornstein 1930 (zero that wanders by half the noise)", rig="tribometer")
def zero_wanders(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        return motion.position + 0.5 * w.nominal.noise * steady_noise(rng, w.duration, 8.0 * w.nominal.period)(t)

    w.sensor = sensor


@form(NONE, source="Widrow and Kollar 2008 (steps of five times the noise)", rig="probe", quantum=5.0)
def quantised(w: World, a: float) -> None:
    pass


@form(NONE, source="Balakrishnan 1962 (sampling instants uncertain by as much as the noise at most)", rig="axis", jitter=0.03)
def clock_jitters(w: World, a: float) -> None:
    pass


@form(NONE, source="Marvasti 2001 (stamps rounded to a tenth of a millisecond)", rig="turntable", rate=3000.0, stamp=1.0e-4)
def stamps_rounded(w: World, a: float) -> None:
    pass


@form(NONE, source=LIMITS, rig="tribometer", at_limits=True)
def limits_tribometer(w: World, a: float) -> None:
    pass


@form(NONE, source=LIMITS, rig="sled", at_limits=True)
def limits_sled(w: World, a: float) -> None:
    pass


@form(NONE, source=LIMITS, rig="turntable", at_limits=True)
def limits_turntable(w: World, a: float) -> None:
    pass


@form(
    NONE,
    source="JCGM 100:2008 (nothing stated: what the page says is taken then)",
    rig="axis",
    uncertainty=DEFAULT_UNCERTAINTY,
    unstated=True,
)
def uncertainty_unstated(w: World, a: float) -> None:
    pass


@form(NONE, source="JCGM 100:2008 (stated loosely, and off by as much)", rig="probe", uncertainty=LOOSE, at_limits=True)
def uncertainty_loose(w: World, a: float) -> None:
    pass


@form(
    NONE,
    source="Kang, Choi and Yoo 2015, section 2.2 (declared, a pair for each stick)",
    rig="probe",
    declared="per_event",
    declared_sigma=0.03,
)
def scatter_declared(w: World, a: float) -> None:
    rig = w.rig

    def draw(s) -> None:
        z = w.rng.standard_normal(2)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.03 * z[0], rig.mu_k + 0.03 * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form(NONE, source="Uhlenbeck and Ornstein 1930 (declared)", rig="axis", declared="ornstein_uhlenbeck", declared_sigma=0.006)
def scatter_declared_correlated(w: World, a: float) -> None:
    rig, (z, y) = w.rig, (steady_noise(w.rng, w.duration, w.nominal.period) for _ in range(2))
    w.mu_s, w.mu_k = lambda s: rig.mu_s + 0.006 * z(s.t), lambda s: rig.mu_k + 0.006 * y(s.t)


@form(NONE, source="Little and Rubin 1987 (single samples)", rig="sled", missing=0.01, gap=0.0)
def samples_missing(w: World, a: float) -> None:
    pass


@form(NONE, source="Little and Rubin 1987 (a pause of the logger)", rig="tribometer", missing=1.0e-3, gap=0.4, designs=("one",))
def logger_pauses(w: World, a: float) -> None:
    pass


@form(NONE, source="a logger that is switched on while the box slips", rig="turntable", begins=733.0, amid=0.3)
def begins_in_a_slip(w: World, a: float) -> None:
    pass


@form(NONE, source="a logger that is switched on while the box sticks", rig="sled", begins=-41.0, amid=3.1)
def begins_in_a_stick(w: World, a: float) -> None:
    pass


@form(NONE, source="four times the usual noise", rig="tribometer", loudness=4.0)
def noise_loud(w: World, a: float) -> None:
    pass


@form(NONE, source="a quarter of the usual noise", rig="turntable", loudness=0.25)
def noise_quiet(w: World, a: float) -> None:
    pass


@form(NONE, source="Sripad and Snyder 1977 (a rounding error's noise: uniform)", rig="axis", noise="uniform")
def noise_uniform(w: World, a: float) -> None:
    pass


@form(NONE, source="Horowitz and Hill 1989 (mains hum below the noise)", rig="probe", noise="hum")
def noise_and_hum(w: World, a: float) -> None:
    pass


@form(NONE, source="a thermometer that matters to nobody", rig="tribometer")
def temperature_recorded(w: World, a: float) -> None:
    warm(w)


@form(NONE, source="a vibrometer beside the gauge, on time", rig="axis")
def velocity_recorded(w: World, a: float) -> None:
    velocity_too(w)


@form(NONE, source="Amontons 1699 (the same both ways)", rig="turntable", designs=("several",), reversed=True)
def both_directions(w: World, a: float) -> None:
    pass


@form(NONE, source="Amontons 1699 (in proportion to the load)", rig="probe", designs=("several",), loads=True)
def many_loads(w: World, a: float) -> None:
    pass


@form(NONE, source="Nyquist 1928 (44 samples a natural period)", rig="turntable", rate=700.0)
def rate_low(w: World, a: float) -> None:
    pass


@form(NONE, source="a try that was cut short", rig="sled", designs=("one",), length=0.5)
def record_short(w: World, a: float) -> None:
    pass


@form(NONE, source="a long afternoon", rig="turntable", designs=("one",), length=3.0)
def record_long(w: World, a: float) -> None:
    pass
