"""The picture of a raw record."""

import re

import numpy as np
import pytest

from stochfric_mb.report.record_picture import record

TIME = np.arange(0.0, 4.0, 0.01)
SAW = TIME % 1.0 - 9.0 * np.clip(TIME % 1.0 - 0.9, 0.0, None)
"""Stick for 0.9 s, then slip back in 0.1 s."""
SLIPS = [(90, 100), (190, 200), (290, 300)]


@pytest.mark.parametrize(("first", "phases"), [(0, 4), (40, 4), (95, 2)])
def test_sticks_at_both_ends_are_shaded(first, phases):
    """A record that begins within a slip is not shaded up to the first whole one."""
    slips = [(i - first, j - first) for i, j in SLIPS if i >= first]
    shown = record(TIME[first:390], SAW[first:390], "position [m]", slips)
    assert len(re.findall(r"#56b4e9", shown)) == phases + 1  # the legend has one


def test_one_slip_tells_no_speed_in_stick():
    assert "#56b4e9" not in record(TIME[:190], SAW[:190], "position [m]", [(90, 100)])
