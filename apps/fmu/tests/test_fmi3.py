"""Units of FMI 3.0: valid, with the same numbers as FMI 2.0, and with the additions of version 3."""

import ctypes
import subprocess
import zipfile

import numpy as np
import pytest
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu

from conftest import states_and_rates
from test_units import CRANES, FLEXIBLE, HYDRAULIC, PENDULUM, acceleration

VERSION = ("--fmi", "3.0")


@pytest.fixture
def open_unit(tmp_path):
    """Opens a unit in co-simulation, begins, and returns it with references by name and its messages."""
    opened = []

    def make(file, start=0.0, token=None, begin=True, **parameters):
        description = read_model_description(file)
        unit = FMU3Slave(
            guid=token or description.instantiationToken,
            unzipDirectory=extract(file, str(tmp_path / f"unit{len(opened)}")),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="crane",
        )
        unit.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        unit.messages = []
        unit.instantiate(loggingOn=True, logMessage=lambda *message: unit.messages.append(message[-1].decode()))
        opened.append(unit)
        if begin:
            unit.enterInitializationMode(startTime=start)
            for name, value in parameters.items():
                unit.setFloat64([unit.references[name]], [value])
            unit.exitInitializationMode()
        return unit

    yield make
    for unit in opened:
        unit.freeInstance()


def get(unit, *names):
    return np.array(unit.getFloat64([unit.references[name] for name in names]))


def follow(unit, begin, end, steps):
    length = (end - begin) / steps
    for step in range(steps):
        unit.doStep(begin + step * length, length)


@pytest.mark.parametrize("name", CRANES)
def test_every_shipped_crane_is_a_valid_unit(name, export):
    assert validate_fmu(export(name, *VERSION, name="3")) == []


def test_the_archive_names_the_processor(export):
    with zipfile.ZipFile(export("knuckle_boom", *VERSION, name="3")) as archive:
        libraries = [name for name in archive.namelist() if name.startswith("binaries/")]
    assert len(libraries) == 1 and libraries[0].split("/")[1] in ("x86_64-linux", "aarch64-linux", "aarch64-darwin")


@pytest.mark.parametrize("name_of_crane", [FLEXIBLE, HYDRAULIC])
def test_co_simulation_is_the_run_of_the_command(name_of_crane, export, simulate):
    own = simulate(name_of_crane, "--duration", "1", "--output", "0.01")
    names = [name for name in own if name not in ("t", "drive_work", "dissipated_energy", "energy_balance")]
    file = export(name_of_crane, *VERSION, name="3")
    result = simulate_fmu(file, stop_time=1, step_size=0.01, output_interval=0.01, output=names)
    assert len(result) == len(own["t"]) == 101
    for name in names:
        # The same steps by the same library: the difference is rounding of the times, which FMPy accumulates.
        size = max(1.0, np.abs(own[name]).max())
        assert np.abs(result[name] - own[name]).max() < 1e-9 * size, name


def test_model_exchange_is_that_of_version_2(export):
    """The same solver with the same library gives the same numbers, at events too."""
    names = ["load_centre_x", "load_centre_z", "hook_theta", "hook_theta_rate", "main_boom_theta_drive_torque"]
    options = {"fmi_type": "ModelExchange", "stop_time": 3, "output_interval": 0.1, "relative_tolerance": 1e-9, "output": names}
    new = simulate_fmu(export("knuckle_boom", *VERSION, name="3"), **options)
    old = simulate_fmu(export("knuckle_boom"), **options)
    assert len(new) == len(old) > 31
    for name in ("time", *names):
        size = 4e6 if name.endswith("torque") else 1.0
        # Where FMPy rounds the time of an event differently, the solver takes different steps, within its tolerance of 1e-9.
        assert np.abs(new[name] - old[name]).max() < 1e-7 * size, name


