"""The same model with other friction at one site: with none, and with a law of this package that fits the site."""

from __future__ import annotations

import copy
import dataclasses

import mujoco

from stochfric_mb.errors import InputError
from stochfric_mb.laws import Law, make_law
from stochfric_mb.laws.substitute import MARGIN
from stochfric_mb.mujoco import joints
from stochfric_mb.mujoco.attach import add_friction
from stochfric_mb.mujoco.check.loading import copied
from stochfric_mb.mujoco.check.probes import State, started
from stochfric_mb.mujoco.check.sites import ContactPair, Site, pair_contacts
from stochfric_mb.mujoco.pairs import take_over


def without_friction(spec: mujoco.MjSpec | None, model: mujoco.MjModel, site: Site) -> mujoco.MjModel | None:
    """Return the model without the site's friction, None if it cannot be had."""
    if isinstance(site, ContactPair):
        if spec is None:
            return None
        bare = copied(spec)
        take_over(bare, *site.names, site.mu).condim = 1
        return bare.compile()
    model = copy.copy(model)
    losses = model.dof_frictionloss if site.kind == "joint" else model.tendon_frictionloss
    losses[site.number] = 0.0
    return model


def fitted_law(kind: str, mu_k_ratio: float, site: Site, normal: float, mass: float) -> tuple[Law, float]:
    """Return our law for a site, and its explicit step limit [s]."""
    mu_s = site.mu if isinstance(site, ContactPair) else 1.0
    law = make_law(kind, mu_s=mu_s, mu_k=mu_k_ratio * mu_s)
    return law, law.step_limit(normal, mass)


def mode_of(model: mujoco.MjModel, law: Law, limit: float) -> str:
    """Return how add_friction's mode auto runs a law: explicit with RK4 below half its limit, otherwise by MuJoCo's solver."""
    runge_kutta = model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4
    explicit = law.rest == "bristle" or (runge_kutta and law.rest != "rigid" and limit >= MARGIN * model.opt.timestep)
    return "explicit" if explicit else "solver"


def with_ours(
    spec: mujoco.MjSpec | None, model: mujoco.MjModel, state: State, site: Site, law: Law
) -> tuple[mujoco.MjModel | None, Site | None, str]:
    """Return the model with our law at the site, or why it cannot be had."""
    if spec is None:
        return None, None, "a binary model cannot be changed; give the XML"
    changed = copied(spec)
    try:
        if changed.option.cone != mujoco.mjtCone.mjCONE_ELLIPTIC:
            changed.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        if isinstance(site, ContactPair):
            contacts = len(pair_contacts(started(model, state), site.geoms))
            name = add_friction(changed, site.names, law, slots=max(16, 2 * contacts))
        else:
            place = joints.Joint(*site.names) if site.kind == "joint" else joints.Tendon(*site.names)
            name = add_friction(changed, place, law, normal_force=site.loss)
        return changed.compile(), dataclasses.replace(site, instance=name), ""
    except (InputError, ValueError) as error:
        return None, None, str(error)
