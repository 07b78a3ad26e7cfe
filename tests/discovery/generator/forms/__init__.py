"""Hidden effects. Importing the modules fills the table of forms."""

from . import law, null, place, randomness
from .form import FORMS, Effect, Form, Record

__all__ = ["FORMS", "Effect", "Form", "Record", "law", "null", "place", "randomness"]
