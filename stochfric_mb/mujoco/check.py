"""What a model's friction does and what this package's does in its place: contact pairs, joints and tendons.

Each site is probed on copies of the model, from the state to which it settles (`probes`): it holds a share of its
limit, breaks away under a rising load, and slides; with the model's own friction and with ours.
"""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import contextlib
import copy
import dataclasses
import math
import warnings
from collections.abc import Callable, Generator
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError, SimulationError, require_name, require_number
from stochfric_mb.laws import Law, make_law
from stochfric_mb.laws.coulomb import Coulomb
from stochfric_mb.laws.elastic_stick import ElasticStick
from stochfric_mb.laws.substitute import MARGIN, elastic_substitute
from stochfric_mb.mujoco import joints, probes
from stochfric_mb.mujoco.advice import SLIDING, advice
from stochfric_mb.mujoco.attach import add_friction, copied, take_over
from stochfric_mb.mujoco.encounters import covers, forgotten, own_pairs
from stochfric_mb.mujoco.findings import SHARES, CheckResult, Findings, Row
from stochfric_mb.mujoco.probes import Drift, Record, Slide, State
from stochfric_mb.mujoco.sites import (
    ContactPair,
    Joint,
    Tendon,
    contact_forces,
    flat,
    kick,
    lightest_mass,
    mobility,
    pair_contacts,
)
from stochfric_mb.scenario import scenario_folders

Array = npt.NDArray[np.float64]
AnySite = ContactPair | Joint | Tendon
Stage = Callable[[str, float], Callable[[float], None]]

FRICTIONLESS = 1.0e-4
"""Coefficients below this are no friction (MuJoCo's least is 1e-5)."""
UNSTEADY = 0.5
"""Relative spread of the normal force above which a contact is not at rest."""
TAIL = 0.2
"""Share of the settling time at whose end contacts are looked for."""
LEAST_LOAD = 0.02
"""Carried friction over the limit below which it gives no direction."""


def check(
    model: str | Path | mujoco.MjSpec,
    *,
    keyframe: str | None = None,
    settle: float = 2.0,
    duration: float = 0.5,
    law: str = "elastic_stick",
    mu_k_ratio: float = 1.0,
    most: int = 12,
    stage: Stage = lambda name, length: lambda t: None,
) -> CheckResult:
    """Return what the friction of a model does, and what a law of this package does in its place.

    Args:
        model: an MJCF, URDF or MJB file, or a spec (which is left as it is).
        keyframe: name or number of the keyframe to start from.
        settle: time that the model is left to itself first [s].
        duration: time of a hold [s].
        law: kind of our law.
        mu_k_ratio: its mu_k over mu_s [-], in [0, 1]; mu_s is the model's coefficient.
        most: most contact pairs that are probed, the most loaded first.
        stage: called with each site's name and total simulated time [s]; what it returns is called with the progress.

    Raises:
        InputError: the model cannot be loaded, or an option is out of range.
        SimulationError: the model breaks before anything is probed.
    """
    require_number("settle", settle, low=0.0, unit="s")
    require_number("duration", duration, above=0.0, unit="s")
    require_number("mu_k_ratio", mu_k_ratio, low=0.0, high=1.0)
    make_law(law, mu_s=1.0, mu_k=mu_k_ratio)
    with _quiet() as said:
        bench = _Bench(model, law=law, mu_k_ratio=mu_k_ratio, duration=duration)
        bench.settle(keyframe, settle, stage)
        found, notes = bench.sites(most)
        rows = tuple(bench.row(site, problem, stage(site.name, bench.probe_time())) for site, problem in found)
    option = bench.model.opt
    return CheckResult(
        model=str(model) if isinstance(model, str | Path) else (model.modelname or "spec"),
        timestep=float(option.timestep),
        integrator=_word(mujoco.mjtIntegrator(option.integrator), "mjINT_"),
        cone=_word(mujoco.mjtCone(option.cone), "mjCONE_"),
        impratio=float(option.impratio),
        keyframe=keyframe or "",
        settle=settle,
        duration=duration,
        mu_k_ratio=mu_k_ratio,
        rows=rows,
        notes=tuple(dict.fromkeys([*(str(w.message) for w in said), *notes])),
    )


def _word(member: Any, prefix: str) -> str:
    return str(member.name).removeprefix(prefix).lower()


