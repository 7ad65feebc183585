"""Arms on hydraulic cylinders as cranes and in Exudyn: angles and pressures over time, with the same openings of the valves.

    python hydraulics.py --command target/release/crane

The arms and their pins are those of Exudyn's own examples; `one_arm.yaml` and `two_arms.yaml` describe them. The runs in Exudyn begin with
the state of those of `crane simulate` at START. Exit code 0 if all agrees, and errors in Exudyn's cylinders are noticed, 1 otherwise.
"""

import argparse
import csv
import json
import math
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import casadi as ca
import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    HydraulicActuatorSimple,
    LoadForceVector,
    MarkerBodyPosition,
    NodeGenericODE1,
    NodeRigidBody2D,
    ObjectGround,
    ObjectRigidBody2D,
    RevoluteJoint2D,
    SensorNode,
)
from scipy.integrate import solve_ivp

from chain import read_chain
from crane_model import read_crane

FOLDER = Path(__file__).resolve().parent
ARMS = ["one_arm", "two_arms"]
# When the runs in Exudyn begin, s: all chambers are under pressure, and the pressures, whose rates Exudyn takes as zero at first, hardly change.
START = 0.6
# Exudyn's step, s. A hundredth of it changes angles by 4e-7 rad, and pressures by 1e-5 of that of the pump.
STEP = 5e-4
# Of `crane simulate`: an error per step, m and rad, and relative.
TOLERANCE = 1e-9
# How far both may be apart: angles, rad, and pressures, as parts of that of the pump. Edges of Exudyn's valves let through K √Δ; ours, laminar
# below ε = 1 bar, K Δ/(Δ² + ε²)^¼, which is less by a share of ε²/4Δ²: 1e-4 at Δ = 46 bar, the least of these runs.
ANGLES, PRESSURES = 5e-5, 1e-4
LAMINAR = 1e5
# Factors of numbers of Exudyn's cylinders that must be noticed.
ERRORS = {
    "oilBulkModulus": 1.1,
    "hoseVolume0": 1.1,
    "hoseVolume1": 1.1,
    "nominalFlow": 1.01,
    "actuatorDamping": 1.01,
    "strokeLength": 1.1,
}


