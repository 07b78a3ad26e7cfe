"""Waves: the quick search against the plain regression, a force whose crests the slips keep to, a scar of the belt."""

from types import SimpleNamespace

import numpy as np
import pytest

from stochfric_mb.discovery.stick_slip.decision.kinematics import in_step
from stochfric_mb.discovery.stick_slip.records.calibration import calibrate
from stochfric_mb.discovery.stick_slip.records.pool import Pool, make_pool
from stochfric_mb.discovery.stick_slip.records.record import make_record
from stochfric_mb.discovery.stick_slip.records.slips import extract
from stochfric_mb.discovery.stick_slip.records.stick_waves import in_slips_too, wave_in_stick
from stochfric_mb.discovery.stick_slip.screening.hypotheses import waves_in
from stochfric_mb.discovery.stick_slip.screening.naming import _bounded, with_candidate
from stochfric_mb.discovery.stick_slip.screening.regression import START, Baseline, Regression, Terms, stated_terms
from stochfric_mb.discovery.stick_slip.screening.screen import screen
from stochfric_mb.discovery.stick_slip.screening.waves import _begins, _gains, best_wave, frequencies, wave_columns
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.effects import make_effect
from stochfric_mb.effects.marks import RETURNING
from stochfric_mb.effects.shapes.splines import returning, returning_course
from stochfric_mb.laws import make_law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.reference.augmented import Start, augmented_system

NOISE = 5e-6
FREQUENCY = 4.3
BELTS = (2.5e-3, 1.7e-3)


def pool_of(effect, other=None, belts=BELTS) -> Pool:
    """Two runs of 30 s with an effect, at two belt velocities; in the second one an effect may be another."""
    law = make_law("coulomb", mu_s=0.8, mu_k=0.46)
    items = []
    for run, belt in enumerate(belts):
        box = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=belt)
        motion = augmented_system(box, law, [effect if other is None or run == 0 else other]).march(
            Start(-20.0, 0.0, belt, stick=True), 1e-3, 50_000
        )
        position = motion.position[20_000:] + NOISE * np.random.default_rng(run).standard_normal(30_000)
        items.append(extract(make_record(f"run {run}", np.arange(1, 30_001) * 1e-3, position, box)))
    return make_pool(items, [calibrate(s) for s in items])


@pytest.fixture(scope="module")
def entrained() -> tuple[Pool, Regression, Terms]:
    pool = pool_of(make_effect("harmonic_force", amplitude=0.6, frequency=FREQUENCY, phase=0.4))
    return pool, Regression(pool), stated_terms(pool, {"mass": 0.003, "stiffness": 0.01, "damping": 0.2})


@pytest.mark.parametrize("kind", ["normal_load_ripple", "harmonic_force", "position_dependent_friction"])
@pytest.mark.parametrize(("frequency", "harmonics"), [(0.31, 1), (0.31, 3), (FREQUENCY, 1)])
def test_gain_is_that_of_the_regression(kind, frequency, harmonics, entrained):
    pool, regression, terms = entrained
    scatter = START
    wave = waves_in(pool)[kind]
    quick = _gains(pool, wave, regression.parts(terms, scatter), np.array([frequency]), harmonics)[0]
    plain = regression.gains(terms, scatter, [wave_columns(pool, wave, frequency, harmonics)])[0]
    # both add a ridge of 1e-6 or less to a Gram matrix of unit diagonal
    assert quick == pytest.approx(plain, rel=1e-3, abs=1e-3)


def test_a_fast_force_is_found_although_slips_keep_to_its_crests(entrained):
    pool, regression, terms = entrained
    for run in range(pool.n_runs):
        phase = np.exp(2j * np.pi * FREQUENCY * pool.onset_time[pool.run == run])
        assert abs(phase.mean()) > 0.9  # the same phase at every break-away
    start = regression.fit(terms)
    scores = {}
    for kind, wave in waves_in(pool).items():
        hypothesis, looked_at = best_wave(kind, wave, Baseline(regression, terms, start))
        fitted = regression.fit(terms.plus(hypothesis.columns), start.scatter)
        scores[kind] = 2.0 * (start.cost - fitted.cost) - 2.0 * np.log(looked_at)
        if kind == "harmonic_force":
            # a wave seen for 30 s has a line 1/30 Hz wide
            assert hypothesis.setting[0] == pytest.approx(FREQUENCY, abs=1.0 / 30.0)
    assert max(scores, key=lambda k: scores[k]) == "harmonic_force"
    assert scores["harmonic_force"] > 100.0


def test_a_wave_along_the_belt_is_looked_for_by_the_waves_of_a_typical_run(entrained):
    pool, _, _ = entrained
    wave = waves_in(pool)["position_dependent_friction"]
    # the belts run at 1.7 and 2.5 mm/s: the typical one passes 3 waves where the slowest passes fewer
    assert wave.pace == pytest.approx(np.median(BELTS) / min(BELTS))
    longest = wave.setting(frequencies(pool, wave.pace)[0])
    assert longest == pytest.approx(np.median(BELTS) * pool.duration / 3.0)


