"""What the tests share: units exported by the command, runs of the command to compare with, and running units."""

import csv
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave, defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE


# A boom whose drive follows an input, with a load that hangs from it and a wind that another input scales.
STEERED = """
format: 1
name: steered
parameters: {payload: {value: 80, unit: kg}}
inputs:
  lever: {motion: {quintic: {from: 0, to: 60 deg, begin: 0.2, duration: 3}}, unit: rad}
  gust: {unit: N, about: wind at the tip}
links:
  - {name: boom, placement: {transform: {rotation: {x: 90 deg}}}, joint: revolute, mass: 200, com: [2, 0, 0], inertia: {gyration: [0.1, 1, 1]}}
  - {name: load, placement: {transform: {translation: [4, 0, 0]}}, joint: revolute, mass: payload, com: [0, -1, 0]}
drives: [{coordinate: boom_psi, stiffness: 2e5, damping: 2e4, motion: {input: lever}}]
loads: [{name: wind, link: boom, at: [4, 0, 0], force: [0, 0, 1], scale: {input: gust}}]
damping: {load_psi: 40}
points: [{name: hook, link: load, at: [0, -1, 0]}]
run: {duration: 2, output: 0.1}
"""


def pytest_addoption(parser):
    parser.addoption("--command", required=True, help="the program `crane`")


@pytest.fixture(scope="session")
def crane(request):
    """Runs the command, and returns what it prints."""
    program = request.config.getoption("--command")

    # Where cargo builds quickly. What is compiled stays beside the command: the next tests find what cargo has built for it.
    folder = Path(__file__).parents[3] / "tests" / "unoptimised"
    environment = {**os.environ, "CRANE_CACHE": str(Path(program).resolve().parents[1] / "tmp" / "units")}

    def run(*arguments, fails=False):
        done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, cwd=folder, env=environment)
        assert (done.returncode != 0) == fails, done.stderr
        return done.stderr if fails else done.stdout

    return run


@pytest.fixture(scope="session")
def refused(crane):
    """What the command says to arguments that it refuses."""
    return lambda *arguments: crane(*arguments, fails=True)


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
def steered(export, tmp_path_factory):
    """The spec with inputs, and its unit."""
    file = tmp_path_factory.mktemp("steered") / "steered.yaml"
    file.write_text(STEERED)
    return file, export(str(file), name="steered")


@pytest.fixture(scope="session")
def simulate(crane, tmp_path_factory):
    """Columns of a run of the command, by name."""

    def run(spec, *options):
        folder = tmp_path_factory.mktemp("run")
        crane("simulate", spec, "--out", folder, "--no-verify", *options)
        with open(folder / f"{Path(spec).stem}.csv", newline="") as file:
            header, *rows = csv.reader(file)
        table = np.array(rows, dtype=float)
        return {title.split(" [")[0]: table[:, place] for place, title in enumerate(header)}

    return run


def states_and_rates(file):
    """Names of all states of a unit, and of their derivatives."""
    pairs = [(variable.derivative.name, variable.name) for variable in read_model_description(file).modelVariables if variable.derivative]
    return [list(names) for names in zip(*pairs)]


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
