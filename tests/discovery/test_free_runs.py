"""`augmented.toml`, run freely for a minute, has the periods, tops and bottoms of the held-out record's cycles."""

import dataclasses

import numpy as np
import pytest
from scipy.signal import find_peaks, savgol_filter

from stochfric_mb.discovery import discover
from stochfric_mb.engines import adapter
from stochfric_mb.measurement import load_dataset
from tests.discovery.generator.case import Case
from tests.discovery.test_discover import SEED, made
from tests.discovery.unseen_forms.records import cases as unseen_cases
from tests.discovery.unseen_forms.records import write_record

pytestmark = pytest.mark.slow

CLOSE = 0.1
"""Share by which means and deviations may be off: what a user who replaces an experiment by the model was promised."""
DRAWS = 6
"""Free runs that are averaged where friction is random."""
SETTLED = 5.0
"""Time after which a run from rest is on its cycle: five cycles [s]."""


def cycles(time: np.ndarray, position: np.ndarray) -> dict[str, np.ndarray]:
    """Period [s], top and bottom [m] of each cycle, all smoothed alike over a fiftieth of a second."""
    smooth = savgol_filter(position, max(round(0.02 / (time[1] - time[0])) | 1, 5), 2)
    swing = 0.4 * (np.quantile(position, 0.99) - np.quantile(position, 0.01))
    tops, bottoms = find_peaks(smooth, prominence=swing)[0], find_peaks(-smooth, prominence=swing)[0]
    return {"period": np.diff(time[tops]), "top": smooth[tops], "bottom": smooth[bottoms]}


@pytest.mark.parametrize(
    ("form", "kind"),
    [
        ("velocity_weakening.exponential", "velocity_weakening"),
        ("random_coefficients.per_slip", "random_coefficients"),
        ("harmonic_force.sine", "harmonic_force"),
        ("normal_load_ripple.sinusoidal", "normal_load_ripple"),
        ("position_dependent_friction.sinusoidal", "position_dependent_friction"),
        ("viscous_friction.proportional", "viscous_friction"),
    ],
)
def test_a_free_run_has_the_cycles_of_the_held_out_record(form, kind):
    data = made(Case(form, "one_free", 1.0, SEED))[1]
    outcome = discover(data)
    assert [e.kind for e in outcome.result.effects][:1] == [kind]
    run = data.test[0]
    noise = outcome.study.pool.slips[0].noise
    scenario = dataclasses.replace(outcome.scenario, duration=60.0, output_step=run.sample_interval)
    random = kind == "random_coefficients"
    free = []
    for seed in range(DRAWS if random else 1):
        moved = adapter("reference").simulate(scenario, seed=seed)
        shown = moved.position + noise.draw(len(moved.position), np.random.default_rng(seed))
        free.append(cycles(moved.time[moved.time > SETTLED], shown[moved.time > SETTLED]))
    for name, seen in cycles(run.time, run.channels["position"]).items():
        mean = np.mean([f[name].mean() for f in free])
        spread = np.mean([f[name].std() for f in free])
        assert mean == pytest.approx(seen.mean(), rel=CLOSE), name
        # the deviation of n draws is itself uncertain by 1/sqrt(2 n), in the record as in the free runs: 2 standard errors
        doubt = 2.0 * np.sqrt(0.5 / len(seen) + 0.5 / sum(len(f[name]) for f in free)) if random else 0.0
        # what noise and sampling leave of a cycle that repeats is no spread of its own: half a sample, or the noise
        least = run.sample_interval if name == "period" else noise.deviation
        assert spread == pytest.approx(seen.std(), rel=CLOSE + doubt, abs=least), name


def test_of_friction_drawn_anew_all_slips_tell_the_mean():
    """A fit to forecasts of single slips had it off by seven of these standard errors: it followed their draws."""
    outcome = discover(made(Case("random_coefficients.per_slip", "one_free", 1.0, SEED))[1])
    (effect,), slips = outcome.result.effects, outcome.study.pool.slips[0]
    for name, sigma, forces in (("mu_s", "sigma_s", slips.onset_force), ("mu_k", "sigma_k", slips.moments[:, 0])):
        error = effect.parameters[sigma].value / np.sqrt(len(slips))
        seen = np.mean(forces) / slips.record.mechanism.normal_force
        # the forces are taken with the mechanism as corrected, within a hundredth of which the fit may place it
        assert outcome.result.parameters[name].value == pytest.approx(seen, abs=3.0 * error + 0.01 * seen), name


def test_coefficients_that_scatter_together_do_so_in_free_runs(tmp_path):
    """Drawn independently, the bottoms of the cycles scattered six times as much as those of the record."""
    case = next(c for c in unseen_cases() if c.name == "thirteenth_scatter_of_crests-one-1")
    write_record(case, tmp_path, 131)
    outcome = discover(load_dataset(tmp_path / "data"))
    assert [e.kind for e in outcome.result.effects] == ["random_coefficients"]
    cross = outcome.result.effects[0].parameters["cross_correlation"]
    assert 0.95 < cross.low < cross.value
    run, noise = outcome.dataset.test[0], outcome.study.pool.slips[0].noise
    free = []
    for seed in range(DRAWS):
        scenario = dataclasses.replace(
            outcome.scenario, duration=float(np.ptp(run.time)) * 1.5, output_step=run.sample_interval
        )
        moved = adapter("reference").simulate(scenario, seed=seed)
        shown = moved.position + noise.draw(len(moved.position), np.random.default_rng(seed))
        kept = moved.time > 0.2 * scenario.duration
        free.append(cycles(moved.time[kept], shown[kept]))
    for name, seen in cycles(run.time, run.channels["position"]).items():
        doubt = 2.0 * np.sqrt(0.5 / len(seen) + 0.5 / sum(len(f[name]) for f in free))
        assert np.mean([f[name].std() for f in free]) == pytest.approx(seen.std(), rel=CLOSE + doubt), name
