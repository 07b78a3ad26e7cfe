"""Fit the friction of a joint with ``mujoco.sysid``: its parameters reach our plugin through the plugin's configuration.

A slide is pushed to and fro. Its mass and its friction coefficient are wrong in the model; sysid finds both. With RK4 the
law's switches are found within the steps, so that errors are smooth in the parameters; with other integrators switches fall
on steps, and an optimiser may end in one of many small dents. It needs
``pip install 'mujoco[sysid]'``. Run it as ``python examples/mujoco_sysid_friction.py``; it takes a few seconds.
"""

from __future__ import annotations

import math
import sys

import mujoco
import numpy as np
from mujoco import sysid

from stochfric_mb.laws.elastic_stick import ElasticStick
from stochfric_mb.mujoco import Joint, add_friction

XML = """
<mujoco>
  <option gravity="0 0 0" timestep="0.002" integrator="RK4"/>
  <worldbody>
    <body name="sledge">
      <joint name="slide" type="slide" axis="1 0 0"/>
      <geom name="sledge" type="box" size="0.05 0.05 0.05" mass="2"/>
    </body>
  </worldbody>
  <actuator><motor name="push" joint="slide"/></actuator>
  <sensor><jointpos name="position" joint="slide"/></sensor>
</mujoco>
"""
TRUTH = {"mass": 2.6, "mu": 0.31}
LOAD = 20.0
"""Load of the joint [N]."""


def law(mu: float) -> ElasticStick:
    """Return the friction law with one coefficient for rest and sliding."""
    return ElasticStick(mu_s=mu, mu_k=mu, e_lim=1.0e-4)


def spec_with(mass: float, mu: float) -> mujoco.MjSpec:
    """Return the model with friction in its joint."""
    spec = mujoco.MjSpec.from_string(XML)
    spec.geom("sledge").mass = mass
    add_friction(spec, Joint("slide"), law(mu), normal_force=LOAD)
    return spec


def write_mu(spec: mujoco.MjSpec, parameter: sysid.Parameter) -> None:
    """Write a friction coefficient into the configuration of the plugin."""
    mu = float(parameter.value[0])
    plugin = next(p for p in spec.plugins if p.name == "friction_slide")
    text = f"kind = 'elastic_stick', mu_s = {mu!r}, mu_k = {mu!r}, e_lim = 1e-4"
    plugin.config = {**dict(plugin.config), "law": text}


def write_mass(spec: mujoco.MjSpec, parameter: sysid.Parameter) -> None:
    """Write the mass."""
    spec.geom("sledge").mass = float(parameter.value[0])


def measured(model: mujoco.MjModel, noise: float = 1.0e-5) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return times, pushes and positions of a simulated measurement."""
    data = mujoco.MjData(model)
    times = model.opt.timestep * np.arange(1000)
    pushes = np.array([15.0 * math.sin(5.0 * t) + 6.0 * math.sin(11.0 * t) for t in times])
    positions = np.empty(len(times))
    for i, push in enumerate(pushes):
        data.ctrl[0] = push
        mujoco.mj_step(model, data)
        positions[i] = data.sensordata[0]
    return times, pushes, positions + noise * np.random.default_rng(0).standard_normal(len(times))


def rollout(models, datas, control_signal, initial_states, param_dicts=None, **others):  # type: ignore[no-untyped-def]
    """Return sysid's own roll-outs, each from the plugin state of its own model: the state holds the law's numbers."""
    states = np.atleast_2d(np.array(initial_states, dtype=np.float64))
    for model, state in zip(models, states, strict=True):
        own = sysid.create_initial_state(model, np.zeros(model.nq), np.zeros(model.nv))
        first = 1 + model.nq + model.nv + model.na
        state[first:] = own[first:]
    return sysid.sysid_rollout(models, datas, control_signal, states, **others)


def main() -> dict[str, float]:
    """Fit, print, and return the parameters."""
    if not hasattr(sysid, "optimize"):  # MuJoCo brings the module, but not what it needs
        sys.exit("mujoco.sysid lacks the packages that it needs; run: pip install 'mujoco[sysid]'")
    nominal = spec_with(2.0, 0.2)
    times, pushes, positions = measured(spec_with(**TRUTH).compile())
    model = nominal.compile()
    sequences = sysid.ModelSequences(
        "sledge",
        nominal,
        "push",
        sysid.create_initial_state(model, np.zeros(1), np.zeros(1)),
        sysid.TimeSeries.from_control_names(times, pushes[:, None], model),
        sysid.TimeSeries.from_names(times, positions[:, None], model),
    )
    parameters = sysid.ParameterDict()
    parameters.add(sysid.Parameter("mass", 2.0, 1.0, 4.0, modifier=write_mass))
    parameters.add(sysid.Parameter("mu", 0.2, 0.05, 0.6, modifier=write_mu))
    residual = sysid.build_residual_fn(models_sequences=[sequences], custom_rollout=rollout)
    fitted, _ = sysid.optimize(parameters, residual, optimizer="scipy", verbose=False)
    estimates = dict(zip(("mass", "mu"), fitted.as_vector().tolist(), strict=True))
    for name, value in estimates.items():
        print(f"{name}: {value:.4f} (truth {TRUTH[name]})")
    return estimates


if __name__ == "__main__":
    main()
