"""MuJoCo: importing compiles nothing; a model compiles what it asks for, from XML or from a binary model, in any thread."""

import subprocess
import sys

import pytest

pytest.importorskip("mujoco")

STATE = """
import concurrent.futures, ctypes, io, os, sys, tempfile, threading
import mujoco
import mujoco.rollout
import stochfric_mb.mujoco
from stochfric_mb.mujoco.memory import engine, structs
from stochfric_mb.mujoco.plugin import frictions, sensor

def entered(name):
    get = engine.library().mjp_getPlugin
    get.restype, get.argtypes = ctypes.POINTER(structs.Plugin), [ctypes.c_char_p, ctypes.c_void_p]
    return get(name.encode(), None).contents

def compiled():
    "What is compiled now, in words."
    names = {"pair": frictions.PAIRS, "dof": frictions.DOFS, "sensor": sensor.NAME}
    return [word for word, name in names.items() if entered(name).compute]

LAW = "kind = 'elastic_stick', mu_s = 0.5, mu_k = 0.4"
def xml(plugin, keys, dt=1e-5):
    config = "".join(f'<config key="{k}" value="{v}"/>' for k, v in {"law": LAW, **keys}.items())
    return f'''<mujoco><extension><plugin plugin="{plugin}"><instance name="f">{config}</instance></plugin></extension>
    <option timestep="{dt}" cone="elliptic"/><worldbody><geom name="floor" type="plane" size="5 5 1"/>
    <body pos="0 0 .05"><joint name="x" type="slide" axis="1 0 0"/><joint name="z" type="slide" axis="0 0 1"/>
    <geom name="box" type="box" size=".05 .05 .05" mass="1"/></body></worldbody></mujoco>'''
def load(*args, **options):
    return mujoco.MjModel.from_xml_string(xml(*args, **options))
def slide(model, steps=10000):
    data = mujoco.MjData(model)
    data.qvel[0] = 1.0
    mujoco.mj_step(model, data, steps)
    return 1.0 - data.qvel[0]
PAIR = {"geom1": "box", "geom2": "floor"}
LOSS = 0.4 * 9.81 * 0.1  # mu_k g t; the landing bounces a little, hence 2%
LANDING = 2 / 25  # two of 25 coarse steps may pass before the floor carries the box
"""


def _run(code):
    """Run code after STATE in a process of its own; it prints nothing but what it fails with."""
    out = subprocess.run([sys.executable, "-c", STATE + code], check=False, capture_output=True, text=True, timeout=500)
    assert out.returncode == 0, out.stdout + out.stderr


def test_importing_compiles_nothing_and_a_model_what_it_asks_for():
    _run("""
assert compiled() == [], compiled()
loss = slide(load("stochfric.pair", {**PAIR, "mode": "explicit"}))
assert compiled() == ["pair"], compiled()
assert abs(loss - LOSS) < 0.02 * LOSS, loss
loss = slide(load("stochfric.pair", {**PAIR, "mode": "solver"}))
assert compiled() == ["pair"], compiled()
assert abs(loss - LOSS) < 0.02 * LOSS, loss
load("stochfric.dof", {"joint": "x", "normal_force": "9.81"})
assert compiled() == ["pair", "dof"], compiled()
""")


def test_auto_mode_needs_nothing_more():
    _run("""
model = load("stochfric.pair", PAIR, dt=4e-3)
mujoco.MjData(model)
assert compiled() == ["pair"], compiled()
assert abs(slide(model, 25) - LOSS) < LANDING * LOSS
assert compiled() == ["pair"], compiled()
""")


def test_a_binary_model_compiles_when_its_data_are_made():
    _run("""
model = load("stochfric.pair", {**PAIR, "mode": "explicit"})
path = os.path.join(tempfile.mkdtemp(), "m.mjb")
mujoco.mj_saveModel(model, path)
again = '''
model = mujoco.MjModel.from_binary_path(sys.argv[1])
assert compiled() == [], compiled()
assert abs(slide(model) - LOSS) < 0.02 * LOSS
assert compiled() == ["pair"], compiled()
'''
import subprocess
text = sys.orig_argv[sys.orig_argv.index("-c") + 1].split("model = load", 1)[0]
out = subprocess.run([sys.executable, "-c", text + again, path], check=False, capture_output=True, text=True)
assert out.returncode == 0, out.stdout + out.stderr
""")


def test_first_use_in_many_threads():
    _run("""
def work(_):
    return slide(load("stochfric.pair", {**PAIR, "mode": "solver"}))
with concurrent.futures.ThreadPoolExecutor(4) as pool:
    losses = list(pool.map(work, range(8)))
assert len(set(losses)) == 1 and abs(losses[0] - LOSS) < 0.02 * LOSS, losses
""")


def test_first_use_in_the_threads_of_a_rollout():
    _run("""
import numpy as np
model = load("stochfric.pair", PAIR, dt=4e-3)
data = [mujoco.MjData(model) for _ in range(3)]
assert compiled() == ["pair"], compiled()
size = mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS.value)
start = np.zeros(size)
mujoco.mj_getState(model, data[0], start, mujoco.mjtState.mjSTATE_FULLPHYSICS.value)
start[1 + model.nq] = 1.0
states, _ = mujoco.rollout.rollout(model, data, np.tile(start, (6, 1)), nstep=25)
losses = 1.0 - states[:, -1, 1 + model.nq]
assert np.all(losses == losses[0]) and abs(losses[0] - LOSS) < LANDING * LOSS, losses
assert compiled() == ["pair"], compiled()
""")


def test_what_fails_within_mujocos_call_is_the_error_of_that_call():
    """At first in nstate, as the model is made, then in init, as its data are; the next try works."""
    _run("""
from stochfric_mb.mujoco.plugin import registration
def fail(*args):
    raise OSError("no 100 % of the disk")
def refused(make, kind):
    try:
        make()
    except kind as error:
        assert "stochfric_mb: plugin stochfric.pair: OSError: no 100 % of the disk" in str(error), error
    else:
        raise AssertionError("made")
native, registration.native = registration.native, fail
refused(lambda: load("stochfric.pair", PAIR), ValueError)
registration.native = native
model = load("stochfric.pair", PAIR)
law_of, frictions.law_of = frictions.law_of, fail
refused(lambda: mujoco.MjData(model), mujoco.FatalError)
frictions.law_of = law_of
assert mujoco.MjData(model).plugin_state.size == model.npluginstate > 0
""")
