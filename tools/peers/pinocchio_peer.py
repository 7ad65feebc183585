"""A chain in Pinocchio, every coordinate a joint of one degree of freedom."""

import numpy as np
import pinocchio as pin

JOINTS = {
    (True, "x"): pin.JointModelRX,
    (True, "y"): pin.JointModelRY,
    (True, "z"): pin.JointModelRZ,
    (False, "x"): pin.JointModelPX,
    (False, "y"): pin.JointModelPY,
    (False, "z"): pin.JointModelPZ,
}


class Pinocchio:
    """A, e, q̈ and joint wrenches of a chain: crba, nonLinearEffects, aba, rnea."""

    name = "Pinocchio"

    def __init__(self, chain):
        self.model = pin.Model()
        self.model.gravity.linear = chain.gravity
        for last, step in enumerate(chain.steps()):
            placement = pin.SE3(step.placement[:3, :3], step.placement[:3, 3])
            joint = self.model.addJoint(last, JOINTS[step.is_rotation, step.axis](), placement, f"joint_{last}")
            self.model.appendBodyToJoint(joint, pin.Inertia(step.mass, step.com, step.tensor), pin.SE3.Identity())
        self.model.armature = chain.armature
        self.data = self.model.createData()

    def evaluate(self, q, v, force):
        """A, e and q̈ at a state with generalized forces."""
        mass_matrix = np.triu(pin.crba(self.model, self.data, q))
        mass_matrix += np.triu(mass_matrix, 1).T
        bias = -pin.nonLinearEffects(self.model, self.data, q, v)
        return mass_matrix, bias, pin.aba(self.model, self.data, q, v, force).copy()

    def transmitted(self, q, v, acceleration, frames):
        """Force and moment that the part beyond a joint exerts on the part before it, in other frames.

        `frames`: the coordinate of each joint, and the pose in the world of the frame.
        """
        pin.forwardKinematics(self.model, self.data, q)
        pin.rnea(self.model, self.data, q, v, acceleration)
        wrenches = []
        for coordinate, pose in frames:
            needed = self.data.oMi[coordinate + 1].act(self.data.f[coordinate + 1])
            wrenches.append(-pin.SE3(pose[:3, :3], pose[:3, 3]).actInv(needed).vector)
        return np.array(wrenches)
