"""What a list of effects means for a model: its coefficient process, its law, and which effects act on the motion."""

from __future__ import annotations

from collections.abc import Sequence

from stochfric_mb.coefficients import Process
from stochfric_mb.effects.contract import Effect
from stochfric_mb.effects.kinds.presliding_compliance import PreslidingCompliance
from stochfric_mb.errors import InputError
from stochfric_mb.laws import Law
from stochfric_mb.laws.elastic_stick import ElasticStick

SLOWEST = 1.0e-10
"""v_s of the elastic law of a compliant contact over mu_s [m/s]: next to nothing, since Coulomb's law has none."""


def combined_process(effects: Sequence[Effect], process: Process | None) -> Process | None:
    """Return the coefficient process of a model: its own, or the one that an effect sets.

    Raises:
        InputError: both, or two effects, set it.
    """
    setting = [(effect.kind, own) for effect in effects if (own := effect.coefficient_process()) is not None]
    if not setting:
        return process
    if len(setting) > 1 or process is not None:
        names = [kind for kind, _ in setting] + ([f"[coefficients] process {process.kind}"] if process is not None else [])
        raise InputError(f"{' and '.join(names)} each set the coefficient process, of which there is one; keep one of them")
    return setting[0][1]


def moving(effects: Sequence[Effect]) -> tuple[Effect, ...]:
    """Return the effects that act on the motion by functions of their own."""
    return tuple(e for e in effects if any(hasattr(e.functions(), name) for name in ("surroundings", "friction")))


def on_sensor(effects: Sequence[Effect]) -> tuple[Effect, ...]:
    """Return the effects that act on what the sensor shows."""
    return tuple(e for e in effects if type(e).measure is not Effect.measure)


def any_but_random(effects: Sequence[Effect]) -> bool:
    """Return whether there is an effect that does more than set the coefficient process."""
    return any(effect.coefficient_process() is None for effect in effects)


def with_compliance(law: Law, effects: Sequence[Effect]) -> Law:
    """Return the law, or the elastic one that it becomes by an effect ``presliding_compliance``.

    Raises:
        InputError: two such effects, or one with a law other than coulomb.
    """
    compliant = [e for e in effects if isinstance(e, PreslidingCompliance) and e.elastic_limit > 0.0]
    if not compliant:
        return law
    if len(compliant) > 1 or law.kind != "coulomb":
        raise InputError(
            f"presliding_compliance makes law coulomb elastic, once; law {law.kind} with {len(compliant)} such effects: "
            "leave out the effect, or use law coulomb"
        )
    return ElasticStick(
        law.mu_s, law.mu_k, e_lim=compliant[0].elastic_limit, zeta=compliant[0].damping_ratio,
        v_s=SLOWEST * law.mu_s, decay_velocity=0.0,
    )  # fmt: skip
