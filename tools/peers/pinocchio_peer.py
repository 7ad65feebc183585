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
    """A, e and q̈ of a chain: crba, nonLinearEffects, aba."""

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
