"""The augmented model, written where it is used: scenario file, table of parameters, augmented MJCF, Exudyn snippet."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stochfric_mb.discovery.result import Interval, Result
from stochfric_mb.effects.traits import LATE
from stochfric_mb.errors import InputError, MissingEngineError
from stochfric_mb.laws.elastic_stick import ElasticStick
from stochfric_mb.mechanisms import HingePendulum, Mjcf, PrismaticJoint
from stochfric_mb.scenario import Scenario

if TYPE_CHECKING:
    from stochfric_mb.discovery.outcome import Outcome

PRESLIDING = 1.0e-5
"""Presliding displacement of the law that MuJoCo runs [m or rad]: it holds at rest, where Coulomb's law says nothing."""


def files(outcome: Outcome) -> dict[str, str]:
    """Return what a result is exported as: name of a file -> its text.

    Always ``parameters.csv`` and ``augmented.toml``; for driven joints ``augmented.xml``, where MuJoCo is installed, and for
    slides and hinges ``exudyn_friction.py``, to be run beside ``augmented.toml``.
    """
    scenario = outcome.scenario
    written = {"parameters.csv": parameter_table(outcome.result), "augmented.toml": scenario_toml(scenario)}
    if isinstance(scenario.mechanism, Mjcf | PrismaticJoint | HingePendulum) and importlib.util.find_spec("mujoco"):
        written["augmented.xml"] = mjcf(scenario)
    # a load that moves by itself is no friction: the engine needs a second body
    if isinstance(scenario.mechanism, PrismaticJoint | HingePendulum) and not any(e.moves_load for e in scenario.effects):
        written["exudyn_friction.py"] = exudyn_snippet("augmented.toml")
    return written


def parameter_table(result: Result) -> str:
    """Return the numbers of a result with their 95 % intervals as CSV.

    Columns: effect (empty for mechanism and law), parameter, value, low, high, unit; source: "fit", "prior" where what is
    stated decides more than the data do, "none" for what no fit has moved; moved: by how many stated standard deviations a
    measured number is off, where those are many.
    """
    about = result.details.get("parameters", {})
    priors, moved = about.get("not_measured", ()), about.get("moved_beyond_uncertainty", {})
    rows = ["effect,parameter,value,low,high,unit,source,moved"]
    for effect in result.effects:
        rows += [_row(effect.kind, name, number, _source(number)) for name, number in effect.parameters.items()]
    for name, number in result.parameters.items():
        off = f"{moved[name]:.3g}" if name in moved else ""
        rows.append(_row("", name, number, "prior" if name in priors else _source(number), off))
    return "\n".join(rows) + "\n"


def _source(number: Interval) -> str:
    return "none" if number.low == number.high else "fit"


def _row(effect: str, name: str, number: Interval, source: str, off: str = "") -> str:
    return f"{effect},{name},{number.value:.6g},{number.low:.6g},{number.high:.6g},{number.unit},{source},{off}"


def scenario_toml(scenario: Scenario[Any]) -> str:
    """Return the text of a scenario file."""
    return importlib.import_module("tomli_w").dumps(scenario.to_dict())


def mjcf(scenario: Scenario[Any]) -> str:
    """Return an MJCF model with the friction of a scenario in its joints (plugin ``stochfric.dof``) or pair.

    Viscous friction becomes the joint's damping. Effects that neither can carry are listed in a comment at the top.

    Raises:
        InputError: the mechanism is no driven joint.
        MissingEngineError: MuJoCo is not installed.
    """
    try:
        mujoco: Any = importlib.import_module("mujoco")
    except ImportError:
        raise MissingEngineError(
            "an MJCF export needs MuJoCo; in a clone of this package run: pip install '.[mujoco]'"
        ) from None
    attach: Any = importlib.import_module("stochfric_mb.mujoco")
    mechanism = scenario.mechanism
    if isinstance(mechanism, Mjcf):
        spec, loads, acts_in = corrected_model(mujoco, mechanism), dict(mechanism.friction), mechanism.effects_in
    elif isinstance(mechanism, PrismaticJoint | HingePendulum):
        spec, loads, acts_in = mujoco.MjSpec.from_string(plain_mjcf(mechanism)), {"joint": mechanism.normal_force}, ()
    else:
        raise InputError(f"mechanism {mechanism.kind!r} has no joint; its augmented.toml can be run by itself")
    _with_friction(attach, spec, scenario, loads, acts_in)
    spec.compile()
    return f"<!-- {scenario.title}; import stochfric_mb.mujoco before loading -->{_left_out(scenario)}{spec.to_xml()}"


def _with_friction(attach: Any, spec: Any, scenario: Scenario[Any], loads: dict[str, float], acts_in: Sequence[str]) -> None:
    """Add friction, and viscous friction as damping, to the places of a model that carry load."""
    mechanism = scenario.mechanism
    law = ElasticStick(mu_s=scenario.law.mu_s, mu_k=scenario.law.mu_k, e_lim=PRESLIDING)
    viscous = sum(e.linear_damping for e in scenario.effects)
    tendons, pairs = getattr(mechanism, "tendons", ()), getattr(mechanism, "pairs", {})
    for place, load in loads.items():
        if place in pairs:
            attach.add_friction(spec, pairs[place].geoms, law)
            continue
        tied = place in tendons
        attach.add_friction(spec, attach.Tendon(place) if tied else attach.Joint(place), law, normal_force=load)
        if not acts_in or place in acts_in:
            element = next(j for j in (spec.tendons if tied else spec.joints) if j.name == place)
            _damp(element, viscous)