TURN, SHIFT = 21.0e-3, 0.3
"""Length of a scarred belt [m], and where on it the second run begins, less where the first one does [turns]."""


def scarred_belt(begin=0.0):
    """A scar of a tenth of the turn, off the knots of the search's splines; ``begin`` of a record in turns."""
    weights = 0.12 * np.exp(-(((np.arange(15) / 16.0 - 0.47) / 0.06) ** 2))
    numbers = returning_course(weights, 16) | {"wavelength": TURN, "phase": 1.1 + 2.0 * np.pi * begin}
    return make_effect("position_dependent_friction", axis="belt", **numbers)


@pytest.fixture(scope="module")
def scarred() -> tuple[Pool, Baseline]:
    pool = pool_of(scarred_belt(), scarred_belt(SHIFT))
    regression, terms = Regression(pool), stated_terms(pool, {"mass": 0.003, "stiffness": 0.01, "damping": 0.2})
    return pool, Baseline(regression, terms, regression.fit(terms))


def test_a_scar_of_the_belt_is_one_course_that_comes_back_in_runs_of_different_speed(scarred):
    pool, baseline = scarred
    best, second, *_ = screen(baseline)
    assert (best.name, best.hypothesis.variant) == ("position_dependent_friction", RETURNING)
    # harmonics have sizes and phases of their own in each run, a course is shared: what is the same needs fewer numbers
    assert best.score > second.score + 20.0
    # the belts pass 75 and 51 mm, three turns together: frequencies are tried a fifteenth of a turn over the record apart
    assert best.hypothesis.setting[0] == pytest.approx(TURN, rel=0.02)
    (found,) = with_candidate(Model(make_law("coulomb", mu_s=0.8, mu_k=0.46), {}), best, pool).effects
    turn, truth = np.linspace(0.0, 1.0, 200, endpoint=False), scarred_belt()
    shapes = [e.course * e.shape(turn) for e in (truth, found)]
    # each run's phase is its own: the shapes may be shifted
    alike = max(float(np.corrcoef(shapes[0], np.roll(shapes[1], k))[0, 1]) for k in range(200))
    assert alike > 0.95
    assert np.ptp(shapes[1]) == pytest.approx(np.ptp(shapes[0]), rel=0.2)  # first order in a tenth of the friction


def test_a_course_that_comes_back_begins_where_each_run_does(scarred):
    pool, baseline = scarred
    best = screen(baseline)[0]
    model = with_candidate(Model(make_law("coulomb", mu_s=0.8, mu_k=0.46), {}), best, pool)
    begins = [model.own[f"run {i}"][0]["phase"] / (2.0 * np.pi) for i in range(2)]
    assert (begins[1] - begins[0]) % 1.0 == pytest.approx(SHIFT, abs=1.0 / 48.0)  # shifts of so much are tried


def test_a_reversed_belt_passes_its_course_backwards():
    """A tooth with a gentle and a steep side: passed the wrong way round, no shift would make the runs alike."""
    u = np.arange(15) / 16.0
    numbers = returning_course(0.12 * np.clip((u - 0.2) / 0.5, 0.0, 1.0) * (u < 0.75), 16) | {"wavelength": TURN}
    first, second = (make_effect("position_dependent_friction", axis="belt", phase=p, **numbers) for p in (1.1, 2.9))
    pool = pool_of(first, second, (BELTS[0], -BELTS[1]))
    regression, terms = Regression(pool), stated_terms(pool, {"mass": 0.003, "stiffness": 0.01, "damping": 0.2})
    baseline, wave = Baseline(regression, terms, regression.fit(terms)), waves_in(pool)["position_dependent_friction"]
    begins = _begins(pool, wave, baseline, BELTS[1] / TURN)
    assert (begins[1] - begins[0]) % 1.0 == pytest.approx(1.8 / (2.0 * np.pi), abs=1.0 / 48.0)  # shifts of so much are tried


def compressor(begin=0.0):
    """A load that is pumped up for a quarter of 6.2 s, and leaks; ``begin`` of a record in turns."""
    turn = np.arange(15) / 16.0
    weights = 0.03 * np.where(turn < 0.25, turn / 0.25, np.exp(-3.0 * (turn - 0.25)))
    return make_effect(
        "normal_load_ripple", **returning_course(weights, 16), frequency=1.0 / 6.2, phase=0.4 + 2.0 * np.pi * begin
    )


@pytest.mark.parametrize("belts", [BELTS, (2.5e-3, -1.7e-3)])
def test_a_load_that_is_no_sine_is_one_course_in_time_whichever_way_belts_run(belts):
    """It was a random drift: harmonics with sizes and phases of their own in each run cost more than they explained."""
    pool = pool_of(compressor(), compressor(SHIFT), belts)
    regression, terms = Regression(pool), stated_terms(pool, {"mass": 0.003, "stiffness": 0.01, "damping": 0.2})
    best = screen(Baseline(regression, terms, regression.fit(terms)))[0]
    assert (best.name, best.hypothesis.variant) == ("normal_load_ripple", RETURNING)
    assert best.hypothesis.setting[0] == pytest.approx(1.0 / 6.2, rel=0.01)
    model = with_candidate(Model(make_law("coulomb", mu_s=0.8, mu_k=0.46), {}), best, pool)
    begins = [model.own[f"run {i}"][0]["phase"] / (2.0 * np.pi) for i in range(2)]
    # two of the shifts that are tried: a run has 25 slips
    assert (begins[1] - begins[0]) % 1.0 == pytest.approx(SHIFT, abs=2.0 / 48.0)
    turn = np.linspace(0.0, 1.0, 200, endpoint=False)
    true, found = (e.course * e.shape(turn) for e in (compressor(), model.effects[0]))
    alike = max(float(np.corrcoef(true, np.roll(found, k))[0, 1]) for k in range(200))
    assert alike > 0.95  # first order in a tenth of the friction
    assert np.ptp(found) == pytest.approx(np.ptp(true), rel=0.2)


