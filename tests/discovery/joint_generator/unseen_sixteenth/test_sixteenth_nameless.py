"""What no effect describes, in the sixteenth set: finite records that each form moves, and the physics of each one."""

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.discovery import joint_plan
from tests.discovery.joint_generator import series_checks, slider, thrown
from tests.discovery.joint_generator.bench import GRAVITY, nominal_bench
from tests.discovery.joint_generator.case import Case, Made
from tests.discovery.joint_generator.forms import FORMS, Record
from tests.discovery.joint_generator.forms.form import Form
from tests.discovery.joint_generator.plant import Array

from .nameless import bounces, braked, caught, folded, since_turn, stored, void

SERIES = series_checks.Series(16)
NAMES = [name for name in SERIES.forms if name.startswith("unknown.")]
UNDRIVEN = [name for name in SERIES.undriven if name in NAMES]
JOINTS = [name for name in NAMES if name not in UNDRIVEN]
INNER = slice(300, -300)
"""Rows at which running polynomials see both sides."""


def column(record: Record, *begins: str) -> str:
    """Name of the first column that begins so."""
    return next(name for name in record if name.startswith(begins))


def shown_and_plain(made: Made, *begins: str) -> tuple[Array, Array]:
    """A column of the first run with and without the effects."""
    record = made.record(0)
    name = column(record, *begins)
    return record[name], replace(made, effects=()).record(0)[name]


def for_seconds(name: str, design: str | None = None, *, lasts: float = 12.0, strength: float = 1.0) -> Made:
    """A case whose runs last as long, which is usually twelve seconds."""
    made = SERIES.short(name, design=design, strength=strength)
    return replace(made, nominal=replace(made.nominal, duration=lasts), true=replace(made.true, duration=lasts))


def friction(name: str, run: int = 0) -> slider.RateAndState | thrown.Throw:
    """What a slider or a thrown block has in a run, at full strength."""
    case = Case(name, SERIES.forms[name].designs[0], 1.0, 7)
    law = case.parts[0].draw(case.rng(1, 0), 1.0, nominal_bench("slide", case.rng(0))).law
    assert law is not None
    drawn = law(case.rng(2, run))
    assert isinstance(drawn, slider.RateAndState | thrown.Throw)
    return drawn


def drive_and_motion(made: Made) -> tuple[Array, Array, Array, Array]:
    """What a single drive shows beyond the plain one [N or N m]; place, speed and time of the states, which have no noise."""
    shown, plain = shown_and_plain(made, "force", "torque", "voltage")
    states, _ = made.states(0)
    return (shown - plain) * made.nominal.gain, states[:, 0], states[:, 2], np.arange(len(states)) / made.nominal.rate


def ratio_and_motion(made: Made) -> tuple[Array, Array, Array, Array]:
    """Ratio of what a single drive shows to the plain one; the plain one, place and speed of the states."""
    shown, plain = shown_and_plain(made, "force", "torque", "voltage")
    states, _ = made.states(0)
    return shown / plain, plain, states[:, 0], states[:, 2]


def relative(off: Array, size: Array) -> float:
    """Root of the mean square of what is off over that of what it should be."""
    return float(np.sqrt(np.mean(off**2) / np.mean(size**2)))


def strokes_of(v: Array) -> list[tuple[int, int]]:
    """First row and the row after the last one of each stretch in which the speed keeps its sign."""
    turns = np.flatnonzero(np.diff(np.sign(v)) != 0) + 1
    return list(pairwise([0, *turns.tolist(), v.size]))


def sources(form: Form) -> set[str]:
    """Authors with their years, as the first line of a form names them."""
    first = (form.draw.__doc__ or "").split("\n")[0].split(" (")[0]
    return {part.strip(" .") for part in re.split(r";|, in ", first) if re.search(r"\d{4}", part)}


def test_there_are_fourteen_and_each_says_what_else_could_be_answered():
    assert len(NAMES) == 14
    assert {SERIES.kinds[name] for name in NAMES} == {"unknown"}
    assert not SERIES.misplaced() & set(NAMES)
    assert not set(SERIES.unsourced()) & set(NAMES)
    cases = [case for case in joint_plan.unseen_cases([1601], 16) if case.forms in NAMES]
    assert len(cases) == 2 * len(NAMES)
    assert {case.strength for case in cases} == {0.5, 1.0}


