"""An effect of another package, found by its entry point, runs like those of this one."""

from __future__ import annotations

import importlib
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest

from stochfric_mb import effects
from stochfric_mb.errors import InputError

SOURCE = '''
import dataclasses
import math
from typing import ClassVar

from stochfric_mb.effects.contract import MU_K, SPEED, Effect, parameter


@dataclasses.dataclass(frozen=True, kw_only=True)
class PowerLaw(Effect):
    """mu_k times (1 + speed/reference_speed)^exponent."""

    exponent: float = parameter("-", "exponent of the speed", scale=0.1)
    reference_speed: float = parameter("m/s", "speed at which it sets in", scale=1e-3, low=0.0, strict=True, default=1e-3)

    kind: ClassVar[str] = "power_law"
    equation: ClassVar[str] = "mu_k times (1 + abs(v)/reference_speed)^exponent"
    source: ClassVar[str] = "this test"
    group: ClassVar[str] = "friction law"
    order: ClassVar[int] = 3


def friction(world, memory, rates, p):
    world[MU_K] *= math.exp(p[0] * math.log(1.0 + world[SPEED] / p[1]))
'''


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with an importable module and the metadata that an installation would leave."""
    (tmp_path / "rig_effects.py").write_text(SOURCE)
    info = tmp_path / "rig_effects-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: rig-effects\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(
        "[stochfric_mb.effects]\npower_law = rig_effects:PowerLaw\nbroken = rig_effects:SPEED\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    importlib.invalidate_caches()
    effects._entry_points.cache_clear()
    yield tmp_path
    effects._entry_points.cache_clear()
    effects.EFFECTS.pop("power_law", None)
    sys.modules.pop("rig_effects", None)


def test_an_own_effect_is_found_and_acts(package: Path) -> None:
    from stochfric_mb.laws import make_law
    from stochfric_mb.mechanisms import BeltBox
    from stochfric_mb.reference.augmented import Start, augmented_system

    assert "power_law" in effects.effect_kinds()
    own = effects.effect_from_dict({"kind": "power_law", "exponent": 0.05})
    box = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
    law = make_law("coulomb", mu_s=0.8, mu_k=0.46)
    start = Start(velocity=-0.01)
    force = augmented_system(box, law, [own]).at(start).friction_force[0]
    assert force == pytest.approx(0.46 * 13.0 * (1.0 + 0.0125 / 1.0e-3) ** 0.05, rel=1.0e-12)


def test_an_entry_point_that_is_no_effect_is_named(package: Path) -> None:
    with pytest.raises(InputError, match="entry point 'broken'"):
        effects.effect_class("broken")


def test_an_own_effect_runs_from_a_scenario_in_an_engine(package: Path) -> None:
    """In a fresh process, as a user would: the command line, an engine, the comparison."""
    pytest.importorskip("pymunk")
    program = """
        import dataclasses
        from stochfric_mb.effects import make_effect
        from stochfric_mb.engines import adapter
        from stochfric_mb.scenario import load_scenario, scenario_from_dict
        base = load_scenario("kang2015_table1", law="coulomb")
        scenario = dataclasses.replace(
            base, process=None, effects=(make_effect("power_law", exponent=0.05),), duration=1.2, output_step=1e-3
        )
        scenario = scenario_from_dict(scenario.to_dict())
        for name in ("reference", "pymunk"):
            print(*adapter(name).simulate(scenario).position[[400, 1100]].tolist())
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(program)],
        env={**__import__("os").environ, "PYTHONPATH": str(package)}, capture_output=True, text=True, check=True,
    )  # fmt: skip
    reference, engine = (np.array(line.split(), dtype=float) for line in done.stdout.splitlines())
    np.testing.assert_allclose(engine, reference, atol=5.0e-6)
