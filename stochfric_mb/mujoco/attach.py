"""Add friction to a pair of geoms, a joint or a tendon of any MuJoCo model."""

from __future__ import annotations

import warnings
from typing import Any

import mujoco

from stochfric_mb.errors import InputError
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law
from stochfric_mb.mujoco.anisotropy import ISOTROPIC, Anisotropy
from stochfric_mb.mujoco.joints import Joint, Tendon, element_of, load_of
from stochfric_mb.mujoco.pairs import colliding_pairs, require_free, require_geoms, take_over, warn_of_filters
from stochfric_mb.mujoco.plugin.configuration import MAX_SLOTS, configuration, enter, require_slots
from stochfric_mb.mujoco.plugin.frictions import ANY, DOFS, KEYS, PAIRS
from stochfric_mb.mujoco.plugin.options import check_options, require_primal


class ConeWarning(UserWarning):
    """A model's friction cones have been made elliptic."""


def add_friction(
    spec: mujoco.MjSpec,
    geoms: tuple[str, str] | Joint | Tendon,
    friction: Law | Friction,
    *,
    normal_force: float | str | None = None,
    radius: float | None = None,
    seed: int = 0,
    sample: int = 0,
    contact: int = 0,
    slots: int | None = None,
    mode: str = "auto",
    anisotropy: Anisotropy = ISOTROPIC,
) -> str:
    """Return the name of the plugin instance that now sets the friction between two geoms, or of a joint or tendon.

    A joint's or tendon's law steers MuJoCo's own friction of the coordinate, ``frictionloss``, which becomes mu_s normal_force;
    for a hinge the law's lengths and velocities are angles [rad] and rates [rad/s].

    The pair becomes an explicit contact pair with the law's sliding friction; torsional and rolling friction stay MuJoCo's,
    all other contacts stay as they are. With ``"*"`` for one side, so does every pair of the named geom with a geom that it
    can collide with (by contype, conaffinity, excludes, welding and the parent filter); geoms without a name get one. All
    these contacts share one coefficient path; give them an instance each to have paths of their own.

    Args:
        spec: the model, before it is compiled; changed in place. Its cones become elliptic (but not for ``explicit``).
        geoms: names of the body's geom and of the counter-surface's (one may be ``"*"``), or a `Joint` or `Tendon`
            with ``normal_force``.
        friction: a law, or a `Friction` with a coefficient process.
        normal_force: the load of a joint or tendon [N]; of a hinge, times the radius at which it rubs [N m]. Or "reaction":
            the force between the joint's two bodies, step by step (of a slide joint, across its axis).
        radius: of a hinge's bearing [m], with ``normal_force="reaction"``.
        seed: first part of the coefficient path's address.
        sample: second part: the run of an ensemble.
        contact: third part: number of this pair in the model.
        slots: most contacts at a time; 16, or four for each pair of a ``"*"``, if not given.
        mode: ``solver``: the law steers MuJoCo's own friction solver; ``explicit``: its force at each instant; ``auto``:
            explicit where the integrator is RK4 and the step below half the law's limit, otherwise solver.
        anisotropy: how the coefficients of a pair differ by direction; only in ``solver``.

    Raises:
        InputError: unknown geom or joint, no load, a law that cannot run here, an address out of range, or options that switch
            passive forces or, for a joint or tendon, frictionloss off.

    Warns:
        IntegratorWarning: the ``discrete`` integrator, for a joint or tendon, or in ``explicit``; noslip iterations with it or
            with PGS.
        ConeWarning: the model's cones were pyramidal, and are elliptic from now on.
        ContactWarning: the geoms did not collide before, or flexible bodies keep MuJoCo's friction.
        PluginWarning: MuJoCo would save the model without this friction, since another plugin's instance has no name.
    """
    if not isinstance(spec, mujoco.MjSpec):
        raise InputError(
            f"spec is a {type(spec).__name__}; give an MjSpec (mujoco.MjSpec.from_file), or use friction(model, data, "
            "...) for a model that is compiled already"
        )
    friction = as_friction(friction)
    address: Any = {"seed": seed, "sample": sample, "contact": contact}
    if isinstance(geoms, Joint | Tendon):
        if anisotropy != ISOTROPIC:
            raise InputError(f"anisotropy = {anisotropy}: a joint or tendon has one direction; give it to a pair of geoms")
        element = element_of(spec, geoms)
        load = load_of(geoms, element, normal_force, radius)
        texts = configuration(friction, mode=mode, **address) | {geoms.kind: geoms.name} | load
        check_options(spec.option, steered=False, coordinate=True)
        name = _enter(spec, DOFS, f"friction_{geoms.name}", geoms.kind, texts)
        element.frictionloss = friction.law.mu_s * float(load.get("normal_force", 1.0))
        return name
    if normal_force is not None or radius is not None:
        raise InputError(
            f"normal_force = {normal_force!r}, radius = {radius!r} are for joints and tendons, and {geoms!r} is neither: write "
            "Joint(name) or Tendon(name); contacts have MuJoCo's own normal force"
        )
    body, surface = require_geoms(spec, geoms)
    pairs = colliding_pairs(spec, body, surface) if ANY in (body, surface) else [(body, surface)]
    require_free(spec, pairs)
    room = require_slots(max(16, min(4 * len(pairs), MAX_SLOTS)) if slots is None else slots)
    texts = configuration(friction, mode=mode, slots=room, anisotropy=anisotropy, **address)
    steered = mode != "explicit" and friction.law.rest != "bristle"
    check_options(spec.option, steered=steered)
    if anisotropy != ISOTROPIC:
        require_primal(spec.option)
    name = _enter(
        spec, PAIRS, f"friction_{body}_{surface}".replace(ANY, "any"), "pair", texts | {"geom1": body, "geom2": surface}
    )
    warn_of_filters(spec, body, surface)
    if steered:
        make_elliptic(spec)
    for pair in pairs:
        take_over(spec, *pair, friction.law.mu_s)
    return name


def _enter(spec: mujoco.MjSpec, plugin: str, name: str, what: str, texts: dict[str, str]) -> str:
    """Enter an instance of one of this package's plugins into a spec, and return its name.

    Raises:
        InputError: there is one of that name already.
    """
    if name in {p.name for p in spec.plugins}:
        raise InputError(f"the model has a plugin {name!r} already: this {what} has friction; build the spec anew to change it")
    enter(spec, plugin, name, {key: texts[key] for key in KEYS[plugin] if texts.get(key)})
    return name


def make_elliptic(spec: mujoco.MjSpec) -> None:
    """Make a model's friction cones elliptic, which alone let friction set coefficients step by step; say so."""
    if spec.option.cone != mujoco.mjtCone.mjCONE_ELLIPTIC:
        spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        warnings.warn(
            "option.cone was pyramidal and is elliptic now, for all contacts of the model: the coefficients of pyramidal "
            "contacts cannot be set step by step; set cone='elliptic' in the model to hear no more of it",
            ConeWarning,
            stacklevel=3,
        )
