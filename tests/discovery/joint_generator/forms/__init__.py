"""Hidden effects of driven joints. Importing the modules fills the table of forms."""

from . import coupling, law, null, place, sensor, slider, time, unknown, variants
from .form import FORMS, Effect, Form, Record

__all__ = [
    "FORMS",
    "Effect",
    "Form",
    "Record",
    "coupling",
    "law",
    "null",
    "place",
    "sensor",
    "slider",
    "time",
    "unknown",
    "variants",
]