def main():
    """Compares all arms and returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", metavar="PROGRAM", required=True, help="the built program `crane`")
    options = parser.parse_args()
    agree = [compare(name, options.command) for name in ARMS]
    return 0 if all(agree) else 1


def compare(name, command):
    """Whether the arms of a spec move alike in both programs, and do not with any of the errors."""
    arms = Arms(FOLDER / f"{name}.yaml")
    ours, rates = arms.simulate(command)
    theirs = arms.in_exudyn(ours, rates, {})
    differences = theirs.differences(ours)
    agree = differences[0] < ANGLES and differences[1] < PRESSURES
    print(f"{name}: {ours.seconds:.3f} s, in Exudyn {theirs.seconds:.3f} s")
    print(f"  {'':24} angles, rad   pressures / that of the pump")
    print(f"  {'tolerance':24} {ANGLES:11.1e}   {PRESSURES:.1e}")
    print(f"  {'difference':24} {differences[0]:11.1e}   {differences[1]:.1e}  {'ok' if agree else 'FAILED'}")
    for number, factor in ERRORS.items():
        wrong = arms.in_exudyn(ours, rates, {number: factor}).differences(ours)
        noticed = wrong[0] > ANGLES or wrong[1] > PRESSURES
        verdict = "noticed" if noticed else "NOT NOTICED"
        print(f"  {f'{number} × {factor}':24} {wrong[0]:11.1e}   {wrong[1]:.1e}  {verdict}", flush=True)
        agree &= noticed
    return agree


@dataclass
class Run:
    """Angles of all arms from the x axis, rad, and pressures as parts of that of the pump, from START on: a row for each. The seconds that it
    took."""

    times: np.ndarray
    angles: np.ndarray
    pressures: np.ndarray
    seconds: float

    def differences(self, other):
        """The largest differences of angles and of pressures from another run."""
        return [np.abs(mine - its).max() for mine, its in ((self.angles, other.angles), (self.pressures, other.pressures))]


class Arms:
    """Arms in the x-y plane, each turning about a pin of the previous one, with a cylinder between both; the first link is the ground."""

    def __init__(self, path):
        self.path = path
        crane = read_crane(path)
        self.spec = crane.spec.keys
        self.arms = read_chain(crane).links
        self.names = [link["name"] for link in self.spec["links"]]
        self.cylinders = self.spec["cylinders"]
        self.pump = self.spec["pump"]["pressure"]
        self.spools = [
            self.spool(ca.Function("command", [crane.time], [drive.opening]), cylinder["valve"]["lag"])
            for drive, cylinder in zip(crane.drives, self.cylinders)
        ]

    def spool(self, command, lag):
        """Where a spool is after each of Exudyn's steps, from START on: it lags behind its command."""
        times = self.steps()

        def slope(t, place):
            return (float(command(t)) - place) / lag

        return solve_ivp(slope, (0, times[-1]), [0], t_eval=times, max_step=lag, rtol=1e-9, atol=1e-12).y[0].tolist()

    def steps(self):
        """The times of Exudyn's steps."""
        end = self.spec["run"]["duration"]
        return np.linspace(START, end, round((end - START) / STEP) + 1)

    def simulate(self, command):
        """The run of `crane simulate` from START on, and the rates of the angles at START."""
        with tempfile.TemporaryDirectory() as folder:
            arguments = ["simulate", self.path, "--tolerance", str(TOLERANCE), "--out", folder, "--format", "json"]
            summary = subprocess.run([command, *arguments], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
            with open(Path(folder) / f"{self.path.stem}.csv", newline="", encoding="utf-8") as file:
                rows = list(csv.reader(file))
        table = np.array(rows[1:], dtype=float)
        columns = dict(zip((title.split(" ")[0] for title in rows[0]), table[table[:, 0] > START - 1e-9].T))
        of_arms = [f"{name}_psi" for name in self.names[1:]]
        sides = [f"{cylinder['name']}_{side}_pressure" for cylinder in self.cylinders for side in ("piston", "rod")]
        quantities = {entry["quantity"]: entry["value"] for entry in json.loads(summary.stdout)["summary"]}
        run = Run(
            columns["t"],
            np.cumsum([columns[name] for name in of_arms], axis=0),
            np.array([columns[name] for name in sides]) / self.pump,
            quantities["wall time"],
        )
        return run, np.cumsum([columns[f"{name}_rate"][0] for name in of_arms])

    def in_exudyn(self, start, rates, errors):
        """The run in Exudyn from the first state of another with these rates; `errors`: factors of numbers of the cylinders."""
        # The container owns the system and must outlive it.
        container = exu.SystemContainer()
        system = container.AddSystem()
        bodies = Bodies(system, self.names[0])
        gravity = np.array(self.spec["gravity"], float)
        for name, arm, angle, rate in zip(self.names[1:], self.arms, start.angles[:, 0], rates):
            bodies.add(name, arm, angle, rate, gravity)
        cylinders = [
            self.add_cylinder(system, bodies, cylinder, start.pressures[2 * place : 2 * place + 2, 0], errors)
            for place, cylinder in enumerate(self.cylinders)
        ]

        def open_valves(system, t):
            step = round((t - START) / STEP)
            for (actuator, _), openings in zip(cylinders, self.spools):
                opening = openings[step]
                system.SetObjectParameter(actuator, "valveOpening0", opening)
                system.SetObjectParameter(actuator, "valveOpening1", -opening)
            return True

        system.SetPreStepUserFunction(open_valves)
        sensors = [
            system.AddSensor(
                SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=exu.OutputVariableType.Coordinates)
            )
            for node in [*bodies.nodes, *(node for _, node in cylinders)]
        ]
        system.Assemble()
        begun = time.perf_counter()
        system.SolveDynamic(self.settings(start.times[1] - start.times[0]))
        seconds = time.perf_counter() - begun
        stored = [system.GetSensorStoredData(sensor) for sensor in sensors]
        of_arms, of_oil = stored[: len(self.arms)], stored[len(self.arms) :]
        return Run(
            stored[0][:, 0],
            np.array([table[:, 3] for table in of_arms]) + start.angles[:, :1],
            np.concatenate([table[:, 1:3].T for table in of_oil]) / self.pump,
            seconds,
        )

    def add_cylinder(self, system, bodies, cylinder, pressures, errors):
        """A cylinder with its valve: its number, and that of the node of its pressures."""
        piston, rod = (math.pi / 4 * cylinder[key] ** 2 for key in ("bore", "rod"))
        valve = cylinder["valve"]
        drop = valve["pressure_drop"]
        seals = next(c for c in self.spec["connectors"] if c["name"] == f"{cylinder['name']}_seals")
        numbers = {
            "offsetLength": cylinder["retracted"],
            "strokeLength": cylinder["stroke"],
            "chamberCrossSection0": piston,
            "chamberCrossSection1": piston - rod,
            "hoseVolume0": cylinder["hose_volumes"][0],
            "hoseVolume1": cylinder["hose_volumes"][1],
            "oilBulkModulus": cylinder["bulk_modulus"],
            "actuatorDamping": seals["law"]["spring"]["damping"],
            "nominalFlow": valve["flow"] * (drop**2 + LAMINAR**2) ** 0.25 / drop,
        }
        node = system.AddNode(
            NodeGenericODE1(
                referenceCoordinates=[0, 0], initialCoordinates=list(pressures * self.pump), numberOfODE1Coordinates=2
            )
        )
        actuator = system.AddObject(
            HydraulicActuatorSimple(
                markerNumbers=[bodies.marker(cylinder[pin]["link"], cylinder[pin]["at"]) for pin in ("foot", "head")],
                nodeNumbers=[node],
                systemPressure=self.pump,
                tankPressure=0,
                useChamberVolumeChange=True,
                **{name: number * errors.get(name, 1) for name, number in numbers.items()},
            )
        )
        return actuator, node

    def settings(self, output):
        """Exudyn's generalized-alpha method with a fixed step and without damping of its own, with results at an interval."""
        times = self.steps()
        settings = exu.SimulationSettings()
        stepping = settings.timeIntegration
        stepping.startTime, stepping.endTime = times[0], times[-1]
        stepping.numberOfSteps = len(times) - 1
        stepping.generalizedAlpha.spectralRadius = 1
        stepping.newton.numericalDifferentiation.minimumCoordinateSize = 1
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = output
        return settings