@contextlib.contextmanager
def _quiet() -> Generator[list[warnings.WarningMessage]]:
    """Give the warnings about the model; MuJoCo's while it runs, which become errors here, stay out of MUJOCO_LOG.TXT."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda text: None)
    try:
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            yield said
    finally:
        mujoco.set_mju_user_warning(before)


class _Bench:
    """The model under test, the state it settled to, and how to make copies with other friction."""

    def __init__(self, model: str | Path | mujoco.MjSpec, *, law: str, mu_k_ratio: float, duration: float) -> None:
        self.spec, self.model = load(model)
        self.invented = _name_all(self.spec) if self.spec is not None else frozenset()
        if self.invented and self.spec is not None:
            self.model = self.spec.compile()
        self.law, self.mu_k_ratio, self.duration = law, mu_k_ratio, duration
        self.state = probes.State(np.zeros(0), np.zeros(0))
        self.tail: dict[tuple[int, int], _Seen] = {}
        self.met: set[frozenset[int]] = set()
        self.duration_seen = 0.0

    def probe_time(self) -> float:
        """Return the simulated time of one site's probes, without slides [s]."""
        return 2.0 * (1.0 + len(SHARES) + probes.BREAK_AWAY_TIME) * self.duration

    def settle(self, keyframe: str | None, duration: float, stage: Stage) -> None:
        """Simulate from the initial state, and keep the contacts of the last part."""
        model, data = self.model, mujoco.MjData(self.model)
        if keyframe is not None:
            mujoco.mj_resetDataKeyframe(model, data, _keyframe(model, keyframe))
        steps = round(duration / model.opt.timestep)
        advance = stage("settling", duration)
        for i in range(steps + 1):
            mujoco.mj_forward(model, data)
            self.met.update(frozenset(pair) for pair in data.contact.geom[: data.ncon].tolist())
            if i >= (1.0 - TAIL) * steps:
                _look(model, data, self.tail)
            if i < steps:
                mujoco.mj_step(model, data)
                advance((i + 1) * model.opt.timestep)
            if not np.isfinite(data.qvel).all() or probes.diverged(data):
                raise SimulationError(
                    f"the model itself breaks at t = {data.time:.4g} s with timestep {model.opt.timestep:g} s; "
                    "lower its timestep, or shorten the settling time"
                )
        self.state = probes.snapshot(model, data)
        self.duration_seen = float(data.time)

    def sites(self, most: int) -> tuple[list[tuple[AnySite, str]], list[str]]:
        """Return what has friction, each with the reason not to probe it (empty: probe), and what was left out."""
        notes: list[str] = []
        data = probes.started(self.model, self.state)
        rough = {g: seen for g, seen in self.tail.items() if seen.dim >= 3 and seen.mu[0] > FRICTIONLESS}
        owned = own_pairs(self.model)
        ours = [g for g in self.tail.keys() - rough.keys() if any(covers(pair, g) for pair in owned)]
        smooth = len(self.tail) - len(rough) - len(ours)
        if ours:
            notes.append(f"{len(ours)} touching pair{'s have' if len(ours) > 1 else ' has'} friction of this package already")
        if smooth:
            notes.append(f"{smooth} touching pair{'s have' if smooth > 1 else ' has'} no friction (condim 1 or mu 0)")
        notes += forgotten(self.model, self.met, self.duration_seen)
        loaded = sorted(rough.items(), key=lambda item: -item[1].normal)
        found: list[tuple[AnySite, str]] = []
        for number, (geoms, seen) in enumerate(loaded):
            problem = "" if number < most else f"only the {most} most loaded pairs are probed"
            pair = self._pair(data, geoms, seen)
            found.append((pair, problem or self._unusable(data, geoms, seen)))
            if seen.mu[0] != seen.mu[1]:
                notes.append(f"{pair.name} has two sliding coefficients, {seen.mu[0]:g} and {seen.mu[1]:g}; the first is used")
        return found + [(site, "") for site in _losses(self.model)], notes

    def _pair(self, data: mujoco.MjData, geoms: tuple[int, int], seen: _Seen) -> ContactPair:
        model = self.model
        a, b = geoms
        force = seen.friction
        if not model.body_dofnum[model.body_weldid[model.geom_bodyid[a]]]:
            a, b, force = b, a, -force
        names = tuple(mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_GEOM, g) or f"#{g}" for g in (a, b))
        along = _along(model, data, (a, b), -force if np.linalg.norm(force) > LEAST_LOAD * seen.mu[0] * seen.normal else None)
        return ContactPair((a, b), (names[0], names[1]), seen.mu[0], (float(along[0]), float(along[1]), float(along[2])))

    def _unusable(self, data: mujoco.MjData, geoms: tuple[int, int], seen: _Seen) -> str:
        contacts = pair_contacts(data, geoms)
        if len(contacts) and not flat(data, contacts):
            return "its contacts face different ways"
        if not len(contacts) or seen.count < probes.TOUCHING * seen.samples:
            return f"flickers: touches in {100.0 * seen.count / seen.samples:.0f} % of the steps"
        return ""

    def row(self, site: AnySite, problem: str, advance: Callable[[float], None]) -> Row:
        """Return what the probes find at one site."""
        data = probes.started(self.model, self.state)
        mass, sliding = math.inf, math.inf
        carried: Record | None = None
        if not problem:
            mass = lightest_mass(self.model, data, site)
            sliding = kick(self.model, data, site.row(self.model, data))[1]
            if not math.isfinite(sliding):
                problem = "cannot slide: other constraints, or no freedom along the surface"
        if not problem:
            try:
                carried = probes.run(self.model, self.state, site, self.duration)
                problem = _unsteady(carried)
            except SimulationError as error:
                problem = str(error)
        if problem or carried is None:
            return self._row(site, problem=problem, advice="not probed: " + problem)
        limit = float(carried.column("limit").mean())
        normal = float(carried.column("normal").mean())
        native, native_problem = self._findings(self.model, site, site, limit, sliding, 1.0, advance, 0.0)
        law, law_limit, e_lim = self._fitted_law(site, normal, mass)
        ours = None
        model, own, why = self._ours(site, law)
        if model is not None and own is not None:
            ours, why = self._findings(model, own, site, limit, sliding, self.mu_k_ratio, advance, 0.5 * self.probe_time())
        row = self._row(
            site, problem=native_problem, native=native, ours=ours, ours_problem=why, law=law, mass=mass, limit=limit,
            normal_force=normal, step_limit=law_limit, explicit_e_lim=e_lim,
            mode=self._mode(site, law, law_limit),
        )  # fmt: skip
        return dataclasses.replace(row, advice=advice(row, float(self.model.opt.timestep), self.invented))

    def _row(self, site: AnySite, **values: Any) -> Row:
        kind = {ContactPair: "contact", Joint: "joint", Tendon: "tendon"}[type(site)]
        blank: dict[str, Any] = {
            "normal_force": math.nan, "limit": math.nan, "problem": "", "native": None, "ours": None, "ours_problem": "",
            "law": None, "mass": math.nan, "mode": "", "step_limit": math.nan, "explicit_e_lim": None, "advice": "",
        }  # fmt: skip
        return Row(
            kind=kind, name=site.name, names=_names(site),
            unit=_unit(self.model, site), coefficient=site.mu if isinstance(site, ContactPair) else None, **(blank | values),
        )  # fmt: skip

    def _findings(
        self, model: mujoco.MjModel, site: AnySite, original: AnySite, limit: float, mass: float, ratio: float,
        advance: Callable[[float], None], done: float,
    ) -> tuple[Findings | None, str]:  # fmt: skip
        """Return what all probes find with one friction, or why they could not run."""
        notes: list[str] = []
        try:
            own, record = probes.hold(model, self.state, site, self.duration, 0.0)
            if own is None:
                return None, "the contact is lost"
            state, carried, records = record.end, own.load * limit, [record]
            held: list[Drift | None] = []
            for share in SHARES:
                advance(done + len(records) * self.duration)
                if share * limit <= carried:
                    held.append(None)
                    continue
                found, record = probes.hold(model, state, site, self.duration, share * limit - carried)
                held.append(found)
                if found is None:
                    notes.append(f"the contact is lost at {100.0 * share:.0f} % of the limit")
                records.append(record)
            broken, record = probes.break_away(model, state, site, self.duration, carried, limit, mass)
            records.append(record)
            slide, why = self._slide(model, state, site, original, limit, ratio, records)
        except SimulationError as error:
            return None, str(error)
        if own.load >= SLIDING:
            notes.append("slides in the given state: nothing to hold")
        if slide is not None and slide.touching < 1.0:
            notes.append(f"hops: touches in {100.0 * slide.touching:.0f} % of the slide")
        if broken is None:
            notes.append(f"no break-away up to {100.0 * probes.OVERLOAD:.0f} % of the limit")
        if why:
            notes.append(f"no slide: {why}")
        created = max(r.energy_created() for r in records)
        dissipated = sum(r.energy_dissipated() for r in records)
        advance(done + 0.5 * self.probe_time())
        return Findings(own, tuple(held), broken, slide, created, dissipated, tuple(notes)), ""

    def _slide(
        self, model: mujoco.MjModel, state: State, site: AnySite, original: AnySite, limit: float, ratio: float,
        records: list[Record],
    ) -> tuple[Slide | None, str]:  # fmt: skip
        bare = self._bare(original)
        if bare is None:
            return None, "a contact's friction can be removed only in a model that comes as XML"
        slide, record, why = probes.slide(model, bare, state, site, original, limit)
        if record is not None:
            records.append(record)
        return (dataclasses.replace(slide, expected=ratio * slide.expected) if slide is not None else None), why

    def _bare(self, site: AnySite) -> mujoco.MjModel | None:
        """Return the model without the site's friction, None if it cannot be had."""
        if isinstance(site, ContactPair):
            if self.spec is None:
                return None
            spec = copied(self.spec)
            take_over(spec, *site.names)
            return spec.compile()
        model = copy.copy(self.model)
        if isinstance(site, Joint):
            model.dof_frictionloss[site.dof] = 0.0
        else:
            model.tendon_frictionloss[site.number] = 0.0
        return model

    def _fitted_law(self, site: AnySite, normal: float, mass: float) -> tuple[Law, float, float | None]:
        """Return our law for a site, its explicit step limit [s], and the e_lim for which it would run explicitly [m].

        With ``mode`` auto, friction runs explicitly below half the limit and implicitly above; on joints and tendons it
        is implicit in the velocity always.
        """
        mu_s = site.mu if isinstance(site, ContactPair) else 1.0
        dt = float(self.model.opt.timestep)
        law = make_law(self.law, mu_s=mu_s, mu_k=self.mu_k_ratio * mu_s)
        if not isinstance(site, ContactPair):
            return law, math.inf, None
        limit = law.step_limit(normal, mass)
        if not isinstance(law, ElasticStick) or limit >= MARGIN * dt:
            return law, limit, None
        stiffest, _ = elastic_substitute(Coulomb(mu_s, law.mu_k), dt, normal, mass)
        return law, limit, _rounded_up(getattr(stiffest, "e_lim", law.e_lim))

    def _mode(self, site: AnySite, law: Law, limit: float) -> str:
        """Return how add_friction's mode auto runs a law."""
        implicit = not isinstance(site, ContactPair) or law.needs_holding_force or limit < MARGIN * self.model.opt.timestep
        return "implicit" if implicit else "explicit"

    def _ours(self, site: AnySite, law: Law) -> tuple[mujoco.MjModel | None, AnySite | None, str]:
        """Return the model with our law at the site, or why it cannot be had."""
        if self.spec is None:
            return None, None, "a binary model cannot be changed; give the XML"
        spec = copied(self.spec)
        try:
            if isinstance(site, ContactPair):
                contacts = len(pair_contacts(probes.started(self.model, self.state), site.geoms))
                name = add_friction(spec, site.names, law, slots=max(16, 2 * contacts))
            else:
                place = joints.Joint(site.joint) if isinstance(site, Joint) else joints.Tendon(site.name)
                name = add_friction(spec, place, law, normal_force=site.loss)
            return spec.compile(), dataclasses.replace(site, instance=name), ""
        except (InputError, ValueError) as error:
            return None, None, str(error)


