"""One RK44 step of a chain with all its forces in Exudyn.

    python exudyn_peer.py values|time CHAIN STATES [SECONDS]

CHAIN is a pickled pair of chain and springs. Exudyn has a kinematic tree with joints of one degree of freedom, springs and
dampers in the joints; a general second-order object on the same coordinates represents the supports.
"""

import pickle
import sys
import time

import exudyn as exu
import numpy as np
from exudyn.itemInterface import NodeGenericODE2, ObjectGenericODE2, ObjectKinematicTree

KINDS = {
    (True, "x"): exu.JointType.RevoluteX,
    (True, "y"): exu.JointType.RevoluteY,
    (True, "z"): exu.JointType.RevoluteZ,
    (False, "x"): exu.JointType.PrismaticX,
    (False, "y"): exu.JointType.PrismaticY,
    (False, "z"): exu.JointType.PrismaticZ,
}
# A run takes this many steps, another three times as many: the fixed cost of a run cancels in the difference.
STEPS = 200


class Exudyn:
    """The crane, and runs of RK44 over it."""

    def __init__(self, chain, springs, step):
        self.container = exu.SystemContainer()
        self.system = self.container.AddSystem()
        self.step, steps, size = step, chain.steps(), chain.size
        self.node = self.system.AddNode(
            NodeGenericODE2(
                referenceCoordinates=[0] * size,
                initialCoordinates=[0] * size,
                initialCoordinates_t=[0] * size,
                numberOfODE2Coordinates=size,
            )
        )
        self.system.AddObject(
            ObjectKinematicTree(
                nodeNumber=self.node,
                gravity=list(chain.gravity),
                jointTypes=[KINDS[s.is_rotation, s.axis] for s in steps],
                linkParents=list(range(-1, size - 1)),
                jointTransformations=exu.Matrix3DList([s.placement[:3, :3] for s in steps]),
                jointOffsets=exu.Vector3DList([s.placement[:3, 3] for s in steps]),
                linkInertiasCOM=exu.Matrix3DList([s.tensor for s in steps]),
                linkCOMs=exu.Vector3DList([s.com for s in steps]),
                linkMasses=[s.mass for s in steps],
                jointPositionOffsetVector=list(springs.rest),
                jointVelocityOffsetVector=[0] * size,
                jointPControlVector=list(springs.stiffness),
                jointDControlVector=list(springs.damping),
            )
        )
        stiffness, damping, force = springs.base_matrices()
        self.system.AddObject(
            ObjectGenericODE2(
                nodeNumbers=[self.node],
                massMatrix=np.zeros((size, size)),
                stiffnessMatrix=stiffness,
                dampingMatrix=damping,
                forceVector=list(force),
            )
        )
        self.system.Assemble()

    def run(self, q, v, steps, solver=exu.DynamicSolverType.RK44):
        """State after this many steps, and the seconds that they took."""
        system, settings = self.system, exu.SimulationSettings()
        system.systemData.SetODE2Coordinates(q, configuration=exu.ConfigurationType.Initial)
        system.systemData.SetODE2Coordinates_t(v, configuration=exu.ConfigurationType.Initial)
        integration = settings.timeIntegration
        integration.numberOfSteps, integration.endTime = steps, steps * self.step
        integration.verboseMode = 0
        settings.solution.file.write = False
        settings.solution.recordImagesInterval = -1
        settings.show.computationTime = False
        start = time.perf_counter()
        system.SolveDynamic(settings, solverType=solver, storeSolver=False)
        seconds = time.perf_counter() - start
        return system.systemData.GetODE2Coordinates(), system.systemData.GetODE2Coordinates_t(), seconds


def main():
    """The same command line as that of the programs with timing.hpp."""
    task, chain_file, states_file, *seconds = sys.argv[1:]
    with open(chain_file, "rb") as file:
        chain, springs, step = pickle.load(file)
    records = np.fromfile(states_file).reshape(-1, 1 + 3 * chain.size)
    exudyn = Exudyn(chain, springs, step)
    states = [(record[1 : 1 + chain.size], record[1 + chain.size : 1 + 2 * chain.size]) for record in records]
    if task == "values":
        sys.stdout.buffer.write(np.array([np.concatenate(exudyn.run(*state, 1)[:2]) for state in states]).tobytes())
        return
    begun, times = time.perf_counter(), []
    while not times or time.perf_counter() - begun < float(seconds[0]):
        state = states[len(times) % len(states)]
        short, long = (exudyn.run(*state, steps)[2] for steps in (STEPS, 3 * STEPS))
        times.append((long - short) / (2 * STEPS))
    print(np.median(times) * 1e9)


if __name__ == "__main__":
    main()