def _left_out(scenario: Scenario[Any]) -> str:
    """Return a comment on the effects that the file does not hold, between two lines."""
    pairs = getattr(scenario.mechanism, "pairs", {})
    left = [e.kind for e in scenario.effects if LATE not in e.signatures and (pairs or not e.linear_damping)]
    if not left:
        return "\n"
    return f"\n<!-- not in this file, since neither damping nor the plugin's laws hold it: {', '.join(left)} -->\n"


def corrected_model(mujoco: Any, mechanism: Mjcf) -> Any:
    """Return the user's model with what data have corrected, a MuJoCo spec."""
    spec = mujoco.MjSpec.from_file(str(mechanism.file))
    factor = mechanism.factors.get("mass", 1.0) * _to_total_mass(spec)
    for geom in spec.geoms:
        geom.mass, geom.density = geom.mass * factor, geom.density * factor
    for body in spec.bodies:
        if body.explicitinertial:
            body.mass, body.inertia = body.mass * factor, body.inertia * factor
    if mechanism.payload:
        _load(mujoco, spec, mechanism)
    for joint in spec.joints:
        joint.armature = joint.armature * mechanism.factors.get("armature", 1.0)
        _damp(joint, mechanism.damping.get(joint.name, 0.0))
    return spec


def _to_total_mass(spec: Any) -> float:
    """Return the factor by which a file that sets its total mass scales all of them, and set none any more.

    It would undo each correction of a mass.
    """
    total = float(spec.compiler.settotalmass)
    if total <= 0.0:
        return 1.0
    spec.compiler.settotalmass = -1.0
    return total / float(np.sum(spec.compile().body_mass))


def _load(mujoco: Any, spec: Any, mechanism: Mjcf) -> None:
    """Add a payload to the body that carries it, as bodies of their own."""
    from stochfric_mb.discovery.driven_joint.mjcf.compiled_model import carrier, places_of_payload

    model = spec.compile()
    places = places_of_payload(mujoco, model)
    for name, mass in mechanism.payload.items():
        held = spec.bodies[carrier(model)].add_body(name=f"payload_{name}", pos=places[name])
        small = mujoco.mjMINVAL * np.ones(3)  # a point
        held.mass, held.inertia, held.ipos, held.explicitinertial = mass, small, np.zeros(3), True


def _damp(joint: Any, coefficient: float) -> None:
    """Add damping to a joint, whose damping is a polynomial in its speed: the first number is the linear one."""
    damping = np.array(joint.damping, dtype=np.float64)
    damping.flat[0] += coefficient
    joint.damping = damping


def plain_mjcf(mechanism: PrismaticJoint | HingePendulum) -> str:
    """Return the mechanism as MJCF."""
    if isinstance(mechanism, PrismaticJoint):
        gravity, kind, armature = "0 0 0", 'type="slide" axis="1 0 0"', 0.0
        place, gain = "0 0 0", (mechanism.force_gain or 1.0) * mechanism.drive_factor
    else:
        gravity, kind, armature = f"0 0 {-mechanism.gravity!r}", 'type="hinge" axis="0 1 0"', mechanism.inertia
        place, gain = f"0 0 {-mechanism.length!r}", (mechanism.torque_gain or 1.0) * mechanism.drive_factor
    mass = max(mechanism.mass, 1.0e-3)
    small = 1.0e-6 * mass
    return f"""<mujoco>
  <option gravity="{gravity}" integrator="implicitfast" timestep="0.001"/>
  <worldbody>
    <body name="body">
      <joint name="joint" {kind} damping="{mechanism.damping!r}" armature="{armature!r}"/>
      <inertial pos="{place}" mass="{mass!r}" diaginertia="{small!r} {small!r} {small!r}"/>
    </body>
  </worldbody>
  <actuator><motor name="drive" joint="joint" gear="{gain!r}"/></actuator>
</mujoco>"""


def exudyn_snippet(file: str | Path = "augmented.toml") -> str:
    """Return Python that puts the friction of an augmented scenario into an Exudyn model.

    Args:
        file: where the augmented scenario is.
    """
    return f'''"""Friction identified by discovery, in Exudyn: a user function on a coordinate."""
from exudyn.itemInterface import CoordinateSpringDamper
from stochfric_mb.discovery.driven_joint.simulation.friction_function import joint_friction
from stochfric_mb.scenario import load_any_scenario

friction = joint_friction(load_any_scenario({str(file)!r}), smoothing_velocity=1e-3)


def friction_force(mbs, t, item, q, v, stiffness, damping, offset):
    return -friction(t, q, v)  # Exudyn counts the force of a spring-damper against its coordinate


def add_friction(mbs, ground_marker, joint_marker):
    """Add the friction between two coordinate markers; return the number of the object."""
    return mbs.AddObject(
        CoordinateSpringDamper(markerNumbers=[ground_marker, joint_marker], springForceUserFunction=friction_force)
    )
'''