# --- loading and finding ---------------------------------------------------------------------------------------------


def load(model: str | Path | mujoco.MjSpec) -> tuple[mujoco.MjSpec | None, mujoco.MjModel]:
    """Return a spec of one's own (None for a binary model) and the compiled model.

    Raises:
        InputError: there is no such file, or MuJoCo cannot load it.
    """
    if isinstance(model, mujoco.MjSpec):
        spec = copied(model)
        return spec, _compiled(spec, "the spec")
    path = _located(Path(model))
    try:
        if path.suffix.lower() == ".mjb":
            return None, mujoco.MjModel.from_binary_path(str(path))
        spec = mujoco.MjSpec.from_file(str(path))
    except (ValueError, mujoco.FatalError) as error:
        raise InputError(f"{path} is no model that MuJoCo can load: {_one_line(error)}") from None
    return spec, _compiled(spec, str(path))


def _located(path: Path) -> Path:
    """Return a model file, or the one that comes with the package under that name."""
    if path.is_file():
        return path
    bundled = [folder / path.name / f"{path.name}.xml" for folder in scenario_folders()] if path.name == str(path) else []
    for file in bundled:
        if file.is_file():
            return file
    raise InputError(
        f"{path}: no such file; give an MJCF (.xml), URDF or binary (.mjb) model, or a bundled one: incline, belt_box"
    )


