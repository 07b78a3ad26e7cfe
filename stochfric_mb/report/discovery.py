"""The page of a discovery: every number in it stands in ``result.json``, and is marked with the value it shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from markupsafe import Markup

from stochfric_mb.discovery.driven_joint.balance.inverse_dynamics import ABSOLUTE
from stochfric_mb.discovery.driven_joint.decision.estimates import FACTORS
from stochfric_mb.discovery.outcome import Outcome
from stochfric_mb.effects import effect_class, effect_kinds, words_of
from stochfric_mb.report.comparison import UNITS
from stochfric_mb.report.discovery_pictures import COLOURS, given
from stochfric_mb.report.page import digits, marked, render, said
from stochfric_mb.report.page import unit as raised

CAPTIONS = {
    "cycles": "Left: held-out cycles from the middle of a stick phase on, measured and forecast. Right: error of the "
    "forecasts; line: median, area: the middle nine tenths of all cycles. Dotted, if drawn: the error that a random model "
    "predicts.",
    "map": "Measured friction force minus the model's, one column a slip. Horizontal stripes: every slip is off alike. "
    "Vertical stripes: the slips differ. Pale: explained.",
    "left_over": "The same residual slip by slip, against time and against the position on the belt. Any pattern here is "
    "something that the model lacks.",
    "folded": "The same residual of the first run, folded at the estimated wavelength or period.",
    "friction": "Friction force against sliding velocity. Lines: the fitted laws, in one slip of the first run. Dots: the law "
    "plus the median of its residual in the measured slips, without their ends; area: the middle nine tenths. At rest: the "
    "force at break-away.",
    "events": "Events in the held-out runs, measured and simulated; bar: the middle nine tenths of all values, tick: median.",
    "ranking": "How well each candidate explains the residual of the recalibrated model. Blue: named. Grey: other effects. "
    "Sand: patterns that name no physics.",
    "gap": "Error on held-out runs.",
}
"""What each picture shows."""

METRICS = {
    "crps_one_cycle": "error of forecasts one cycle ahead (CRPS; without scatter, the mean absolute error)",
    "crps_slip_forces": "error of the predicted forces of single slips, over their noise (CRPS)",
    "log_score_readings": "surprise of single readings (minus their log likelihood, given those around them)",
    "velocity_of_position": "error of the measured velocity against the rate of the position (root mean square)",
    "closed_loop_voltage": "voltage error of the simulated closed loop (root mean square, over that of the voltage)",
    "closed_loop_drive": "error of the controller's output in the simulated closed loop (root mean square, over its size)",
    "crps_friction": "error of predicted friction while the joint slides (CRPS, with the scatter between runs)",
    "inverse_dynamics_sliding": "error of the predicted driving force while the joint slides (root mean square)",
    "friction_coefficient": "error of the predicted coefficient of friction (root mean square)",
}
"""Metric -> what it is, in words; other metrics stand with their names."""

DISPLAYED = {"m": ((1.0e-3, 1.0e6, "µm"), (1.0, 1.0e3, "mm")), "m/s": ((1.0, 1.0e3, "mm/s"),), "-": ()}
"""Unit -> (below this, multiplied by that, shown as)."""


STATED_AS = {shown: name for name, shown in FACTORS.items()}
"""Number of a joint in the result -> its key under ``[uncertainty]``."""
MOST_DIGITS = 7
"""Significant digits that an interval is shown with, at most."""
AFTERWARDS = 3
"""Candidates shown of a search after the first."""

Picture = tuple[str, str, str]
"""Title, caption and SVG."""


def further(outcome: Outcome) -> list[Picture]:
    """Return the pictures that an outcome brings along as data, ``outcome.pictures``, if it does; see `given`."""
    return [(title, caption, given(data)) for title, caption, data in getattr(outcome, "pictures", ())]


def page(
    content: Mapping[str, Any],
    drawn: Mapping[str, str],
    pictures: Sequence[Picture] = (),
    records: Sequence[tuple[str, str]] = (),
) -> str:
    """Return the report as one HTML text that needs no other file.

    Args:
        content: what ``result.json`` holds; all that the page shows comes from it.
        drawn: pictures of a belt-box, from `discovery_pictures.figures`.
        pictures: further pictures.
        records: captions and pictures of the raw records, from `record_picture.record_pictures`.
    """
    details = content["details"]
    return render(
        "discovery.html",
        result=content,
        details=details,
        drawn=drawn,
        captions=CAPTIONS,
        further=pictures,
        records=records,
        colours=COLOURS,
        metrics=METRICS,
        beliefs=_beliefs(content),
        rounds=_rounds(details),
        number=number,
        error=error,
        interval=interval,
        percent=percent,
        said=said,
        words=words_of,
        in_words=in_words,
        units=UNITS,
    )


def number(value: float | None, unit: str = "-", n: int = 3) -> Markup:
    """Return a number of ``result.json`` as the page shows it, with its exact value in the markup.

    Args:
        value: the number, in ``unit``.
        unit: its unit; small lengths are shown in µm or mm.
        n: significant digits.
    """
    return _numbers([value], unit, n)[0] + _unit(value, unit)


def interval(value: Mapping[str, Any], n: int = 3) -> Markup:
    """Return "value (low to high) unit" of an interval; one that was not fitted is shown without."""
    if value["low"] == value["high"]:
        return number(value["value"], value["unit"], n)
    three = [value["value"], value["low"], value["high"]]
    factor = _scale(value["value"], value["unit"])[0]
    while n < MOST_DIGITS and len({digits(factor * v, n) for v in three}) < len(set(three)):
        n += 1  # ends that look like the value say nothing
    middle, low, high = _numbers(three, value["unit"], n)
    return Markup("{} <small>({} to {})</small>{}").format(middle, low, high, _unit(value["value"], value["unit"]))


def error(value: float | None, unit: str) -> Markup:
    """Return a forecast's error; a relative one as a percentage."""
    return percent(value, 3) if unit == "-" else number(value, unit)


