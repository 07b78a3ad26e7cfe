"""All probes of one site, with the model's own friction and with ours, and what they amount to."""

from __future__ import annotations

import copy
import dataclasses
import math
from collections.abc import Callable

import mujoco
import numpy as np

from stochfric_mb.errors import InputError, SimulationError
from stochfric_mb.laws import Law, make_law
from stochfric_mb.mujoco import joints
from stochfric_mb.mujoco.attach import add_friction
from stochfric_mb.mujoco.check import probes
from stochfric_mb.mujoco.check.advice import SLIDING, advice
from stochfric_mb.mujoco.check.findings import SHARES, Findings, Row
from stochfric_mb.mujoco.check.loading import copied
from stochfric_mb.mujoco.check.probes import BREAK_AWAY_TIME, Drift, Probe, Record, started
from stochfric_mb.mujoco.check.sites import ContactPair, Site, kick, touches
from stochfric_mb.mujoco.memory.state import header_of
from stochfric_mb.mujoco.pairs import take_over
from stochfric_mb.mujoco.reading import instances, state_of


@dataclasses.dataclass(frozen=True)
class Bench:
    """The model under test in the state it settled to, and how it is tested."""

    spec: mujoco.MjSpec | None
    """The model as it can be changed; None where it cannot."""
    model: mujoco.MjModel
    """The model."""
    paired: mujoco.MjModel | None
    """The model with each pair of the sites by itself, see `paired`; None where it cannot be changed."""
    invented: frozenset[str]
    """Names that are not the user's."""
    state: mujoco.MjData
    """Where every probe starts."""
    law: str
    """Kind of our law."""
    mu_k_ratio: float
    """Its mu_k over mu_s [-]."""
    duration: float
    """Time of a hold [s]."""

    def probe_time(self) -> float:
        """Return the simulated time of one site's probes, without slides [s]."""
        return 2.0 * (1.0 + len(SHARES) + BREAK_AWAY_TIME) * self.duration

    def row(self, site: Site, problem: str, advance: Callable[[float], None]) -> Row:
        """Return what the probes find at one site; ``problem`` says why not to probe it."""
        row = Row(site.kind, site.name, site.names, site.unit, getattr(site, "mu", None))
        probe = Probe(self.model, self.state, site, self.duration)
        try:
            if problem:
                raise SimulationError(problem)
            data = started(self.model, self.state)
            sliding = kick(self.model, data, site.sample(self.model, data).row)[1]
            if not math.isfinite(sliding):
                raise SimulationError("cannot slide: other constraints, or no freedom along the surface")
            record = probe.run(self.duration)
            _require_steady(record, self.duration / sliding, site.unit)
        except SimulationError as error:
            return dataclasses.replace(row, problem=str(error), advice=f"not probed: {error}")
        limit, normal = float(record.column("limit").mean()), float(record.column("normal").mean())
        native, problem = self._findings(probe, site, limit, sliding, 1.0, advance)
        mu_s = site.mu if isinstance(site, ContactPair) else 1.0
        law = make_law(self.law, mu_s=mu_s, mu_k=self.mu_k_ratio * mu_s)
        mobility = site.mobility(self.model, data)
        mass = 1.0 / mobility if mobility > 0.0 else math.inf
        ours, mode = None, ""
        try:
            own = self._with_ours(site, law)
            half = 0.5 * self.probe_time()
            ours, why = self._findings(own, site, limit, sliding, self.mu_k_ratio, lambda t: advance(half + t))
            if ours is not None:
                state = state_of(own.model, own.records[0].end, instances(own.model)[own.site.instance])
                mode = "solver" if header_of(state).solved else "explicit"
        except ValueError as error:
            why = str(error)
        row = dataclasses.replace(
            row, problem=problem, native=native, ours=ours, ours_problem=why, law=law, mass=mass, limit=limit,
            normal_force=normal, step_limit=law.step_limit(normal, mass), mode=mode,
        )  # fmt: skip
        return dataclasses.replace(row, advice=advice(row, self.invented))

    def _findings(
        self, probe: Probe, original: Site, limit: float, mass: float, ratio: float, advance: Callable[[float], None]
    ) -> tuple[Findings | None, str]:
        """Return what all probes find with one friction, or why they could not run."""
        notes: list[str] = []
        try:
            own = probe.hold(0.0)
            if own is None:
                return None, probes.LOST
            carried, rest = own.load * limit, probe.records[-1]
            probe = dataclasses.replace(probe, state=rest.end, records=[rest])
            held: list[Drift | None] = []
            for share in SHARES:
                advance(len(probe.records) * self.duration)
                if share * limit <= carried:
                    held.append(None)
                    continue
                held.append(probe.hold(share * limit - carried))
                if held[-1] is None:
                    notes.append(f"the contact is lost at {100.0 * share:.0f} % of the limit")
            broken = probe.break_away(carried, limit, mass)
            slide, why = None, "a contact's friction can be removed only in a model that comes as XML"
            if (bare := self._without_friction(original)) is not None:
                slide, why = probe.slide(Probe(bare, probe.state, original, self.duration), limit, ratio)
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
        energies = [r.integral("power") for r in probe.records]
        created, dissipated = max(0.0, *(float(e.max()) for e in energies)), -sum(float(e[-1]) for e in energies)
        advance(0.5 * self.probe_time())
        return Findings(own, tuple(held), broken, slide, created, dissipated, tuple(notes)), ""

    def _without_friction(self, site: Site) -> mujoco.MjModel | None:
        """Return the model without the site's friction, None if it cannot be had."""
        if isinstance(site, ContactPair):
            if self.paired is None:
                return None
            bare = copy.copy(self.paired)
            pairs = zip(bare.pair_geom1.tolist(), bare.pair_geom2.tolist(), strict=True)
            bare.pair_dim[[set(pair) == set(site.geoms) for pair in pairs]] = 1
            return bare
        model = copy.copy(self.model)
        losses = model.dof_frictionloss if site.kind == "joint" else model.tendon_frictionloss
        losses[site.number] = 0.0
        return model

    def _with_ours(self, site: Site, law: Law) -> Probe:
        """Return the same with our law at the site.

        Raises:
            InputError: it cannot be had; says why.
            ValueError: MuJoCo does not compile the model.
        """
        if self.spec is None:
            raise InputError("a binary model cannot be changed; give the XML")
        changed = copied(self.spec)
        changed.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        if isinstance(site, ContactPair):
            contacts = len(touches(self.model, started(self.model, self.state), site.geoms))
            name = add_friction(changed, site.names, law, slots=max(16, 2 * contacts))
        else:
            place = joints.Joint(*site.names) if site.kind == "joint" else joints.Tendon(*site.names)
            name = add_friction(changed, place, law, normal_force=site.loss)
        return Probe(changed.compile(), self.state, dataclasses.replace(site, instance=name), self.duration)


