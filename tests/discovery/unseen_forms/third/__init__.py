"""A third set, written from the literature by an author who has not read the method, and run once after the method was frozen.

friction, mechanism, sensor   shapes of known effects
nameless                      effects that no name describes
nulls                         rigs that are as believed
"""

from . import friction, mechanism, nameless, nulls, sensor

__all__ = ["friction", "mechanism", "nameless", "nulls", "sensor"]
