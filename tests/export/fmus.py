"""FMUs made for this machine, and what drives them."""

import functools
import tempfile
from pathlib import Path

import fmpy
from fmpy.fmi2 import FMU2Model, FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Model, FMU3Slave

from stochfric_mb.c.compiler import host
from stochfric_mb.export.exported import Exported, exported_scenario
from stochfric_mb.export.fmu import fmu_source, write_fmu
from stochfric_mb.scenario import load_scenario


@functools.cache
def folder():
    made = tempfile.TemporaryDirectory(prefix="stochfric-fmu-", ignore_cleanup_errors=True)
    _kept.append(made)
    return Path(made.name)


_kept: list = []


@functools.cache
def table_1(law="elastic_stick", *overrides):
    return load_scenario("kang2015_table1", law=law, overrides=overrides)


@functools.cache
def built(exported: Exported, fmi: int, mechanism: bool):
    """Return the file of an FMU, made once."""
    out = folder() / f"fmu_{len(list(folder().iterdir()))}.fmu"
    write_fmu(fmu_source(exported, fmi=fmi, mechanism=mechanism, name="friction"), out, platforms=[host().name])
    return out


def table_1_fmu(law="elastic_stick", *, fmi=2, mechanism=False):
    return built(exported_scenario(table_1(law)), fmi, mechanism)


@functools.cache
def unzipped(path):
    return fmpy.extract(str(path))


@functools.cache
def description(path):
    return fmpy.read_model_description(str(path))


class Driven:
    """An instance of an FMU in co-simulation, or model exchange, with access by name."""

    def __init__(self, path, *, co_simulation=True, start=True, t=0.0, log=None, token=None, **parameters):
        about = description(path)
        self.fmi = int(about.fmiVersion[0])
        kind = {(2, True): FMU2Slave, (2, False): FMU2Model, (3, True): FMU3Slave, (3, False): FMU3Model}[
            self.fmi, co_simulation
        ]
        self.variables = {v.name: v for v in about.modelVariables}
        identifier = (about.coSimulation if co_simulation else about.modelExchange).modelIdentifier
        self.fmu = kind(
            guid=token or (about.guid if self.fmi == 2 else about.instantiationToken),
            unzipDirectory=unzipped(path),
            modelIdentifier=identifier,
            instanceName="one",
        )
        self.log = [] if log is None else log
        self._instantiate()
        self.t = t
        if start:
            self.begin(**parameters)

    def _instantiate(self):
        if self.fmi == 2:
            self.keep = fmi2CallbackLoggerTYPE(lambda e, name, status, category, message: self.log.append(message.decode()))
            callbacks = fmi2CallbackFunctions()
            callbacks.logger = self.keep
            self.fmu.instantiate(callbacks=callbacks)
        else:
            self.fmu.instantiate(logMessage=lambda e, status, category, message: self.log.append(message.decode()))

    def begin(self, **values):
        if self.fmi == 2:
            self.fmu.setupExperiment(startTime=self.t)
        for name, value in values.items():
            self.set(name, value)
        if self.fmi == 2:
            self.fmu.enterInitializationMode()
        else:
            self.fmu.enterInitializationMode(startTime=self.t)
        self.fmu.exitInitializationMode()

    def set(self, name, value):
        name = name.replace("__", ".")
        if isinstance(value, tuple):
            for i, part in enumerate(value):
                self.set(f"{name}[{i + 1}]", part)
            return
        v = self.variables[name]
        if v.type in ("Integer", "UInt32"):
            (self.fmu.setInteger if self.fmi == 2 else self.fmu.setUInt32)([v.valueReference], [value])
        else:
            (self.fmu.setReal if self.fmi == 2 else self.fmu.setFloat64)([v.valueReference], [value])

    def get(self, name):
        v = self.variables[name]
        if v.type == "Boolean":
            return self.fmu.getBoolean([v.valueReference])[0]
        return (self.fmu.getReal if self.fmi == 2 else self.fmu.getFloat64)([v.valueReference])[0]

    def step(self, h, **inputs):
        for name, value in inputs.items():
            self.set(name, value)
        self.fmu.doStep(currentCommunicationPoint=self.t, communicationStepSize=h)
        self.t += h

    def save(self):
        state = self.fmu.getFMUState()
        return state, self.t

    def restore(self, saved):
        self.fmu.setFMUState(saved[0])
        self.t = saved[1]

    def forget(self, saved):
        self.fmu.freeFMUState(saved[0])

    def bytes_of(self, saved):
        return self.fmu.serializeFMUState(saved[0])

    def from_bytes(self, data, t):
        return self.fmu.deserializeFMUState(data), t

    def end(self):
        self.fmu.terminate()
        self.fmu.freeInstance()
