"""Repeated and stray positions are detected, replaced, and distinguished from encoders that are coarse or rest."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint import joint_outcome
from stochfric_mb.discovery.driven_joint.balance.readings import mended, repeated, stray
from stochfric_mb.discovery.driven_joint.joint_workflow import require_usable
from stochfric_mb.discovery.driven_joint.replaced_readings import as_stated, error_kept
from stochfric_mb.discovery.driven_joint.sliding import FEWEST, hardly_sliding, require_sliding
from stochfric_mb.discovery.driven_joint.source import source_of
from stochfric_mb.discovery.inference.stray_readings import without
from stochfric_mb.effects import make_effect
from stochfric_mb.errors import InputError
from stochfric_mb.measurement import load_dataset
from tests.discovery.joint_generator.case import Case, write
from tests.discovery.joints.test_parts import coulomb, pair

RATE, NOISE = 1000.0, 1.0e-5


def motion(seed=0):
    """Strokes of 0.1 m at 1 Hz with white noise: position [m] at 1 kHz."""
    t = np.arange(6000) / RATE
    return 0.1 * np.sin(2.0 * np.pi * t) + NOISE * np.random.default_rng(seed).standard_normal(t.size)


def test_telegrams_that_are_dropped_are_found_and_the_motion_between_them_is_known_again():
    x = motion()
    stale = x.copy()
    begins = range(100, 5900, 250)  # at all speeds, turning points among them
    for begin in begins:
        stale[begin : begin + 20] = stale[begin]
    held = repeated(stale)
    # where the joint turns round it misses less than four steps of 20 ms, which does no harm
    fast = [b for b in begins if abs(np.cos(2.0 * np.pi * (b + 10) / RATE)) > 0.3]
    assert {start - 1 for start, _ in held} >= set(fast)
    assert all(end - start == 19 for start, end in held)
    better = without(stale, held, np.zeros(len(x), dtype=bool))
    missed = max(abs(stale[a:b] - x[a:b]).max() for a, b in held)
    # cubics of 30 readings on each side: off by no more than some of the noise of one of them
    assert max(abs(better[a:b] - x[a:b]).max() for a, b in held) < 6.0 * NOISE < 0.01 * missed


def test_news_that_comes_at_odd_times_is_old_between():
    x, rng = motion(), np.random.default_rng(1)
    news = np.cumsum(rng.integers(4, 12, 900))
    news = np.r_[0, news[news < len(x)]]
    stale = x[news[np.searchsorted(news, np.arange(len(x)), side="right") - 1]]
    held = repeated(stale)
    assert [start - 1 for start, _ in held] == news[: len(held)].tolist()
    assert len(held) >= len(news) - 1
    better = without(stale, held, np.zeros(len(x), dtype=bool))
    assert abs(better - x)[news[0] : news[-1]].max() < 0.01 * abs(stale - x).max()


def test_a_wild_reading_at_rest_is_no_news_of_a_joint_that_has_moved_on():
    """A clean encoder rests; what ends its constant readings comes back."""
    t = np.arange(6000) / RATE
    x = np.round(0.05 * (1.0 - np.cos(2.0 * np.pi * np.clip(t % 1.5, 0.0, 1.0))) / 1.0e-5) * 1.0e-5  # rests of half a second
    hit = [1200, 1301, 2700, 2701, 4400]
    wild = x.copy()
    wild[hit] += [0.04, -0.03, 0.05, 0.05, 0.02]
    assert repeated(wild) == []
    assert np.flatnonzero(stray(wild)).tolist() == hit
    late = x.copy()
    late[300:340] = x[300]  # there are repeated ones, too: the joint moves on
    assert repeated(late) == [(301, 340)]


def test_a_coarse_encoder_and_rest_repeat_nothing():
    coarse = np.round(motion() / 2.0e-4) * 2.0e-4
    resting = 0.1 + np.cumsum(1.0e-5 * (np.arange(6000) // 1500 % 2))
    assert repeated(coarse) == []
    dithers = 0.1 + 1.0e-6 * np.round(0.7 * np.random.default_rng(7).standard_normal(6000))
    dithers[2000:2003] = dithers[1999] + 1.0e-6 * np.array([0.25, 0.5, 0.75])  # rows that were lost
    assert repeated(dithers) == []
    fuzzy = dithers * (1.0 + 2.0e-16 * (np.arange(6000) % 7 == 0))  # equal but for arithmetic, here and there
    assert repeated(fuzzy) == []
    assert repeated(np.round(resting, 6)) == []


def test_stray_readings_are_found_and_no_turning_point_is_one():
    x = motion()
    assert not stray(x).any()
    assert not stray(x - NOISE * np.random.default_rng(0).standard_normal(x.size)).any()
    hit = np.arange(37, 5990, 491)
    off = x.copy()
    off[hit] += np.where(hit % 2 == 0, 2.0e-3, -1.0e-3)
    seen = stray(off)
    assert np.array_equal(np.flatnonzero(seen), hit)
    assert abs(without(off, [], seen) - x)[hit].max() < 6.0 * NOISE


def test_a_click_that_rings_is_stray_and_a_kick_or_a_step_is_none():
    x = motion()
    clicked, hit = x.copy(), np.arange(41, 5950, 397)
    for i, ring in enumerate((1.0, -0.7, 0.45, -0.25)):
        clicked[hit + i] += 2.0e-3 * ring
    seen = stray(clicked)
    assert np.array_equal(np.flatnonzero(seen), np.sort(np.concatenate([hit + i for i in range(4)])))
    assert abs(without(clicked, [], seen) - x)[seen].max() < 6.0 * NOISE
    after = np.maximum(np.arange(len(x)) - 3000, 0)
    assert not stray(x + 2.0e-4 * after).any()  # a kick: another velocity from then on
    assert not stray(x + 2.0e-3 * (after > 0)).any()
    assert not stray(x + 2.0e-3 * np.exp(-after / 20.0) * np.sin(1.5 * after)).any()  # it rings on


def test_steps_of_an_encoder_that_starts_from_rest_are_not_stray():
    """It rests for most of the record, where nothing differs from a curve, and then turns slowly, by a count now and then."""
    t = np.arange(9000) / RATE
    counts = np.round(1.0e-3 * np.maximum(t - 6.0, 0.0) ** 2 / 1.0e-6) * 1.0e-6
    assert not stray(counts).any()
    off = counts.copy()
    off[7000] += 40.0e-6
    assert np.flatnonzero(stray(off)).tolist() == [7000]


@pytest.mark.parametrize("every", [1, 10, 20])
def test_single_stray_readings_are_found_however_few_samples_come_in_a_period(every):
    x = motion()[::every].copy()
    hit = np.arange(29, len(x) - 20, 31)
    x[hit] += np.where(hit % 2 == 0, 6.0e-3, -6.0e-3)
    assert np.array_equal(np.flatnonzero(stray(x)), hit)


def test_a_position_that_a_multiplexer_mixes_with_another_channel_is_seen_without_it(tmp_path):
    """As it is read, its noise asks for windows so wide that the joint slides in none: no reason to refuse the record."""
    case = Case("sensor_outliers.multiplexer_at_the_drive", "mjcf_hinge", 1.0, 1701)
    write(case, tmp_path / "set", tmp_path / "truth.json")
    require_usable(load_dataset(tmp_path / "set"))


def with_strays(measured, size, every=397):
    """A dataset in which one position of ``every`` is off by ``size`` [m], to either side."""
    runs = []
    for run in measured.runs:
        x = run.channels["position"].copy()
        x[41::every] += size * (-1.0) ** np.arange(len(x[41::every]))
        runs.append(dataclasses.replace(run, channels={**run.channels, "position": x}))
    return dataclasses.replace(measured, runs=tuple(runs))


def drag(q, v):
    return coulomb(q, v) + 40.0 * v


def test_stray_readings_beside_another_effect_are_told_by_what_is_left_with_it():
    """The drag is 60 times what the strays leave: beside the stated model they change nothing, and were lost."""
    result = joint_outcome(with_strays(pair(drag), 1.0e-4)).result
    assert [e.kind for e in result.effects] == ["viscous_friction", "sensor_outliers"]
    assert result.effects[0].parameters["coefficient"].value == pytest.approx(40.0, rel=1.0e-3)
    assert result.gap.augmented < 1.5 * result.gap.floor
    assert not any("replaced" in note for note in result.notes)


def test_what_replacing_readings_is_worth_depends_on_what_is_named_beside_it():
    measured = with_strays(pair(drag), 1.0e-4)
    as_read, repaired = source_of(measured), source_of(mended(measured)[0])
    stated = {"": as_stated(as_read, "")}
    model, nuisances, noise = stated[""]
    named = {"": (model.plus(make_effect("viscous_friction", coefficient=40.0)), nuisances, 0.05 * noise)}
    assert error_kept(as_read, repaired, stated) > 0.99
    assert error_kept(as_read, repaired, named) < 0.4


def test_stray_readings_that_change_little_are_no_finding():
    """20 times the noise of the position, three times a run, and the force is loud."""
    measured, rng = with_strays(pair(coulomb), 2.0e-5, 2900), np.random.default_rng(4)
    loud = [r.channels | {"force": r.channels["force"] + 0.3 * rng.standard_normal(len(r.time))} for r in measured.runs]
    runs = tuple(dataclasses.replace(r, channels=c) for r, c in zip(measured.runs, loud, strict=True))
    result = joint_outcome(dataclasses.replace(measured, runs=runs)).result
    assert result.verdict == "none"
    assert not any("replaced" in note for note in result.notes)


def test_a_joint_that_rests_all_the_time_is_refused_with_what_to_change():
    moves, rng = pair(coulomb), np.random.default_rng(0)
    assert hardly_sliding(source_of(moves)) is None
    require_sliding(source_of(moves))
    still = [r.channels | {"position": 1.0e-6 * rng.standard_normal(len(r.time))} for r in moves.runs]
    runs = tuple(dataclasses.replace(r, channels=c) for r, c in zip(moves.runs, still, strict=True))
    with pytest.raises(InputError, match=f"at least {FEWEST} are needed: record longer or livelier motion, or check units"):
        require_sliding(source_of(dataclasses.replace(moves, runs=runs)))


def test_a_wild_reading_of_an_even_motion_without_noise_is_found():
    """Each sample is 3e-4 after the one before and shows no resolution; six of them off is wild."""
    x = 3.0e-4 * np.arange(3000.0)
    assert not stray(x).any()
    x[1500] += 2.0e-3
    assert np.flatnonzero(stray(x)).tolist() == [1500]
