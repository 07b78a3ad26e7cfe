"""A fourth set, written from the literature by an author who has read neither the method nor its results.

rigs                          five rigs of their own
friction, mechanism, sensor   shapes of known effects
nameless                      effects that no name describes
nulls                         rigs that are as believed
"""

from tests.discovery.unseen_forms import (  # earlier sets enter first: the rigs that they take in turn hang on the order
    friction_forms,  # noqa: F401
    mechanism_forms,  # noqa: F401
    nameless_forms,  # noqa: F401
    null_forms,  # noqa: F401
    second_forms,  # noqa: F401
    third,  # noqa: F401
)

from . import friction, mechanism, nameless, nulls, sensor

__all__ = ["friction", "mechanism", "nameless", "nulls", "sensor"]
