"""The C library, and its glue against stand-ins of the vendors' interfaces."""

import ctypes
import re
from pathlib import Path

import numpy as np
import pytest

from stochfric_mb.c.compiler import FLAGS, compile_library, host
from stochfric_mb.contact import PlaneContact
from stochfric_mb.errors import MissingEngineError
from stochfric_mb.export.exported import Exported, exported_scenario
from stochfric_mb.export.library import GLUE, library_files
from stochfric_mb.friction import Friction
from stochfric_mb.laws import make_law

from .conftest import pointer
from .fmus import table_1
from .test_fmu_element import H, motion

STAND_INS = Path(__file__).parent / "standins"
DRIVERS = {
    "adams_vfosub.c": ("adams_driver.c", ()),
    "adams_gfosub.c": ("adams_driver.c", ("-DGFORCE",)),
    "recurdyn_friction.c": ("recurdyn_driver.c", ()),
    "simulink_sfunction.c": ("simulink_driver.c", ()),
}
PAR = np.array([10.0, 20.0, 13.0, 9.0, 4.0, 2.0])
"""Markers, normal force, seed, sample, contact."""
SAME = 1.0e-15
"""The same operations in the same order, and the same libm."""


def law():
    """Return a law that uses displacement, velocity, a mode and random coefficients, and no effective mass but 1 kg."""
    return make_law("elastic_stick", mu_s=0.8, mu_k=0.46)


def written(folder, exported):
    for name, text in library_files(exported).items():
        (folder / name).write_text(text, encoding="utf-8")


@pytest.fixture(scope="module", params=list(GLUE))
def glue(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("glue")
    written(folder, Exported(law(), table_1().process))
    driver, flags = DRIVERS[request.param]
    sources = [folder / "stochfric.c", STAND_INS / driver]
    if driver != "simulink_driver.c":  # that one includes the glue, as its functions are static
        sources.append(folder / request.param)
    out = folder / f"glue{host().ending}"
    compile_library(sources, out, host(), include=[STAND_INS, folder], flags=flags)
    return request.param, ctypes.CDLL(str(out))


def test_glue_commits_accepted_steps_alone(glue, rng):
    """With trial steps, differences and rejected steps in between, forces are those of accepted steps alone."""
    name, call = glue[0], glue[1].call
    u, v, _, _ = motion(rng, 300)
    contact = PlaneContact(Friction(law(), table_1().process), effective_mass=1.0, seed=9, sample=4, contact=2)
    result = np.zeros(2)

    def ask(t, place, accepted, dflag=0, iflag=0):
        errors = call(
            ctypes.c_double(t), pointer(u[place].copy()), pointer(v[place].copy()), ctypes.c_double(accepted), dflag, iflag,
            pointer(PAR), pointer(result),
        )  # fmt: skip
        assert errors == 0
        return result.copy()

    sticks = set()
    update = 2 if name == "simulink_sfunction.c" else 0
    ask(0.0, 0, 0.0, iflag=1)
    contact.start(0.0, tuple(u[0]), tuple(v[0]), 13.0)
    np.testing.assert_allclose(ask(0.0, 0, 0.0), contact.force(0.0, tuple(u[0]), tuple(v[0]), 13.0), rtol=SAME)
    for i in range(1, 300):
        t, before = i * H, (i - 1) * H
        if i % 3 == 0:  # a trial of the whole step, then one of half of it: both rejected
            half = (i + 90) % 300
            ask(t, (i + 50) % 300, before)
            ask(t - 0.5 * H, half, before)
            if name == "recurdyn_friction.c":  # which is not told: going on from the half means that it was accepted
                contact.commit(t - 0.5 * H, tuple(u[half]), tuple(v[half]), 13.0)
        if i % 4 == 0:  # a difference for the Jacobian
            ask(t, (i + 20) % 300, before, dflag=1)
        trial = ask(t, i, before)
        np.testing.assert_allclose(trial, contact.force(t, tuple(u[i]), tuple(v[i]), 13.0), rtol=SAME, atol=1e-300)
        contact.commit(t, tuple(u[i]), tuple(v[i]), 13.0)
        sticks.add(contact.stick)
        if update:
            ask(t, i, t, dflag=update)
    assert len(sticks) == 2


@pytest.mark.parametrize("iflag", [5, 7, 9])
def test_adams_may_save_and_reload_in_between(glue, iflag):
    """Calls for other things than a force leave the contact as it is."""
    name, call = glue[0], glue[1].call
    if not name.startswith("adams"):
        pytest.skip("calls of Adams/Solver alone: 5 at the end, 7 to save, 9 to reload")

    def ask(t, u, flag):
        place, speed, result = np.array([u, 0.0]), np.array([1.0e-3, 0.0]), np.zeros(2)
        time, before = ctypes.c_double(t), ctypes.c_double(t - H)
        assert call(time, pointer(place), pointer(speed), before, 0, flag, pointer(PAR), pointer(result)) == 0
        return result[0]

    ask(0.0, 0.0, 1)
    forces = [ask(i * H, 1.0e-7 * i, 0) for i in range(1, 40)]
    ask(40 * H, 4.0e-6, iflag)
    after = ask(40 * H, 4.0e-6, 0)
    assert after == pytest.approx(forces[-1] + forces[-1] - forces[-2], rel=1e-6)  # the bristle goes on where it was
    assert after > 1.0


def test_adams_with_too_few_parameters_is_an_error(glue):
    name, library = glue
    if not name.startswith("adams"):
        pytest.skip("the drivers of the others have a fixed number of parameters")
    zero, result = np.zeros(3), np.zeros(2)
    library.give_parameters(5)
    arguments = (ctypes.c_double(0.0), pointer(zero), pointer(zero), ctypes.c_double(0.0), 0, 0, pointer(PAR), pointer(result))
    assert library.call(*arguments) > 0
    library.give_parameters(6)


def test_glue_reports_a_negative_normal_force(glue):
    name, call = glue[0], glue[1].call
    bad = PAR.copy()
    bad[2] = -1.0
    zero, result = np.zeros(3), np.zeros(2)
    call(ctypes.c_double(0.0), pointer(zero), pointer(zero), ctypes.c_double(0.0), 0, 1, pointer(bad), pointer(result))
    errors = call(ctypes.c_double(0.0), pointer(zero), pointer(zero), ctypes.c_double(0.0), 0, 0, pointer(bad), pointer(result))
    assert errors > 0
    assert "stand-in" in library_files(Exported(law()))[name]


def test_the_library_compiles_without_a_warning_and_has_no_globals_and_no_allocation(tmp_path):
    written(tmp_path, exported_scenario(table_1()))
    assert {"-Wall", "-Wextra", "-Werror"} <= set(FLAGS)
    compile_library([tmp_path / "stochfric.c"], tmp_path / f"lib{host().ending}", host())
    text = (tmp_path / "stochfric.c").read_text(encoding="utf-8")
    assert not re.search(r"\b(malloc|calloc|realloc|free)\s*\(", text)
    outside = re.findall(r"^(?!static|typedef|#|/\*|\s|\}|int stochfric|void stochfric|const char|$).*", text, re.M)
    assert outside == []  # at the left margin stand functions alone
    assert not re.search(r"^static [^(]*=", text, re.M)  # and no static data that could change


def test_a_missing_compiler_is_named_with_its_remedy(tmp_path, monkeypatch):
    written(tmp_path, Exported(law()))
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(MissingEngineError, match=r"pip install '\.\[fmi\]'"):
        compile_library([tmp_path / "stochfric.c"], tmp_path / "lib.so", host())
