"""What the code blocks of a page need besides what stands there: files, names of the reader's own, shorter runs.

``code`` runs before a block, given by its number on the page, in the same names as the page's Python; ``text`` is the block.
Blocks that are no commands and no Python (TOML, XML, C, text) are used by their ``code`` alone. ``shorter`` replaces parts of
commands whose full run takes long or needs a network; each of them must stand on the page.
"""

import dataclasses
from collections.abc import Mapping


@dataclasses.dataclass(frozen=True)
class Setting:
    """Where the blocks of a page run."""

    needs: tuple[str, ...] = ()
    """Packages of extras."""
    code: Mapping[int, str] = dataclasses.field(default_factory=dict)
    """Number of a block -> Python that runs before it."""
    shorter: Mapping[str, str] = dataclasses.field(default_factory=dict)
    """Part of a command -> what stands for it; an empty text leaves the whole command out."""
    seconds: float = 600.0
    """Longest time that the page may take."""


OWN_BOX = """
import mujoco
spec = mujoco.MjSpec.from_string('<mujoco><option cone="elliptic"/><worldbody><geom name="floor" type="plane" size="1 1 1"/>'
    '<body pos="0 0 0.1"><freejoint/><geom name="foot" type="box" size=".1 .1 .1"/></body></worldbody></mujoco>')
"""
BOX_ON_BELT = OWN_BOX.replace('"foot"', '"box"').replace('"floor"', '"belt"')
ARM = """
ARM = '<mujoco><worldbody><body><joint name="elbow" type="hinge" axis="0 1 0" frictionloss="1"/>' \\
    '<geom type="capsule" fromto="0 0 0 .3 0 0" size=".02"/><site name="end" pos=".3 0 0"/></body>' \\
    '<site name="wall" pos="1 0 0"/></worldbody>' \\
    '<tendon><spatial name="cable"><site site="end"/><site site="wall"/></spatial></tendon></mujoco>'
open("arm.xml", "w").write(ARM)
"""
SCENARIO = """
import tomllib
from importlib.resources import files
from stochfric_mb.scenario import load_any_scenario, load_scenario, scenario_from_dict
BELT_BOX = load_scenario("kang2015_table1").to_dict()
def with_tables(text):
    return scenario_from_dict(BELT_BOX | tomllib.loads(text))
"""
ENTRY_POINT = """
import tomllib
from stochfric_mb.{module} import GROUP
assert list(tomllib.loads(text)["project"]["entry-points"]) == [GROUP]
"""
LOG = """
import numpy as np
from stochfric_mb import load_scenario
from stochfric_mb.reference import simulate
from stochfric_mb.storage import write_trajectory
import tomli_w
write_trajectory(simulate(load_scenario("kang2015_table1")), "run_1.csv")
write_trajectory(simulate(load_scenario("kang2015_table1", overrides=("mechanism.belt_velocity=1e-3",))), "run_2.csv")
open("scenario.toml", "w").write(tomli_w.dumps(load_scenario("kang2015_table1").to_dict()))
"""

