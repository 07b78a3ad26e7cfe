"""Hidden effects. Importing the modules fills the table of forms."""

from . import contact, drive, law, null, place, randomness, sensor, structure, unknown
from .form import FORMS, Effect, Form, Record

__all__ = [
    "FORMS",
    "Effect",
    "Form",
    "Record",
    "contact",
    "drive",
    "law",
    "null",
    "place",
    "randomness",
    "sensor",
    "structure",
    "unknown",
]