def test_no_earlier_form_has_the_name_or_the_source_of_one_of_these():
    assert not SERIES.repeated_names() & {name.split(".")[1] for name in NAMES}
    earlier = [*FORMS.values(), *(form for i in range(1, 16) for form in joint_plan.SERIES[i][0].values())]
    used = {(form.kind, source) for form in earlier for source in sources(form)}
    own = [("unknown", source) for name in NAMES for source in sources(SERIES.forms[name])]
    assert len(own) == len(NAMES) == len(set(own))
    assert not used & set(own)


@pytest.mark.parametrize("name", JOINTS)
def test_a_record_is_finite_and_moved_by_tens_of_noise_floors(name):
    """Half of them at half strength: 10 and 5, as the least of rigs are slow ones with loud drives."""
    for strength, floors in ((1.0, 10.0), (0.5, 5.0)):
        made = for_seconds(name, lasts=7.0, strength=strength)
        series_checks.assert_finite(made.record(0))
        assert series_checks.columns_moved(made) > floors


@pytest.mark.parametrize("name", UNDRIVEN)
def test_sliders_and_throws_are_finite_and_moved_by_tens_of_noise_floors(name):
    for strength, floors in ((1.0, 20.0), (0.5, 10.0)):
        series_checks.assert_finite(SERIES.shown(name, strength=strength))
        assert series_checks.undriven_moved(SERIES, name, strength=strength) > floors


@pytest.mark.parametrize("name", JOINTS)
def test_every_mechanism_of_a_form_gives_a_finite_record(name):
    for design in SERIES.forms[name].designs:
        series_checks.assert_finite(for_seconds(name, design, lasts=1.5).record(0))


@pytest.mark.parametrize("name", NAMES)
def test_the_same_seed_gives_the_same_record(name):
    if name in UNDRIVEN:
        series_checks.assert_same(SERIES.shown(name), SERIES.shown(name))
    else:
        made = for_seconds(name, lasts=1.5)
        again = replace(made, effects=SERIES.short(name).effects)
        series_checks.assert_same(made.record(0), again.record(0))


@pytest.mark.parametrize("name", NAMES)
def test_no_strength_is_no_effect(name):
    if name in UNDRIVEN:
        assert series_checks.undriven_moved(SERIES, name, strength=0.0) == 0.0
        return
    made = for_seconds(name, lasts=1.5, strength=0.0)
    shown, plain = made.record(0), replace(made, effects=()).record(0)
    series_checks.assert_same({name: shown[name] for name in plain}, plain)


def test_an_accumulator_loses_what_is_drawn_and_gains_what_is_pumped():
    """The gas's volume, which the drive goes by: its change is the oil's, unless all is drawn or all is stored."""
    np.testing.assert_allclose(stored(np.array([0.0, 3.0, 3.0, 0.0, 0.0]), 1.0, 0.3), [1.0, 0.4, 0.0, 0.3, 0.6])
    made = for_seconds("unknown.accumulator_is_drawn_on", "slide")
    ratio, _, _, v = ratio_and_motion(made)
    p, b = made.effects[0].parameters, made.nominal
    gas = (ratio - 1.0) / p["grows"]
    assert gas.min() == pytest.approx(0.0, abs=1e-9)
    assert 0.3 < gas.max() < 1.0 + 1e-9
    drawn = np.abs(v) / p["holds"]
    taken = np.cumsum(drawn - p["spare"] * drawn.mean()) / b.rate
    partly = (gas > 0.02) & (gas < 0.98)
    both = partly[1:] & partly[:-1]
    both[:300], both[-300:] = False, False
    assert relative((np.diff(gas) - np.diff(taken))[both], np.diff(taken)[both]) < 0.03
    quick, full = drawn > p["spare"] * drawn.mean(), gas < 1e-9
    assert not np.any(quick & full & np.roll(full, 20) & (np.arange(v.size) > 300))


