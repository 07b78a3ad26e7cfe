"""Calls that a master should not make give an error status and a message, never a crash."""

import ctypes

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException

from .fmus import Driven, table_1_fmu


def refused(fmu, call, message):
    with pytest.raises(FMICallException):
        call()
    assert message in fmu.log[-1]


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("mechanism", [False, True], ids=["element", "belt_box"])
def test_wrong_references_types_and_moments(fmi, mechanism):
    fmu = Driven(table_1_fmu(fmi=fmi, mechanism=mechanism))
    get = fmu.fmu.getReal if fmi == 2 else fmu.fmu.getFloat64
    put = fmu.fmu.setReal if fmi == 2 else fmu.fmu.setFloat64
    seed = fmu.variables["seed"].valueReference
    refused(fmu, lambda: get([10_000]), "names no variable")
    refused(fmu, lambda: get([seed]), "of this type")
    refused(fmu, lambda: put([fmu.variables["mu"].valueReference], [1.0]), "computed by the FMU")
    refused(fmu, lambda: put([fmu.variables["law.mu_s"].valueReference], [0.7]), "fixed after the initialisation")
    refused(fmu, lambda: fmu.step(float("nan")), "not finite")
    refused(fmu, lambda: fmu.step(-1.0e-3), "negative")
    fmu.t = 0.0
    fmu.step(1.0e-3)
    fmu.end()


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_step_before_the_start(fmi):
    fmu = Driven(table_1_fmu(fmi=fmi), start=False)
    refused(fmu, lambda: fmu.step(1.0e-3), "outside of the step mode")
    fmu.fmu.freeInstance()


@pytest.mark.parametrize("fmi", [2, 3])
def test_states_of_others_and_torn_bytes(fmi):
    one = Driven(table_1_fmu(fmi=fmi))
    other = Driven(table_1_fmu(fmi=fmi, mechanism=True))
    foreign, own = other.save(), one.save()
    data = one.bytes_of(own)
    refused(one, lambda: one.restore(foreign), "no state of this FMU")
    refused(one, lambda: one.from_bytes(data[: len(data) // 2], 0.0), "too short")
    refused(one, lambda: one.from_bytes(bytes(len(data)), 0.0), "no serialised state")
    one.step(1.0e-3)
    one.end()
    other.end()


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_null_instance_is_an_error(fmi):
    fmu = Driven(table_1_fmu(fmi=fmi))
    library = ctypes.CDLL(fmu.fmu.dll._name)
    name = "fmi2Terminate" if fmi == 2 else "fmi3Terminate"
    assert getattr(library, name)(ctypes.c_void_p(None)) == 3  # error
    fmu.end()


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("mechanism", [False, True], ids=["element", "belt_box"])
def test_random_calls_never_crash_and_leave_it_usable(fmi, mechanism):
    """Values over all magnitudes, NaN and infinity among them, in any order of calls."""
    rng = np.random.default_rng(11)
    fmu = Driven(table_1_fmu(fmi=fmi, mechanism=mechanism), start=False)
    inputs = [n for n, v in fmu.variables.items() if v.causality == "input"]
    parameters = [n for n, v in fmu.variables.items() if v.causality == "parameter" and v.type in ("Real", "Float64")]
    outputs = [n for n, v in fmu.variables.items() if v.causality in ("output", "local")]
    errors = 0

    def value():
        return rng.choice([0.0, np.nan, np.inf, -np.inf, *(10.0 ** rng.uniform(-300, 300, 4) * rng.choice([-1, 1], 4))])

    for _ in range(30):
        try:
            fmu.fmu.reset()
            fmu.t = 0.0
            for name in rng.choice(parameters, 2):
                fmu.set(name, abs(value()))
            fmu.begin()
        except FMICallException:
            errors += 1
        for _ in range(30):
            try:
                fmu.set(rng.choice(inputs), value())
                fmu.step(10.0 ** rng.uniform(-9, -2))
                assert all(np.isfinite(fmu.get(name)) for name in outputs)
            except FMICallException:
                errors += 1
    assert 100 < errors < 900
    fmu.fmu.reset()
    fmu.t = 0.0
    fmu.begin()
    fmu.step(1.0e-3)
    fmu.end()
