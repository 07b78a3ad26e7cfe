"""All probes of one site, with the model's own friction and with ours, and what they amount to."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from typing import Any

import mujoco

from stochfric_mb.errors import SimulationError
from stochfric_mb.mujoco.check import probes
from stochfric_mb.mujoco.check.advice import SLIDING, advice
from stochfric_mb.mujoco.check.alternatives import fitted_law, mode_of, with_ours, without_friction
from stochfric_mb.mujoco.check.findings import SHARES, Findings, Row
from stochfric_mb.mujoco.check.probes import Drift, Record, Slide, State
from stochfric_mb.mujoco.check.site_search import unit_of
from stochfric_mb.mujoco.check.sites import ContactPair, Site, kick, lightest_mass

UNSTEADY = 0.5
"""Relative spread of the normal force above which a contact is not at rest."""


@dataclasses.dataclass(frozen=True)
class Bench:
    """The model under test in the state it settled to, and how it is tested."""

    spec: mujoco.MjSpec | None
    """The model as it can be changed; None where it cannot."""
    model: mujoco.MjModel
    """The model."""
    invented: frozenset[str]
    """Names that are not the user's."""
    state: State
    """Where every probe starts."""
    law: str
    """Kind of our law."""
    mu_k_ratio: float
    """Its mu_k over mu_s [-]."""
    duration: float
    """Time of a hold [s]."""

    def probe_time(self) -> float:
        """Return the simulated time of one site's probes, without slides [s]."""
        return 2.0 * (1.0 + len(SHARES) + probes.BREAK_AWAY_TIME) * self.duration

    def row(self, site: Site, problem: str, advance: Callable[[float], None]) -> Row:
        """Return what the probes find at one site."""
        data = probes.started(self.model, self.state)
        dt = float(self.model.opt.timestep)
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
        law, law_limit = fitted_law(self.law, self.mu_k_ratio, site, normal, mass)
        ours = None
        model, own, why = with_ours(self.spec, self.model, self.state, site, law)
        if model is not None and own is not None:
            ours, why = self._findings(model, own, site, limit, sliding, self.mu_k_ratio, advance, 0.5 * self.probe_time())
        row = self._row(
            site, problem=native_problem, native=native, ours=ours, ours_problem=why, law=law, mass=mass, limit=limit,
            normal_force=normal, step_limit=law_limit,
            mode=mode_of(self.model, law, law_limit),
        )  # fmt: skip
        return dataclasses.replace(row, advice=advice(row, dt, self.invented))

    def _row(self, site: Site, **values: Any) -> Row:
        blank: dict[str, Any] = {
            "normal_force": math.nan, "limit": math.nan, "problem": "", "native": None, "ours": None, "ours_problem": "",
            "law": None, "mass": math.nan, "mode": "", "step_limit": math.nan, "advice": "",
        }  # fmt: skip
        return Row(
            kind=site.kind, name=site.name, names=site.names,
            unit=unit_of(self.model, site), coefficient=site.mu if isinstance(site, ContactPair) else None, **(blank | values),
        )  # fmt: skip

    def _findings(
        self, model: mujoco.MjModel, site: Site, original: Site, limit: float, mass: float, ratio: float,
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
                result, record = probes.hold(model, state, site, self.duration, share * limit - carried)
                held.append(result)
                if result is None:
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
        self, model: mujoco.MjModel, state: State, site: Site, original: Site, limit: float, ratio: float,
        records: list[Record],
    ) -> tuple[Slide | None, str]:  # fmt: skip
        bare = without_friction(self.spec, self.model, original)
        if bare is None:
            return None, "a contact's friction can be removed only in a model that comes as XML"
        slide, record, why = probes.slide(model, bare, state, site, original, limit)
        if record is not None:
            records.append(record)
        return (dataclasses.replace(slide, expected=ratio * slide.expected) if slide is not None else None), why


def _unsteady(record: Record) -> str:
    if record.touching < probes.TOUCHING:
        return f"flickers: touches in {100.0 * record.touching:.0f} % of the steps"
    limit = record.column("limit")
    if limit.mean() <= 0.0:
        return "carries no normal force"
    spread = float(limit.std() / limit.mean())
    return f"not at rest: the normal force varies by {100.0 * spread:.0f} %" if spread > UNSTEADY else ""
