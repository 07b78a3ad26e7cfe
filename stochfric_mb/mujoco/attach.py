"""Add friction to a pair of geoms, a joint or a tendon of any MuJoCo model."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import warnings
from typing import Any

import mujoco

from stochfric_mb.errors import InputError
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law
from stochfric_mb.mujoco.anisotropy import ISOTROPIC, Anisotropy
from stochfric_mb.mujoco.joints import Joint, Tendon, add_joint_friction
from stochfric_mb.mujoco.memory.structs import ELLIPTIC
from stochfric_mb.mujoco.pairs import ANY, colliding_pairs, require_free, require_geoms, take_over, warn_of_filters
from stochfric_mb.mujoco.plugin.configuration import MAX_SLOTS, configuration, require_slots
from stochfric_mb.mujoco.plugin.options import check_options, require_primal
from stochfric_mb.mujoco.plugin.pair import NAME, register


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

    The pair becomes an explicit contact pair with the law's sliding friction; torsional and rolling friction stay MuJoCo's,
    all other contacts stay as they are. With ``"*"`` for one side, so does every pair of the named geom with a geom that it
    can collide with (by contype, conaffinity, excludes, welding and the parent filter); geoms without a name get one. All
    these contacts share one coefficient path; give them an instance each to have paths of their own.

    Args:
        spec: the model, before it is compiled; changed in place. Its cones become elliptic (but not for ``explicit``).
        geoms: names of the body's geom and of the counter-surface's (one may be ``"*"``), or a `Joint` or `Tendon`
            (see `add_joint_friction`).
        friction: a law, or a `Friction` with a coefficient process.
        normal_force: the load of a joint or tendon [N, for a hinge N m], or "reaction" for that of the joint's bearing;
            contacts have MuJoCo's own normal force.
        radius: of a hinge's bearing [m], with ``normal_force="reaction"``.
        seed: first part of the coefficient path's address.
        sample: second part: the run of an ensemble.
        contact: third part: number of this pair in the model.
        slots: most contacts at a time; 16, or four for each pair of a ``"*"``, if not given.
        mode: ``solver``: the law steers MuJoCo's own friction solver; ``explicit``: its force at each instant; ``auto``:
            explicit where the integrator is RK4 and the step below half the law's limit, otherwise solver.
        anisotropy: how the coefficients of a pair differ by direction; only in ``solver``.

    Raises:
        InputError: unknown geom, a law that cannot run here, an address out of range, or options that switch passive
            forces off.

    Warns:
        IntegratorWarning: the ``discrete`` integrator, for a joint or tendon, or in ``explicit``.
        ConeWarning: the model's cones were pyramidal, and are elliptic from now on.
        ContactWarning: the geoms did not collide before, or flexible bodies keep MuJoCo's friction.
    """
    if not isinstance(spec, mujoco.MjSpec):
        raise InputError(
            f"spec is a {type(spec).__name__}; give an MjSpec (mujoco.MjSpec.from_file), or use friction(model, data, "
            "...) for a model that is compiled already"
        )
    register()
    friction = as_friction(friction)
    steered = mode != "explicit" and friction.law.rest != "bristle"
    if isinstance(geoms, Joint | Tendon):
        if anisotropy != ISOTROPIC:
            raise InputError(f"anisotropy = {anisotropy}: a joint or tendon has one direction; give it to a pair of geoms")
        check_options(spec.option.disableflags, spec.option.integrator, ELLIPTIC, steered=False)
        return add_joint_friction(
            spec,
            geoms,
            friction,
            normal_force=normal_force,
            radius=radius,
            seed=seed,
            sample=sample,
            contact=contact,
            mode=mode,
        )
    if normal_force is not None or radius is not None:
        raise InputError(
            f"normal_force = {normal_force!r}, radius = {radius!r} are for joints and tendons; contacts have MuJoCo's own "
            "normal force"
        )
    body, surface = require_geoms(spec, geoms)
    pairs = colliding_pairs(spec, body, surface) if ANY in (body, surface) else [(body, surface)]
    require_free(spec, pairs)
    slots = max(16, min(4 * len(pairs), MAX_SLOTS)) if slots is None else slots
    texts = configuration(
        friction,
        body,
        surface,
        seed=seed,
        sample=sample,
        contact=contact,
        slots=require_slots(slots),
        mode=mode,
        anisotropy=anisotropy,
    )
    name = free_name(spec, f"friction_{body}_{surface}".replace(ANY, "any"), "pair")
    check_options(spec.option.disableflags, spec.option.integrator, ELLIPTIC, steered=steered)
    if anisotropy != ISOTROPIC:
        require_primal(spec.option.solver, spec.option.noslip_iterations)
    warn_of_filters(spec, body, surface)
    if steered:
        make_elliptic(spec)
    plugin: Any = spec.add_plugin(name=name, plugin_name=NAME, active=True)
    plugin.config = {key: value for key, value in texts.items() if value}
    spec.activate_plugin(NAME)
    for pair in pairs:
        take_over(spec, *pair, friction.law.mu_s)
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


def free_name(spec: mujoco.MjSpec, name: str, what: str) -> str:
    """Return a name for a plugin instance, or raise an `InputError` if the model has it already."""
    taken = {p.name for p in spec.plugins}
    if name in taken:
        raise InputError(f"the model has a plugin {name!r} already: this {what} has friction; build the spec anew to change it")
    return name
