"""A seventh set, written from the literature by an author who has read neither the method nor its results.

rigs                          five rigs of their own, from micrograms to tons
friction, mechanism, sensor   shapes of known effects, one a kind
nameless                      effects that no name describes
nulls                         rigs that are as believed

A report runs it once, in random order::

    nice python -m tests.discovery.unseen_forms --series 7 --plan all --seed 51 --here --out DIR
"""

from tests.discovery.unseen_forms import sixth  # noqa: F401  the earlier sets enter first: rigs in turn hang on the order

from . import friction, mechanism, nameless, nulls, sensor

__all__ = ["friction", "mechanism", "nameless", "nulls", "sensor"]
