"""The claims of Kang, Choi and Yoo 2015: verdicts follow from numbers, and the numbers are right.

The quick twin of `stochfric reproduce kang2015`; exact numbers are from the closed forms beside them.
"""

import dataclasses
import json
import math
import re

import numpy as np
import pytest
from click.testing import CliRunner

from stochfric_mb import load_scenario
from stochfric_mb.__main__ import main
from stochfric_mb.coefficients import Knots
from stochfric_mb.reproduction import FAILS, HOLDS, QUICK, UNDECIDABLE, Number, coefficients, output_step, portraits
from stochfric_mb.reproduction.claims import same_distribution

VERDICTS = {HOLDS, FAILS, UNDECIDABLE}
COULOMB_BREAK_AWAY = {0.01: 0.7932, 0.001: 0.7777, 0.0001: 0.7646}  # by an independent program, to 1e-4, up to 10 s


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("reproduce") / "out"
    done = CliRunner().invoke(main, ["reproduce", "kang2015", "--quick", "--out", str(out)])
    assert done.exit_code == 0, done.output
    return out


@pytest.fixture(scope="module")
def content(folder):
    return json.loads((folder / "reproduce.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def claims(content):
    return {claim["id"]: claim for claim in content["claims"]}


def test_schema(content):
    assert content["schema"] == "stochfric.reproduction/1"
    for claim in content["claims"]:
        assert {"id", "claim", "where", "verdict", "figures", "test", "rule"} <= set(claim)
        assert claim["verdict"] in VERDICTS
        assert claim["figures"]
        for name, number in claim["figures"].items():
            assert {"value", "low", "high", "unit"} <= set(number), name
            if number["low"] is not None and not name.startswith("ks_"):
                # A bootstrapped KS distance lies above its estimate where the samples agree; every other interval holds it.
                assert number["low"] <= number["value"] <= number["high"], name
    assert {gap["gap"] for gap in content["left_open"]} >= {"e_lim", "zeta", "v_r < 0", "mu_k < 0 draws"}
    assert all(gap["default"] and gap["effect"] for gap in content["left_open"])


def test_page_is_one_file_with_everything(folder, content):
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert not re.search(r"(src|href)\s*=\s*[\"'](https?:)?//", page)
    for claim in content["claims"]:
        assert f'id="{claim["id"]}"' in page
        for mend in claim["mended_by"]:
            assert mend["process"] in page
    plots = {p.stem for p in (folder / "plots").iterdir()}
    assert {
        "step_position",
        "step_velocity",
        "rejection",
        "infeasible",
        "interpolation",
        "growth",
        "portrait_1",
        "portrait_3",
    } <= plots
    assert page.count("<svg ") == len(plots)


def test_displacement_depends_on_the_output_step(claims):
    claim = claims["step_independence_displacement"]
    assert claim["verdict"] == FAILS
    distance = claim["figures"]["ks_coulomb_2s_0.01_0.0001_n1000"]
    assert distance["low"] > 0.9  # 0.97 by an independent program with 3000 samples
    assert distance["p_value"] < 1e-6


def test_the_draws_near_break_away_are_why(claims):
    figures = claims["step_independence_displacement"]["figures"]
    for step, mu_s in COULOMB_BREAK_AWAY.items():
        result = figures[f"break_away_mu_s_coulomb_{step:g}"]
        # Here only the first slips, up to 2 s, count: five standard errors of 1000 runs, and the last digit given.
        assert result["value"] == pytest.approx(mu_s, abs=2.5 * (result["high"] - result["low"]) / 2 + 3e-4)


def test_our_processes_mend_it(claims):
    mends = {mend["process"]: mend for mend in claims["step_independence_displacement"]["mended_by"]}
    for process in ("knots, 0.01 s", "spatial, 25 um", "matern, correlation time 0.2 s"):
        assert mends[process]["outcome"] == HOLDS
    assert mends["knots, 0.01 s"]["figures"]["largest_difference"]["value"] < 7e-13


def test_they_mend_velocity_too(claims):
    mends = {mend["process"]: mend for mend in claims["step_independence_velocity"]["mended_by"]}
    for process in ("knots, 0.01 s", "spatial, 25 um", "matern, correlation time 0.2 s"):
        assert mends[process]["outcome"] == HOLDS
    # Positions agree to 7e-13 m; the oscillator turns them into velocities with 50 rad/s.
    assert mends["knots, 0.01 s"]["figures"]["largest_difference"]["value"] < 50 * 7e-13


def test_smooth_paths_keep_sigma(claims):
    """Between knots a tenth of the correlation time apart: sd^2 falls half-way by (1 - correlation)/2 at most."""
    for mend in claims["interpolation_keeps_distribution"]["mended_by"]:
        averaged = mend["figures"]["sd_time_average"]
        assert averaged["low"] > 0.9  # independent knots: 0.8116
        assert averaged["low"] < 1.0 < averaged["high"] + 0.03  # Ornstein-Uhlenbeck: exp(-0.1), so 0.976 half-way


def test_rejection_by_closed_form(claims):
    claim = claims["rejection_keeps_distributions"]
    assert claim["verdict"] == HOLDS
    figures = claim["figures"]
    assert figures["infeasible_exact_table_1"]["value"] == pytest.approx(2e-35, rel=0.5)  # given to one digit
    assert figures["infeasible_exact_table_2"]["value"] == pytest.approx(4e-20, rel=0.5)
    for d in (1, 2, 3):
        density = math.exp(-0.5 * d * d) / math.sqrt(2 * math.pi)
        exact = density / (1 - 0.5 * math.erfc(d / math.sqrt(2))) / math.sqrt(2)  # mean of a truncated normal, equal sigmas
        shift = figures[f"mean_shift_d{d}"]
        assert shift["value"] == pytest.approx(exact, abs=2.5 * (shift["high"] - shift["low"]) / 2)  # five standard errors
        share = figures[f"infeasible_d{d}"]
        exact = 0.5 * math.erfc(d / math.sqrt(2))
        assert share["value"] == pytest.approx(exact, abs=5 * math.sqrt(exact * (1 - exact) / QUICK.n_pairs))


def test_rejection_fails_where_the_means_are_close():
    close = load_scenario("kang2015_table1", overrides=["law.mu_k=0.77", "coefficients.sigma_k=0.015"])
    drawn = coefficients.draw_rejections({"Table 3": close}, QUICK, 0)
    assert coefficients.rejection_claim(drawn).verdict == FAILS


def test_interpolation_narrows(claims):
    claim = claims["interpolation_keeps_distribution"]
    assert claim["verdict"] == FAILS
    result = claim["figures"]["sd_time_rms"]
    assert result["value"] == pytest.approx(math.sqrt(2 / 3), abs=2.5 * (result["high"] - result["low"]) / 2)  # five errors
    assert claims["interpolation_keeps_feasible"]["verdict"] == HOLDS


def test_portraits(claims):
    for name in ("table_1", "table_2_13_8_rad_s"):
        claim = claims[f"portrait_wider_{name}"]
        assert claim["verdict"] == HOLDS
        assert claim["figures"]["settled_coulomb"]["value"] < 30.0
    assert claims["portrait_wider_table_2_13_8_rad_s"]["figures"]["settled_coulomb"]["value"] == pytest.approx(23.4, abs=0.05)
    assert claims["portrait_wider_table_2_18_7_rad_s"]["figures"]["settled_elastic_stick"]["value"] is None


def test_sigma_k(claims):
    assert claims["sigma_k_table_1"]["verdict"] == HOLDS
    assert claims["sigma_k_table_2"]["verdict"] == FAILS


def test_cost_grows_in_proportion(claims, content):
    assert all(len(s["size"]) == len(s["seconds"]) == len(QUICK.cost_multiples) for s in content["cost_growth"])
    figures = claims["cost_of_a_run"]["figures"]
    for law in ("coulomb", "havsin", "elastic_stick"):
        for along in ("samples", "time"):
            # Thirty-fold ensembles: 1.2 would be twice the work for nothing (30^0.2), 0.8 a cost that is not the runs'.
            assert figures[f"exponent_{along}_{law}"]["value"] == pytest.approx(1.0, abs=0.2), (along, law)


def test_a_process_that_does_not_know_the_step_turns_the_verdict(monkeypatch):
    monkeypatch.setattr(output_step, "paper_process", lambda sigma_s, sigma_k, step: Knots(
        sigma_s=sigma_s, sigma_k=sigma_k, spacing=0.01))  # fmt: skip
    scenarios = {"coulomb": load_scenario("kang2015_table1", law="coulomb")}
    study = output_step.run_steps(scenarios, QUICK, 0, lambda done: None)
    verdicts = {claim.id: claim.verdict for claim in output_step.claims(study, {}, QUICK)}
    assert verdicts == {"step_independence_displacement": HOLDS, "step_independence_velocity": HOLDS}


def test_same_numbers_for_the_same_seed():
    few = dataclasses.replace(QUICK, n_many=20, n_paper=10, steps=(0.01, 0.001), resamples=9)
    scenarios = {"coulomb": load_scenario("kang2015_table1", law="coulomb")}
    one, two, other = (
        output_step.claims(output_step.run_steps(scenarios, few, seed, lambda done: None), {}, few) for seed in (5, 5, 6)
    )
    assert [c.to_dict() for c in one] == [c.to_dict() for c in two]
    assert [c.to_dict() for c in one] != [c.to_dict() for c in other]


def distance(value, p, n, half=0.01):
    return Number(name="d", label="d", value=value, low=value - half, high=value + half, p_value=p, n=n)


@pytest.mark.parametrize(
    ("distances", "verdict"),
    [
        ([distance(0.3, 1e-9, 1000)], FAILS),
        ([distance(0.3, 1e-9, 1000), distance(0.01, 0.9, 1000)], FAILS),
        ([distance(0.3, 0.009, 1000), distance(0.01, 0.9, 1000)], HOLDS),  # 0.009 is no rarity among two at 0.01
        ([distance(0.02, 1e-9, 100_000)], UNDECIDABLE),  # certain, but too small to matter
        ([distance(0.01, 0.5, 1000)], HOLDS),
        ([distance(0.01, 0.5, 100)], UNDECIDABLE),  # too few to have seen it
    ],
)
def test_rule(distances, verdict):
    assert same_distribution(distances) == verdict


def test_turning_points_are_located():
    time = np.arange(0.0, 20.0, portraits.STEP)
    phase = 2.0 * np.pi * time / 1.3
    x = 2e-3 + 1e-3 * np.sin(phase)
    v = 1e-3 * 2.0 * np.pi / 1.3 * np.cos(phase)
    runs = (np.array([x, x + 1e-5]), np.array([v, v]))
    p = portraits.Portrait("", "", 0.0, time, runs, runs, None, 0.0, 1e-3, 2e-3)
    result = portraits.turns(p, runs, 5.0, 15.0)
    tops = [t for t in 1.3 * (0.25 + np.arange(20)) if 5.0 <= t <= 15.0]
    assert result.n.tolist() == [len(tops)] * 2
    # Cubic error of a linear velocity over 2 ms at 4.8 rad/s: far below 1e-9 m.
    np.testing.assert_allclose(result.total / result.n + p.static, [3e-3, 3e-3 + 1e-5], atol=1e-9)
    assert result.spread() == pytest.approx(np.std([0.0] * len(tops) + [1e-5] * len(tops), ddof=1), rel=1e-3)


def test_existing_folder_and_unknown_study(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "mine").write_text("x")
    for words, part in ((["kang2015"], "exists"), (["kang2015", "--force"], "reproduce.json"), (["kang2016"], "kang2015")):
        out = tmp_path / ("out" if words[0] == "kang2015" else "new")
        done = CliRunner().invoke(main, ["reproduce", *words, "--quick", "--out", str(out)])
        assert done.exit_code == 2
        assert part in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["out"]