def test_an_amplifier_gives_half_from_one_limit_of_its_square_to_the_other_one():
    states = folded(np.array([0.0, 2.0, 1.0, 0.8, 0.7, 0.8, 1.2]), 1.0, 1e-3, 1.1, 0.75)
    np.testing.assert_array_equal(states, [False, True, True, True, False, False, True])
    made = for_seconds("unknown.amplifier_folds_back", "slide")
    ratio, plain, _, _ = ratio_and_motion(made)
    held = ratio > 1.5
    assert np.all((np.abs(ratio - 1.0) < 1e-9) | (np.abs(ratio - 2.0) < 1e-9))
    n, time = round(5.0 * made.nominal.rate), made.effects[0].parameters["time"] * made.nominal.rate
    weights = np.exp(-np.arange(n) / time)
    heat = np.convolve(plain**2 / np.mean(plain**2), weights / np.sum(weights))[: plain.size]
    settled = np.arange(plain.size) > 6.0 * time
    assert heat[settled & held].min() > 0.74
    assert heat[settled & ~held].max() < 1.11
    either = settled & (heat > 0.8) & (heat < 1.05)
    assert 0.1 < np.mean(held[either]) < 0.9
    assert np.sum(np.diff(held.astype(int)) != 0) >= 4


def test_a_late_compensation_is_one_push_a_turn_along_the_motion():
    v = np.array([0.0, 1.0, 1.0, 0.01, -0.01, 0.01, -1.0, -1.0, 1.0])
    np.testing.assert_allclose(since_turn(v, 0.1, 0.1)[6:], [0.0, 0.1, 0.0])
    assert np.all(np.isinf(since_turn(v, 0.1, 0.1)[:6]))
    made = for_seconds("unknown.compensation_comes_late", "slide")
    more, _, v, t = drive_and_motion(made)
    p, b = made.effects[0].parameters, made.nominal
    pushes = np.flatnonzero(np.diff((np.abs(more) > 1e-6 * b.level).astype(int)) == 1) + 1
    turned = np.array([end for _, end in strokes_of(np.where(np.abs(v) > 0.05 * b.speed, v, 0.0)[np.abs(v) > 0.05 * b.speed])])
    at = np.flatnonzero(np.abs(v) > 0.05 * b.speed)[turned[:-1]]
    at = at[t[at] < t[-1] - 0.4]
    assert at.size > 5
    for row in at:
        begins = pushes[np.argmin(np.abs(t[pushes] - t[row] - p["late"]))]
        assert t[begins] - t[row] == pytest.approx(p["late"], abs=0.012)  # the speed is smoothed over 40 ms
        push = more[begins : begins + round(p["lasts"] * b.rate)]
        if np.all(np.abs(v[begins : begins + push.size]) > 0.05 * b.speed):
            assert np.sum(push) / b.rate == pytest.approx(-np.sign(v[begins]) * p["size"] * p["lasts"] * 2.0 / np.pi, rel=0.02)
    assert np.mean(np.abs(more) > 1e-6 * b.level) < 0.5


