"""A tree of links in MuJoCo: one body per link, which contains its joints in order."""

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

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
    is off.

    Free and ball joints have the angles psi, theta, phi of `R = Rz Ry Rx` in place of quaternions. With MuJoCo's velocities `w = S(q) v`,
    `A = Sᵀ M S`, `e = −Sᵀ (bias + M Ṡ v)`, `f = Sᵀ g`."""

    def __init__(self, path, disabled):
        self.model = mujoco.MjModel.from_xml_path(str(path))
        self.model.opt.disableflags |= int(disabled)
        self.data = mujoco.MjData(self.model)
        free, ball = (int(kind) for kind in (mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_BALL))
        # Where the angles of each joint that turns freely begin among q and among MuJoCo's positions, without and with its place.
        self.turning = []
        self.plain = np.ones(self.model.nv, bool)
        for kind, first, place in zip(self.model.jnt_type, self.model.jnt_dofadr, self.model.jnt_qposadr):
            if kind in (free, ball):
                places = 3 if kind == free else 0
                self.turning.append((first + places, place + places))
                self.plain[first + places : first + places + 3] = False
        self.positions = np.ones(self.model.nq, bool)
        for _, place in self.turning:
            self.positions[place : place + 4] = False

    def move_to(self, q, v):
        """Sets MuJoCo's state; returns S and Ṡ."""
        rates, changes = np.eye(q.size), np.zeros((q.size, q.size))
        self.data.qpos[self.positions] = q[self.plain]
        for first, place in self.turning:
            own = slice(first, first + 3)
            self.data.qpos[place : place + 4] = np.roll(Rotation.from_euler("ZYX", q[own]).as_quat(), 1)
            rates[own, own], changes[own, own] = angular_velocity(q[own], v[own])
        self.data.qvel = rates @ v
        return rates, changes

    def evaluate(self, q, v, force):
        """A, e and q̈ at a state with generalized forces."""
        rates, changes = self.move_to(q, v)
        self.data.qfrc_applied = np.linalg.solve(rates.T, force)
        mujoco.mj_forward(self.model, self.data)
        mass_matrix = np.zeros((self.model.nv, self.model.nv))
        mujoco.mj_fullM(self.model, self.data, mass_matrix)
        bias = -rates.T @ (self.data.qfrc_bias + mass_matrix @ changes @ v)
        acceleration = np.linalg.solve(rates, self.data.qacc - changes @ v)
        return rates.T @ mass_matrix @ rates, bias, acceleration

    def passive(self, q, v):
        """Forces of springs, dampers and actuators without commands."""
        rates, _ = self.move_to(q, v)
        mujoco.mj_forward(self.model, self.data)
        return rates.T @ (self.data.qfrc_passive + self.data.qfrc_actuator)


def angular_velocity(angles, rates):
    """S with the angular velocity in the frame of a body `S (psi, theta, phi)˙`, `R = Rz(psi) Ry(theta) Rx(phi)`, and Ṡ."""
    _, (sin_theta, sin_phi), (cos_theta, cos_phi) = angles, np.sin(angles[1:]), np.cos(angles[1:])
    _, theta, phi = rates
    matrix = np.array([[-sin_theta, 0, 1], [cos_theta * sin_phi, cos_phi, 0], [cos_theta * cos_phi, -sin_phi, 0]])
    change = np.array([
        [-cos_theta * theta, 0, 0],
        [-sin_theta * sin_phi * theta + cos_theta * cos_phi * phi, -sin_phi * phi, 0],
        [-sin_theta * cos_phi * theta - cos_theta * sin_phi * phi, -cos_phi * phi, 0],
    ])
    return matrix, change


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
