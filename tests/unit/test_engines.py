"""The registry of engines: built in, brought by other packages, registered by hand."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from stochfric_mb import engines
from stochfric_mb.engines import Engine, adapter, register_engine
from stochfric_mb.errors import InputError, MissingEngineError


@pytest.fixture
def a_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """An installed distribution 'my-engine' whose package 'my_engine' brings the engine 'mine'."""
    (tmp_path / "my_engine.py").write_text("def simulate(scenario, **options):\n    return scenario, options\n")
    info = tmp_path / "my_engine-2.5.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: my-engine\nVersion: 2.5\n")
    (info / "entry_points.txt").write_text(
        "[stochfric_mb.engines]\nmine = my_engine\nmujoco = my_engine\nsubmodule = my_engine.deep.adapter\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "my_engine", raising=False)
    return "my_engine"


def test_an_entry_point_brings_an_engine(a_package: str) -> None:
    engine = engines._brought()["mine"]
    assert (engine.name, engine.adapter, engine.distribution) == ("mine", a_package, "my-engine")
    assert engine.installed
    assert engine.version == "2.5"
    assert engines._brought()["submodule"].installed
    assert a_package not in sys.modules  # nothing is loaded to list it


def test_built_in_engines_cannot_be_replaced_by_an_entry_point(a_package: str) -> None:
    assert engines._brought()["mujoco"].adapter == a_package
    assert engines.ENGINES["mujoco"].adapter == "stochfric_mb.mujoco.belt_box"


def test_a_registered_engine_is_found_by_name(a_package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engines, "ENGINES", dict(engines.ENGINES))
    register_engine(Engine("mine", a_package, a_package, "external force", "me", "my-engine"))
    assert "mine" in engines.installed_engines()
    assert adapter("mine").simulate(1, seed=2) == (1, {"seed": 2})


def test_a_missing_engine_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engines, "ENGINES", dict(engines.ENGINES))
    register_engine(Engine("theirs", "nowhere.adapter", "no_such_package", "", "", "no-such-distribution"))
    assert "theirs" not in engines.installed_engines()
    with pytest.raises(MissingEngineError, match="pip install no-such-distribution"):
        adapter("theirs")
    with pytest.raises(InputError, match=r"unknown engine 'their'.*theirs"):
        adapter("their")


def test_an_fmu_is_an_engine_where_its_extra_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is compiled for those who have not the extra: both of its packages must be there."""
    import importlib.util

    assert "fmu" in engines.installed_engines()
    result = importlib.util.find_spec
    for absent in ("fmpy", "ziglang"):
        with monkeypatch.context() as patch:
            patch.setattr(
                "importlib.util.find_spec", lambda name, *a, absent=absent: None if name == absent else result(name, *a)
            )
            assert "fmu" not in engines.installed_engines()
            with pytest.raises(MissingEngineError, match=r"engine 'fmu' is not installed; .* run: pip install '\.\[fmi\]'"):
                adapter("fmu")


def test_an_engine_that_knows_no_effects_refuses_them(monkeypatch):
    import types

    from stochfric_mb import engines
    from stochfric_mb.effects import make_effect

    monkeypatch.setitem(engines.ENGINES, "plain", engines.Engine("plain", "plain_adapter", "", "none", "nobody"))
    monkeypatch.setitem(__import__("sys").modules, "plain_adapter", types.ModuleType("plain_adapter"))
    ageing, random = make_effect("dwell_ageing", rate=0.02), make_effect("random_coefficients", sigma_s=0.01, sigma_k=0.01)
    with pytest.raises(InputError, match="would leave out dwell_ageing"):
        engines.adapter("plain", effects=[ageing])
    engines.adapter("plain", effects=[random])  # a coefficient process, which every engine knows
    engines.adapter("reference", effects=[ageing])
