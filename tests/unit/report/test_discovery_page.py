"""The report of a discovery: every number on the page stands in result.json, whatever the verdict."""

import csv
import dataclasses
import html
import html.parser
import json
import re
from types import SimpleNamespace

import numpy as np
import pytest

from stochfric_mb import load_scenario
from stochfric_mb.discovery import discover
from stochfric_mb.discovery.export import files
from stochfric_mb.discovery.outcome import Outcome
from stochfric_mb.discovery.result import EffectEstimate, Gap, Interval, Result, Where
from stochfric_mb.effects import make_effect
from stochfric_mb.measurement.dataset import Dataset, Run
from stochfric_mb.reference.augmented import Start, augmented_system
from stochfric_mb.report.discovery import further, interval, page
from stochfric_mb.report.discovery_evidence import gather
from stochfric_mb.report.discovery_facts import complete
from stochfric_mb.report.discovery_pictures import figures
from stochfric_mb.report.record_picture import record

SCENARIO = dataclasses.replace(load_scenario("kang2015_table1", law="coulomb"), process=None)
GAP = Gap("crps_one_cycle", "m", True, 1.5e-4, 6.0e-5, 3.8e-5, 3.6e-5)
PARAMETERS = {"mu_s": Interval(0.7912, 0.75, 0.83, "-"), "stiffness": Interval(3967.0, 3900.0, 4040.0, "N/m")}
WEAKENING = EffectEstimate(
    "velocity_weakening", ("viscous_friction",), Where("relative velocity", "friction falls as the speed rises"),
    {"amplitude": Interval(0.0512, 0.049, 0.0534, "-"), "decay_velocity": Interval(0.0071, 0.0065, 0.0077, "m/s")},
    151.3, 2.4e-31,
)  # fmt: skip
RANDOM = EffectEstimate(
    "random_coefficients", (), Where("scatter", "friction scatters"),
    {"sigma_s": Interval(0.0152, 0.0125, 0.0179, "-"), "spacing": Interval(0.01, 0.01, 0.01, "s")}, 431.0, 0.0,
)  # fmt: skip
BASE = Result(
    verdict="effect", effects=(WEAKENING,), where=None, ranking=(("velocity_weakening", 151.3), ("slip_shape", -4.2)), gap=GAP,
    not_identifiable=("dwell_ageing",), next_experiment="a run at 2 belt speeds", parameters=PARAMETERS,
    notes=("8.3e-06 of the samples were outliers",),
    details={"round_1": {"velocity_weakening": 151.3, "slip_shape": -4.2}, "round_2": {"backlash": 3.1},
             "confirmation_1": {"velocity_weakening": [9.01, 17.2], "believed": [8295.4, 8295.4]}},
)  # fmt: skip
RESULTS = {
    "one effect": BASE,
    "two effects": dataclasses.replace(BASE, effects=(WEAKENING, RANDOM)),
    "none": dataclasses.replace(
        BASE, verdict="none", effects=(), gap=dataclasses.replace(GAP, recalibrated=3.65e-5, augmented=3.65e-5),
        power={"dwell_ageing": 0.0123, "viscous_friction": 1.7}, details={},
    ),
    "unknown": dataclasses.replace(BASE, verdict="unknown", effects=(), where=Where("scatter", "it switches between 2 levels")),
    "too few slips": Result(
        "unknown", (), Where("record", "the runs hold too few slips: each needs 12"), (), None, (), "record 12 cycles", {}
    ),
    "floor too high": dataclasses.replace(BASE, gap=dataclasses.replace(GAP, augmented=3.0e-5)),
    "relative error": dataclasses.replace(BASE, gap=Gap("closed_loop_voltage", "-", True, 0.231, 0.159, 0.038, 0.0021)),
    "another metric": dataclasses.replace(
        BASE, gap=Gap("simulated closed loop, voltage", "V", True, 3.37, 0.446, 0.358, 0.35, "repeated strokes")
    ),
}  # fmt: skip
HEADLINES = {
    "one effect": "Missing from the model: friction falls as the sliding velocity rises",
    "two effects": "velocity rises; friction scatters from slip to slip with no memory",
    "none": "Nothing is missing that these data show",
    "unknown": "Something is missing, and no known effect explains it",
    "too few slips": "These data do not decide",
    "floor too high": "the floor is an estimate",
    "relative error": "from 15.9&nbsp;% to 3.80&nbsp;%",
    "another metric": "simulated closed loop, voltage",
}


