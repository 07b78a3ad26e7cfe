"""A sixteenth set, written from the literature by three authors who have read neither the method nor its results; on the
rigs of the fifteenth.

friction, mechanism, sensor   shapes of known effects, one a kind, as laboratories meet them: none had to be new
nameless                      effects that no name describes
nulls                         rigs that are as believed

A report runs it once, in random order::

    nice python -m tests.discovery.unseen_forms --series 16 --plan all --seed 161 --here --out DIR
"""

from tests.discovery.unseen_forms import fifteenth  # noqa: F401  the earlier sets enter first: rigs in turn hang on the order

from . import friction, mechanism, nameless, nulls, sensor

__all__ = ["friction", "mechanism", "nameless", "nulls", "sensor"]
