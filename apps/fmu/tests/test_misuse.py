"""Calls that an importer must not make: each is refused with a message, and leaves the crane as it was."""

import ctypes
import zipfile

import numpy as np
import pytest
from conftest import Slave

NOTHING = None
COUNT = 5


@pytest.fixture
def boom(export, slave):
    return slave(export("knuckle_boom"))


def refused(unit, call, *words):
    unit.messages.clear()
    with pytest.raises(Exception):
        call()
    said = " ".join(unit.messages)
    assert all(word in said for word in words), said


def raw(unit, name, *arguments):
    """A call as C makes it, also of functions that FMPy does not offer in co-simulation; an error becomes an exception."""
    size = [ctypes.c_size_t(argument) if isinstance(argument, int) else argument for argument in arguments]
    status = getattr(unit.dll, name)(ctypes.c_void_p(unit.component), *size)
    if status > 1:
        raise RuntimeError(f"{name}: {status}")


def test_numbers_that_are_none(boom):
    before = boom.get("hook_theta", "main_boom_theta", "time")
    nan, inf = float("nan"), float("inf")
    refused(boom, lambda: boom.doStep(nan, 0.01), "t = NaN", "is at t = 0")
    refused(boom, lambda: boom.doStep(inf, 0.01), "t = inf")
    refused(boom, lambda: boom.doStep(0.0, nan), "NaN", "choose one above 0")
    refused(boom, lambda: boom.doStep(0.0, inf), "inf", "choose one above 0, from")
    refused(boom, lambda: boom.doStep(0.0, 1e300), "choose one above 0, from")
    for time in (nan, inf, -inf):
        refused(boom, lambda: raw(boom, "fmi2SetTime", ctypes.c_double(time)), "choose a finite time")
    states = (ctypes.c_double * 8)(*[0.0] * 7, nan)
    refused(boom, lambda: raw(boom, "fmi2SetContinuousStates", states, 8), "state 7 is NaN")
    references = [boom.references["hook_theta_acceleration"]], [boom.references["hook_theta"]]
    refused(boom, lambda: boom.getDirectionalDerivative(*references, [nan]), "direction of hook_theta is NaN")
    assert (boom.get("hook_theta", "main_boom_theta", "time") == before).all()
    boom.follow(0, 0.1, 2)
    assert boom.get("time") == [0.1]
    refused(boom, lambda: boom.doStep(5.0, 0.01), "t = 5 s", "is at t = 0.1")
    refused(boom, lambda: boom.doStep(nan, 0.01), "t = NaN")


def test_arrays_that_are_missing(boom):
    """NULL with a count above zero, for every function that takes an array."""
    references = (ctypes.c_uint * COUNT)(*range(COUNT))
    numbers = (ctypes.c_double * COUNT)()
    for call in [
        lambda: raw(boom, "fmi2GetReal", NOTHING, COUNT, numbers),
        lambda: raw(boom, "fmi2GetReal", references, COUNT, NOTHING),
        lambda: raw(boom, "fmi2SetReal", NOTHING, COUNT, numbers),
        lambda: raw(boom, "fmi2SetReal", references, COUNT, NOTHING),
        lambda: raw(boom, "fmi2SetContinuousStates", NOTHING, COUNT),
        lambda: raw(boom, "fmi2GetContinuousStates", NOTHING, COUNT),
        lambda: raw(boom, "fmi2GetDerivatives", NOTHING, COUNT),
        lambda: raw(boom, "fmi2GetEventIndicators", NOTHING, COUNT),
        lambda: raw(boom, "fmi2GetNominalsOfContinuousStates", NOTHING, COUNT),
        lambda: raw(boom, "fmi2GetDirectionalDerivative", references, 1, NOTHING, 1, numbers, numbers),
        lambda: raw(boom, "fmi2GetDirectionalDerivative", NOTHING, 1, references, 1, numbers, numbers),
        lambda: raw(boom, "fmi2GetDirectionalDerivative", references, 1, references, 1, NOTHING, numbers),
        lambda: raw(boom, "fmi2DeSerializeFMUstate", NOTHING, COUNT, ctypes.byref(ctypes.c_void_p())),
    ]:
        refused(boom, call, "no array was given for")
    # Nothing is asked for.
    raw(boom, "fmi2GetReal", NOTHING, 0, NOTHING)


