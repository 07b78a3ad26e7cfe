"""The model of a law with effects, as C reads it: numbers of functions in the place of addresses."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.c.dispatch import Dispatch
from stochfric_mb.effects import Effect
from stochfric_mb.effects import augmented_law as augmented
from stochfric_mb.effects.abi import native_effect
from stochfric_mb.effects.combine import moving
from stochfric_mb.laws.abi import native_law


def numbered_model(law: augmented.Augmented, effects: Sequence[Effect], dispatch: Dispatch) -> npt.NDArray[np.float64]:
    """Return the model of a law with effects with addresses replaced by the numbers of ``dispatch``.

    The place of the inner law's parameters is left as it is: who calls the C code sets it.

    Args:
        law: the law with effects.
        effects: those effects.
        dispatch: where laws and effects have their numbers.
    """
    model = law.model_numbers.copy()
    inner = type(law.inner)
    native, numbers = native_law(inner.kind), dispatch.law(inner)
    known = {float(getattr(native, n)): float(getattr(numbers, n)) for n in ("init", "force", "commit", "guards")}
    for place in (augmented.INIT, augmented.FORCE, augmented.COMMIT, augmented.GUARD):
        model[place] = known[model[place]]
    places: dict[float, float] = {}
    for effect in moving(effects):
        addresses = native_effect(type(effect))
        for name in ("surroundings", "friction"):
            if address := getattr(addresses, name):
                places[float(address)] = float(dispatch.effect(type(effect), name))
    rows = int(model[augmented.N_AROUND] + model[augmented.N_FRICTION])
    for row in range(augmented.TABLE, augmented.TABLE + 3 * rows, 3):
        model[row] = places[model[row]]
    return model
