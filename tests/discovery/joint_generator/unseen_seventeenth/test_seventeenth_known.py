"""The forms of the seventeenth set with an effect of the vocabulary give finite records that they move; nulls move nothing."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.discovery import joint_plan
from tests.discovery.joint_generator import series_checks, slider
from tests.discovery.joint_generator.bench import nominal_bench
from tests.discovery.joint_generator.case import Case
from tests.discovery.joint_generator.forms import FORMS
from tests.discovery.joint_generator.plant import AREA_AT, FACTOR_AT, FORCE_AT, GAIN_AT
from tests.discovery.joint_generator.unseen_fourteenth.test_fourteenth import (
    at_places,
    drag_at,
    energy_and_work,
    shown_and_plain,
    sources,
)
from tests.discovery.joint_generator.unseen_sixteenth.test_sixteenth_known import lasting

from .law import across, bare, round_strip, strokes_since_clean
from .mechanism import pick_and_place
from .null import secant

SERIES = series_checks.Series(17)
MADE_UP_FOR = {"constant_force.hysteresis_clutch_keeps_a_cord_taut": "size"}
"""What the controller makes up for, and is seen against what is believed."""
OWN = {name: form for name, form in SERIES.forms.items() if not form.draw.__module__.endswith("nameless")}
KNOWN = [name for name in OWN if SERIES.kinds[name] != "none"]
JOINTS = [name for name in KNOWN if name in SERIES.joints]
UNDRIVEN = [name for name in OWN if name in SERIES.undriven]
NULLS = [name for name in OWN if name in SERIES.nulls]


def friction(name, run=0):
    """What a slider or a thrown block has in a run, at full strength."""
    case = Case(name, SERIES.forms[name].designs[0], 1.0, 7)
    return case.parts[0].draw(case.rng(1, 0), 1.0, nominal_bench("slide", case.rng(0))).law(case.rng(2, run))


def test_the_set_is_as_wide_as_asked_for():
    assert (len(KNOWN), len(OWN) - len(KNOWN)) == (27, 10)
    assert not SERIES.misplaced() & OWN.keys()
    assert not OWN.keys() & set(SERIES.unsourced())
    sixteenth = [kind for kind in series_checks.Series(16).kinds.values() if kind not in ("unknown", "none")]
    assert sorted(SERIES.kinds[name] for name in KNOWN) == sorted(sixteenth)


def test_no_earlier_form_has_the_name_or_in_its_kind_the_source_of_one_of_these():
    assert not SERIES.repeated_names() & {name.split(".")[1] for name in OWN}
    earlier = [*FORMS.values(), *(form for i in range(1, 17) for form in joint_plan.SERIES[i][0].values())]
    used = {(form.kind, source) for form in earlier for source in sources(form)}
    own = [(form.kind, source) for form in OWN.values() for source in sources(form)]
    assert len(own) == len(OWN) == len(set(own))
    assert not used & set(own)


def test_pairs_share_a_mechanism_and_are_of_two_kinds():
    assert len(SERIES.pairs) == len(set(SERIES.pairs)) == 4
    for pair in SERIES.pairs:
        one, other = (SERIES.forms[name] for name in pair.split("+"))
        assert {one.name, other.name} <= set(KNOWN)
        assert set(one.designs) & set(other.designs)
        assert one.kind != other.kind
        assert one.kind not in other.also
        assert other.kind not in one.also
        series_checks.assert_finite(lasting(SERIES.short(pair), 1.5).record(0))


@pytest.mark.parametrize("name", JOINTS)
def test_a_record_is_finite_and_moved_at_half_strength(name):
    made = SERIES.short(name, strength=0.5)
    series_checks.assert_finite(made.record(0))
    off = made.effects[0].parameters.get(MADE_UP_FOR.get(name, ""), 0.0)
    assert max(series_checks.columns_moved(made), abs(off) / made.nominal.sensor.drive) > 5.0


@pytest.mark.parametrize("name", [name for name in JOINTS if name not in MADE_UP_FOR])
def test_a_record_is_moved_by_tens_of_noises_at_full_strength(name):
    assert series_checks.columns_moved(lasting(SERIES.short(name), 12.0)) > 10.0


@pytest.mark.parametrize("name", UNDRIVEN)
def test_sliders_and_throws_are_finite_and_moved_at_half_strength(name):
    series_checks.assert_finite(SERIES.shown(name, strength=0.5))
    series_checks.assert_same(SERIES.shown(name), SERIES.shown(name))
    assert SERIES.shown(name)["time [s]"].size > 50
    if SERIES.kinds[name] != "none":
        assert series_checks.undriven_moved(SERIES, name, strength=0.5) > 5.0


@pytest.mark.parametrize("name", NULLS)
def test_a_null_moves_as_believed_and_is_off_by_no_more_than_is_stated(name):
    made = SERIES.short(name, design="slide")
    series_checks.assert_finite(made.record(0))
    series_checks.assert_nothing_is_missing(made)


@pytest.mark.parametrize("name", [*JOINTS, *NULLS])
def test_the_same_seed_gives_the_same_record_and_no_strength_is_no_effect(name):
    one, again = (lasting(SERIES.short(name), 1.5).record(0) for _ in range(2))
    series_checks.assert_same(one, again)
    if name in JOINTS and not name.startswith("load_dependence"):
        shown, plain = (made := lasting(SERIES.short(name, strength=0.0), 1.5)).record(0), replace(made, effects=()).record(0)
        series_checks.assert_same({name: shown[name] for name in plain}, plain)


CONSERVES = ("viscous", "velocity_w", "direction", "quadratic", "position_dependent_friction", "drive_gain_change", "harmonic")


@pytest.mark.parametrize("name", [n for n in JOINTS if n.startswith(CONSERVES)])
def test_energy_is_kept_and_friction_takes_it_alone(name):
    made = SERIES.short(name, design="slide")
    energy, worked = energy_and_work(made, made.plant(0))
    assert np.abs(energy - energy[0] - worked).max() < 0.02 * np.ptp(energy)
    states = made.states(0)[0]
    quick = np.abs(states[:, 2]) > 0.05 * made.nominal.speed
    assert np.all((states[:, 6] * states[:, 2])[quick] > 0.0)


def test_laws_of_the_speed_are_what_they_are_said_to_be():
    made = SERIES.short("viscous_friction.melt_in_a_rotary_damper")
    w = np.array([0.2, 0.5, 1.0]) * made.effects[0].parameters["top"]
    s = np.linspace(0.0, 3.0, 300_001)
    solved = np.interp(w, s * np.exp(s**2), s)
    assert drag_at(made, [0.2, 0.5, 1.0])[0] / 0.95 == pytest.approx(solved / solved[-1], rel=3e-3)
    made = SERIES.short("velocity_weakening.junctions_soften_by_their_heat")
    softens = made.effects[0].parameters["softens"] / made.nominal.speed
    assert drag_at(made, [0.0, softens, 9.0 * softens])[0] / 1.1 == pytest.approx([1.0, 0.5, 0.25], abs=5e-3)
    made = SERIES.short("direction_asymmetry.wing_on_the_carriage")
    assert np.sort(drag_at(made, [1.0]).ravel()) == pytest.approx([-0.65 * 0.9, 0.9], rel=5e-3)
    assert np.all(np.diff(SERIES.short("viscous_friction.rubber_solution_in_a_seal").plant(0).by_speed[0]) > 0.0)


def test_laws_of_load_temperature_and_chance():
    assert round_strip(np.array([1.0, 4.0])) == pytest.approx([1.0, 2.0 * 0.85 + 4.0 * 0.15])
    assert bare(np.array([10.0, 34.0, 60.0])) == pytest.approx([0.012, 1.0 - np.exp(-1.0), 1.0], abs=5e-3)
    ages = np.stack([strokes_since_clean(np.random.default_rng(i), 400) for i in range(200)])
    assert ages.mean() == pytest.approx(4.0 * (1.0 - 0.8**14), abs=0.1)
    assert np.mean(ages == 0.0) == pytest.approx(0.2, abs=0.01)
    mu = np.array([friction("random_coefficients.grained_block_lands_turned", i).mu(1.0, 0.0) for i in range(400)])
    assert (mu.min(), mu.max()) == pytest.approx((0.196, 0.364), abs=2e-3)
    assert np.mean(mu**2) == pytest.approx(0.28**2 * (1.0 + 0.3**2), rel=0.04)
    level = np.concatenate([SERIES.short("random_coefficients.side_pull_of_hoses").plant(i).by_stroke for i in range(5)])
    assert (level.mean(), level.min() > 0.5) == (pytest.approx(1.0, abs=0.03), True)


def test_a_castor_follows_as_it_is_dragged():
    solved = solve_ivp(lambda _, y: -np.sin(y), (0.0, 6.0), [np.radians(150.0)], t_eval=[0.0, 1.0, 3.0, 6.0], rtol=1e-9)
    assert across(solved.t) == pytest.approx(np.sin(solved.y[0]), abs=1e-5)
    assert across(np.array([np.inf])) == pytest.approx([0.0])


def test_laws_of_the_place():
    made = SERIES.short("position_dependent_force.chain_lifted_from_the_floor")
    reach, size = made.nominal.reach, made.effects[0].parameters["size"] / made.nominal.level
    q = np.array([0.3, 0.6, 1.0]) * reach
    before, after = (0.5 * (1.0 - np.cos(q + d)) ** 2 for d in (-1e-5, 1e-5))  # energy of a chain that hangs so high
    slope = (after - before) / 2e-5 / (np.sin(reach) * (1.0 - np.cos(reach)))
    assert at_places(made, FORCE_AT, [0.3, 0.6, 1.0]) / made.nominal.level == pytest.approx(size * slope, abs=5e-3)
    made = SERIES.short("position_dependent_friction.kinked_joint_of_a_rail")
    p, reach = made.effects[0].parameters, made.nominal.reach
    u = [(p["at"] + k * np.pi / 4.0 * p["length"]) / reach for k in (-1, 0, 1, 4)]
    assert (at_places(made, FACTOR_AT, u) - 1.0) / p["size"] == pytest.approx([-1.0, 0.0, 1.0, 0.0], abs=5e-3)
    made = SERIES.short("effective_area.square_lifting_bag")
    assert np.sort(at_places(made, AREA_AT, [-1.0, 0.0, 1.0])) == pytest.approx([0.81, 1.0, 1.21], abs=2e-3)
    made = SERIES.short("drive_gain_change.voice_coil_leaves_its_gap")
    p = made.effects[0].parameters
    gain = at_places(made, GAIN_AT, [p["at"] / made.nominal.reach, (p["at"] + p["half"]) / made.nominal.reach])
    assert gain == pytest.approx([1.0, 0.7], abs=2e-3)


def test_an_arm_comes_back_to_where_it_was_and_rests():
    t = np.linspace(0.0, 1.0, 100_001)
    push = pick_and_place(t)
    speed = np.cumsum(push) * 1e-5
    assert (np.abs(push).max(), abs(push.mean())) == pytest.approx((1.0, 0.0), abs=1e-4)
    assert np.abs(speed[(t > 0.31) & (t < 0.49)]).max() < 1e-3 * np.abs(speed).max() + 1e-4
    assert abs(np.sum(speed) * 1e-5) < 1e-4


def test_sensors_and_noise_are_what_they_are_said_to_be():
    made = lasting(SERIES.short("sensor_outliers.multiplexer_at_the_drive", design="slide"), 12.0)
    shown, plain = shown_and_plain(made, "position")
    assert 0.5 / 220.0 < np.mean(shown != plain) < 1.6 / 220.0
    assert np.abs(shown).max() <= 1.2 * made.nominal.reach
    made = lasting(SERIES.short("stale_samples.telegrams_lost_by_chance", design="slide"), 12.0)
    shown, plain = shown_and_plain(made, "position")
    new = np.flatnonzero(np.diff(shown) != 0.0) + 1
    np.testing.assert_array_equal(shown[new], plain[new])
    assert np.mean(np.diff(new)) / made.nominal.rate == pytest.approx(0.018 / 0.6, rel=0.12)
    noise = secant(np.random.default_rng(3), 200_000)
    assert (noise.mean(), noise.std(), np.mean(noise**4)) == pytest.approx((0.0, 1.0, 5.0), abs=0.2)
    law = friction("none.level_below_and_mains_folded_down")
    assert np.argmax(np.abs(np.fft.rfft(law.added(np.arange(500) / slider.RATE, np.zeros(500))))) == 37
    assert friction("none.dry_slate").mu(1.0, 0.1) == pytest.approx(0.3 + 0.35 * 0.15)  # half of 0.3 is its deviation