def test_parameters_states_and_derivatives(export, open_unit, tmp_path):
    spec = tmp_path / "pendulum.yaml"
    spec.write_text(PENDULUM)
    file = export(str(spec), *VERSION, name="pendulum3")
    assert validate_fmu(file) == []
    variables = {variable.name: variable for variable in read_model_description(file).modelVariables}
    bob = variables["bob"]
    assert (bob.type, bob.causality, bob.variability, bob.start, bob.unit) == ("Float64", "parameter", "tunable", "2", "kg")
    assert bob.description == 'what hangs, "m" < M & so on'
    assert variables["rod_theta_acceleration"].derivative is variables["rod_theta_rate"]
    unit = open_unit(file)
    follow(unit, 0, 0.2, 2)
    angle, before = get(unit, "rod_theta", "rod_theta_acceleration")
    assert abs(before - acceleration(angle, 2)) < 1e-12
    unit.setFloat64([unit.references["bob"]], [50.0])
    assert abs(get(unit, "rod_theta_acceleration")[0] - acceleration(angle, 50)) < 1e-12
    # Back and forth, and serialised.
    state = unit.getFMUState()
    follow(unit, 0.2, 0.4, 2)
    went_on = get(unit, "rod_theta", "rod_theta_rate")
    unit.setFMUState(state)
    assert get(unit, "rod_theta") == [angle]
    other = open_unit(file)
    other.setFMUState(other.deserializeFMUState(unit.serializeFMUState(state)))
    for one in (unit, other):
        follow(one, 0.2, 0.4, 2)
    assert (get(unit, "rod_theta", "rod_theta_rate") == get(other, "rod_theta", "rod_theta_rate")).all()
    # A restored motion has no history: it differs by a few times the tolerance of 2e-5.
    assert np.abs(get(unit, "rod_theta", "rod_theta_rate") - went_on).max() < 1e-4
    unit.freeFMUState(state)
    here = get(unit, "rod_theta")[0]
    names = ("rod_theta_acceleration", "bob_end_z", "rod_theta_rate"), ("rod_theta", "rod_theta_rate")
    unknowns, knowns = ([unit.references[name] for name in those] for those in names)
    found = unit.getDirectionalDerivative(unknowns, knowns, [2.0, 3.0])
    expected = [2 * acceleration(np.pi / 2 - here, 50), 2 * 1.5 * np.sin(here), 3.0]
    off = np.abs(np.array(found) - expected)
    # Of outputs central differences with steps of 6e-6: truncation 1e-11, rounding 1e-10.
    assert off[1] < 1e-7 and max(off[0], off[2]) < 1e-12
    # With weights 1, 4, 5: the transpose, of the same numbers.
    columns = np.array([unit.getDirectionalDerivative(unknowns, [known], [1.0]) for known in knowns])
    back = unit.getAdjointDerivative(unknowns, knowns, [1.0, 4.0, 5.0], nSensitivity=2)
    assert np.abs(np.array(back) - columns @ [1.0, 4.0, 5.0]).max() < 1e-12


def test_adjoint_derivatives_are_the_transpose_of_directional_ones(export, open_unit):
    """With valves, their states, joints that stick and feet, in motion: of all rates, and of an output, which both difference."""
    file = export("eight_link_hydraulic", *VERSION, name="3")
    unit = open_unit(file)
    follow(unit, 0, 0.2, 4)
    states, rates = states_and_rates(file)
    unknowns = [unit.references[name] for name in [*rates, *states[:3], "log_middle_z"]]
    knowns = [unit.references[name] for name in states]
    columns = np.array([unit.getDirectionalDerivative(unknowns, [known], [1.0]) for known in knowns])
    weights = np.cos(np.arange(len(unknowns))) / np.maximum(np.abs(columns).max(axis=0), 1.0)
    back = np.array(unit.getAdjointDerivative(unknowns, knowns, weights, nSensitivity=len(knowns)))
    for found, column, name in zip(back, columns, states):
        assert abs(found - column @ weights) <= 1e-11 * np.abs(column * weights).max(), name


def test_mistakes_of_the_importer_are_refused_with_words(export, open_unit):
    file = export("knuckle_boom", *VERSION, name="3")
    unit = open_unit(file)

    def refused(call, *words):
        unit.messages.clear()
        with pytest.raises(Exception):
            call()
        said = " ".join(unit.messages)
        assert all(word in said for word in words), said

    payload = [unit.references["payload"]]
    refused(lambda: unit.setFloat64(payload, [-5.0]), "payload", "-5", "E03")
    refused(lambda: unit.setFloat64([unit.references["hook_theta"]], [0.1]), "hook_theta", "cannot be set")
    refused(lambda: unit.getFloat64([10_000]), "no variable 10000")
    refused(lambda: unit.getFloat64(payload, nValues=3), "3 values for 1 variables", "no arrays")
    refused(lambda: unit.getInt32([0]), "Int32", "Float64")
    refused(lambda: unit.getClock([0]), "Clock")
    refused(lambda: unit.doStep(0.5, 0.1), "t = 0.5", "is at t = 0")
    refused(lambda: unit.getAdjointDerivative(payload, payload, [1.0]), "payload", "neither a state nor an input")
    hook = [unit.references["hook_theta"]]
    refused(lambda: unit.getAdjointDerivative(hook, hook, [float("nan")]), "weight of hook_theta is NaN")
    # None of this has damaged the crane.
    assert get(unit, "payload") == [800]
    follow(unit, 0, 0.1, 1)
    messages = []
    with pytest.raises(Exception):
        open_unit(file, token="another")
    library = ctypes.CDLL(unit.dll._name)
    library.fmi3InstantiateScheduledExecution.restype = ctypes.c_void_p
    logger = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p)
    log = logger(lambda *message: messages.append(message[-1].decode()))
    texts = [b"crane", b"token", b"/nowhere"]
    assert not library.fmi3InstantiateScheduledExecution(*texts, False, True, None, log, None, None, None)
    assert messages == ["a crane has no clocks and cannot be scheduled: use it for co-simulation or model exchange"]


def test_an_unknown_version_is_refused(request, tmp_path):
    program = request.config.getoption("--command")
    arguments = ["export", "knuckle_boom", "--format", "fmu", "--fmi", "1.0", "-o", tmp_path / "unit.fmu"]
    done = subprocess.run([program, *arguments], capture_output=True, text=True)
    assert done.returncode != 0 and "2.0" in done.stderr and "3.0" in done.stderr
    assert not list(tmp_path.iterdir())
