"""What the tests share: units exported by the command, runs of the command to compare with, and running units."""

import csv
import subprocess

import numpy as np
import pytest
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave, defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE


def pytest_addoption(parser):
    parser.addoption("--command", required=True, help="the program `crane`")


@pytest.fixture(scope="session")
def crane(request):
    """Runs the command."""
    program = request.config.getoption("--command")

    def run(*arguments):
        done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


@pytest.fixture(scope="session")
def export(crane, tmp_path_factory):
    """Exports a crane as a unit, and returns its file."""
    folder = tmp_path_factory.mktemp("units")

    def unit(spec, *options, name="unit"):
        file = folder / f"{spec}-{name}.fmu".replace("/", "-")
        crane("export", spec, "--format", "fmu", "-o", file, *options)
        return str(file)

    return unit


@pytest.fixture(scope="session")
def simulate(crane, tmp_path_factory):
    """Columns of a run of the command, by name."""

    def run(spec, *options):
        folder = tmp_path_factory.mktemp("run")
        crane("simulate", spec, "--out", folder, "--no-verify", *options)
        with open(folder / f"{spec}.csv", newline="") as file:
            header, *rows = csv.reader(file)
        table = np.array(rows, dtype=float)
        return {title.split(" [")[0]: table[:, place] for place, title in enumerate(header)}

    return run


class Slave:
    """A unit in co-simulation: variables by name, messages in a list; everything else is FMPy's."""

    def __init__(self, file, folder, guid=None):
        description = read_model_description(file)
        self.unit = FMU2Slave(
            guid=guid or description.guid,
            unzipDirectory=extract(file, str(folder)),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="crane",
        )
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.messages = []
        self.callbacks = fmi2CallbackFunctions()
        self.callbacks.logger = fmi2CallbackLoggerTYPE(lambda *message: self.messages.append(message[-1].decode()))
        self.callbacks.allocateMemory = defaultCallbacks.allocateMemory
        self.callbacks.freeMemory = defaultCallbacks.freeMemory

    def __getattr__(self, name):
        return getattr(self.unit, name)

    def open(self):
        self.instantiate(callbacks=self.callbacks, loggingOn=True)

    def begin(self, start=0.0, **parameters):
        self.setupExperiment(startTime=start)
        self.enterInitializationMode()
        self.set(**parameters)
        self.exitInitializationMode()

    def set(self, **values):
        for name, value in values.items():
            self.setReal([self.references[name]], [value])

    def get(self, *names):
        return np.array(self.getReal([self.references[name] for name in names]))

    def follow(self, begin, end, steps):
        """Steps from one time to another."""
        length = (end - begin) / steps
        for step in range(steps):
            self.doStep(begin + step * length, length)


@pytest.fixture
def slave(tmp_path):
    """Opens units in co-simulation."""
    opened = []

    def make(file, **parameters):
        unit = Slave(file, tmp_path / f"unit{len(opened)}")
        opened.append(unit)
        unit.open()
        unit.begin(**parameters)
        return unit

    yield make
    for unit in opened:
        unit.terminate()
        unit.freeInstance()