SETTINGS = {
    "README.md": Setting(
        ("mujoco", "pymunk"),
        {1: OWN_BOX},
        {
            "--engines mujoco,exudyn,pymunk": "--engines pymunk --no-convergence",
            ".venv/bin/stochfric compare kang2015_table1": "stochfric compare kang2015_table1 --no-convergence --force",
            "&& .venv/bin/pytest -n logical": "",  # .ci/run runs this line word for word
        },
    ),
    "docs/adapters.md": Setting(
        ("pybullet",),
        {
            0: "from stochfric_mb import Trajectory",
            2: """
from stochfric_mb import load_scenario
assert simulate(load_scenario("kang2015_table1", overrides=("simulation.duration=0.05",))).position[-1] > 0.0
""",
            3: """
import tomllib
assert "stochfric_engines" in tomllib.loads(text)["tool"]["pytest"]["ini_options"]
from stochfric_mb.testing import plugin
import inspect
assert '"stochfric_engines"' in inspect.getsource(plugin)
""",
            4: ENTRY_POINT.format(module="engines"),
        },
        {"pytest --pyargs": "pytest -q --collect-only --pyargs", "my_package.adapter": "examples/adapter_pybullet.py"},
    ),
    "docs/c.md": Setting(
        code={
            1: """
import pathlib, subprocess
pathlib.Path("friction_c/main.c").write_text('#include "stochfric.h"\\nint main(void) {\\n'
    'double u = 0.0, v = 1e-3, normal_force = 13.0;\\n' + text + 'return force[0] > 0.0 ? 0 : 1;\\n}\\n')
subprocess.run("cc -std=c99 -Wall friction_c/main.c stochfric.o -lm -o main && ./main", shell=True, check=True)
"""
        }
    ),
    "docs/check.md": Setting(("mujoco",), {0: OWN_BOX + "\nopen('MODEL.xml', 'w').write(spec.to_xml())"}),
    "docs/coefficients.md": Setting(
        code={
            0: SCENARIO + "assert with_tables(text).process.sigma_s == 0.015",
        }
    ),
    "docs/commands.md": Setting(
        ("mujoco", "pymunk"),
        {
            5: """
open("plan.toml", "w").write(text)
from pathlib import Path
from stochfric_mb.discovery.planning.planned_run import load_plan
assert [run.duration for run in load_plan(Path("plan.toml"))[1]] == [30.0, 15.0]
"""
        },
        {
            "compare kang2015_table1 --engines mujoco,pymunk": "compare kang2015_table1 --engines pymunk --no-convergence",
            "--run belt_velocity=5e-3,duration=15 --out plan": "--run belt_velocity=5e-3,duration=15 --no-extra --out plan",
        },
    ),
    "docs/datasets.md": Setting(
        (),
        {
            0: LOG + "open('dataset.toml', 'w').write(text)\nfrom stochfric_mb.measurement import load_dataset\n"
            "assert [run.role for run in load_dataset('.').runs] == ['fit', 'test']",
            1: """
from stochfric_mb.measurement.readers import read_table
open("short.csv", "w").write(text)
import pathlib
assert read_table(pathlib.Path("short.csv")).units["position"] == "mm"
""",
            6: ENTRY_POINT.format(module="measurement.readers"),
        },
    ),
    "docs/discovery.md": Setting(
        code={
            2: """
import numpy as np
def table(seed, t=np.arange(6000) * 2e-3):
    phase = np.random.default_rng(seed).uniform(0.0, 6.0, 2)
    q, v, a = (0.8 * np.sin(2.0 * t + phase[0] + k) * 2.0**n + 0.2 * np.sin(5.0 * t + phase[1] + k) * 5.0**n
               for n, k in ((0, 0.0), (1, np.pi / 2), (2, np.pi)))
    torque = 0.05 * a + 0.3 * v + 1.5 * np.sign(v)
    noise = np.random.default_rng(seed + 9).standard_normal((2, t.size)) * [[1e-5], [0.01]]
    return {"time": list(t), "angle": np.degrees(q + noise[0]), "torque": 1e3 * (torque + noise[1])}
first, second = table(1), table(2)
open("wrist.toml", "w").write('schema = "stochfric.scenario/1"\\n[mechanism]\\nkind = "hinge_pendulum"\\nmass = 1e-3\\n'
    'length = 1e-3\\ninertia = 0.05\\nnormal_force = 1.0\\n[law]\\nkind = "coulomb"\\nmu_s = 1.5\\nmu_k = 1.5\\n'
    '[uncertainty]\\noffset = 0.05\\n[simulation]\\nduration = 12.0\\noutput_step = 2e-3\\n')
""",
        }
    ),
    "docs/discovery_joints_suite.md": Setting(
        shorter={
            "--seeds 0 --out suite": "--list --out suite",
            "--seeds 0 --kind viscous --out some --keep": "--list --kind viscous --out some",
        }
    ),
    "docs/discovery_suite.md": Setting(
        shorter={
            "--full --seeds 1000 --out suite --jobs 2": "--full --seeds 1000 --list --out suite",
            "--sample 24 --rescore --out again": "--sample 24 --list --out again",
            "tests.discovery.ablation --sample 24 --seeds 5 --out ablation": "tests.discovery.ablation --help",
        }
    ),
    "docs/effects.md": Setting(
        code={
            0: SCENARIO + "assert [e.kind for e in with_tables(text).effects] == ['dwell_ageing', 'second_mode']",
            2: ENTRY_POINT.format(module="effects")
            + """
import sys, types
from stochfric_mb.effects import effect_class
module, _, name = tomllib.loads(text)["project"]["entry-points"][GROUP]["power_law"].partition(":")
assert names[name].kind == "power_law"
""",
        }
    ),
    "docs/ensembles.md": Setting(
        ("pymunk", "distributed"),
        shorter={
            "--n-runs 1000 ": "--n-runs 20 ",
            "dask scheduler": "",
            "dask worker tcp://host:8786": "",
            "--n-runs 100000 --scheduler tcp://host:8786": "--n-runs 20 --workers 1",
        },
    ),
    "docs/exudyn.md": Setting(
        ("exudyn",),
        {
            0: """
import exudyn as exu
from exudyn.itemInterface import *
mbs = exu.SystemContainer().AddSystem()
ground = mbs.AddNode(NodePointGround())
box = mbs.AddNode(Node1D(referenceCoordinates=[0.0]))
mbs.AddObject(Mass1D(physicsMass=6.08, nodeNumber=box))
ground_marker = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
box_marker = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=box, coordinate=0))
mbs.AddObject(CoordinateSpringDamper(markerNumbers=[ground_marker, box_marker], stiffness=3956.0, damping=0.768))
"""
        },
    ),
    "docs/fmu.md": Setting(
        ("fmpy", "ziglang", "mujoco"),
        {1: "open('friction.toml', 'w').write(text)\nimport subprocess, sys\n"
         "subprocess.run([sys.executable, '-m', 'stochfric_mb', 'export', 'c', 'friction.toml', '--out', 'c'], check=True)"},
        {
            "compare kang2015_table1 --engines mujoco,fmu": "compare kang2015_table1 --engines fmu --no-convergence",
            "pytest --pyargs": "pytest -q --collect-only --pyargs",
        },
    ),
    "docs/joints.md": Setting(
        ("mujoco", "scipy"),
        {
            1: """
import tomllib
from stochfric_mb.scenario import any_scenario_from_dict
open("block.xml", "w").write('<mujoco><option cone="elliptic"/><worldbody><body><joint name="slide" type="slide" axis="1 0 0"/>'
    '<joint name="lift" type="slide" axis="0 0 1"/><geom name="block" type="box" size=".1 .1 .1" mass="4"/></body>'
    '<geom name="rail" type="plane" pos="0 0 -.1" size="2 2 .1"/></worldbody></mujoco>')
REST = {"schema": "stochfric.scenario/1", "law": {"kind": "coulomb", "mu_s": 0.3, "mu_k": 0.2},
        "simulation": {"duration": 1.0, "output_step": 0.001}}
assert any_scenario_from_dict(REST | tomllib.loads(text)).mechanism.pairs["foot"].geoms == ("block", "rail")
""",
            2: """
from stochfric_mb.scenario import load_any_scenario
arm = load_any_scenario("two_joint_arm").to_dict()
assert any_scenario_from_dict(arm | tomllib.loads(text)).controller is not None
""",
        },
        {"export STOCHFRIC_DATA=/path/to/data": ""},
    ),
    "docs/mujoco.md": Setting(("mujoco",), {0: OWN_BOX + "\nopen('scene.xml', 'w').write(spec.to_xml())"}),
    "docs/mujoco_joints.md": Setting(
        ("mujoco",),
        {
            0: ARM,
            1: """
head, foot = ARM.split("<worldbody>", 1)
mujoco.MjModel.from_xml_string(head + text + "<worldbody>" + foot)
""",
            2: "from stochfric_mb.mujoco import add_sensor, set_friction\n" + BOX_ON_BELT,
            3: BOX_ON_BELT + "model = spec.compile()\ndata = mujoco.MjData(model)",
            4: "import numpy as np\n" + BOX_ON_BELT + "name = add_friction(spec, ('box', 'belt'), law)\nmodel = spec.compile()",
        },
    ),
    "docs/pymunk.md": Setting(("pymunk",)),
    "docs/reproduce.md": Setting(shorter={"reproduce kang2015 --out": "reproduce kang2015 --quick --out"}),
    "docs/translate.md": Setting(
        code={
            0: """
import pathlib
law = '[law]\\nkind = "elastic_stick"\\nmu_s = 0.8\\nmu_k = 0.46\\n'
pathlib.Path("friction.toml").write_text('schema = "stochfric.friction/1"\\n' + law)
"""
        },
        shorter={"--law stribeck --out friction.toml": "--law stribeck --force --out friction.toml"},
    ),
    "docs/warp.md": Setting(
        ("mujoco_warp", "warp"),
        {
            0: """
import pathlib
pathlib.Path("scene.xml").write_text('<mujoco><option cone="elliptic"/><worldbody>'
    '<geom name="floor" type="plane" size="1 1 1" condim="3"/><body pos="0 0 0.1"><freejoint/>'
    '<geom name="foot" type="box" size=".1 .1 .1" condim="3"/>'
    '<body><joint name="elbow" type="hinge" axis="0 1 0" frictionloss="1"/>'
    '<geom type="capsule" fromto="0 0 .2 .3 0 .2" size=".02"/></body></body></worldbody></mujoco>')
""",
            2: "import warp as wp\nwp.to_torch = wp.array.numpy  # torch is not needed to show the call",
            3: """
import tomllib
from stochfric_mb.scenario import any_scenario_from_dict
pathlib.Path("robot.xml").write_text(pathlib.Path("scene.xml").read_text().replace('"elbow"', '"knee"'))
assert any_scenario_from_dict(tomllib.loads(text)).mechanism.pairs["foot"].geoms == ("*", "floor")
""",
        },
        {"nworld=4096": "nworld=2"},
    ),
}  # fmt: skip
"""Page -> setting; a page that is missing here runs as it stands."""