def test_a_damper_drags_on_the_way_back_once_the_void_has_closed():
    """The void by whole strokes: what a pull lacked is the way that the next push goes freely."""
    np.testing.assert_allclose(void(np.array([1.0, 3.0, -1.0, -1.5, 0.5]), 1.0, 1.0), [0.0, 2.0, 1.0, 0.0, 0.0])
    made = for_seconds("unknown.damper_draws_a_void", "slide")
    more, x, v, _ = drive_and_motion(made)
    p, b = made.effects[0].parameters, made.nominal
    x, v, push = p["side"] * x, p["side"] * v, p["side"] * more
    left, checked = 0.0, 0
    for begin, end in strokes_of(v):
        if v[(begin + end) // 2] > 0.0:
            left += np.sum(np.maximum(v[begin:end] - p["refills"], 0.0)) / b.rate
            rows = slice(max(begin, 300) + 30, end - 30)
            assert np.all(np.abs(push[rows] - p["size"] * v[rows] / b.speed) < 0.05 * p["size"])
            continue
        gone = x[begin] - x[begin:end]
        free, meets = gone < left - 0.02 * b.reach, (gone > left + 0.02 * b.reach) & (np.arange(begin, end) > 300)
        assert np.all(np.abs(push[begin:end][free & (v[begin:end] < -0.05 * b.speed)]) < 1e-9 * b.level)
        drags = (push - p["size"] * v / b.speed)[begin:end][meets]
        assert np.all(np.abs(drags[30:-30]) < 0.05 * p["size"])
        left, checked = max(0.0, left - gone[-1]), checked + 1
    assert checked > 2


def test_late_switches_take_gain_by_the_place_ahead_and_give_it_behind():
    """What acts is cos(a + l)/cos(a) of what is asked for; the lag ends at half of the speed."""
    made = for_seconds("unknown.hall_switches_come_late", "hinge")
    ratio, _, q, v = ratio_and_motion(made)
    p, b = made.effects[0].parameters, made.nominal
    turns = q / p["sector"] + p["start"]
    ahead = np.pi / 3.0 * (turns - np.floor(turns) - 0.5)
    lag = 0.8 * np.clip(v / b.speed / 0.5, -1.0, 1.0)
    inside = (np.abs(ahead) < 0.45)[INNER]
    gain = (np.cos(ahead + lag) / np.cos(ahead))[INNER]
    assert np.abs(1.0 / ratio[INNER] - gain)[inside].max() < 0.05
    assert np.sqrt(np.mean((1.0 / ratio[INNER] - gain)[inside] ** 2)) < 0.01
    assert 1.0 / ratio.min() > 1.05  # ahead and behind: more force here, less there
    assert 1.0 / ratio.max() < 0.4


def test_two_channels_of_which_one_is_filtered_err_by_half_of_its_lag():
    """A low pass of first order in time, at even speeds; what the encoder makes of both channels."""
    made = SERIES.short("unknown.channels_are_filtered_unlike", design="slide")
    effect, b = made.effects[0], made.nominal
    p, t = effect.parameters, np.arange(8000) * 5e-4
    for share in (0.3, -0.8):
        v = share * b.speed
        x = v * t
        shown = effect.measure({"time [s]": t, "position [m]": x}, np.random.default_rng(0))["position [m]"]
        w = 2.0 * np.pi * v / p["pitch"]
        lag = 1.2 * share / w  # seconds by which a low pass of that lag is late while slow
        passed = np.imag(np.exp(1j * (w * t + p["start"])) / (1.0 + 1j * w * lag))
        angle = np.unwrap(np.arctan2(passed, np.cos(w * t + p["start"])))
        assert np.ptp(shown[INNER] - p["pitch"] / (2.0 * np.pi) * angle[INNER]) < 1e-6 * b.reach
        off = (shown - x)[INNER] * 2.0 * np.pi / p["pitch"]
        assert np.abs(off).max() < 1.2 * abs(np.arctan(1.2 * share))
        assert np.sign(off.mean()) == -np.sign(share)
        assert np.ptp(off) > 0.3 * abs(np.arctan(1.2 * share))


def test_a_housing_swings_as_its_own_equation_says():
    """y'' + 2 d w y' + w^2 y = w^2 teeth; what is added is what y has beyond the teeth. Within 5 %, by Newton's equation."""
    made = for_seconds("unknown.teeth_shake_the_housing", "slide", lasts=5.0)
    more, q, v, t = drive_and_motion(made)
    p, b = made.effects[0].parameters, made.nominal
    w = p["often"]

    def teeth(s: float) -> float:
        return float(np.cos(2.0 * np.pi * np.interp(s, t, q) / p["pitch"] + p["start"]))

    def rates(s: float, y: Array) -> list[float]:
        return [y[1], w**2 * (teeth(s) - y[0]) - 0.16 * w * y[1]]

    y = solve_ivp(rates, (0.0, t[-1]), [teeth(0.0), 0.0], t_eval=t, max_step=4e-3, rtol=1e-5, atol=1e-7).y[0]
    asked = p["size"] * (y - np.cos(2.0 * np.pi * q / p["pitch"] + p["start"]))
    assert relative(more - asked, asked) < 0.05
    slow = np.convolve(np.abs(v), np.ones(400) / 400.0, "same") < 0.1 * b.speed
    assert np.abs(more).max() > 2.0 * p["size"]
    assert not slow.any() or np.abs(more[slow]).mean() < 0.5 * np.abs(more).mean()


def test_air_pads_touch_by_the_acceleration_and_rub_against_the_motion():
    made = for_seconds("unknown.air_pads_touch_when_jerked", "slide")
    more, _, v, t = drive_and_motion(made)
    p, b = made.effects[0].parameters, made.nominal
    jerked, usual = np.abs(np.gradient(v, t)), b.speed**2 / b.reach
    moving = (np.abs(v) > 0.1 * b.speed) & (np.arange(v.size) > 300) & (np.arange(v.size) < v.size - 300)
    calm, hard = jerked < p["touches"] - 0.1 * usual, jerked > p["touches"] + 0.25 * usual
    assert np.abs(more[moving & calm]).max() < 0.02 * p["size"]
    np.testing.assert_allclose((more * np.sign(v))[moving & hard], p["size"], rtol=0.02)
    assert 0.05 < np.mean(np.abs(more) > 0.5 * p["size"]) < 0.7
    assert np.mean(moving & calm) > 0.05


def test_a_table_does_no_work_but_its_springs_and_its_rubbing():
    """Power of both drives: what the spring stores, and friction times the tip's speed along the table."""
    made = for_seconds("unknown.tool_grazes_a_table", "arm")
    shown, plain = made.record(0), replace(made, effects=()).record(0)
    states, _ = made.states(0)
    p, b = made.effects[0].parameters, made.nominal
    more = [shown[name] - plain[name] for name in ("shoulder_torque [N m]", "elbow_torque [N m]")]
    power = more[0] * states[:, 2] + more[1] * states[:, 3]
    upper, fore = b.numbers["l1"], b.numbers["l2"]
    tip = -1j * (upper * np.exp(1j * states[:, 0]) + fore * np.exp(1j * (states[:, 0] + states[:, 1])))
    tip_speed = np.gradient(tip) * b.rate
    depth = np.maximum(-upper - fore + p["high"] - tip.imag, 0.0) / p["high"]
    asked = p["most"] * depth * (p["mu"] * np.abs(tip_speed.real) - tip_speed.imag)
    assert relative((power - asked)[INNER], asked[INNER]) < 0.05
    assert 0.1 < np.mean(depth > 0.0) < 0.95
    assert np.abs(more[0][depth == 0.0]).max() < 0.05 * np.abs(more[0]).max()  # noise of positions at the edge
    assert np.abs(more).max() > b.level


def test_a_brake_shuts_after_long_rests_alone_and_opens_after_its_time():
    v = np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 1.0])
    np.testing.assert_array_equal(braked(v, 1.0, 0.5, 2.5, 2.5), [False, False, True, True, True, False, False, False])
    made = for_seconds("unknown.brake_opens_late", "slide", lasts=24.0)
    more, _, v, t = drive_and_motion(made)
    p, b = made.effects[0].parameters, made.nominal
    moves = np.abs(v) > 0.02 * b.speed
    starts = np.flatnonzero(~moves[:-1] & moves[1:]) + 1
    long, short = 0, 0
    for row in starts[(t[starts] > 1.0) & (t[starts] < t[-1] - 0.5)]:
        rested = (row - np.flatnonzero(moves[:row])[-1]) / b.rate
        stops = row + np.flatnonzero(np.append(~moves[row:], True))[0]
        if stops < row + round((p["opens"] + 0.03) * b.rate):
            continue
        drags = np.abs(more[row:stops]) > 0.5 * p["size"]
        if rested > p["closes"] + 0.03:
            assert np.sum(drags) / b.rate == pytest.approx(p["opens"], abs=0.03)
            long += 1
        elif rested < p["closes"] - 0.03:
            assert not drags.any()
            short += 1
    assert long > 2
    assert short > 2
    assert np.all((more * v)[np.abs(v) > 0.1 * b.speed] >= 0.0)


