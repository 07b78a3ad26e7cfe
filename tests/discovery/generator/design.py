"""Experiments: which runs are made, at which operating conditions."""

from dataclasses import dataclass, field

from .rig import Rig


@dataclass(frozen=True)
class Run:
    """One record. `conditions` are what differs from the scenario's mechanism."""

    role: str
    conditions: dict[str, float] = field(default_factory=dict)
    duration: float = 60.0


@dataclass(frozen=True)
class Design:
    """An experiment on one rig."""

    name: str
    rig: Rig
    runs: tuple[Run, ...]

    @property
    def varied(self) -> frozenset[str]:
        """What the experiment varies: `belt_velocity`, `normal_force`, `direction`; empty at one operating point."""
        keys = {key for run in self.runs for key in run.conditions}
        if any(run.conditions.get("belt_velocity", 1.0) < 0.0 for run in self.runs):
            keys.add("direction")
            speeds = {abs(run.conditions.get("belt_velocity", self.rig.belt_velocity)) for run in self.runs}
            if len(speeds) == 1:
                keys.discard("belt_velocity")
        return frozenset(keys)

    @property
    def several_points(self) -> bool:
        """Whether the experiment has several operating points."""
        return bool(self.varied)


FREE = Rig()
_TABLE_2 = {"mass": 5.632, "stiffness": 5610.0, "normal_force": 14.0, "mu_k": 0.55, "belt_velocity": 1e-3}


def forced(angular_frequency: float) -> Rig:
    """Kang 2015, Table 2."""
    return Rig(**_TABLE_2, excitation_amplitude=0.5e-3, excitation_angular_frequency=angular_frequency)


def _runs(*conditions: dict[str, float], test: tuple[dict[str, float], ...], duration: float = 60.0) -> tuple[Run, ...]:
    fits = tuple(Run("fit", dict(condition), duration) for condition in conditions)
    return fits + tuple(Run("test", dict(condition), duration) for condition in test)


def _speed(value: float) -> dict[str, float]:
    return {"belt_velocity": value}


def _load(value: float) -> dict[str, float]:
    return {"normal_force": value}


DESIGNS = {
    design.name: design
    for design in (
        Design("one_free", FREE, _runs({}, {}, test=({},))),
        Design("one_forced", forced(13.8), _runs({}, {}, test=({},))),
        Design("one_forced_fast", forced(18.7), _runs({}, {}, test=({},))),
        Design("belt_speeds", FREE, _runs(_speed(1.5e-3), {}, _speed(4e-3), test=(_speed(2e-3), _speed(4e-3)), duration=40.0)),
        Design("normal_loads", FREE, _runs(_load(9.0), {}, _load(18.0), test=(_load(9.0), _load(15.0)), duration=40.0)),
        Design("reversed_belt", FREE, _runs({}, _speed(-2.5e-3), test=({}, _speed(-2.5e-3)), duration=40.0)),
        Design(
            "several",
            FREE,
            _runs(
                {},
                _speed(1.5e-3),
                _speed(4e-3),
                _load(9.0),
                _load(18.0),
                _speed(-2.5e-3),
                test=({}, _speed(-4e-3)),
                duration=30.0,
            ),
        ),
    )
}
