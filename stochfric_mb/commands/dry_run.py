"""``stochfric discover --dry-run``: everything is read and checked, the raw records are drawn, nothing is inferred."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from stochfric_mb.commands.speech import answer, say
from stochfric_mb.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

    from stochfric_mb.measurement.dataset import Dataset

MARKER = "records.html"
"""File that shows that a folder holds a dry run."""
SECONDS_A_SLIP = (0.025, 0.2)
"""Processor time of a discovery, least and most, measured on simulated belt rigs with one effect or none [s]."""
SECONDS = (2.0, 10.0)
"""Time that is added to it [s]."""
SECONDS_A_JOINT = (5.0, 45.0)
"""Processor time of a discovery for each joint, least and most of nine tenths of 98 generated records, on a busy machine
[s]; records in which much is missing take minutes."""
OFF_SPEED = 0.1
"""Distance of the stuck speed from the belt's from which it is told [-]: this look sees it to some per cent."""


def dry_run(dataset: str, scenario: str | None, out: str, *, force: bool) -> None:
    """Read a dataset, draw its raw records and say what a discovery would do with them, and how long that takes."""
    from stochfric_mb.measurement import load_dataset
    from stochfric_mb.outputs import check_target, claimed, whole_folder

    target = check_target(out, force=force, marker=MARKER)
    with claimed(target):
        try:
            data = load_dataset(dataset, scenario)
        except InputError as error:
            raise with_records(dataset, scenario, target, error) from None
        runs, refused = _facts(data), _refusal(data)
        lines = [*(_line(run) for run in runs), *_off_speed(data), _stated(data)]
        lines += [] if refused else _plan(data, runs)
        with whole_folder(target, replace=force) as folder:
            draw(data, folder, lines, refused)
    answer({"out": str(target), "runs": runs, "refused": refused})
    for line in lines:
        say(line)
    if refused:
        raise InputError(f"{refused} (the raw records are drawn in {target / MARKER})")
    say(str(target / MARKER))


def with_records(dataset: str, scenario: str | None, target: Path, error: InputError) -> InputError:
    """Draw the raw records of data that are refused, if they can be read at all; return the error that says so."""
    from stochfric_mb.measurement import load_dataset
    from stochfric_mb.outputs import whole_folder

    try:
        data = load_dataset(dataset, scenario, plausible=False)
    except InputError:
        return error
    with whole_folder(target, replace=True) as folder:
        draw(data, folder, (), str(error))
    return InputError(f"{error} (the raw records are drawn in {target / MARKER})")


def only_records(out: str) -> bool:
    """Return whether a folder holds drawn records and nothing else: any discovery may replace those."""
    from pathlib import Path

    return Path(out).is_dir() and [p.name for p in Path(out).iterdir()] == [MARKER]


def draw(data: Dataset, folder: Path, lines: Sequence[str], refused: str) -> None:
    """Draw the raw records of a dataset into a folder, with what is said of them and why they are refused, if they are."""
    from stochfric_mb.report.page import render
    from stochfric_mb.report.record_picture import record_pictures

    page = render("records.html", title=data.title, records=record_pictures(data), lines=lines, refused=refused)
    (folder / MARKER).write_text(page, encoding="utf-8")


def _facts(data: Dataset) -> list[dict[str, Any]]:
    """Return what there is of each run."""
    from stochfric_mb.measurement.scales import slip_spans
    from stochfric_mb.mechanisms import BeltBox

    facts: list[dict[str, Any]] = []
    mapped = _mapped(data)
    for run in data.runs:
        columns = [*run.channels, *(name for name in mapped if name in run.covariates)]
        position = run.channels.get("position")
        slips = None
        if isinstance(data.scenario.mechanism, BeltBox) and position is not None:
            slips = len(slip_spans(position, run.sample_interval))
        facts.append({
            "name": run.name, "role": run.role, "seconds": float(run.time[-1] - run.time[0]), "rate": 1.0 / run.sample_interval,
            "channels": {name: run.units.get(name, "") for name in columns}, "notes": list(run.notes), "slips": slips,
        })  # fmt: skip
    return facts


def _mapped(data: Dataset) -> list[str]:
    """Return the columns, beside the known quantities, that a mechanism is told to read its joints from."""
    from stochfric_mb.mechanisms import Mjcf

    mechanism = data.scenario.mechanism
    if not isinstance(mechanism, Mjcf):
        return []
    positions = [column for column in mechanism.positions.values() if isinstance(column, str)]
    drives = [column for drive in mechanism.drives.values() for column in drive.columns]
    pressed = [pair.normal_force for pair in mechanism.pairs.values() if pair.normal_force]
    return list(dict.fromkeys([*positions, *drives, *pressed]))


def _line(run: dict[str, Any]) -> str:
    channels = ", ".join(f"{name} [{unit}]" if unit else name for name, unit in run["channels"].items())
    slips = "" if run["slips"] is None else f", {run['slips']} slips"
    notes = "".join(f"; {note}" for note in run["notes"])
    use = "used to fit" if run["role"] == "fit" else "held out"
    return f"{run['name']}: {use}, {run['seconds']:.4g} s at {run['rate']:.4g} Hz{slips}; {channels}{notes}"


