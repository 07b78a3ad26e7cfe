"""The sites of a model with friction: its touching pairs that can be probed, its joints and its tendons."""

from __future__ import annotations

import dataclasses
import math

import mujoco
import numpy as np
import numpy.typing as npt

from stochfric_mb.mujoco.check.probes import TOUCHING, started
from stochfric_mb.mujoco.check.settling import Seen, Settled
from stochfric_mb.mujoco.check.sites import ContactPair, Coordinate, Site, Touch, plane_mobility, touches
from stochfric_mb.mujoco.memory.state import header_of
from stochfric_mb.mujoco.plugin.frictions import PAIRS, covers
from stochfric_mb.mujoco.reading import instances, name_in, state_of

Array = npt.NDArray[np.float64]

FRICTIONLESS = 1.0e-4
"""Coefficients below this are no friction (MuJoCo's least is 1e-5)."""
LEAST_LOAD = 0.02
"""Carried friction over the limit below which it gives no direction."""
SLOPE = 0.98
"""Contacts whose normals have less than this cosine with their mean are not one plane."""
NAMED = 4
"""Most pairs that a note names."""
GEOM, JOINT, TENDON = mujoco.mjtObj.mjOBJ_GEOM, mujoco.mjtObj.mjOBJ_JOINT, mujoco.mjtObj.mjOBJ_TENDON


def find_sites(model: mujoco.MjModel, settled: Settled, most: int) -> tuple[list[tuple[Site, str]], list[str]]:
    """Return what has friction, each with the reason not to probe it (empty: probe), and what was left out.

    Args:
        model: the model.
        settled: what it does when left to itself.
        most: most contact pairs to probe, the most loaded first.
    """
    data = started(model, settled.data)
    headers = [header_of(state_of(model, data, i)) for i in instances(model, PAIRS).values()]
    owned = [(int(h.geom_body), int(h.geom_surface)) for h in headers]
    ours = [g for g in settled.tail if any(covers(pair, g) for pair in owned)]
    rough = {g: s for g, s in settled.tail.items() if g not in ours and s.dim >= 3 and s.mu[0] > FRICTIONLESS}
    smooth = len(settled.tail) - len(rough) - len(ours)
    notes: list[str] = []
    for count, what in ((len(ours), "friction of this package already"), (smooth, "no friction (condim 1 or mu 0)")):
        if count:
            notes.append(f"{count} touching pair{'s have' if count > 1 else ' has'} {what}")
    notes += _never_met(model, settled, owned)
    sites: list[tuple[Site, str]] = []
    for number, (geoms, seen) in enumerate(sorted(rough.items(), key=lambda item: -item[1].normal)):
        contacts = touches(model, data, geoms)
        pair = _pair(model, data, geoms, seen, contacts)
        sites.append((pair, _unusable(seen, contacts) if number < most else f"only the {most} most loaded pairs are probed"))
        if seen.mu[0] != seen.mu[1]:
            notes.append(f"{pair.name} has two sliding coefficients, {seen.mu[0]:g} and {seen.mu[1]:g}; the first is used")
    if settled.unconverged:
        notes.append(
            f"MuJoCo's solver stopped at option.iterations = {model.opt.iterations} in {settled.unconverged} of "
            f"{settled.steps} steps of settling, with forces that are not the solution, friction's too; raise it"
        )
    return sites + [(site, "") for site in _losses(model, data)], notes


def _never_met(model: mujoco.MjModel, settled: Settled, owned: list[tuple[int, int]]) -> list[str]:
    """Return a note on the pairs that ``<pair>`` or this package's friction names, and that never touched, if there are any."""
    listed = list(zip(model.pair_geom1.tolist(), model.pair_geom2.tolist(), strict=True))
    named = owned + [p for p in listed if not any(covers(pair, p) for pair in owned)]
    missed = [pair for pair in named if not any(covers(pair, met) for met in settled.met)]
    apart = sorted(" x ".join(sorted("*" if g < 0 else name_in(model, GEOM, g) for g in pair)) for pair in missed)
    if not apart:
        return []
    listed_names = ", ".join(apart[:NAMED]) + (f" and {len(apart) - NAMED} more" if len(apart) > NAMED else "")
    return [
        f"never touched in {settled.data.time:g} s, so nothing is known of their friction: {listed_names}; "
        "give a keyframe in which they touch, or a longer --settle"
    ]


def _pair(model: mujoco.MjModel, data: mujoco.MjData, geoms: tuple[int, int], seen: Seen, contacts: list[Touch]) -> ContactPair:
    (a, b), force = geoms, seen.friction
    if not model.body_dofnum[model.body_weldid[model.geom_bodyid[a]]]:
        a, b, force = b, a, -force
    along = _along(model, data, contacts, -force if np.linalg.norm(force) > LEAST_LOAD * seen.mu[0] * seen.normal else None)
    names = name_in(model, GEOM, a), name_in(model, GEOM, b)
    return ContactPair((a, b), names, seen.mu[0], (float(along[0]), float(along[1]), float(along[2])))


def _unusable(seen: Seen, contacts: list[Touch]) -> str:
    normals = np.array([t.frame[0] for t in contacts]).reshape(-1, 3)
    mean = normals.sum(axis=0)
    if np.any(normals @ mean < SLOPE * np.linalg.norm(mean)):
        return "its contacts face different ways"
    if not contacts or seen.touching < TOUCHING:
        return f"flickers: touches in {100.0 * seen.touching:.0f} % of the steps"
    return ""


def _along(model: mujoco.MjModel, data: mujoco.MjData, contacts: list[Touch], load: Array | None) -> Array:
    """Return the direction of the probe: of the load that is there, or the most mobile one along the surface."""
    if not contacts:
        return np.array([1.0, 0.0, 0.0])
    frame = contacts[0].frame
    if load is not None:
        tangential = np.asarray(load - (load @ frame[0]) * frame[0])
        if np.linalg.norm(tangential) > 0.0:
            return tangential / np.linalg.norm(tangential)
    plane = plane_mobility(model, data, contacts[0])
    if abs(plane[0, 0] - plane[1, 1]) + 2.0 * abs(plane[0, 1]) < 0.01 * np.trace(plane):
        return frame[1]
    return np.linalg.eigh(plane)[1][:, -1] @ frame[1:]


def _losses(model: mujoco.MjModel, data: mujoco.MjData) -> list[Site]:
    """Return the joints and tendons with frictionloss, to be probed in the direction of the load that is there."""
    sites: list[Coordinate] = []
    for dof in np.flatnonzero(model.dof_frictionloss > 0.0):
        joint = int(model.dof_jntid[dof])
        place, kind = int(dof - model.jnt_dofadr[joint]), mujoco.mjtJoint(model.jnt_type[joint])
        name = name_in(model, JOINT, joint)
        several = kind in (mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_BALL)
        slides = kind == mujoco.mjtJoint.mjJNT_SLIDE or (kind == mujoco.mjtJoint.mjJNT_FREE and place < 3)
        shown, unit = f"{name}[{place}]" if several else name, "m" if slides else "rad"
        sites.append(Coordinate(shown, (name,), "joint", unit, int(dof), float(model.dof_frictionloss[dof])))
    for tendon in np.flatnonzero(model.tendon_frictionloss > 0.0).tolist():
        name = name_in(model, TENDON, tendon)
        sites.append(Coordinate(name, (name,), "tendon", "m", tendon, float(model.tendon_frictionloss[tendon])))
    loads = [site.sample(model, data).resistance for site in sites]
    return [dataclasses.replace(site, along=math.copysign(1.0, load)) for site, load in zip(sites, loads, strict=True)]
