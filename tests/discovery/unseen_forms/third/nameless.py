"""Forms that no effect of the vocabulary describes; a second name that stands with `unknown` would be defensible."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import UNKNOWN, steady_noise, warm
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form(UNKNOWN, "second_mode", source="Oden and Martins 1985; Hoffmann, Fischer, Allgaier and Gaul 2002 (normal resonance)")
def load_resonates(w: World, a: float) -> None:
    load, rig = w.normal_force, w.nominal
    p, most = 3.3 * rig.pulsation, 0.5 * rig.slip_length * rig.pulsation**2
    w.q0 = (0.0, 0.0)
    w.rates = lambda s: (s.q[1], -p * p * (s.q[0] + 0.5 * s.a / most) - 0.1 * p * s.q[1])
    w.normal = lambda s: load * (1.0 + 0.3 * a * s.q[0])


@form(UNKNOWN, source="Whitehouse 2002 (run-out of the sensor's target)")
def target_runs_out(w: World, a: float) -> None:
    size, turn = 0.012 * a * w.nominal.reach, 2 * np.pi / (0.43 * w.nominal.belt_velocity * w.nominal.period)

    def sensor(t, motion, rng):
        u = turn * w.travel(t)
        return motion.position + size * (np.sin(u) + 0.6 * np.sin(2.0 * u + 1.0))

    w.sensor = sensor


@form(UNKNOWN, "correlated_coefficients", source="Davenport 1961 (gusts)")
def gusts(w: World, a: float) -> None:
    force, z = 0.2 * a * w.nominal.gap * w.nominal.normal_force, steady_noise(w.rng, w.duration, 1.5 * w.nominal.period)
    w.load = lambda s: force * z(s.t)


@form(UNKNOWN, "random_coefficients", source="Aki 1979 (barriers that arrest some slips)")
def slips_are_arrested(w: World, a: float) -> None:
    rig, gap, half = w.rig, w.nominal.gap, 0.45 * w.nominal.slip_length
    w.on_break = lambda s: w.memory.update(barrier=float(w.rng.random() < 0.3))
    w.mu_k = lambda s: rig.mu_k + 0.9 * a * gap * w.memory.get("barrier", 0.0) * (s.slip > half)


@form(UNKNOWN, source="Graeme 1973 (slew rate)")
def sensor_slews(w: World, a: float) -> None:
    if a <= 0.0:
        return
    rate = (0.9 - 0.6 * a) * w.nominal.peak_speed

    def sensor(t, motion, rng):
        shown, last, most = np.empty_like(motion.position), motion.position[0], rate * (t[1] - t[0])
        for i, x in enumerate(motion.position):
            last += min(max(x - last, -most), most)
            shown[i] = last
        return shown

    w.sensor = sensor


@form(UNKNOWN, "sensor_step", source="Bobroff 1993 (an interferometer that loses fringes)")
def fringes_are_lost(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        lost = motion.breaks[rng.random(len(motion.breaks)) < 0.25, 0] + 1.0 / w.nominal.pulsation
        steps = np.concatenate([[0.0], np.cumsum(rng.choice([-1.0, 1.0], lost.size))])
        return motion.position + 0.015 * a * w.nominal.reach * steps[np.searchsorted(lost, t)]

    w.sensor = sensor


@form(UNKNOWN, source="Allan 1987 (a clock that is slow)")
def clock_is_slow(w: World, a: float) -> None:
    w.sensor = lambda t, motion, rng: np.interp(t * (1.0 - 0.04 * a), t, motion.position)


@form(UNKNOWN, source="Slocum 1992 (a frame that bends under the friction it measures)")
def frame_bends(w: World, a: float) -> None:
    rig, give = w.rig, 0.02 * a * w.nominal.reach / (w.nominal.gap * w.nominal.normal_force)

    def sensor(t, motion, rng):
        force = rig.mass * np.gradient(motion.velocity, t) + rig.damping * motion.velocity + rig.stiffness * motion.position
        return motion.position - give * force

    w.sensor = sensor


@form(UNKNOWN, "frictional_lag", source="Patton 1966; Barton 1976 (a joint that first climbs its asperities)")
def slip_hardens_first(w: World, a: float) -> None:
    rig, size, distance = w.rig, 0.5 * a * w.nominal.gap, 0.25 * w.nominal.slip_length
    w.mu_k = lambda s: rig.mu_k + size * max(s.slip, 0.0) / distance * np.exp(1.0 - max(s.slip, 0.0) / distance)


@form(UNKNOWN, "belt_speed_ripple", source="Armstrong-Helouvry 1991, chapter 3 (a drive that hunts)")
def belt_hunts(w: World, a: float) -> None:
    speed, z = w.belt_velocity, steady_noise(w.rng, w.duration + 1.0, 0.6 * w.nominal.period, order=2)
    w.set_belt(lambda t: speed * np.maximum(1.0 + 0.2 * a * z(t), 0.2))


@form(UNKNOWN, source="Ben-David, Cohen and Fineberg 2010 (a front that comes back from the edge)")
def front_returns(w: World, a: float) -> None:
    rig, size, pulsation = w.rig, 0.6 * a * w.nominal.gap, w.nominal.pulsation
    w.mu_k = lambda s: rig.mu_k + size * np.exp(-(((s.slip_time * pulsation - 1.7) / 0.3) ** 2))


@form(UNKNOWN, "viscous_friction", "quadratic_damping", source="Milliken and Milliken 1995 (a damper that fades)")
def damper_fades(w: World, a: float) -> None:
    rig, span = w.rig, 50.0 * w.nominal.period
    size = 0.4 * a * w.nominal.gap * w.nominal.normal_force / w.nominal.peak_speed
    w.damping = lambda s: s.v * (rig.damping + size * np.maximum(1.0 - s.t / span, 0.0))


@form(UNKNOWN, "temperature_drift", source="Mack 1940 (a spring that softens as it warms)")
def spring_warms(w: World, a: float) -> None:
    warm(w)
    k = w.rig.stiffness
    w.spring = lambda s: k * s.x * (1.0 - 0.01 * a * (w.temperature(s.t) - 20.0))


@form(UNKNOWN, source="Crassous, Charlaix and Gayvallet 1997 (moist air that comes and goes: break-away alone)")
def breakaway_breathes(w: World, a: float) -> None:
    rig, size, turn = w.rig, 0.15 * a * w.nominal.gap, 2 * np.pi / (6.3 * w.nominal.period)
    w.mu_s = lambda s: rig.mu_s + size * np.sin(turn * s.t)


@form(UNKNOWN, source="Neale 1995 (an oiler that drips: sliding alone)")
def oil_drips(w: World, a: float) -> None:
    rig, every, tau = w.rig, 11.0 * w.nominal.period, 2.5 * w.nominal.period
    w.mu_k = lambda s: rig.mu_k * (1.0 - 0.15 * a * np.exp(-np.mod(s.t, every) / tau))


@form(UNKNOWN, source="Kester 2005 (a word that overflows)")
def word_overflows(w: World, a: float) -> None:
    full, size = w.nominal.reach - 0.15 * w.nominal.slip_length, 0.1 * a * w.nominal.slip_length
    w.sensor = lambda t, motion, rng: motion.position - size * (motion.position > full)