def paired(spec: mujoco.MjSpec | None, sites: list[Site]) -> mujoco.MjModel | None:
    """Return a model whose pairs of geoms at the sites are pairs by themselves; None without a spec."""
    if spec is None:
        return None
    changed = copied(spec)
    for site in sites:
        if isinstance(site, ContactPair):
            take_over(changed, *site.names, site.mu)
    return changed.compile()


def _require_steady(record: Record, motion: float, unit: str) -> None:
    """Refuse a contact that flickers, bears nothing or is shaken, and a site that moves though friction could hold it.

    Args:
        record: the site left to itself.
        motion: time over the mass that slides, by which a force sets it in motion [s/kg].
        unit: of its displacement.

    Raises:
        SimulationError: says why.
    """
    if record.touching < probes.TOUCHING:
        raise SimulationError(f"flickers: touches in {100.0 * record.touching:.0f} % of the steps")
    limit = record.column("limit")
    if limit.mean() <= 0.0:
        raise SimulationError("carries no normal force")
    if limit.std() > probes.UNSTEADY * limit.mean():
        spread = 100.0 * limit.std() / limit.mean()
        raise SimulationError(f"not at rest: the normal force varies by {spread:.0f} %")
    half = len(limit) // 2
    speed = float(np.abs(record.column("velocity")[half:]).max())
    load = float(record.column("resistance")[half:].mean() / limit[half:].mean())
    if speed > probes.EXCESS * float(limit.mean()) * motion and load < SLIDING:
        raise SimulationError(f"not at rest: moves by up to {speed:.2g} {unit}/s under {100.0 * load:.0f} % of its limit")