def run(name, role, position, **settings):
    time = 1.0e-3 * np.arange(len(position))
    return Run(name=name, role=role, time=time, channels={"position": position}, settings=settings, sample_interval=1.0e-3)


def outcome_of(result):
    flat = np.linspace(0.0, 1.0e-3, 4000)
    runs = (run("run_1", "fit", flat), run("run_2", "test", flat, belt_velocity=1.7e-3))
    return Outcome(result, SCENARIO, Dataset(title="rig 7", scenario_path=None, scenario=SCENARIO, runs=runs))


def test_what_the_result_says_of_several_runs_is_not_said_of_each_again():
    note = "voltage is taken to be in mV (of run 7)"
    outcome = outcome_of(dataclasses.replace(BASE, notes=(f"2 runs, such as run_1: {note}",)))
    runs = tuple(dataclasses.replace(r, notes=(note, "sampled by hand")) for r in outcome.dataset.runs)
    _, text, _ = written(dataclasses.replace(outcome, dataset=dataclasses.replace(outcome.dataset, runs=runs)))
    assert text.count("voltage is taken to be in mV") == 1
    assert text.count("sampled by hand") == 2


def written(outcome):
    """Return what result.json holds, and the page, of an outcome."""
    evidence = gather(outcome)
    content = json.loads(complete(outcome, evidence, "stochfric discover rig7 --out out9").to_json())
    drawn = figures(content, evidence)
    return content, page(content, drawn, further(outcome)), drawn


@pytest.fixture(scope="module")
def outcome():
    """Return the outcome of discovery on data simulated with velocity weakening."""
    truth = [make_effect("velocity_weakening", amplitude=0.12, decay_velocity=0.008)]
    runs = []
    for number, role in enumerate(("fit", "test")):
        system = augmented_system(SCENARIO.mechanism, SCENARIO.law, truth)
        motion = system.march(Start(position=1.0e-4 * number, velocity=2.5e-3, stick=True), 1.0e-3, 30_000)
        noise = 5.0e-6 * np.random.default_rng(number).standard_normal(30_000)
        runs.append(run(f"run_{number}", role, motion.position + noise))
    return discover(Dataset(title="planted", scenario_path=None, scenario=SCENARIO, runs=tuple(runs)))


QUIET = ("style", "title", "script", "svg")
"""Tags in which numbers are no claims: the ticks of an axis, for one."""


