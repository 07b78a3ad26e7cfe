"""Friction laws, one file each; `LAWS` is the registry: a new law is a new file and one line here."""

from __future__ import annotations

import importlib
from typing import Any

from stochfric_mb.errors import require_fields, require_name
from stochfric_mb.laws.contract import AXIOMS, GUARDS, Law

LAWS: dict[str, tuple[str, str] | type[Law]] = {
    "coulomb": ("stochfric_mb.laws.coulomb", "Coulomb"),
    "havsin": ("stochfric_mb.laws.havsin", "Havsin"),
    "tanh": ("stochfric_mb.laws.tanh", "Tanh"),
    "karnopp": ("stochfric_mb.laws.karnopp", "Karnopp"),
    "piecewise_linear": ("stochfric_mb.laws.piecewise_linear", "PiecewiseLinear"),
    "smooth": ("stochfric_mb.laws.smooth", "Smooth"),
    "elastic_stick": ("stochfric_mb.laws.elastic_stick", "ElasticStick"),
    "stribeck": ("stochfric_mb.laws.stribeck", "Stribeck"),
    "dahl": ("stochfric_mb.laws.dahl", "Dahl"),
    "lugre": ("stochfric_mb.laws.lugre", "Lugre"),
}
"""Kind of a law -> its module and class name, or the class itself if a user registered it."""

_WRAPPERS: dict[str, tuple[str, str]] = {"augmented": ("stochfric_mb.effects.augmented_law", "Augmented")}
"""Kinds that no scenario names: made from another law."""

__all__ = ["AXIOMS", "GUARDS", "LAWS", "Law", "law_class", "make_law", "register_law"]


def law_class(kind: str) -> type[Law]:
    """Return the class of a law by its kind.

    Raises:
        InputError: the kind is unknown; the message lists the known ones.
    """
    entry = _WRAPPERS[kind] if kind in _WRAPPERS else LAWS[require_name("law", kind, LAWS)]
    if isinstance(entry, tuple):
        module, name = entry
        return getattr(importlib.import_module(module), name)
    return entry


def make_law(kind: str, **parameters: Any) -> Law:
    """Return a law from its kind and the parameters of its class.

    >>> make_law("stribeck", mu_s=0.8, mu_k=0.46)
    Stribeck(mu_s=0.8, mu_k=0.46, stribeck_velocity=0.001, form='exponential')

    Raises:
        InputError: unknown kind, unknown or missing parameter, or a value out of range.
    """
    cls = law_class(kind)
    require_fields(f"law {kind}", cls, parameters)
    return cls(**parameters)


def register_law(cls: type[Law]) -> type[Law]:
    """Add a user's own law class to the registry (usable as a class decorator); its module holds its functions."""
    LAWS[cls.kind] = cls
    return cls
