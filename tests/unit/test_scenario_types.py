"""Every value of a scenario replaced by odd ones: an error that says what is wrong, never another exception or silence."""

import copy
import datetime
import tomllib

import pytest

from stochfric_mb import InputError
from stochfric_mb.scenario import any_scenario_from_dict, bundled_scenarios

ODD = (True, "text", "3.0", [], {}, [1], {"a": 1}, datetime.date(2026, 1, 1), float("nan"), float("inf"), -1, 0, 10**400)
WORDS = ("title", "file", "reference", "factor", "positions", "drives", "columns")
"""Keys whose value is a text, or may be one."""


def _places(value, path=()):
    for key, inner in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
        yield (*path, key)
        yield from _places(inner, (*path, key))


@pytest.mark.parametrize("name", list(bundled_scenarios()))
def test_odd_values_are_errors_or_fit(name):
    file = bundled_scenarios()[name]
    whole = tomllib.loads(file.read_text(encoding="utf-8"))
    for path in _places(whole):
        for odd in ODD:
            tables = copy.deepcopy(whole)
            inner = tables
            for key in path[:-1]:
                inner = inner[key]
            inner[path[-1]] = odd
            try:
                any_scenario_from_dict(tables, folder=file.parent)
            except InputError:
                continue
            assert odd is not True, (path, odd)
            assert odd != "3.0" or set(path) & set(WORDS), (path, odd)


def _lasting(duration, output_step):
    tables = tomllib.loads(bundled_scenarios()["kang2015_table1"].read_text(encoding="utf-8"))
    return tables | {"simulation": {"duration": duration, "output_step": output_step}}


@pytest.mark.parametrize(
    ("duration", "output_step", "message"),
    [
        (1e9, 1e-3, r"duration = 1e\+09 s holds 1e\+12 samples.*shorten the duration, or raise output_step"),
        (1e12, 1e5, r"natural periods.*more than a day"),
    ],
)
def test_simulations_of_days_are_refused_before_they_begin(duration, output_step, message):
    with pytest.raises(InputError, match=message):
        any_scenario_from_dict(_lasting(duration, output_step))


def test_steps_that_take_days_are_refused():
    scenario = any_scenario_from_dict(_lasting(1e8, 10.0))
    with pytest.raises(InputError, match=r"1e\+12 steps of dt = 0\.0001 s.*more than a day"):
        scenario.checked_step(1e-4)