class Text(html.parser.HTMLParser):
    """Splits a page into marked numbers, texts said to come from result.json, and the rest."""

    def __init__(self, text):
        super().__init__()
        self.numbers, self.sayings, self.rest, self._inside = [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        if tag in QUIET or tag in ("data", "span"):
            self._inside.append((tag, dict(attrs)))
            if tag == "span" and dict(attrs).get("class") == "said":
                self.sayings.append("")

    def handle_endtag(self, tag):
        if tag in QUIET or tag in ("data", "span"):
            assert self._inside.pop()[0] == tag

    def handle_data(self, data):
        tag, attrs = self._inside[-1] if self._inside else ("", {})
        if tag == "data":
            self.numbers.append((float(attrs["value"]), data))
        elif tag == "span" and attrs.get("class") == "said":
            self.sayings[-1] += data
        elif not any(open_tag in QUIET for open_tag, _ in self._inside):
            self.rest.append(data)


def leaves(value):
    """Return all numbers, and all strings and keys, in a JSON value."""
    if isinstance(value, dict):
        inner = [leaves(v) for v in value.values()]
        return set().union(*(n for n, _ in inner)), set(value).union(*(s for _, s in inner))
    if isinstance(value, list):
        inner = [leaves(v) for v in value]
        return set().union(*(n for n, _ in inner)), set().union(*(s for _, s in inner))
    if isinstance(value, str):
        return set(), {value}
    return ({float(value)} if value is not None and not isinstance(value, bool) else set()), set()


def shows(text, value):
    """Return whether ``text`` is ``value``, as it is or as %, thousandths or millionths, to its last digit."""
    plain = text.replace("−", "-").translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    mantissa, _, power = plain.partition("·10")
    exponent = int(power or 0)
    last = 10.0 ** (exponent - len(mantissa.partition(".")[2]))
    number = float(mantissa) * 10.0**exponent
    return any(abs(number - scale * value) <= 0.5001 * last for scale in (1.0, 1.0e2, 1.0e3, 1.0e6))


def check_backed(content, text):
    """Check that every number of the page stands in ``content``, and that none stands unmarked."""
    numbers, strings = leaves(content)
    seen = Text(text)
    assert seen.numbers
    for value, shown in seen.numbers:
        assert value in numbers, (value, shown)
        assert shows(shown, value), (value, shown)
    for saying in seen.sayings:
        assert saying in strings or saying + "." in strings, saying
    assert not re.findall(r"[^\n]*\d[^\n]*", " ".join(seen.rest)), "a number that is not marked"


@pytest.mark.parametrize("name", RESULTS)
def test_every_number_stands_in_the_result(name):
    content, text, _ = written(outcome_of(RESULTS[name]))
    check_backed(content, text)
    assert HEADLINES[name] in re.sub(r"\s+", " ", re.sub(r"<[^>]+>", "", text))


def test_the_check_finds_a_number_that_is_not_backed():
    content, text, _ = written(outcome_of(BASE))
    for wrong in (
        text.replace("</h1>", " 42</h1>"),
        text.replace('<data value="6e-05">', '<data value="6.1e-05">'),
        text.replace(">60.0</data>", ">61.0</data>"),
        text.replace('class="said">8.3e-06', 'class="said">9.3e-06'),
    ):
        assert wrong != text
        with pytest.raises(AssertionError):
            check_backed(content, wrong)


@pytest.mark.parametrize("name", RESULTS)
def test_the_page_needs_no_other_file(name):
    _, text, drawn = written(outcome_of(RESULTS[name]))
    assert not re.findall(r'(?:src|href)="(?!data:|#)|url\((?!#)|@import|<script ', text)
    assert text.count("<svg ") == len(drawn)


def test_what_is_named_equivalent_blind_and_next_is_told():
    _, text, _ = written(outcome_of(BASE))
    plain = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", "", text))
    for part in (
        "these data cannot distinguish it from viscous friction",
        "0.0512 (0.0490 to 0.0534)",
        "mu_k(v) = mu_k + amplitude exp(-s), s = (abs(v)/decay_velocity)^shape_exponent, or amplitude (1 + tail s)^(-1/tail)",
        "are not looked for in this mechanism: dwell ageing",
        "a run at 2 belt speeds.",
        "8.3e-06 of the samples were outliers.",
        "belt_velocity = ",
        "91.7 % of what lies above the noise floor",
    ):
        assert part in plain.replace("&nbsp;", " "), part


def test_what_was_not_fitted_has_no_interval():
    _, text, _ = written(outcome_of(RESULTS["two effects"]))
    row = next(line for line in text.splitlines() if ">spacing<" in line)
    assert "not fitted" in row
    assert " to " not in row


def test_pictures_that_come_as_data_are_drawn():
    line = {"name": "data", "x": [0.0, 1.0], "y": [0.0, 2.0]}
    data = {"panels": [{"x": "angle [rad]", "y": "torque [N m]", "series": [line, line | {"draw": "points", "name": "more"}]}]}
    (picture,) = further(SimpleNamespace(pictures=[("Friction", "Torque against angle.", data)]))
    content, _, drawn = written(outcome_of(BASE))
    text = page(content, drawn, [picture])
    assert "Torque against angle." in text
    assert picture[2].startswith("<svg ")
    assert text.count("<svg ") == len(drawn) + 1


def test_detection_limits_name_their_parameter_and_unit():
    content, text, _ = written(outcome_of(RESULTS["none"]))
    assert content["details"]["detection_limits"] == [
        {"kind": "dwell_ageing", "parameter": "rate", "value": 0.0123, "unit": "-"},
        {"kind": "viscous_friction", "parameter": "coefficient", "value": 1.7, "unit": "N s/m"},
    ]
    row = next(line for line in text.splitlines() if "viscous friction" in line and "<tr>" in line)
    assert "coefficient" in row
    assert "N s/m" in row


def test_parameters_are_those_of_the_model_with_the_effects(outcome):
    """Page, result and table show one set of numbers, and flag what moved beyond its uncertainty or was not measured."""
    content, text, _ = written(outcome)
    table = {(r["effect"], r["parameter"]): r for r in csv.DictReader(files(outcome)["parameters.csv"].splitlines())}
    rows = {m[1]: m[0] for m in re.finditer(r'<tr><th><span class="said">(\w+)</span></th>.*?</tr>', text, re.DOTALL)}
    stated = {**content["details"]["stated"]["mechanism"], **content["details"]["stated"]["law"]}
    about = content["details"]["parameters"]
    for name, number in content["believed"].items():
        assert float(table["", name]["value"]) == pytest.approx(number["value"], rel=1e-5)  # six digits in the table
        assert table["", name]["source"] == ("prior" if name in about["not_measured"] else "fit")
        assert bool(table["", name]["moved"]) == (name in about["moved_beyond_uncertainty"])
        assert f'<data value="{number["value"]!r}">' in rows[name]
        assert ("your stated value" in rows[name]) == (name in about["not_measured"])
        assert ("stated standard deviations off" in rows[name]) == (
            name in about["moved_beyond_uncertainty"] and name not in about["not_measured"]
        )
        if name not in about["not_measured"]:
            assert number["low"] < number["value"] < number["high"], f"{name}: a prior returned as a measurement"
        augmented = {
            **outcome.scenario.mechanism.__dict__,
            "mu_s": outcome.scenario.law.mu_s,
            "mu_k": outcome.scenario.law.mu_k,
        }
        assert number["value"] == pytest.approx(augmented[name], rel=1e-6), name
        assert name in stated


def test_what_an_axis_says_is_not_rounded():
    drawn = record(np.linspace(0.0, 1.0, 50), np.linspace(0.0012, 0.0038, 50), "position [m]")
    said = set(re.findall(r"<text[^>]*>([^<]+)</text>", drawn))
    assert {"0.0015", "0.0025", "0.0035"} <= said
    facts = json.loads(html.unescape(re.search(r"data-axes='(.*?)'", drawn)[1]))
    assert facts[0]["y"] == pytest.approx([0.0012 - 0.00013, 0.0038 + 0.00013])  # matplotlib's margins of 5 %


def test_friction_against_speed_has_the_law_and_no_ends(outcome):
    _, _, drawn = written(outcome)
    facts = json.loads(html.unescape(re.search(r"data-axes='(.*?)'", drawn["friction"])[1]))
    assert [name for name in facts[0]["series"] if name] == ["measured", "recalibrated", "with the effects"]
    assert facts[0]["labels"] == ["relative velocity [mm/s]", "friction force in the slip [N]"]
    slip = gather(outcome).friction["augmented"]
    effect, law, box = outcome.result.effects[0].parameters, outcome.scenario.law, outcome.scenario.mechanism
    speeds = np.linspace(0.2, 0.9, 5) * slip.relative_velocity.max()
    rising = slice(0, int(np.argmax(slip.relative_velocity)))
    assert (effect["shape_exponent"].value, effect["tail"].value) == (1.0, 1.0)  # what was planted
    fall = 1.0 / (1.0 + speeds / effect["decay_velocity"].value)
    assert np.interp(speeds, slip.relative_velocity[rising], slip.force[rising]) == pytest.approx(
        box.normal_force * (law.mu_k + effect["amplitude"].value * fall),
        rel=2e-3,  # 200 points a slip, joined by lines
    )
    low, high = facts[0]["y"]  # a polynomial's swings at the ends of a slip would reach further than break-away
    assert 0.9 * slip.force.min() < low < high < 1.1 * law.mu_s * box.normal_force


def test_what_repeats_is_drawn_folded(outcome):
    effect = EffectEstimate(
        "position_dependent_friction", (), Where("belt position", "friction varies along the belt"),
        {"amplitude": Interval(0.03, 0.02, 0.04, "-"), "wavelength": Interval(0.011, 0.0109, 0.0111, "m")}, 40.0, 1e-6,
    )  # fmt: skip
    _, text, drawn = written(dataclasses.replace(outcome, result=dataclasses.replace(outcome.result, effects=(effect,))))
    facts = json.loads(html.unescape(re.search(r"data-axes='(.*?)'", drawn["folded"])[1]))
    assert facts[0]["labels"][0] == "position on the belt within 11 mm [mm]"
    assert facts[0]["x"][1] - facts[0]["x"][0] <= 11.0 * 1.2  # one round and its margins
    assert "friction varies along the belt" in text


def test_a_real_discovery_shows_where_the_model_fails(outcome):
    content, text, drawn = written(outcome)
    check_backed(content, text)
    assert set(drawn) == {"cycles", "map", "left_over", "friction", "events", "ranking", "gap"}
    assert [e["kind"] for e in content["effects"]] == ["velocity_weakening"]
    evidence = gather(outcome)
    # friction that falls with speed leaves the same mark in every slip; taken out, less than a third of it remains
    marks = [np.abs(np.median(left.along, axis=0)).max() for left in (evidence.before, evidence.after)]
    assert marks[1] < marks[0] / 3.0
    errors = [np.abs(evidence.cycles[name].error).mean() for name in ("recalibrated", "augmented")]
    assert errors == pytest.approx([content["gap"]["recalibrated"], content["gap"]["augmented"]], rel=1e-6)
    assert content["details"]["events"]["data"]["period"]["median"] == pytest.approx(
        content["details"]["events"]["augmented"]["period"]["median"], rel=0.01
    )


def test_without_effect_there_is_no_third_model(outcome):
    nothing = dataclasses.replace(
        outcome,
        result=dataclasses.replace(outcome.result, verdict="none", effects=()),
        models=(*outcome.models[:2], outcome.models[1]),
    )
    content, text, _ = written(nothing)
    check_backed(content, text)
    assert set(content["details"]["events"]) == {"data", "believed", "recalibrated"}
    assert "with the effects" not in re.sub(r"<[^>]+>", "", text)


def test_a_model_that_never_slips_is_shown_as_such(outcome):
    stuck = outcome.models[0].with_law(40.0, 0.46)
    content, text, drawn = written(dataclasses.replace(outcome, models=(stuck, stuck, outcome.models[2])))
    check_backed(content, text)
    assert content["details"]["events"]["recalibrated"]["period"]["median"] is None
    assert "events" in drawn


def test_without_held_out_cycles_the_rest_is_shown(outcome):
    result = dataclasses.replace(outcome.result, gap=None, slip_forces=None, leading="gap")
    content, text, drawn = written(
        dataclasses.replace(outcome, result=result, runs=dataclasses.replace(outcome.runs, second=()))
    )
    check_backed(content, text)
    assert {"map", "left_over"} <= set(drawn)
    assert not {"cycles", "gap"} & set(drawn)


def test_an_interval_has_the_digits_that_tell_its_ends_from_its_value():
    text = re.sub(r"<[^>]*>", "", str(interval({"value": 0.012, "low": 0.0119996, "high": 0.0120004, "unit": "m"})))
    assert text == "12.0000 (11.9996 to 12.0004)&nbsp;mm"
    text = re.sub(r"<[^>]*>", "", str(interval({"value": 0.5, "low": 0.4, "high": 0.6, "unit": "N s^2/m^2"})))
    assert text == "0.500 (0.400 to 0.600)&nbsp;N s²/m²"


@pytest.mark.parametrize(("asked", "shown"), [("is it the zero?", "is it the zero?<"), ("a second load", "a second load.<")])
def test_a_question_keeps_its_mark_alone(asked, shown):
    _, text, _ = written(outcome_of(dataclasses.replace(BASE, next_experiment=asked)))
    assert shown in re.sub(r"</span>(\.?)", r"\1<", text)


@pytest.mark.parametrize(("details", "said"), [({"places": []}, True), ({}, False)])
def test_which_direction_an_equation_means_is_said_at_a_joint(details, said):
    effect = dataclasses.replace(WEAKENING, kind="direction_asymmetry")
    _, text, _ = written(outcome_of(dataclasses.replace(BASE, effects=(effect,), details=details)))
    assert ("it is negative while the position grows" in text) == said
