"""The same model with other friction at one site: with none, and with a law of this package that fits the site."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import copy
import dataclasses
import math

import mujoco

from stochfric_mb.errors import InputError
from stochfric_mb.laws import Law, make_law
from stochfric_mb.laws.coulomb import Coulomb
from stochfric_mb.laws.elastic_stick import ElasticStick
from stochfric_mb.laws.substitute import MARGIN, elastic_substitute
from stochfric_mb.mujoco import joints
from stochfric_mb.mujoco.attach import add_friction, copied, take_over
from stochfric_mb.mujoco.probes import State, started
from stochfric_mb.mujoco.site_search import AnySite
from stochfric_mb.mujoco.sites import ContactPair, Joint, pair_contacts


def without_friction(spec: mujoco.MjSpec | None, model: mujoco.MjModel, site: AnySite) -> mujoco.MjModel | None:
    """Return the model without the site's friction, None if it cannot be had."""
    if isinstance(site, ContactPair):
        if spec is None:
            return None
        bare = copied(spec)
        take_over(bare, *site.names)
        return bare.compile()
    model = copy.copy(model)
    if isinstance(site, Joint):
        model.dof_frictionloss[site.dof] = 0.0
    else:
        model.tendon_frictionloss[site.number] = 0.0
    return model


def fitted_law(
    kind: str, mu_k_ratio: float, dt: float, site: AnySite, normal: float, mass: float
) -> tuple[Law, float, float | None]:
    """Return our law for a site, its explicit step limit [s], and the e_lim for which it would run explicitly [m].

    With ``mode`` auto, friction runs explicitly below half the limit and implicitly above; on joints and tendons it
    is implicit in the velocity always.
    """
    mu_s = site.mu if isinstance(site, ContactPair) else 1.0
    law = make_law(kind, mu_s=mu_s, mu_k=mu_k_ratio * mu_s)
    if not isinstance(site, ContactPair):
        return law, math.inf, None
    limit = law.step_limit(normal, mass)
    if not isinstance(law, ElasticStick) or limit >= MARGIN * dt:
        return law, limit, None
    stiffest, _ = elastic_substitute(Coulomb(mu_s, law.mu_k), dt, normal, mass)
    return law, limit, _rounded_up(getattr(stiffest, "e_lim", law.e_lim))


def mode_of(dt: float, site: AnySite, law: Law, limit: float) -> str:
    """Return how add_friction's mode auto runs a law."""
    implicit = not isinstance(site, ContactPair) or law.needs_holding_force or limit < MARGIN * dt
    return "implicit" if implicit else "explicit"


def with_ours(
    spec: mujoco.MjSpec | None, model: mujoco.MjModel, state: State, site: AnySite, law: Law
) -> tuple[mujoco.MjModel | None, AnySite | None, str]:
    """Return the model with our law at the site, or why it cannot be had."""
    if spec is None:
        return None, None, "a binary model cannot be changed; give the XML"
    changed = copied(spec)
    try:
        if isinstance(site, ContactPair):
            contacts = len(pair_contacts(started(model, state), site.geoms))
            name = add_friction(changed, site.names, law, slots=max(16, 2 * contacts))
        else:
            place = joints.Joint(site.joint) if isinstance(site, Joint) else joints.Tendon(site.name)
            name = add_friction(changed, place, law, normal_force=site.loss)
        return changed.compile(), dataclasses.replace(site, instance=name), ""
    except (InputError, ValueError) as error:
        return None, None, str(error)


def _rounded_up(value: float) -> float:
    """Return ``value`` rounded up to two digits."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 1) if value > 0.0 else 1.0
    return float(f"{math.ceil(value / digit) * digit:.2g}")
