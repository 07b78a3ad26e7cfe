"""An eighteenth set, written from the literature by two authors who have read neither the method nor its results.

rigs                          six rigs of their own
friction, mechanism, sensor   shapes of known effects, one a kind, as laboratories meet them: none had to be new
nameless                      effects that no name describes
nulls                         rigs that are as believed

A report runs it once, in random order::

    nice python -m tests.discovery.unseen_forms --series 18 --plan all --seed 181 --here --out DIR
"""

from tests.discovery.unseen_forms import seventeenth  # noqa: F401  the earlier sets enter first: rigs in turn hang on the order

from . import friction, mechanism, nameless, nulls, sensor

__all__ = ["friction", "mechanism", "nameless", "nulls", "sensor"]