def _compiled(spec: mujoco.MjSpec, what: str) -> mujoco.MjModel:
    try:
        return spec.compile()
    except (ValueError, mujoco.FatalError) as error:
        raise InputError(f"{what} does not compile: {_one_line(error)}") from None


def _one_line(error: Exception) -> str:
    return "; ".join(line.strip() for line in str(error).splitlines() if line.strip())


def _name_all(spec: mujoco.MjSpec) -> frozenset[str]:
    """Give every geom, joint and tendon a name; return the names that are not the user's."""
    made: set[str] = set()
    for kind, elements in (("geom", spec.geoms), ("joint", spec.joints), ("tendon", spec.tendons)):
        taken = {e.name for e in elements}
        for element in elements:
            if not element.name:
                name = f"{kind}_{element.id}"
                while name in taken:
                    name += "_"
                element.name = name
                taken.add(name)
                made.add(name)
    return frozenset(made)


def _keyframe(model: mujoco.MjModel, name: str) -> int:
    if name.isdecimal() and int(name) < model.nkey:
        return int(name)
    if not model.nkey:
        raise InputError(f"keyframe {name!r}: the model has no keyframes; leave the option out")
    known = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_KEY, k) or str(k) for k in range(model.nkey)]
    return known.index(require_name("keyframe", name, known))


