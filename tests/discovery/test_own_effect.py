"""An effect of another package is discovered in data of the independent generator, like those of this one."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import pytest

from stochfric_mb import effects
from stochfric_mb.discovery import discover
from tests.discovery.generator.case import Case
from tests.discovery.test_discover import SEED, made

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """What an installation of a package with the example's effect would leave."""
    info = tmp_path / "my_rig-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: my-rig\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[stochfric_mb.effects]\nrail_spot = effect_rail_spot:RailSpot\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.syspath_prepend(str(EXAMPLES))
    importlib.invalidate_caches()
    effects._entry_points.cache_clear()
    yield
    effects._entry_points.cache_clear()
    effects.EFFECTS.pop("rail_spot", None)
    sys.modules.pop("effect_rail_spot", None)


@pytest.mark.usefixtures("package")
def test_an_own_effect_is_discovered():
    truth, dataset = made(Case("position_dependent_friction.worn_stroke", "one_free", 1.0, SEED))
    result = discover(dataset).result
    assert [e.kind for e in result.effects] == ["rail_spot"]
    hidden, estimate = truth["effect_parameters"][0], result.effects[0]
    assert estimate.where.axis == "position of the box"
    # the generator's spot has the same shape; its intervals are of 95 %
    for ours, theirs in (("depth", "depth"), ("place", "centre"), ("width", "width")):
        assert estimate.parameters[ours].low <= hidden[theirs] <= estimate.parameters[ours].high
    gap = result.gap
    assert (gap.recalibrated - gap.augmented) / (gap.recalibrated - gap.floor) > 0.85  # what discovery must reach in 90 %
