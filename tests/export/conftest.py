"""All laws, effects and coefficient paths as C, compiled for this machine once a session."""

import ctypes
import dataclasses
import importlib.util

import numpy as np
import pytest

from stochfric_mb.c import Translation
from stochfric_mb.c.compiler import compile_library, host
from stochfric_mb.c.dispatch import EFFECT_FUNCTIONS, FLOW, NUMBERS, Dispatch
from stochfric_mb.c.types import DOUBLE, INT
from stochfric_mb.coefficients import path
from stochfric_mb.effects import effect_class, effect_kinds
from stochfric_mb.effects.augmented_law import Augmented
from stochfric_mb.laws import LAWS, law_class

if importlib.util.find_spec("fmpy") is None:
    collect_ignore_glob = ["test_[!t]*.py", "test_translation.py"]  # pip install -e '.[fmi]'

HOOKS = """
#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif
static int64_t at(void *pointer) { return (int64_t)(intptr_t)pointer; }
EXPORT void test_law(int64_t number, double *x, double *state, double *p, double *out) {
    call_law(number, x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7], x[8], x[9], x[10], at(state), at(p), at(out));
}
EXPORT void test_effect(int64_t number, double *world, double *memory, double *rates, double *p) {
    call_effect(number, at(world), at(memory), at(rates), at(p));
}
EXPORT void test_path(double *descriptor, double *cursor, int64_t *a, double t, double u, double events, double *out) {
    const tuple_d2 r = path_evaluate(descriptor, cursor, a[0], a[1], a[2], t, u, events);
    out[0] = r.a0; out[1] = r.a1;
}
"""


def pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)


@dataclasses.dataclass
class InC:
    """The compiled library, and the numbers of its laws and effects."""

    library: ctypes.CDLL
    dispatch: Dispatch

    def law(self, number, motion, state, p, out):
        self.library.test_law(ctypes.c_int64(number), pointer(motion), pointer(state), pointer(p), pointer(out))


@pytest.fixture(scope="session")
def in_c(tmp_path_factory):
    translation = Translation()
    dispatch = Dispatch(translation)
    hooks = HOOKS
    for kind in LAWS:
        cls = law_class(kind)
        dispatch.law(cls)
        if cls.has_flow:
            made = translation.add(cls.functions().flow, FLOW)
            arguments = ", ".join(f"x[{i}]" for i in range(7))
            hooks += (
                f"EXPORT void test_flow_{kind}(double *x, double *p, double *out) {{\n"
                f"    const tuple_d4 r = {made.name}({arguments}, p);\n"
                "    out[0] = r.a0; out[1] = r.a1; out[2] = r.a2; out[3] = r.a3;\n}\n"
            )
    dispatch.law(Augmented)
    for kind in effect_kinds():
        for name in EFFECT_FUNCTIONS:
            dispatch.effect(effect_class(kind), name)
    translation.add(path.evaluate, [NUMBERS, NUMBERS, INT, INT, INT, DOUBLE, DOUBLE, DOUBLE])
    folder = tmp_path_factory.mktemp("c")
    source = folder / "all.c"
    source.write_text(translation.text + dispatch.text + hooks, encoding="utf-8")
    library = folder / f"all{host().ending}"
    compile_library([source], library, host())
    return InC(ctypes.CDLL(str(library)), dispatch)


@pytest.fixture
def rng():
    return np.random.default_rng(20150)
