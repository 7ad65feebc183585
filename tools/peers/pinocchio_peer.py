"""A tree of links in Pinocchio, every coordinate a joint of one degree of freedom."""

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
        steps = chain.steps()
        for step in steps:
            placement = pin.SE3(step.placement[:3, :3], step.placement[:3, 3])
            kind = JOINTS[step.is_rotation, step.axis]()
            joint = self.model.addJoint(step.parent + 1, kind, placement, f"joint_{step.coordinate}")
            self.model.appendBodyToJoint(joint, pin.Inertia(step.mass, step.com, step.tensor), pin.SE3.Identity())
        # The coordinate of each joint, and the joint of each coordinate.
        self.order = [step.coordinate for step in steps]
        self.back = np.argsort(self.order)
        self.model.armature = chain.armature[self.order]
        self.data = self.model.createData()

    def evaluate(self, q, v, force):
        """A, e and q̈ at a state with generalized forces."""
        q, v, force = (numbers[self.order] for numbers in (q, v, force))
        q = self.configuration(q)
        mass_matrix = np.triu(pin.crba(self.model, self.data, q))
        mass_matrix += np.triu(mass_matrix, 1).T
        bias = -pin.nonLinearEffects(self.model, self.data, q, v)
        accelerations = pin.aba(self.model, self.data, q, v, force)
        return mass_matrix[np.ix_(self.back, self.back)], bias[self.back], accelerations[self.back]

    def configuration(self, angles):
        """Pinocchio's coordinates of a pose, given the angle or path of every joint."""
        return angles

    def transmitted(self, q, v, acceleration, frames):
        """Force and moment that the part beyond a joint exerts on the part before it, in other frames.

        `frames`: the coordinate of each joint, and the pose in the world of the frame.
        """
        q, v, acceleration = (numbers[self.order] for numbers in (q, v, acceleration))
        pin.forwardKinematics(self.model, self.data, q)
        pin.rnea(self.model, self.data, q, v, acceleration)
        wrenches = []
        for coordinate, pose in frames:
            joint = int(self.back[coordinate]) + 1
            needed = self.data.oMi[joint].act(self.data.f[joint])
            wrenches.append(-pin.SE3(pose[:3, :3], pose[:3, 3]).actInv(needed).vector)
        return np.array(wrenches)