def test_steps_out_of_turn(export, tmp_path):
    unit = Slave(export("knuckle_boom"), tmp_path / "early")
    unit.open()
    refused(unit, lambda: unit.doStep(0.0, 0.01), "before the end of the initialisation")
    unit.setupExperiment()
    unit.enterInitializationMode()
    refused(unit, lambda: unit.doStep(0.0, 0.01), "before the end of the initialisation")
    unit.exitInitializationMode()
    unit.doStep(0.0, 0.01)
    unit.terminate()
    refused(unit, lambda: unit.doStep(0.01, 0.01), "after the end of the simulation")
    unit.reset()
    refused(unit, lambda: unit.doStep(0.0, 0.01), "before the end of the initialisation")
    unit.begin()
    unit.doStep(0.0, 0.01)
    unit.freeInstance()


def test_initialisations_out_of_turn(export, tmp_path):
    unit = Slave(export("knuckle_boom"), tmp_path / "twice")
    unit.open()
    refused(unit, unit.exitInitializationMode, "an initialisation that has not begun")
    unit.setupExperiment()
    unit.enterInitializationMode()
    refused(unit, unit.enterInitializationMode, "has begun before")
    refused(unit, unit.setupExperiment, "has begun before")
    unit.exitInitializationMode()
    refused(unit, unit.exitInitializationMode, "an initialisation that has not begun")
    refused(unit, unit.enterInitializationMode, "has begun before")
    unit.reset()
    unit.begin()
    unit.freeInstance()


def test_states_of_another_crane(export, slave, boom, tmp_path):
    """Another crane, also one with the same number of everything."""
    twin = tmp_path / "twin.yaml"
    twin.write_text("format: 1\nextends: knuckle_boom\nname: twin\ngravity: [0, 0, -5]\n")
    for other in (slave(export("double_pendulum")), slave(export(str(twin), name="twin"))):
        before = boom.get("payload", "hook_theta")
        state = other.getFMUstate()
        refused(boom, lambda: boom.setFMUstate(state), "another crane, not of knuckle_boom")
        refused(boom, lambda: boom.deSerializeFMUstate(other.serializeFMUstate(state)), "not a state of this crane")
        assert (boom.get("payload", "hook_theta") == before).all()
        other.freeFMUstate(state)
    state = boom.getFMUstate()
    whole = boom.serializeFMUstate(state)
    for wrong in (whole[:-1], whole[1:], whole + b"\0" * 8, b""):
        with pytest.raises(Exception):
            boom.deSerializeFMUstate(wrong)
    boom.setFMUstate(boom.deSerializeFMUstate(whole))
    boom.freeFMUstate(state)


def test_a_unit_without_its_parameters(export, tmp_path):
    broken = tmp_path / "broken.fmu"
    with zipfile.ZipFile(export("knuckle_boom")) as archive, zipfile.ZipFile(broken, "w") as copy:
        for name in archive.namelist():
            copy.writestr(name, b"" if name.endswith("parameters.csv") else archive.read(name))
    unit = Slave(str(broken), tmp_path / "broken")
    with pytest.raises(Exception):
        unit.open()
    assert "parameters.csv has no value of `payload`" in " ".join(unit.messages)


def test_a_logger_may_call_the_unit(export, tmp_path):
    """A message can come at any call: the importer's logger reads a variable of the same unit, and gets the value that it has by then."""
    unit = Slave(export("knuckle_boom"), tmp_path / "logger")
    unit.open()
    unit.begin()
    seen = []

    class Messages(list):
        def append(self, message):
            if len(seen) < 3:
                seen.append(message)
                seen.append(unit.getReal([unit.references["payload"]])[0])

    unit.messages = Messages()
    with pytest.raises(Exception):
        unit.set(payload=-5)
    assert seen[1] == 800
    unit.freeInstance()