def test_an_arrester_holds_from_a_speed_on_until_the_joint_turns():
    x, v = np.array([0.0, 1.0, 3.0, 4.0, 3.5, 4.0]), np.array([1.0, 2.0, 2.0, 1.0, -1.0, 1.0])
    np.testing.assert_array_equal(caught(x, v, 1.5), [0.0, 0.0, 2.0, 3.0, 0.0, 0.0])
    made = for_seconds("unknown.fall_arrester_locks", "slide")
    more, x, v, _ = drive_and_motion(made)
    p, b = made.effects[0].parameters, made.nominal
    x, v, push = p["side"] * x, p["side"] * v, p["side"] * more
    held = 0
    for begin, end in strokes_of(v):
        if v[(begin + end) // 2] < 0.0:
            assert np.abs(push[begin + 30 : end - 30]).max(initial=0.0) == 0.0
            continue
        fast = np.flatnonzero(v[begin:end] > 1.03 * p["limit"])
        if fast.size == 0:
            continue
        before = np.flatnonzero(v[begin:end] > 0.97 * p["limit"])[0]
        assert np.abs(push[begin : begin + before - 10]).max(initial=0.0) < 1e-9 * b.level
        beyond = (x > x[begin + fast[0]] + 1.2 * p["gives"])[begin : end - 30]
        np.testing.assert_allclose(push[begin : end - 30][beyond], p["size"])
        held += int(np.any(beyond))
    assert held > 2


def test_rock_sticks_and_slips_while_slow_and_slides_evenly_when_quick():
    law = friction("unknown.jerks_along_when_slow")
    assert law.added is not None
    t = np.arange(20000) / slider.RATE
    slow, quick = law.added(t, 1e-6 * t), law.added(t, 1e-5 * t)
    assert np.all(quick == 0.0)
    drops = np.flatnonzero(np.diff(slow) < 0.0)
    climbs = np.diff(slow)[np.diff(slow) > 0.0]
    assert np.median(climbs) == pytest.approx(0.03 / 5e-6 * 1e-6 / slider.RATE)
    heights = -np.diff(slow)[drops]
    assert heights.mean() == pytest.approx(0.03, rel=0.1)
    assert heights.std() / heights.mean() == pytest.approx(0.4 / np.sqrt(3.0), rel=0.3)
    assert np.diff(t[drops]).mean() == pytest.approx(5.0, rel=0.1)
    assert abs(slow.mean()) < 0.1 * slow.std()
    other = friction("unknown.jerks_along_when_slow", 1)
    assert isinstance(other, slider.RateAndState)
    assert other.added is not None
    assert np.abs(other.added(t, 1e-6 * t) - slow).max() > 0.01


def test_a_gouge_dips_as_it_is_slowed_and_does_not_answer_to_being_quickened():
    law = friction("unknown.answers_to_slowing_alone")
    assert law.added is not None
    n, velocities = 600, np.array([1e-6, 1e-5, 1e-6, 3e-6])
    t, speed = np.arange(n * 4) / slider.RATE, np.repeat(velocities, n)
    x = np.concatenate([[0.0], np.cumsum(speed[:-1])]) / slider.RATE
    added = law.added(t, x)
    assert np.all(added[: 2 * n] == 0.0)
    assert added[2 * n] == pytest.approx(-0.025, rel=1e-3)
    one = 2 * n + round(8e-6 / 1e-6 * slider.RATE)
    assert added[one] / added[2 * n] == pytest.approx(np.exp(-1.0), rel=1e-6)
    assert np.abs(np.diff(added)[3 * n - 1 : 3 * n + 1]).max() < 1e-4  # as it is quickened it goes on coming back


def box_between_rails(start: float, aside: float, first: float, wall: float) -> tuple[Array, Array]:
    """Times and places along of a block between two rails 15 mm apart, from its equation in the plane."""
    h, t, frames = 2e-5, 0.0, []
    x, y, v, w = 0.0, 0.0, start, aside
    low, high = first - 0.015, first
    while v > 0.05:
        frames.append((t, x))
        pull = 0.24 * GRAVITY / v
        x, y, v, w, t = x + h * v, y + h * w, v - h * pull * v, w - h * pull * w, t + h
        if (y >= high and w > 0.0) or (y <= low and w < 0.0):
            v, w = v - wall * 1.75 * abs(w), -0.75 * w
    times, places = np.array(frames).T
    return times, places


def test_a_block_between_rails_goes_as_one_that_bounces_in_the_plane():
    """Within 2 mm, as a blow is spread over 4 mm of way, and its speed at that of the moment."""
    name = "unknown.zigzags_between_two_rails"
    for run in range(4):
        law = friction(name, run)
        assert isinstance(law, thrown.Throw)
        record = thrown.record(replace(law, noise=0.0), np.random.default_rng(run))
        drawn = Case(name, "thrown", 1.0, 7).rng(2, run)
        aside, first = drawn.uniform(0.15, 0.35), 0.015 * drawn.uniform(0.2, 1.0)
        start = np.random.default_rng(run).uniform(*law.starts)
        times, places = box_between_rails(start, aside, first, 0.35)
        t, x = record["time [s]"], record["position [m]"]
        inside = t < times[-1]
        assert np.abs(np.interp(t, times, places) - x)[inside].max() < 2e-3
        blows = bounces(start, aside, 0.24, 0.35, 0.75, 0.015, first)
        assert len(blows) >= 2
        assert all(later[1] < earlier[1] for earlier, later in pairwise(blows))


def test_the_shortest_slides_have_as_many_rows_as_a_record_needs():
    for i in range(thrown.N_RUNS):
        law = friction("unknown.zigzags_between_two_rails", i)
        assert isinstance(law, thrown.Throw)
        slowest = replace(law, starts=(law.starts[0], law.starts[0]))
        assert thrown.record(slowest, np.random.default_rng(i))["time [s]"].size > 50
