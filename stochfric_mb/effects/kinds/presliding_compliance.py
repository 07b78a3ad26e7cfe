"""Presliding compliance: a stuck contact gives like a spring with a damper."""

from __future__ import annotations

import dataclasses
from typing import ClassVar

from stochfric_mb.effects.contract import Effect, parameter
from stochfric_mb.effects.traits import YIELDING


@dataclasses.dataclass(frozen=True, kw_only=True)
class PreslidingCompliance(Effect):
    """Stuck: F = k_stick z + c_stick v_rel within mu_s N.

    k_stick = mu_s N/elastic_limit, c_stick = 2 damping_ratio sqrt(k_stick m).
    Stiffness and damping are those of the mean mu_s; a contact that comes to rest has the deflection of mu_s N, as in
    law elastic_stick, which a scenario's coulomb law becomes in engines.

    Reference: W. S. Kang, C. K. Choi, H. H. Yoo, J. Mech. Sci. Tech. 29, 2015, 3645-3652,
    doi 10.1007/s12206-015-0808-4, eqs. 3-5 (eq. 5 lost its root).
    """

    elastic_limit: float = parameter("m", "deflection at break-away", scale=1.0e-5, low=0.0)
    """Deflection at break-away [m]."""
    damping_ratio: float = parameter("-", "damping ratio of the stuck contact", scale=0.1, low=0.0, high=10.0, default=0.1)
    """Damping ratio of the stuck contact [-]."""

    kind: ClassVar[str] = "presliding_compliance"
    equation: ClassVar[str] = (
        "stuck: F = k_stick z + c_stick v_rel, k_stick = mu_s N/elastic_limit, c_stick = 2 damping_ratio sqrt(k_stick m)"
    )
    source: ClassVar[str] = "Dahl 1968; Kang, Choi and Yoo 2015, eqs. 3-5"
    group: ClassVar[str] = "friction law"
    signatures: ClassVar[tuple[str, ...]] = (YIELDING,)
    shows_on: ClassVar[str] = "stick"
    shows: ClassVar[str] = "the contact yields and rings in stick"
