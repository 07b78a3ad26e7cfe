"""How a case is written down: CSV tables, dataset.toml, scenario.toml and an MJCF model."""

from pathlib import Path

import numpy as np

from .bench import UNCERTAINTY, Bench
from .forms import Record

ARM_JOINTS = ("shoulder", "elbow")


def write_csv(file: Path, record: Record) -> None:
    formats = ["%.7f" if name.startswith("time") else "%.9g" for name in record]
    np.savetxt(file, np.column_stack(list(record.values())), fmt=formats, delimiter=",", header=",".join(record), comments="")


def dataset_text(roles: list[str]) -> str:
    text = 'schema = "stochfric.dataset/1"\ntitle = "a driven joint"\nscenario = "scenario.toml"\n'
    for i, role in enumerate(roles):
        text += f'\n[[runs]]\nfile = "run_{i + 1}.csv"\nrole = "{role}"\n'
    return text


def slider_scenario(stiffness: float, mu: float) -> str:
    return _scenario(f'kind = "spring_slider"\nstiffness = {stiffness!r}\n', mu, "stiffness = 0.5\nmu_s = 0.1\nmu_k = 0.1\n")


def thrown_scenario(mass: float, mu: float) -> str:
    text = f'kind = "prismatic_joint"\nmass = {mass!r}\nnormal_force = {9.81 * mass!r}\n'
    return _scenario(text, mu, "mass = 0.001\nmu_s = 0.5\nmu_k = 0.5\n")


def scenario_text(bench: Bench, gains: tuple[float, float, float]) -> str:
    """The scenario of a nominal rig; gains: position and velocity gain of its controller, and its limit."""
    make = {"slide": _slide, "hinge": _hinge}.get(bench.design, _mjcf)
    return make(bench, gains)


def _scenario(mechanism: str, mu: float, uncertainty: str, controller: str = "") -> str:
    return (
        'schema = "stochfric.scenario/1"\ntitle = "as stated"\n'
        f"\n[mechanism]\n{mechanism}\n{controller}"
        f'\n[law]\nkind = "coulomb"\nmu_s = {mu!r}\nmu_k = {mu!r}\n'
        f"\n[uncertainty]\n{uncertainty}"
        "\n[simulation]\nduration = 10.0\noutput_step = 0.001\n"
    )


def _common(bench: Bench) -> str:
    text = (
        f"mass = {UNCERTAINTY['mass']}\nmu_s = {UNCERTAINTY['mu']}\nmu_k = {UNCERTAINTY['mu']}\noffset = {bench.offset_sd!r}\n"
    )
    if bench.design in ("mjcf_hinge", "arm"):
        text += f"armature = {UNCERTAINTY['inertia']}\n"
    return text + (f"damping = {UNCERTAINTY['damping']}\n" if bench.numbers["damping"] else "")


def _slide(bench: Bench, gains: tuple[float, float, float]) -> str:
    n = bench.numbers
    normal = 9.81 * n["inertia"]
    text = f'kind = "prismatic_joint"\nmass = {n["inertia"]!r}\nnormal_force = {normal!r}\ndamping = {n["damping"]!r}\n'
    if bench.gain != 1.0:
        text += f"force_gain = {bench.gain!r}\n"
    if "area" in n:
        text += f"piston_area = {n['area']!r}\n"
    controller = ""
    if bench.declared:
        position, velocity, limit = gains
        controller = (
            f'\n[controller]\nkind = "cascade"\nposition_gain = {position / velocity!r}\nvelocity_gain = {velocity!r}\n'
            f'limit = {limit!r}\nreference = "target"\n'
        )
    return _scenario(text, bench.level / normal, _common(bench), controller)


def _hinge(bench: Bench, gains: tuple[float, float, float]) -> str:
    del gains
    n = bench.numbers
    text = (
        f'kind = "hinge_pendulum"\nmass = {n["mass"]!r}\nlength = {n["length"]!r}\ninertia = {n["rotor_part"]!r}\n'
        f"normal_force = {bench.level / 0.1!r}\ndamping = {n['damping']!r}\n"
    )
    return _scenario(text, 0.1, _common(bench) + f"inertia = {UNCERTAINTY['inertia']}\n")