def _off_speed(data: Dataset) -> list[str]:
    """Return what is said of a belt rig's runs whose stuck box moves at another speed than the belt is stated to."""
    from stochfric_mb.measurement.scales import stuck_speed
    from stochfric_mb.mechanisms import BeltBox

    said: list[str] = []
    for run in data.runs:
        box, position = run.mechanism(data.scenario), run.channels.get("position")
        if not isinstance(box, BeltBox) or position is None or box.belt_velocity == 0.0:
            continue
        stick = stuck_speed(position, run.sample_interval)
        if stick is not None and abs(abs(stick[0] / box.belt_velocity) - 1.0) > OFF_SPEED:
            said.append(
                f"{run.name}: the stuck box moves at about {abs(stick[0]):.2g} m/s, but belt_velocity = "
                f"{box.belt_velocity:.3g} m/s is stated: no effect would be named; measure the belt's speed and state it"
            )
    return said


def _stated(data: Dataset) -> str:
    """Return how sure the scenario is of its numbers: what it does not name is believed as it stands."""
    from stochfric_mb.scenario import ABSOLUTE

    of, doubts = _unit_of_offsets(data), data.scenario.uncertainty
    if not any(doubts.values()):
        return "No [uncertainty] is stated: every number of the scenario is taken as exact"
    said = (f"{k} ± {v:.3g} {of}" if k in ABSOLUTE else f"{k} ± {100.0 * v:.3g} %" for k, v in doubts.items() if v)
    return f"Stated: {', '.join(said)}; every other number of the scenario is taken as exact"


def _unit_of_offsets(data: Dataset) -> str:
    """Return the unit of an offset of the drive: of joints that are lines, axes, or both."""
    from stochfric_mb.measurement.assemble import TURNS
    from stochfric_mb.mechanisms import Mjcf

    mechanism = data.scenario.mechanism
    if not isinstance(mechanism, Mjcf):
        return "N m" if getattr(mechanism, "rotational", False) else "N"
    columns = [mechanism.positions.get(place) for place in mechanism.friction]
    turns = {data.runs[0].units.get(c, "") in TURNS if isinstance(c, str) else False for c in columns}
    return " or ".join(unit for turning, unit in ((False, "N"), (True, "N m")) if turning in turns)


def _plan(data: Dataset, runs: list[dict[str, Any]]) -> list[str]:
    """Return what a discovery would do."""
    kind = data.scenario.mechanism.kind
    fit = f"{len(data.fit)} run" + ("s" if len(data.fit) > 1 else "")
    said = f"Would search {_searched(kind)} in {fit} and score on {len(data.test)}, {kind}"
    from stochfric_mb.discovery.criteria import FEWEST_OF_RUN, FEWEST_SLIPS
    from stochfric_mb.discovery.stick_slip.records.long_records import SIMULATED
    from stochfric_mb.mechanisms import BeltBox

    if kind != BeltBox.kind:
        joints = len(getattr(data.scenario.mechanism, "friction", ())) or 1
        return [said, _expected(*(joints * seconds for seconds in SECONDS_A_JOINT))]
    counts = [run["slips"] or 0 for run in runs]
    if not sum(counts):
        return [said]
    # slips beyond those that are simulated cost least
    simulated = sum(min(n, SIMULATED) for n in counts)
    beyond = SECONDS_A_SLIP[0] * (sum(counts) - simulated)
    least = FEWEST_OF_RUN if sum(n for n in counts if n >= FEWEST_OF_RUN) >= FEWEST_SLIPS else FEWEST_SLIPS
    few = [run["name"] for run in runs if (run["slips"] or 0) < least]
    if few:
        said += f"; too few slips to judge friction by in {', '.join(few)}: each run needs {least}"
    low, high = (a + b * simulated + beyond for a, b in zip(SECONDS, SECONDS_A_SLIP, strict=True))
    return [said, _expected(low, high)]


def _expected(low: float, high: float) -> str:
    """Return what is said of the time that a discovery takes [s]."""
    return f"Expected time: {low:.0f} to {high:.0f} s of one processor, plus compiling on first use"


def _searched(mechanism: str) -> str:
    """Return what a discovery looks for at a mechanism."""
    from stochfric_mb.effects import effect_class, effect_kinds
    from stochfric_mb.mechanisms import BeltBox, SpringSlider

    if mechanism == SpringSlider.kind:
        return "friction with memory, with speed and with distance"
    classes = map(effect_class, effect_kinds())
    named = [c for c in classes if (c.searched_in_slips() if mechanism == BeltBox.kind else c.searched_at_joints())]
    return f"{len(named)} kinds of effects"


def _refusal(data: Dataset) -> str:
    """Return why a discovery would refuse the records; empty if it would not."""
    from stochfric_mb.discovery.driven_joint import joint_workflow
    from stochfric_mb.discovery.stick_slip import study
    from stochfric_mb.mechanisms import BeltBox

    sticks = isinstance(data.scenario.mechanism, BeltBox)
    try:
        (study if sticks else joint_workflow).require_usable(data)
    except InputError as error:
        return str(error)
    return ""