class Bodies:
    """Arms as rigid bodies of an Exudyn system with pins between them."""

    def __init__(self, system, ground):
        self.system, self.nodes = system, []
        # Object and centre of mass, by name; of the last one its pin, angle, rate and velocity of the pin too.
        self.objects = {ground: (system.AddObject(ObjectGround()), np.zeros(3))}
        self.last, self.pin, self.turn, self.velocity, self.rate = ground, np.zeros(2), np.eye(2), np.zeros(2), 0.0

    def marker(self, name, at):
        """A marker at a point of an arm, in the frame of its pin."""
        number, com = self.objects[name]
        return self.system.AddMarker(MarkerBodyPosition(bodyNumber=number, localPosition=list(np.array(at, float) - com)))

    def add(self, name, arm, angle, rate, gravity):
        """An arm on the previous one, at an angle from the x axis with its rate."""
        pin = arm.placement[:3, 3]
        joint = self.marker(self.last, pin)
        offset = self.turn @ pin[:2]
        self.pin, self.velocity = self.pin + offset, self.velocity + self.rate * across(offset)
        self.turn, self.rate, self.last = rotation(angle), rate, name
        arm_com = self.turn @ arm.com[:2]
        node = self.system.AddNode(
            NodeRigidBody2D(
                referenceCoordinates=[*(self.pin + arm_com), angle],
                initialVelocities=[*(self.velocity + rate * across(arm_com)), rate],
            )
        )
        body = ObjectRigidBody2D(nodeNumber=node, mass=arm.mass, inertia=arm.tensor[2, 2])
        self.objects[name] = self.system.AddObject(body), arm.com
        self.nodes.append(node)
        self.system.AddObject(RevoluteJoint2D(markerNumbers=[joint, self.marker(name, np.zeros(3))]))
        weight = LoadForceVector(markerNumber=self.marker(name, arm.com), loadVector=list(arm.mass * gravity))
        self.system.AddLoad(weight)


def rotation(angle):
    """A rotation in the plane."""
    return np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])


def across(vector):
    """A vector of the plane, turned by 90°."""
    return np.array([-vector[1], vector[0]])


if __name__ == "__main__":
    sys.exit(main())