def joint_names(bench: Bench) -> tuple[str, ...]:
    return ARM_JOINTS if bench.design == "arm" else ("slide",) if bench.design == "mjcf_slide" else ("hinge",)


def _mjcf(bench: Bench, gains: tuple[float, float, float]) -> str:
    names = joint_names(bench)
    unit = "angle" if bench.rotational else "position"
    drive = "torque" if bench.rotational else "force"
    columns = {joint: f"{joint}_{unit}" for joint in names} if bench.design == "arm" else {names[0]: "position"}
    drives = {joint: f"{joint}_{drive}" for joint in names} if bench.design == "arm" else {names[0]: drive}
    friction = {joint: level / 0.5 for joint, level in zip(names, bench.coulomb, strict=False)}
    text = f'kind = "mjcf"\nfile = "model.xml"\nfriction = {_inline(friction)}\npositions = {_inline(columns)}\n'
    text += f"drives = {_inline(drives)}\n"
    if bench.numbers["damping"]:
        text += f"damping = {_inline({names[0]: bench.numbers['damping']})}\n"
    controller = ""
    if bench.declared:
        position, velocity, limit = gains
        controller = f'\n[controller]\nkind = "proportional_derivative"\nperiod = {1.0 / bench.rate!r}\n'
        for joint, share in zip(names, arm_shares(bench), strict=True):
            reference = f"{joint}_target" if bench.design == "arm" else "target"
            controller += (
                f"\n[controller.joints.{joint}]\nposition_gain = {share * position!r}\n"
                f'velocity_gain = {share * velocity!r}\nlimit = {share * limit!r}\nreference = "{reference}"\n'
            )
    return _scenario(text, 0.5, _common(bench), controller)


def arm_shares(bench: Bench) -> tuple[float, ...]:
    """Gains of each joint, as shares of the first one's."""
    n = bench.numbers
    return (1.0, (n["inertia_2"] + n["rotor_2"]) / (n["inertia"] + n["rotor"])) if bench.design == "arm" else (1.0,)


def _inline(table: dict[str, float] | dict[str, str]) -> str:
    entries = [f'{key} = "{value}"' if isinstance(value, str) else f"{key} = {value!r}" for key, value in table.items()]
    return "{ " + ", ".join(entries) + " }"


def model_text(bench: Bench) -> str:
    """The nominal MJCF model: point masses, and rotors as armatures."""
    n = bench.numbers
    head = '<mujoco>\n  <compiler angle="radian"/>\n  <option timestep="0.0005" gravity="0 0 -9.81"/>\n  <worldbody>\n'
    tail = "  </worldbody>\n</mujoco>\n"
    if bench.design == "mjcf_slide":
        return head + (
            '    <body>\n      <joint name="slide" type="slide" axis="1 0 0"/>\n'
            f'      <inertial pos="0 0 0" mass="{n["inertia"]!r}" diaginertia="1 1 1"/>\n    </body>\n'
        ) + tail  # fmt: skip
    if bench.design == "mjcf_hinge":
        return head + _link("hinge", n["length"], n["mass"], n["rotor_part"], "", 0.0) + tail
    inner = _link("elbow", n["l2"], n["m2"], n["rotor_2"], "", n["l1"])
    return head + _link("shoulder", n["l1"], n["m1"], n["rotor"], inner, 0.0) + tail


def _link(joint: str, length: float, mass: float, rotor: float, inside: str, at: float) -> str:
    tiny = 1e-9 * mass
    return (
        f'    <body pos="0 0 {-at!r}">\n      <joint name="{joint}" type="hinge" axis="0 1 0" armature="{rotor!r}"/>\n'
        f'      <inertial pos="0 0 {-length!r}" mass="{mass!r}" diaginertia="{tiny!r} {tiny!r} {tiny!r}"/>\n'
        f"{inside}    </body>\n"
    )