def test_a_wave_that_is_a_sine_is_no_course(entrained):
    _, regression, terms = entrained
    names = [c.hypothesis.variant for c in screen(Baseline(regression, terms, regression.fit(terms)))[:3]]
    assert RETURNING not in names
    weights = np.cos(2.0 * np.pi * np.arange(1, 8) / 8.0)
    turns = np.linspace(-1.0, 2.0, 301)
    np.testing.assert_allclose(returning(turns, 8)[:100], returning(turns + 1.0, 8)[:100], atol=1e-12)
    assert returning(turns, 8).shape == (301, 7)
    assert np.isfinite(returning(turns, 8) @ weights).all()


@pytest.mark.parametrize("amplitude", [0.3, 1.05, 1300.0])
def test_a_ripple_that_screening_makes_larger_than_the_load_begins_within_its_bounds(amplitude):
    ripple = _bounded("normal_load_ripple", {"amplitude": amplitude, "frequency": 1.0})
    assert ripple.amplitude == pytest.approx(min(amplitude, 1.0), abs=2.1e-3)  # a thousandth of the range of 2 inside


def test_a_run_that_tells_nothing_of_a_wave_does_not_set_its_size():
    slips = [SimpleNamespace(record=SimpleNamespace(name=f"run {i}", direction=1)) for i in range(3)]
    strengths = np.array([0.6, 0.0, 0.0, 0.62, 800.0, 0.0])
    candidate = SimpleNamespace(
        name="harmonic_force", is_wave=True, along_belt=False, strengths=strengths,
        hypothesis=SimpleNamespace(setting=(FREQUENCY, 1.0), variant="wave"),
        solution=SimpleNamespace(
            coefficients=np.r_[0.8, 0.46, np.zeros(3), strengths],
            deviations=np.r_[np.zeros(5), 0.02, 0.02, 0.02, 0.02, 900.0, 900.0],
        ),
    )  # fmt: skip
    model = Model(make_law("coulomb", mu_s=0.8, mu_k=0.46), {})
    named = with_candidate(model, candidate, SimpleNamespace(n_runs=3, slips=slips)).effects[0]
    assert named.amplitude == pytest.approx(0.61, abs=0.02)


@pytest.mark.parametrize(("of_the_sensor", "sign"), [(True, 1.0), (False, -1.0)])
def test_a_wave_of_the_sensor_is_in_the_slips_one_of_the_belt_is_not(of_the_sensor, sign):
    frequency, size = 14.0, 5.0e-6  # two waves in a slip, each as large as the noise
    box = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=BELTS[0])
    turn = 2.0 * np.pi * frequency
    ripple = make_effect("belt_speed_ripple", amplitude=size * turn / BELTS[0], frequency=frequency, phase=0.4)
    law = make_law("coulomb", mu_s=0.8, mu_k=0.46)
    motion = augmented_system(box, law, [] if of_the_sensor else [ripple]).march(
        Start(-20.0, 0.0, BELTS[0], stick=True), 1e-3, 50_000
    )
    time = np.arange(1, 30_001) * 1e-3
    position = motion.position[20_000:] + NOISE * np.random.default_rng(0).standard_normal(30_000)
    if of_the_sensor:
        position = position + size * np.sin(turn * time + 0.4)
    slips = extract(make_record("run", time, position, box))
    assert np.hypot(*wave_in_stick(slips, frequency)[0]) == pytest.approx(size, rel=0.2)
    assert sign * in_slips_too(slips, frequency) > 20.0


def test_runs_of_a_belt_are_put_in_step_whichever_tone_is_the_largest():
    rng = np.random.default_rng(4)
    shape = np.array([0.1, 1.0, 0.0, 0.3j, 0.2, 0.0])  # twice a turn in the main: its phase alone leaves half a turn open
    begins = rng.uniform(0.0, 2.0 * np.pi, 5)
    noise = 0.02 * (rng.standard_normal((5, 6)) + 1j * rng.standard_normal((5, 6)))
    found, phases = in_step(shape * np.exp(1j * np.outer(begins, np.arange(1, 7))) + noise)
    away = np.angle(np.exp(1j * (phases - begins)))
    assert np.ptp(away) < 0.05  # all by the same, where the first one begins
    np.testing.assert_allclose(found * np.exp(1j * away.mean() * np.arange(1, 7)), shape, atol=0.05)