def percent(value: float | None, n: int = 2) -> Markup:
    """Return a share as a percentage, with its exact value in the markup."""
    return marked(value, n, 100.0) + (Markup("") if value is None else Markup("&nbsp;%"))


def in_words(kind: str) -> str:
    """Return what an effect does in the field's words, such as "friction differs between the two directions of sliding"."""
    return (effect_class(kind).shows if kind in effect_kinds() else "") or words_of(kind)


def _scale(value: float | None, unit: str) -> tuple[float, str]:
    for below, factor, shown in DISPLAYED.get(unit, ()):
        if value is not None and abs(value) < below:
            return factor, shown
    return 1.0, "" if unit == "-" else unit


def _unit(value: float | None, unit: str) -> Markup:
    shown = _scale(value, unit)[1]
    return Markup('&nbsp;<span class="unit">{}</span>').format(raised(shown)) if shown and value is not None else Markup("")


def _numbers(values: Sequence[float | None], unit: str, n: int) -> list[Markup]:
    """Return numbers shown in the unit that suits the first."""
    factor = _scale(values[0], unit)[0]
    return [marked(v, n, factor) for v in values]


def _beliefs(content: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the parameters of mechanism and law: as stated, how sure, as fitted, and what a reader must know of that."""
    stated = content["details"]["stated"]
    sure = stated.get("uncertainty", {})
    about = content["details"].get("parameters", {})
    beyond, unmeasured = about.get("moved_beyond_uncertainty", {}), about.get("not_measured", [])
    rows: list[dict[str, Any]] = []
    for name, fitted in content["believed"].items():
        own = name.rpartition(".")[2]  # of a joint of a model
        key = STATED_AS.get(own, own) if own not in sure else own
        value = stated["law"].get(own, stated["mechanism"].get(own)) if isinstance(stated.get("law"), Mapping) else None
        rows.append({
            "name": name, "stated": value, "sure": sure.get(key), "absolute": key in ABSOLUTE, "fitted": fitted,
            "moved": beyond.get(name), "measured": name not in unmeasured,
        })  # fmt: skip
    return rows


def _rounds(details: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return, for each round of the search, its best candidates with their misfit when simulated, if they were."""
    items: list[dict[str, Any]] = []
    number_ = 1
    while f"round_{number_}" in details:
        simulated = details.get(f"confirmation_{number_}", {})
        rows = [
            {"kind": kind, "score": score, "misfit": simulated[kind][0] if kind in simulated else None}
            for kind, score in details[f"round_{number_}"].items()
        ][: None if number_ == 1 else AFTERWARDS]
        items.append({"rows": rows, "believed": simulated["believed"][0] if "believed" in simulated else None})
        number_ += 1
    return items