@dataclasses.dataclass
class _Seen:
    """A touching pair over the last part of settling."""

    dim: int
    mu: tuple[float, float]
    normal: float = 0.0
    friction: Array = dataclasses.field(default_factory=lambda: np.zeros(3))
    count: int = 0
    first: int = 0
    samples: int = 0


def _look(model: mujoco.MjModel, data: mujoco.MjData, tail: dict[tuple[int, int], _Seen]) -> None:
    """Add the contacts of this instant to running means over all instants looked at."""
    now: dict[tuple[int, int], list[int]] = {}
    for i in range(data.ncon):
        a, b = (int(g) for g in data.contact.geom[i])
        if a >= 0 and b >= 0 and data.contact.efc_address[i] >= 0:
            now.setdefault((a, b), []).append(i)
    for geoms, contacts in now.items():
        mu = data.contact.friction[contacts[0]]
        seen = tail.setdefault(geoms, _Seen(int(data.contact.dim[contacts[0]]), (float(mu[0]), float(mu[1]))))
        seen.count += 1
    for geoms, seen in tail.items():
        seen.samples += 1
        normal, friction = 0.0, np.zeros(3)
        for i in now.get(geoms, ()):
            push, force = contact_forces(model, data, i, geoms[0])
            normal += push
            friction += force
        seen.normal += (normal - seen.normal) / seen.samples
        seen.friction += (friction - seen.friction) / seen.samples


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


def _losses(model: mujoco.MjModel) -> list[AnySite]:
    """Return the joints and tendons with frictionloss."""
    found: list[AnySite] = []
    for dof in np.flatnonzero(model.dof_frictionloss > 0.0):
        joint = int(model.dof_jntid[dof])
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, joint) or f"joint {joint}"
        several = mujoco.mjtJoint(model.jnt_type[joint]) in (mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_BALL)
        shown = f"{name}[{dof - model.jnt_dofadr[joint]}]" if several else name
        found.append(Joint(shown, name, int(dof), float(model.dof_frictionloss[dof])))
    for number in np.flatnonzero(model.tendon_frictionloss > 0.0):
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_TENDON, int(number)) or f"tendon {number}"
        found.append(Tendon(name, int(number), float(model.tendon_frictionloss[number])))
    return found


def _names(site: AnySite) -> tuple[str, ...]:
    if isinstance(site, ContactPair):
        return site.names
    return (site.joint if isinstance(site, Joint) else site.name,)


def _unit(model: mujoco.MjModel, site: AnySite) -> str:
    if not isinstance(site, Joint):
        return "m"
    joint = int(model.dof_jntid[site.dof])
    kind, place = mujoco.mjtJoint(model.jnt_type[joint]), site.dof - model.jnt_dofadr[joint]
    slides = kind == mujoco.mjtJoint.mjJNT_SLIDE or (kind == mujoco.mjtJoint.mjJNT_FREE and place < 3)
    return "m" if slides else "rad"


def _unsteady(record: Record) -> str:
    if record.touching < probes.TOUCHING:
        return f"flickers: touches in {100.0 * record.touching:.0f} % of the steps"
    limit = record.column("limit")
    if limit.mean() <= 0.0:
        return "carries no normal force"
    spread = float(limit.std() / limit.mean())
    return f"not at rest: the normal force varies by {100.0 * spread:.0f} %" if spread > UNSTEADY else ""


def _rounded_up(value: float) -> float:
    """Return ``value`` rounded up to two digits."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 1) if value > 0.0 else 1.0
    return float(f"{math.ceil(value / digit) * digit:.2g}")
