"""A tree of links in MuJoCo: one body per link, which contains its joints in order."""

import mujoco
import numpy as np

FLAGS = mujoco.mjtDisableBit
# Nothing but the chain: no contact, no constraint, no sensor, no implicit damping; the forces are applied.
DISABLED = (
    FLAGS.mjDSBL_CONSTRAINT
    | FLAGS.mjDSBL_CONTACT
    | FLAGS.mjDSBL_LIMIT
    | FLAGS.mjDSBL_EQUALITY
    | FLAGS.mjDSBL_FRICTIONLOSS
    | FLAGS.mjDSBL_ACTUATION
    | FLAGS.mjDSBL_SENSOR
    | FLAGS.mjDSBL_EULERDAMP
    | FLAGS.mjDSBL_WARMSTART
)
# MuJoCo rejects bodies without mass or inertia: they get this much, kg and kg m².
LEAST_INERTIA = 1e-14


class MuJoCo:
    """A, e and q̈ of a chain: mj_fullM, qfrc_bias, qacc."""

    name = "MuJoCo"

    def __init__(self, chain):
        self.model = build(chain).compile()
        self.data = mujoco.MjData(self.model)
        # The coordinate of each of MuJoCo's joints, which it sorts branch by branch.
        self.order = [int(self.model.joint(joint).name) for joint in range(self.model.njnt)]

    def evaluate(self, q, v, force):
        """A, e and q̈ at a state with generalized forces."""
        data = self.data
        data.qpos, data.qvel, data.qfrc_applied = (numbers[self.order] for numbers in (q, v, force))
        mujoco.mj_forward(self.model, data)
        mass_matrix = np.zeros((self.model.nv, self.model.nv))
        mujoco.mj_fullM(self.model, data, mass_matrix)
        back = np.argsort(self.order)
        return mass_matrix[np.ix_(back, back)], -data.qfrc_bias[back], data.qacc[back]


class LoadedFile(MuJoCo):
    """An MJCF file as MuJoCo loads it, with its own springs, dampers and rotors, and with the order of its joints; what `disabled` flags say
    is off."""

    def __init__(self, path, disabled):
        self.model = mujoco.MjModel.from_xml_path(str(path))
        self.model.opt.disableflags |= int(disabled)
        self.data = mujoco.MjData(self.model)
        self.order = np.arange(self.model.nv)

    def passive(self, q, v):
        """Forces of springs and dampers."""
        self.data.qpos, self.data.qvel = q, v
        mujoco.mj_forward(self.model, self.data)
        return self.data.qfrc_passive.copy()


def with_springs(chain, springs, step):
    """The chain with all forces of the crane as springs and dampers, to be integrated by RK4."""
    spec = build(chain)
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    spec.option.timestep = step
    for index, joint in enumerate(spec.joints):
        joint.name = f"joint_{index}"
        joint.stiffness, joint.damping = linear(springs.stiffness[index]), linear(springs.damping[index])
        joint.springref = springs.rest[index]
    # The length of a fixed tendon is a linear combination of joint positions, like that of a linear support.
    for row, rest, stiffness, damping in springs.principal_rows():
        tendon = spec.add_tendon(stiffness=linear(stiffness), damping=linear(damping), springlength=[rest, rest])
        for index in np.flatnonzero(row):
            tendon.wrap_joint(f"joint_{index}", row[index])
    return spec


def linear(number):
    """MuJoCo's polynomial of a spring or damper."""
    return [number, 0, 0]


def build(chain):
    """The chain as a model to be compiled."""
    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    spec.option.gravity = chain.gravity
    spec.option.disableflags = int(DISABLED)
    bodies = [spec.worldbody]
    for link in chain.links:
        body = bodies[link.parent + 1].add_body(pos=link.placement[:3, 3], quat=quaternion(link.placement[:3, :3]))
        for joint in link.joints:
            kind = mujoco.mjtJoint.mjJNT_HINGE if joint.is_rotation else mujoco.mjtJoint.mjJNT_SLIDE
            added = body.add_joint(type=kind, axis=joint.axis, pos=joint.point, limited=False)
            added.name, added.armature = str(joint.coordinate), chain.armature[joint.coordinate]
        # Principal axes are computed here: MuJoCo's own are accurate only to 1e-12.
        moments, axes = principal(link.tensor)
        body.mass, body.ipos, body.iquat = max(link.mass, LEAST_INERTIA), link.com, quaternion(axes)
        body.inertia = np.maximum(moments, LEAST_INERTIA)
        body.explicitinertial = True
        bodies.append(body)
    return spec


def principal(tensor):
    """Principal moments and axes; the axes of the frame if they are principal."""
    if np.count_nonzero(tensor - np.diag(np.diagonal(tensor))) == 0:
        return np.diagonal(tensor), np.eye(3)
    moments, axes = np.linalg.eigh(tensor)
    return moments, axes * np.linalg.det(axes)


def quaternion(rotation):
    """Unit quaternion (w, x, y, z) of a rotation matrix, from the eigenvector of its quadratic form to full precision."""
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, rotation.ravel())
    return quat / np.linalg.norm(quat)
