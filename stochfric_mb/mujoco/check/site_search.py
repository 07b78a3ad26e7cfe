"""The sites of a model with friction: its touching pairs that can be probed, its joints and its tendons."""

from __future__ import annotations

import mujoco
import numpy as np
import numpy.typing as npt

from stochfric_mb.mujoco.check import probes
from stochfric_mb.mujoco.check.encounters import covers, forgotten, own_pairs
from stochfric_mb.mujoco.check.settling import Seen, Settled
from stochfric_mb.mujoco.check.sites import ContactPair, Coordinate, Site, flat, mobility, pair_contacts

Array = npt.NDArray[np.float64]

FRICTIONLESS = 1.0e-4
"""Coefficients below this are no friction (MuJoCo's least is 1e-5)."""
LEAST_LOAD = 0.02
"""Carried friction over the limit below which it gives no direction."""


def find_sites(model: mujoco.MjModel, settled: Settled, most: int) -> tuple[list[tuple[Site, str]], list[str]]:
    """Return what has friction, each with the reason not to probe it (empty: probe), and what was left out.

    Args:
        model: the model.
        settled: what it does when left to itself.
        most: most contact pairs to probe, the most loaded first.
    """
    notes: list[str] = []
    data = probes.started(model, settled.state)
    owned = own_pairs(model)
    ours = [g for g in settled.tail if any(covers(pair, g) for pair in owned)]
    free = {g: seen for g, seen in settled.tail.items() if g not in ours}
    rough = {g: seen for g, seen in free.items() if seen.dim >= 3 and seen.mu[0] > FRICTIONLESS}
    smooth = len(settled.tail) - len(rough) - len(ours)
    if ours:
        notes.append(f"{len(ours)} touching pair{'s have' if len(ours) > 1 else ' has'} friction of this package already")
    if smooth:
        notes.append(f"{smooth} touching pair{'s have' if smooth > 1 else ' has'} no friction (condim 1 or mu 0)")
    notes += forgotten(model, settled.met, settled.duration)
    loaded = sorted(rough.items(), key=lambda item: -item[1].normal)
    sites: list[tuple[Site, str]] = []
    for number, (geoms, seen) in enumerate(loaded):
        problem = "" if number < most else f"only the {most} most loaded pairs are probed"
        pair = _pair(model, data, geoms, seen)
        sites.append((pair, problem or _unusable(data, geoms, seen)))
        if seen.mu[0] != seen.mu[1]:
            notes.append(f"{pair.name} has two sliding coefficients, {seen.mu[0]:g} and {seen.mu[1]:g}; the first is used")
    return sites + [(site, "") for site in _losses(model)], notes


def _pair(model: mujoco.MjModel, data: mujoco.MjData, geoms: tuple[int, int], seen: Seen) -> ContactPair:
    a, b = geoms
    force = seen.friction
    if not model.body_dofnum[model.body_weldid[model.geom_bodyid[a]]]:
        a, b, force = b, a, -force
    names = tuple(mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_GEOM, g) or f"#{g}" for g in (a, b))
    along = _along(model, data, (a, b), -force if np.linalg.norm(force) > LEAST_LOAD * seen.mu[0] * seen.normal else None)
    return ContactPair((a, b), (names[0], names[1]), seen.mu[0], (float(along[0]), float(along[1]), float(along[2])))


def _unusable(data: mujoco.MjData, geoms: tuple[int, int], seen: Seen) -> str:
    contacts = pair_contacts(data, geoms)
    if len(contacts) and not flat(data, contacts):
        return "its contacts face different ways"
    if not len(contacts) or seen.count < probes.TOUCHING * seen.samples:
        return f"flickers: touches in {100.0 * seen.count / seen.samples:.0f} % of the steps"
    return ""


def _along(model: mujoco.MjModel, data: mujoco.MjData, geoms: tuple[int, int], load: Array | None) -> Array:
    """Return the direction of the probe: of the load that is there, or the most mobile one along the surface."""
    contacts = pair_contacts(data, geoms)
    if not len(contacts):
        return np.array([1.0, 0.0, 0.0])
    frame = data.contact.frame[contacts[0]].reshape(3, 3)
    if load is not None:
        tangential = np.asarray(load - (load @ frame[0]) * frame[0])
        if np.linalg.norm(tangential) > 0.0:
            return tangential / np.linalg.norm(tangential)
    plane = mobility(model, data, geoms, int(contacts[0]))
    if abs(plane[0, 0] - plane[1, 1]) + 2.0 * abs(plane[0, 1]) < 0.01 * np.trace(plane):
        return frame[1]
    vector = np.linalg.eigh(plane)[1][:, -1]
    return vector[0] * frame[1] + vector[1] * frame[2]


def _losses(model: mujoco.MjModel) -> list[Site]:
    """Return the joints and tendons with frictionloss."""
    sites: list[Site] = []
    for dof in np.flatnonzero(model.dof_frictionloss > 0.0):
        joint = int(model.dof_jntid[dof])
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, joint) or f"joint {joint}"
        several = mujoco.mjtJoint(model.jnt_type[joint]) in (mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_BALL)
        shown = f"{name}[{dof - model.jnt_dofadr[joint]}]" if several else name
        sites.append(Coordinate(shown, (name,), "joint", int(dof), float(model.dof_frictionloss[dof])))
    for number in np.flatnonzero(model.tendon_frictionloss > 0.0):
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_TENDON, int(number)) or f"tendon {number}"
        sites.append(Coordinate(name, (name,), "tendon", int(number), float(model.tendon_frictionloss[number])))
    return sites


def unit_of(model: mujoco.MjModel, site: Site) -> str:
    """Return the unit of a site's displacement, m or rad."""
    if site.kind != "joint":
        return "m"
    joint = int(model.dof_jntid[site.number])
    kind, place = mujoco.mjtJoint(model.jnt_type[joint]), site.number - model.jnt_dofadr[joint]
    slides = kind == mujoco.mjtJoint.mjJNT_SLIDE or (kind == mujoco.mjtJoint.mjJNT_FREE and place < 3)
    return "m" if slides else "rad"
